//! A world under construction, and the question in which room a point lies.

use std::ops::Range;

use glam::{DVec2, DVec3};

use crate::geometry::gltf::{ImportedLight, ImportedNode};
use crate::geometry::mesh::Mesh;
use crate::geometry::polygon;
use crate::luminaire::Luminaire;
use crate::material::{Bsdf, Material};
use crate::project::{AreaSpec, Camera, CustomRequirement, GlareMap, Room, Viewpoint};

/// What stands on a room's boundary still belongs to it, m.
const TOLERANCE_M: f64 = 0.01;

/// A world before its scene is built.
#[derive(Debug)]
pub struct Draft {
    /// For messages: the file's name, or the room's.
    pub label: String,
    /// Place in the project file to which faults of the whole world point.
    pub span: Range<usize>,
    /// Whether it came from CAD, where luminaires may hang outside of the rooms.
    pub cad: bool,
    pub mesh: Mesh,
    pub materials: Vec<Material>,
    pub nodes: Vec<ImportedNode>,
    /// Light sources of its CAD file.
    pub lights: Vec<ImportedLight>,
    pub rooms: Vec<Room>,
    /// Maintenance of each room.
    pub factors: Vec<RoomFactors>,
    pub luminaires: Vec<Luminaire>,
    pub areas: Vec<AreaSpec>,
    pub viewpoints: Vec<Viewpoint>,
    pub glare_maps: Vec<GlareMap>,
    pub cameras: Vec<Camera>,
    pub requirements: Vec<CustomRequirement>,
}

/// Maintenance factors given for a room.
#[derive(Clone, Debug, Default)]
pub struct RoomFactors {
    /// Where they are written.
    pub span: Range<usize>,
    pub llmf: Option<f64>,
    pub lsf: Option<f64>,
    pub lmf: Option<f64>,
}

impl RoomFactors {
    /// Names of those that are given.
    pub fn given(&self) -> Vec<&'static str> {
        let named = [("llmf", self.llmf), ("lsf", self.lsf), ("lmf", self.lmf)];
        named.into_iter().filter(|(_, factor)| factor.is_some()).map(|(name, _)| name).collect()
    }
}

/// Where a point lies.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Located {
    Outside,
    /// World and room.
    In(usize, usize),
    /// Rooms of different worlds that share the point.
    Ambiguous(String),
}

impl Draft {
    /// An empty world.
    pub fn new(label: &str, span: Range<usize>) -> Self {
        Self {
            label: label.to_owned(),
            span,
            cad: false,
            mesh: Mesh::default(),
            materials: Vec::new(),
            nodes: Vec::new(),
            lights: Vec::new(),
            rooms: Vec::new(),
            factors: Vec::new(),
            luminaires: Vec::new(),
            areas: Vec::new(),
            viewpoints: Vec::new(),
            glare_maps: Vec::new(),
            cameras: Vec::new(),
            requirements: Vec::new(),
        }
    }

    /// Index of a material, added when it is new.
    pub fn material(&mut self, material: &Material) -> usize {
        self.materials.iter().position(|known| known == material).unwrap_or_else(|| {
            self.materials.push(material.clone());
            self.materials.len() - 1
        })
    }

    /// Whether some surface emits.
    pub fn emits(&self) -> bool {
        self.mesh
            .surfaces
            .iter()
            .any(|surface| matches!(self.materials[surface.material].bsdf, Bsdf::Emitter { .. }))
    }

    /// Surfaces with this name, or those of the node with this name or path.
    pub fn surfaces_named(&self, name: &str) -> Vec<u32> {
        let own: Vec<u32> = (0..self.mesh.surfaces.len() as u32)
            .filter(|&index| self.mesh.surfaces[index as usize].name == name)
            .collect();
        let mut found: Vec<u32> = self
            .nodes
            .iter()
            .filter(|node| node.name == name || node.path == name)
            .flat_map(|node| node.surfaces.iter().copied())
            .chain(own)
            .collect();
        found.sort_unstable();
        found.dedup();
        found
    }

