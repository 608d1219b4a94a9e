//! Which corners of a mesh are one, and which of its surfaces close round a solid. Files give faces corners of
//! their own, so what belongs together shows by the places alone.

use super::mesh::Mesh;

/// Corners closer than this are one, m: a tenth of a micrometre.
const SAME_M: f64 = 1e-7;

/// For each vertex the first one in its place.
pub fn places(mesh: &Mesh) -> Vec<u32> {
    let cell = |index: u32| mesh.positions[index as usize].to_array().map(|x| (x / SAME_M).round() as i64);
    let mut order: Vec<u32> = (0..mesh.positions.len() as u32).collect();
    order.sort_by_key(|index| (cell(*index), *index));
    let mut first = vec![0; order.len()];
    for (place, &index) in order.iter().enumerate() {
        let before = place.checked_sub(1).map(|place| order[place]);
        let same = before.filter(|before| cell(*before) == cell(index));
        first[index as usize] = same.map_or(index, |before| first[before as usize]);
    }
    first
}

/// For each surface whether it closes round a solid: every edge joins an even number of its triangles, however
/// their corners run. A sheet has a rim, which belongs to one.
pub fn closed_surfaces(mesh: &Mesh) -> Vec<bool> {
    let places = places(mesh);
    let mut edges: Vec<[u32; 3]> = Vec::with_capacity(3 * mesh.triangles.len());
    let mut closed = vec![false; mesh.surfaces.len()];
    for triangle in &mesh.triangles {
        closed[triangle.surface as usize] = true;
        let [a, b, c] = triangle.vertices.map(|vertex| places[vertex as usize]);
        edges.extend([[a, b], [b, c], [c, a]].map(|[a, b]| [triangle.surface, a.min(b), a.max(b)]));
    }
    edges.sort_unstable();
    for run in edges.chunk_by(|one, other| one == other) {
        if run.len() % 2 == 1 {
            closed[run[0][0] as usize] = false;
        }
    }
    closed
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    /// Catches: corners joined by index alone, a rim that is passed over, a winding that matters.
    #[test]
    fn a_tetrahedron_closes_and_a_bag_does_not() {
        let p = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let mut mesh = Mesh::default();
        let [whole, open] = ["Whole", "Open"].map(|name| mesh.add_surface(name, 0, true));
        for (surface, faces) in [(whole, 4), (open, 3)] {
            for corners in [[0, 1, 2], [0, 1, 3], [1, 2, 3], [0, 2, 3]].iter().take(faces) {
                let first = mesh.positions.len() as u32;
                mesh.positions.extend(corners.map(|corner: usize| p[corner]));
                let vertices = [first, first + 1, first + 2];
                mesh.triangles.push(crate::geometry::mesh::Triangle { vertices, surface });
            }
        }
        assert_eq!(closed_surfaces(&mesh), [true, false]);
        assert_eq!(places(&mesh)[..6], [0, 1, 2, 0, 1, 5]);
    }
}
