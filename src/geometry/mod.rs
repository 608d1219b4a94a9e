//! Geometry: the triangle mesh of a world, primitive shapes, glTF import, and the ray tracer.
//! Everything here is in project coordinates: metres, Z up, f64 (f32 lives in [`trace`] only).

pub mod gltf;
pub mod mesh;
pub mod polygon;
pub mod trace;
pub mod welded;

pub use glam::{DMat3, DVec2, DVec3};