    /// Names under which surfaces can be found.
    pub fn surface_names(&self) -> impl Iterator<Item = &str> {
        let surfaces = self.mesh.surfaces.iter().map(|s| s.name.as_str());
        surfaces.chain(self.nodes.iter().map(|node| node.name.as_str()))
    }
}

/// World and room of a name.
pub fn room_named(drafts: &[Draft], name: &str) -> Option<(usize, usize)> {
    rooms(drafts).find(|(_, _, room)| room.name == name).map(|(world, index, _)| (world, index))
}

/// All room names in order.
pub fn room_names(drafts: &[Draft]) -> Vec<&str> {
    rooms(drafts).map(|(_, _, room)| room.name.as_str()).collect()
}

/// All rooms with the indices of world and room.
pub fn rooms(drafts: &[Draft]) -> impl Iterator<Item = (usize, usize, &Room)> {
    drafts.iter().enumerate().flat_map(|(world, draft)| {
        let rooms = draft.rooms.iter().enumerate();
        rooms.map(move |(index, room)| (world, index, room))
    })
}

/// The room in which a point lies; where rooms of one world overlap, the smallest.
pub fn locate(drafts: &[Draft], point: DVec3) -> Located {
    for tolerance_m in [1e-6, TOLERANCE_M] {
        let mut found: Vec<(usize, usize, &Room)> =
            rooms(drafts).filter(|(_, _, room)| within(room, point, tolerance_m)).collect();
        found.sort_by(|a, b| {
            let area = |room: &Room| polygon::signed_area_m2(&room.footprint);
            area(a.2).total_cmp(&area(b.2))
        });
        if let [(world, room, first), rest @ ..] = &found[..] {
            return match rest.iter().find(|(other, _, _)| other != world) {
                Some((_, _, other)) => {
                    Located::Ambiguous(format!("\"{}\" and \"{}\"", first.name, other.name))
                }
                None => Located::In(*world, *room),
            };
        }
    }
    Located::Outside
}

/// The room of an area: the one with most of its points, among several such the one with their centre. Neither
/// an angled outline nor points in both legs of an angled room have their centre in it.
pub fn locate_area(drafts: &[Draft], points: &[DVec3]) -> Located {
    let centre = points.iter().sum::<DVec3>() / points.len() as f64;
    let count = |room: &Room| points.iter().filter(|point| in_room(room, **point)).count();
    let counts: Vec<(usize, usize, &Room, usize)> =
        rooms(drafts).map(|(world, index, room)| (world, index, room, count(room))).collect();
    let most = counts.iter().map(|(.., count)| *count).max().unwrap_or(0);
    let found = locate(drafts, centre);
    if most == 0 {
        return found;
    }
    let best = || counts.iter().filter(|(.., count)| *count == most);
    if let Located::In(world, room) = found
        && best().any(|&(w, r, ..)| (w, r) == (world, room))
    {
        return found;
    }
    let area_m2 = |room: &Room| polygon::signed_area_m2(&room.footprint);
    let Some(&(world, room, first, _)) = best().min_by(|a, b| area_m2(a.2).total_cmp(&area_m2(b.2))) else {
        return found;
    };
    match best().find(|(other, ..)| *other != world) {
        Some((_, _, other, _)) => Located::Ambiguous(format!("\"{}\" and \"{}\"", first.name, other.name)),
        None => Located::In(world, room),
    }
}

/// Whether a point lies in a room, boundary included.
pub fn in_room(room: &Room, point: DVec3) -> bool {
    within(room, point, TOLERANCE_M)
}

fn within(room: &Room, point: DVec3, tolerance_m: f64) -> bool {
    let z = point.z - room.floor_m;
    z >= -tolerance_m
        && z <= room.height_m + tolerance_m
        && polygon::contains(&room.footprint, DVec2::new(point.x, point.y), tolerance_m)
}
