//! A scene is one closed world of light: geometry, materials, luminaires and the tracer over them,
//! validated once. It knows no norm, no observer and no file.

mod furniture;

use std::sync::{Arc, OnceLock};

use glam::DVec3;

use crate::digest::Hash;
use crate::geometry::mesh::Mesh;
use crate::geometry::trace::{Simd, Tracer};
use crate::geometry::welded::closed_surfaces;
use crate::luminaire::Luminaire;
use crate::material::{Bsdf, Material};

pub use furniture::{in_a_surface, inside_furniture};

/// Everything light can meet.
#[derive(Debug)]
pub struct Scene {
    /// The triangles; degenerate ones were dropped before.
    pub mesh: Mesh,
    /// Materials, referred to by the mesh's surfaces.
    pub materials: Vec<Material>,
    /// Placed luminaires.
    pub luminaires: Vec<Luminaire>,
    /// Channels in a fixed order; see [`Channel`].
    pub channels: Vec<Channel>,
    /// Channel of each luminaire.
    pub channel_of: Vec<usize>,
    /// Ray tracer over `mesh`.
    pub tracer: Tracer,
    /// Per surface: whether it is part of a luminaire's body.
    of_a_body: Vec<bool>,
    /// Per surface: whether it closes round a solid; found when it is first asked for.
    closed: OnceLock<Vec<bool>>,
}

/// What a line of sight met of luminaires' bodies since it was last turned by something else.
///
/// A luminaire's own light passes its body as if it were not there until something reflects it. Traced
/// against the light: whoever has met a body, by passing or by reflection, has seen that luminaire
/// before or never will on this line.
#[derive(Clone, Debug, Default)]
pub struct BodiesMet(Vec<u32>);

impl BodiesMet {
    /// The line goes on straight behind a pane.
    #[inline]
    pub fn passed(&mut self, scene: &Scene, triangle: u32) {
        let surface = scene.tracer.surface(triangle);
        if scene.of_a_body[surface as usize] {
            self.0.push(surface);
        }
    }

    /// The line was turned by a mirror.
    #[inline]
    pub fn reflected(&mut self, scene: &Scene, triangle: u32) {
        self.0.clear();
        self.passed(scene, triangle);
    }

    /// Whether nothing more is to be seen of a luminaire along this line.
    #[inline]
    pub fn shut(&self, luminaire: &Luminaire) -> bool {
        !self.0.is_empty() && self.0.iter().any(|surface| luminaire.body.contains(surface))
    }
}

/// The unit that is solved separately at initial flux: one luminaire group of one type, or one
/// emitting material. Maintenance, dimming and light scenes are weights applied afterwards.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Channel {
    /// All luminaires of `kind` in `group`.
    Luminaires {
        /// Control group.
        group: String,
        /// Name of the luminaire type.
        kind: String,
    },
    /// All surfaces of an emitting material (index into the scene's materials).
    Surfaces {
        /// Index into [`Scene::materials`].
        material: usize,
    },
}

/// Why a scene cannot be solved.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SceneError {
    /// No triangle is left.
    #[error("the scene has no triangles")]
    NoTriangles,
    /// A vertex is NaN or infinite.
    #[error("vertex {index} of surface \"{surface}\" is not finite: {position}")]
    NotFinite {
        /// Vertex index.
        index: usize,
        /// Surface that uses it.
        surface: String,
        /// The position.
        position: DVec3,
    },
    /// Light can never leave or be absorbed.
    #[error(
        "material \"{0}\" reflects all light (reflectance + transmittance = 1) and so does every other surface: a closed scene without absorption has no finite solution"
    )]
    NoAbsorption(String),
    /// Too many triangles for 32-bit indices.
    #[error("{0} triangles are more than the limit of 100 million")]
    TooLarge(usize),
}

impl Scene {
    /// Validates the parts and builds the tracer.
    ///
    /// # Errors
    /// [`SceneError`] names the first fault.
    pub fn new(mesh: Mesh, materials: Vec<Material>, luminaires: Vec<Luminaire>) -> Result<Self, SceneError> {
        Self::new_with(mesh, materials, luminaires, Simd::Detect)
    }

    /// [`Scene::new`] with an explicit SIMD level, which never changes a result.
    ///
    /// # Errors
    /// [`SceneError`] names the first fault.
    pub fn new_with(
        mesh: Mesh,
        materials: Vec<Material>,
        luminaires: Vec<Luminaire>,
        simd: Simd,
    ) -> Result<Self, SceneError> {
        validate(&mesh, &materials)?;
        let mut channels: Vec<Channel> = Vec::new();
        let mut channel_of = Vec::with_capacity(luminaires.len());
        for luminaire in &luminaires {
            let channel =
                Channel::Luminaires { group: luminaire.group.clone(), kind: luminaire.kind.name.clone() };
            let index = channels.iter().position(|known| *known == channel).unwrap_or_else(|| {
                channels.push(channel);
                channels.len() - 1
            });
            channel_of.push(index);
        }
        let used = |material: usize| {
            mesh.triangles.iter().any(|t| mesh.surfaces[t.surface as usize].material == material)
        };
        for (material, entry) in materials.iter().enumerate() {
            if matches!(entry.bsdf, Bsdf::Emitter { .. }) && used(material) {
                channels.push(Channel::Surfaces { material });
            }
        }
        let tracer = Tracer::build_with(&mesh, &materials, simd);
        let mut of_a_body = vec![false; mesh.surfaces.len()];
        for &surface in luminaires.iter().flat_map(|luminaire| &luminaire.body) {
            of_a_body[surface as usize] = true;
        }
        Ok(Self {
            mesh,
            materials,
            luminaires,
            channels,
            channel_of,
            tracer,
            of_a_body,
            closed: OnceLock::new(),
        })
    }

