//! The triangles of one world with their surfaces. A *surface* is what a user can name (a wall, a
//! glTF node, a piece of furniture); it has exactly one material and both of its sides reflect.

use super::DVec3;

/// Triangles that share vertices, in project coordinates.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Vertex positions in metres.
    pub positions: Vec<DVec3>,
    /// Triangles; the front side is where the vertices run counter-clockwise.
    pub triangles: Vec<Triangle>,
    /// Surfaces, referred to by [`Triangle::surface`].
    pub surfaces: Vec<Surface>,
}

/// One triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Triangle {
    /// Indices into [`Mesh::positions`].
    pub vertices: [u32; 3],
    /// Index into [`Mesh::surfaces`].
    pub surface: u32,
}

/// A named part of the world.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Surface {
    /// Name as a user writes it: `Wall_N`, or the glTF node's name.
    pub name: String,
    /// Index into the world's materials.
    pub material: usize,
    /// Whether this is loose furniture rather than the room's shell (drawn as outline on plans).
    pub furniture: bool,
}

impl Mesh {
    /// Corner positions of triangle `index`.
    pub fn corners(&self, index: usize) -> [DVec3; 3] {
        self.triangles[index].vertices.map(|vertex| self.positions[vertex as usize])
    }

    /// Unit normal of the front side and area in m² of triangle `index`.
    pub fn normal_and_area(&self, index: usize) -> (DVec3, f64) {
        let [a, b, c] = self.corners(index);
        let cross = (b - a).cross(c - a);
        let length = cross.length();
        (cross / length, 0.5 * length)
    }

    /// Adds a surface and returns its index.
    pub fn add_surface(&mut self, name: impl Into<String>, material: usize, furniture: bool) -> u32 {
        self.surfaces.push(Surface { name: name.into(), material, furniture });
        (self.surfaces.len() - 1) as u32
    }

    /// Adds a planar convex quadrilateral as two triangles, corners counter-clockwise seen from its front.
    pub fn add_quad(&mut self, corners: [DVec3; 4], surface: u32) {
        let first = self.positions.len() as u32;
        self.positions.extend(corners);
        for vertices in [[0, 1, 2], [0, 2, 3]] {
            self.triangles.push(Triangle { vertices: vertices.map(|v| first + v), surface });
        }
    }

    /// Smallest and largest coordinates; `None` for an empty mesh.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let first = *self.positions.first()?;
        Some(self.positions.iter().fold((first, first), |(lo, hi), &p| (lo.min(p), hi.max(p))))
    }

    /// Area in m² of each surface (one side).
    pub fn surface_areas_m2(&self) -> Vec<f64> {
        let mut areas = vec![0.0; self.surfaces.len()];
        for (index, triangle) in self.triangles.iter().enumerate() {
            areas[triangle.surface as usize] += self.normal_and_area(index).1;
        }
        areas
    }
}
