//! The paper's view-independent field (Budak et al. 2021): at each node and side what its material asks for –
//! one number for diffuse luminance, a table over directions for a glossy lobe, nothing for mirrors and panes –
//! interpolated over directions at every node, then between the nodes. Unlike [`super::LuminanceField`] it is no
//! control that a residual corrects: its own error of interpolation stays in every look-up.

use glam::DVec3;

use super::angular::{Form, Weights};
use super::nodes::Nodes;

/// What one side of a node stores, cd/m²: `[number · channels + channel]`, the diffuse luminance first, then
/// the table's numbers if the surface has a lobe.
#[derive(Clone, Debug, PartialEq)]
pub struct Stored {
    /// Values.
    pub numbers: Vec<f64>,
    /// Their standard errors.
    pub errors: Vec<f64>,
}

/// Luminance of node sides and how it is interpolated.
#[derive(Clone, Debug)]
pub struct NodalField {
    /// The mesh.
    pub nodes: Nodes,
    /// Form of the tables.
    pub form: Form,
    /// Numbers are per channel.
    pub channels: usize,
    /// Per node: front and back; none where nothing was asked for.
    pub sides: Vec<[Option<Stored>; 2]>,
}

/// A place on a side of a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// Triangle.
    pub triangle: u32,
    /// Weights of its second and third corner.
    pub barycentric: [f64; 2],
    /// Whether it is its front.
    pub front: bool,
}

/// An interpolated luminance.
#[derive(Clone, Debug, PartialEq)]
pub struct Interpolated {
    /// Per channel, cd/m².
    pub luminance: Vec<f64>,
    /// Standard error of each by those of the nodes; what interpolation errs is not in it, nor that numbers of
    /// harmonics at one node are correlated.
    pub se: Vec<f64>,
}

impl NodalField {
    /// Reflected luminance of a spot towards a direction in the local frame of its side; `None` where a node about
    /// it stores nothing.
    pub fn look(&self, spot: &Spot, to_eye: DVec3) -> Option<Interpolated> {
        let around = self.nodes.around(spot.triangle, spot.barycentric)?;
        let mut weights = Weights::new();
        let mut found = Interpolated { luminance: vec![0.0; self.channels], se: vec![0.0; self.channels] };
        for (node, share) in around {
            let stored = self.sides[node][usize::from(!spot.front)].as_ref()?;
            if stored.numbers.len() > self.channels && weights.is_empty() {
                self.form.weights(to_eye, &mut weights);
            }
            let diffuse = std::iter::once((0, 1.0));
            let table = weights.iter().map(|&(number, weight)| (number as usize + 1, weight));
            for (number, weight) in diffuse.chain(table) {
                let (first, factor) = (number * self.channels, share * weight);
                for channel in 0..self.channels {
                    found.luminance[channel] += factor * stored.numbers[first + channel];
                    found.se[channel] += (factor * stored.errors[first + channel]).powi(2);
                }
            }
        }
        found.se.iter_mut().for_each(|variance| *variance = variance.sqrt());
        Some(found)
    }

    /// Memory of the values, bytes; errors take as much again.
    pub fn bytes(&self) -> usize {
        let stored = self.sides.iter().flatten().flatten();
        stored.map(|stored| size_of_val(stored.numbers.as_slice())).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::mesh::Mesh;

    /// Catches: a table read with another number's weight, errors that add like values.
    #[test]
    fn directions_come_first_then_places() {
        let mut mesh = Mesh::default();
        let surface = mesh.add_surface("sheet", 0, false);
        mesh.add_quad([DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y], surface);
        let nodes = Nodes::new(&mesh, 0.5, 1e-3, |_| true);
        for form in [Form::ThetaPhi { steps: 8 }, Form::Harmonics { order: 4 }, Form::Octahedral { size: 12 }]
        {
            // L = 1 + x (2 + cos² θ) in the second of two channels, x along the sheet.
            let stored = |node: usize, lit: bool| {
                let (triangle, [s, t]) = nodes.place(node);
                let [a, b, c] = mesh.corners(triangle as usize);
                let x = (a + (b - a) * s + (c - a) * t).x;
                let values: Vec<f64> =
                    form.directions().iter().flat_map(|w| [0.0, x * (2.0 + w.z * w.z)]).collect();
                let mut numbers = vec![0.0, 1.0];
                numbers.extend(form.store(&values, 2));
                let errors = vec![0.1; numbers.len()];
                lit.then_some(Stored { numbers, errors })
            };
            let sides = (0..nodes.len()).map(|node| [stored(node, true), stored(node, false)]).collect();
            let field = NodalField { nodes: nodes.clone(), form, channels: 2, sides };
            assert_eq!(field.bytes(), field.nodes.len() * 16 * (1 + form.numbers()));
            let spot = Spot { triangle: 0, barycentric: [0.37, 0.21], front: true };
            let to_eye = DVec3::new(0.3, -0.4, 0.75f64.sqrt());
            let found = field.look(&spot, to_eye).expect("its front is lit");
            let x = spot.barycentric[0] + spot.barycentric[1];
            let truth = 1.0 + x * (2.0 + to_eye.z * to_eye.z);
            assert!((found.luminance[1] - truth).abs() < 0.01, "{form:?}: {found:?} is not {truth}");
            assert!(found.luminance[0].abs() < 1e-12 && found.se[1] > 0.0);
            let elsewhere = field.look(&Spot { barycentric: [0.27, 0.21], ..spot }, to_eye).expect("lit");
            assert!((elsewhere.luminance[1] - truth).abs() > 0.1, "place does not matter");
            assert!(field.look(&Spot { front: false, ..spot }, to_eye).is_none(), "nothing is behind");
        }
    }
}