    /// Whether a surface closes round a solid; see [`closed_surfaces`].
    pub fn is_closed(&self, surface: u32) -> bool {
        self.closed.get_or_init(|| closed_surfaces(&self.mesh))[surface as usize]
    }

    /// SHA-256 of everything that decides how light goes: geometry, materials and luminaires at initial
    /// flux. Cameras, viewpoints, areas, light scenes and norms do not enter.
    pub fn fingerprint(&self) -> String {
        let mut hash = Hash::default();
        for position in &self.mesh.positions {
            position.to_array().iter().for_each(|x| hash.add(x.to_bits().to_le_bytes()));
        }
        for triangle in &self.mesh.triangles {
            triangle.vertices.iter().for_each(|vertex| hash.add(vertex.to_le_bytes()));
            hash.add(triangle.surface.to_le_bytes());
        }
        // Debug prints numbers to the last bit.
        let mut add = |text: String| {
            hash.add((text.len() as u64).to_le_bytes());
            hash.add(text);
        };
        add(format!("{:?} {:?} {:?}", self.mesh.surfaces, self.materials, self.channels));
        for (index, luminaire) in self.luminaires.iter().enumerate() {
            let known = self.luminaires[..index].iter().rposition(|l| Arc::ptr_eq(&l.kind, &luminaire.kind));
            add(match known {
                Some(before) => format!("as {before}"),
                None => format!("{:?} {:?}", luminaire.kind.distribution, luminaire.kind.opening),
            });
            let (position, axes) = (luminaire.position, luminaire.world_from_luminaire);
            add(format!(
                "{position:?} {axes:?} {:?} {} {:?}",
                luminaire.dim, luminaire.group, luminaire.body
            ));
        }
        hash.hex()
    }

    /// Area of the surfaces that scatter (all but mirrors and clear panes), m².
    pub fn scattering_m2(&self) -> f64 {
        let triangles = 0..self.mesh.triangles.len();
        let scatters = |&t: &usize| self.bsdf(t as u32).specular(1.0).is_none();
        triangles.filter(scatters).map(|t| self.mesh.normal_and_area(t).1).sum()
    }

    /// The scattering model of each surface.
    pub fn surfaces(&self) -> impl Iterator<Item = &Bsdf> {
        self.mesh.surfaces.iter().map(|surface| &self.materials[surface.material].bsdf)
    }

    /// Triangles from which light may come beside what luminaires send straight: those that scatter or shine, and
    /// mirrors and panes where there are such. None in a scene that is black.
    pub fn returning(&self) -> Vec<u32> {
        let returns = |bsdf: &Bsdf| bsdf.emitted() > 0.0 || bsdf.albedo(1.0) > 0.0 || bsdf.albedo(0.05) > 0.0;
        if !self.surfaces().any(|bsdf| bsdf.specular(1.0).is_none() && returns(bsdf)) {
            return Vec::new();
        }
        (0..self.mesh.triangles.len() as u32).filter(|&triangle| returns(self.bsdf(triangle))).collect()
    }

    /// Whether a surface reflects in a glossy lobe.
    pub fn has_lobes(&self) -> bool {
        self.surfaces().any(|bsdf| bsdf.lobe().is_some())
    }

    /// The scattering model of triangle `index`.
    pub fn bsdf(&self, triangle: u32) -> &Bsdf {
        let surface = self.mesh.triangles[triangle as usize].surface;
        &self.materials[self.mesh.surfaces[surface as usize].material].bsdf
    }
}

fn validate(mesh: &Mesh, materials: &[Material]) -> Result<(), SceneError> {
    if mesh.triangles.is_empty() {
        return Err(SceneError::NoTriangles);
    }
    if mesh.triangles.len() > 100_000_000 {
        return Err(SceneError::TooLarge(mesh.triangles.len()));
    }
    for triangle in &mesh.triangles {
        for vertex in triangle.vertices {
            let position = mesh.positions[vertex as usize];
            if !position.is_finite() {
                let surface = mesh.surfaces[triangle.surface as usize].name.clone();
                return Err(SceneError::NotFinite { index: vertex as usize, surface, position });
            }
        }
    }
    let mut lossless = None;
    for surface in &mesh.surfaces {
        let material = &materials[surface.material];
        if material.bsdf.absorbs() {
            return Ok(());
        }
        lossless = Some(material.name.clone());
    }
    lossless.map_or(Ok(()), |name| Err(SceneError::NoAbsorption(name)))
}
