//! (skeleton)
use super::mesh::Mesh;
use crate::material::Material;

/// Ray tracer over a mesh.
#[derive(Debug)]
pub struct Tracer {}

impl Tracer {
    /// Builds the acceleration structure.
    pub fn build(_mesh: &Mesh, _materials: &[Material]) -> Self {
        Self {}
    }
}
