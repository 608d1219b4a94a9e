//! Places of a surface that no light reaches because something stands on it: the inside of a rack on
//! the floor, of a column under the ceiling. A patch that is partly covered stores the mean of the rest,
//! which is what can be seen of it.
//!
//! Whether a place is covered is found by walking from it, not by the shape of what covers it: normals
//! of CAD files point anywhere, and furniture stands a little above the floor or a little in it. The
//! test draws its own rays, so that a place is never chosen for what its links see.

use rayon::prelude::*;

use super::aims::Aims;
use super::gaps::Gaps;
use super::look::{Landing, Sight, Way, look};
use crate::emitters::Emitters;
use crate::field::Patches;
use crate::rng::{Rng, Stratified};
use crate::sphere;

/// Places of each patch side that are tried first. Of a patch with a share c covered, (1 − c)⁸ pass as
/// clear: 1 % of the light of such patches, on the mean over c.
const PROBES: u32 = 8;
/// Walks from a place, and their steps: it is dark if none of them comes to light, nor itself is lit.
const WALKS: u32 = 2;
const STEPS: u32 = 6;
/// Rays by which a place looks for luminous surfaces.
const GLANCES: u32 = 8;
/// First item of the random numbers of probes; below are those of patch sides.
const ITEM: u64 = 1 << 40;

/// How much of a patch side light reaches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Cover {
    /// All of it, as far as the probes tell.
    Clear,
    /// A part.
    Partial,
    /// Nothing: it lies in a closed cavity, or in a gap too narrow to matter.
    Dark,
}

/// Tells places apart.
pub(super) struct Cavities<'a> {
    pub emitters: &'a Emitters<'a>,
    pub patches: &'a Patches,
    /// Luminous surfaces, aimed at by their light.
    pub glow: Option<&'a Aims>,
    /// What stands or lies right before a side.
    pub gaps: &'a Gaps,
    /// Per patch side, whether any sample of its direct light saw a luminaire or a luminous surface.
    pub lit: &'a [bool],
    /// Per patch side; empty until it is known.
    pub covers: Vec<Cover>,
}

