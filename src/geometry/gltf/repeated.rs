//! Triangles that repeat another one of their surface, as exports of "double-sided" faces write them: every
//! surface has two sides here, so the second one would only be a second floor in the place of the first.

use std::collections::BTreeSet;

use crate::geometry::mesh::Mesh;
use crate::geometry::welded::places;

/// Drops triangles whose three corners are those of an earlier triangle of the same surface, in any order;
/// returns how many.
pub(super) fn drop_repeated(mesh: &mut Mesh) -> usize {
    let before = mesh.triangles.len();
    let places = places(mesh);
    let mut known = BTreeSet::new();
    mesh.triangles.retain(|triangle| {
        let mut corners = triangle.vertices.map(|vertex| places[vertex as usize]);
        corners.sort_unstable();
        known.insert((triangle.surface, corners))
    });
    before - mesh.triangles.len()
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    /// Catches: the second side of a face kept, a face of another surface dropped, corners taken by their indices.
    #[test]
    fn a_face_is_there_once_for_each_surface() {
        let mut mesh = Mesh::default();
        let corners = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
        let [a, b, c, d] = corners;
        let floor = mesh.add_surface("Floor", 0, false);
        let board = mesh.add_surface("Board", 0, false);
        mesh.add_quad(corners, floor);
        mesh.add_quad([a, d, c, b], floor);
        mesh.add_quad([a, d, c, b], board);
        mesh.add_quad(corners.map(|p| p + DVec3::Z), floor);
        assert_eq!(drop_repeated(&mut mesh), 2);
        let areas = mesh.surface_areas_m2();
        assert!((areas[0] - 2.0).abs() < 1e-12 && (areas[1] - 1.0).abs() < 1e-12, "{areas:?}");
        assert!(mesh.normal_and_area(0).0.z > 0.0 && mesh.normal_and_area(1).0.z > 0.0, "the first stay");
    }
}