impl Cavities<'_> {
    /// Probes all patch sides but those that are `known`, drawing from a stream of a seed.
    pub(super) fn probe(&mut self, known: &[Option<Cover>], [seed, stream]: [u64; 2]) {
        self.covers = (0..self.patches.sides())
            .into_par_iter()
            .map(|side| {
                let probed = || self.cover(side, &mut Rng::new(seed, stream, ITEM + side as u64));
                known.get(side).copied().flatten().unwrap_or_else(probed)
            })
            .collect();
    }

    fn cover(&self, side: usize, rng: &mut Rng) -> Cover {
        let scene = self.emitters.scene;
        let (reflectance, transmittance) = scene.bsdf(self.patches.triangle(side)).diffuse();
        if !(reflectance + transmittance > 0.0) {
            return Cover::Clear;
        }
        let mut sight = Sight::new(scene.channels.len());
        let places = Stratified::new(rng);
        let mut lit = 0;
        for probe in 0..PROBES {
            // Without direct light half the probes will do: there are many insides of furniture.
            if probe == PROBES / 2 && lit == 0 && !self.lit[side] {
                break;
            }
            let at = place(self.patches, side, places.point(probe, rng));
            lit += u32::from(self.is_reached(&at, side, rng, &mut sight));
        }
        match lit {
            0 => Cover::Dark,
            PROBES if !self.gaps.beside(side) => Cover::Clear,
            _ => Cover::Partial,
        }
    }

    /// Whether light comes to a place of `side` that is not in a gap.
    pub(super) fn is_reached(&self, place: &Landing, side: usize, rng: &mut Rng, sight: &mut Sight) -> bool {
        if self.gaps.hold(self.emitters.scene, place, side) {
            return false;
        }
        for _ in 0..WALKS {
            if let Some(reached) = self.walk(*place, rng, sight) {
                return reached;
            }
        }
        self.lit[side] && self.sees_light(place, rng)
    }

    /// One walk: whether it came to light or into the dark; `None` if it ended before.
    fn walk(&self, place: Landing, rng: &mut Rng, sight: &mut Sight) -> Option<bool> {
        let scene = self.emitters.scene;
        let mut at = place;
        for _ in 0..STEPS {
            let (reflectance, transmittance) = scene.bsdf(at.triangle).diffuse();
            let same_side = rng.uniform() * (reflectance + transmittance) <= reflectance;
            let facing = if same_side { at.normal } else { -at.normal };
            let direction = sphere::frame(facing) * sphere::cosine_hemisphere(rng.uniforms());
            look(self.emitters, at.origin(scene, same_side), direction, 1.0, rng, sight);
            if sight.met.iter().any(|met| *met > 0.0) {
                return Some(true);
            }
            at = *sight.landings.last()?;
            let side = self.patches.side_at(at.triangle, at.barycentric, at.front);
            if scene.bsdf(at.triangle).emitted() > 0.0 || self.lit[side] && self.sees_light(&at, rng) {
                return Some(true);
            }
            // Even a side that passed as clear may be covered here: direct light is always asked for.
            match self.covers.get(side) {
                Some(Cover::Clear) if !self.lit[side] => return Some(true),
                Some(Cover::Dark) => return Some(false),
                Some(Cover::Clear | Cover::Partial) | None => {}
            }
        }
        None
    }

    /// Whether any luminaire is seen from a place, one ray to each until one is, or a luminous surface.
    fn sees_light(&self, place: &Landing, rng: &mut Rng) -> bool {
        let emitters = self.emitters;
        let scene = emitters.scene;
        let (_, transmittance) = scene.bsdf(place.triangle).diffuse();
        let sides = if transmittance > 0.0 { &[true, false][..] } else { &[true][..] };
        sides.iter().any(|&same_side| {
            let origin = place.origin(scene, same_side);
            let facing = if same_side { place.normal } else { -place.normal };
            emitters.sources[..scene.luminaires.len()].iter().any(|source| {
                emitters.lights(source, place.triangle)
                    && emitters
                        .arrival_if(source, origin, rng.uniforms(), |direction| facing.dot(direction) > 0.0)
                        .is_some_and(|arrival| emitters.passed(source, origin, &arrival) > 0.0)
            })
        }) || self.glow.is_some_and(|glow| sees_glow(glow, emitters, self.patches, place, rng))
    }
}

/// Whether any of a few rays to luminous surfaces meets one.
pub(super) fn sees_glow(
    glow: &Aims,
    emitters: &Emitters,
    patches: &Patches,
    place: &Landing,
    rng: &mut Rng,
) -> bool {
    (0..GLANCES).any(|_| glow.link(emitters, patches, place, rng.uniforms()).is_some())
}

/// A random place of a patch side, as a ray from above would find it.
pub(super) fn place(patches: &Patches, side: usize, u: [f64; 3]) -> Landing {
    let place = patches.place(side, u);
    let front = side.is_multiple_of(2);
    let normal = if front { place.normal } else { -place.normal };
    Landing {
        weight: 1.0,
        to_eye: normal,
        point: place.point,
        normal,
        triangle: patches.triangle(side),
        barycentric: [0.0; 2],
        front,
        way: Way::Turned,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::mesh::Mesh;
    use crate::luminaire::{Luminaire, LuminaireType, Maintenance, orientation};
    use crate::material::{Bsdf, Material};
    use crate::photometry::{IntensityDistribution, Opening};
    use crate::scene::Scene;
    use crate::units::Lumens;
    use glam::DVec3;

    fn cuboid(mesh: &mut Mesh, name: &str, lo: DVec3, hi: DVec3) {
        let surface = mesh.add_surface(name, 0, true);
        cuboid_of(mesh, surface, lo, hi);
    }

    fn cuboid_of(mesh: &mut Mesh, surface: u32, lo: DVec3, hi: DVec3) {
        let p = |k: [usize; 3]| DVec3::new([lo.x, hi.x][k[0]], [lo.y, hi.y][k[1]], [lo.z, hi.z][k[2]]);
        for corners in [
            [p([0, 0, 0]), p([0, 1, 0]), p([1, 1, 0]), p([1, 0, 0])],
            [p([0, 0, 1]), p([1, 0, 1]), p([1, 1, 1]), p([0, 1, 1])],
            [p([0, 0, 0]), p([1, 0, 0]), p([1, 0, 1]), p([0, 0, 1])],
            [p([0, 1, 0]), p([0, 1, 1]), p([1, 1, 1]), p([1, 1, 0])],
            [p([0, 0, 0]), p([0, 0, 1]), p([0, 1, 1]), p([0, 1, 0])],
            [p([1, 0, 0]), p([1, 1, 0]), p([1, 1, 1]), p([1, 0, 1])],
        ] {
            mesh.add_quad(corners, surface);
        }
    }

    /// A room of 4 × 4 × 3 m with a cabinet that stands on the floor, a board 25 cm above the floor that
    /// keeps all direct light off, and one lamp; `origin` moves it all.
    fn room(origin: DVec3) -> Scene {
        let mut mesh = Mesh::default();
        let mut add = |name: &str, lo: [f64; 3], hi: [f64; 3]| {
            cuboid(&mut mesh, name, origin + DVec3::from_array(lo), origin + DVec3::from_array(hi));
        };
        add("room", [0.0; 3], [4.0, 4.0, 3.0]);
        add("cabinet", [0.5, 0.5, 0.0], [1.37, 1.21, 2.0]);
        add("board", [2.5, 2.5, 0.25], [3.5, 3.5, 0.27]);
        let distribution = IntensityDistribution::lambert(Lumens(3000.0));
        let kind = LuminaireType {
            name: "A".into(),
            description: String::new(),
            flux_lm: 3000.0,
            distribution,
            opening: Opening::Rect { length_m: 0.6, width_m: 0.6, side_x_m: 0.0, side_y_m: 0.0 },
            rated_flux_lm: None,
            power_w: None,
            maintenance: Maintenance::NEW,
            file: String::new(),
            declared_ra: None,
            emergency: None,
        };
        let lamp = Luminaire {
            kind: std::sync::Arc::new(kind),
            position: origin + DVec3::new(2.0, 2.0, 2.9),
            world_from_luminaire: orientation(DVec3::NEG_Z, 0.0),
            group: "A".into(),
            dim: 1.0,
            body: Vec::new(),
        };
        let material = Material { name: "grey".into(), bsdf: Bsdf::Lambert { reflectance: 0.5 } };
        Scene::new(mesh, vec![material], vec![lamp]).expect("a scene")
    }

    /// Catches: a covered place that counts as dark floor, a place that is only hard to reach taken for
    /// a covered one; far from the origin too, where a lifted point may fall back into the floor.
    #[test]
    fn what_stands_on_the_floor_covers_it_and_what_hovers_does_not() {
        for origin in [DVec3::ZERO, DVec3::new(3000.0, -2000.0, 500.0)] {
            let scene = room(origin);
            let emitters = Emitters::new(&scene);
            let patches = Patches::new(&scene.mesh, 0.04, |_| true);
            let lit: Vec<bool> = (0..patches.sides())
                .map(|side| {
                    let at = place(&patches, side, [0.5; 3]);
                    let cavities = Cavities {
                        emitters: &emitters,
                        patches: &patches,
                        glow: None,
                        gaps: &Gaps::default(),
                        lit: &[],
                        covers: vec![],
                    };
                    (0..4).any(|k| cavities.sees_light(&at, &mut Rng::new(1, 0, (4 * side + k) as u64)))
                })
                .collect();
            let mut cavities = Cavities {
                emitters: &emitters,
                patches: &patches,
                glow: None,
                gaps: &Gaps::default(),
                lit: &lit,
                covers: vec![],
            };
            cavities.probe(&[], [1, 0]);
            let (mut rng, mut sight) = (Rng::new(1, 2, 3), Sight::new(1));
            let (mut wrong, mut tried, mut covered, mut hovered) = (0, 0, 0, 0);
            for side in 0..patches.sides() {
                let floor = scene.mesh.surfaces
                    [scene.mesh.triangles[patches.triangle(side) as usize].surface as usize]
                    .name
                    == "room";
                // The room's own cuboid has its fronts outside.
                if !floor || side.is_multiple_of(2) {
                    continue;
                }
                for _ in 0..8 {
                    let at = place(&patches, side, rng.uniforms());
                    let p = at.point - origin;
                    if p.z > 1e-6 {
                        continue;
                    }
                    let inside = |lo: f64, hi: f64, x: f64| (lo..hi).contains(&x);
                    let under = inside(0.5, 1.37, p.x) && inside(0.5, 1.21, p.y);
                    tried += 1;
                    covered += i32::from(under);
                    hovered += i32::from(inside(2.5, 3.5, p.x) && inside(2.5, 3.5, p.y));
                    wrong += i32::from(cavities.is_reached(&at, side, &mut rng, &mut sight) == under);
                }
            }
            assert!(covered > 50 && hovered > 100, "{covered} and {hovered} of {tried}");
            // Under the board a walk of a few steps may now and then not get out.
            assert!(
                f64::from(wrong) < 0.01 * f64::from(tried),
                "{wrong} of {tried} places are taken wrongly"
            );
        }
    }

    /// Catches: a hall that only a luminous tile lights taken for a cavity, since walks rarely come to the tile.
    #[test]
    fn luminous_surfaces_are_light_too() {
        let mut mesh = Mesh::default();
        let hall = mesh.add_surface("hall", 0, true);
        cuboid_of(&mut mesh, hall, DVec3::ZERO, DVec3::new(20.0, 10.0, 4.0));
        let tile = mesh.add_surface("tile", 1, true);
        let p = |x: f64, y: f64| DVec3::new(x, y, 3.9);
        mesh.add_quad([p(9.0, 4.0), p(9.0, 5.0), p(10.0, 5.0), p(10.0, 4.0)], tile);
        let materials = vec![
            Material { name: "dark".into(), bsdf: Bsdf::Lambert { reflectance: 0.1 } },
            Material { name: "tile".into(), bsdf: Bsdf::Emitter { luminance_cd_m2: 1e4, reflectance: 0.0 } },
        ];
        let scene = Scene::new(mesh, materials, Vec::new()).expect("a scene");
        let emitters = Emitters::new(&scene);
        let patches = Patches::of_scene(&scene, 1.0);
        let glow = Aims::new(&patches, |side| scene.bsdf(patches.triangle(side)).emitted());
        let clear = |glow: Option<&Aims>| {
            let lit: Vec<bool> = (0..patches.sides())
                .map(|side| {
                    let at = place(&patches, side, [0.5; 3]);
                    let mut rng = Rng::new(3, 0, side as u64);
                    glow.is_some_and(|glow| sees_glow(glow, &emitters, &patches, &at, &mut rng))
                })
                .collect();
            let mut cavities = Cavities {
                emitters: &emitters,
                patches: &patches,
                glow,
                gaps: &Gaps::default(),
                lit: &lit,
                covers: vec![],
            };
            cavities.probe(&[], [1, 0]);
            // Inner sides below the tile: those of the floor.
            let floor = (0..patches.sides()).filter(|&side| {
                let (middle, front) = patches.centre(side);
                let up = if side.is_multiple_of(2) { front.z } else { -front.z };
                middle.z < 1e-6 && up > 0.5
            });
            let covers: Vec<Cover> = floor.map(|side| cavities.covers[side]).collect();
            let clear = covers.iter().filter(|cover| **cover == Cover::Clear).count();
            clear as f64 / covers.len() as f64
        };
        let (known, blind) = (clear(glow.as_ref()), clear(None));
        assert!(known > 0.99, "{known} of the floor is clear");
        assert!(blind < 0.9, "the twin that knows luminaires only finds {blind} clear");
    }
}
