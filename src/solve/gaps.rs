//! Narrow gaps: the desk under a mouse or a sheet of paper, the floor under a rack on feet of a millimetre. A patch
//! is far larger than what covers it there, so what it stores says nothing of the gap, and walks that slip in
//! between find the same wrong luminance again and again: rare, and heavy. Places in a gap therefore count as dark.
//! What is stored decides noise only: walks still bring what light there is.

use rayon::prelude::*;

use super::covered::place;
use super::look::Landing;
use crate::field::Patches;
use crate::material::Bsdf;
use crate::rng::{Rng, Stratified};
use crate::scene::Scene;

/// Widest gap, m …
const WIDEST_M: f64 = 0.005;
/// … and as a share of the scene's size: models may be small.
const OF_SIZE: f64 = 5e-4;
/// Places of a patch side from which gaps are looked for.
const PLACES: u32 = 8;
/// First item of their random numbers, in the field's stream.
const ITEM: u64 = 1 << 41;

/// Which patch sides border on gaps.
#[derive(Clone, Debug, Default)]
pub(super) struct Gaps {
    widest_m: f64,
    /// Per patch side; empty where nothing was looked for.
    beside: Vec<bool>,
}

impl Gaps {
    /// Looks for gaps from every patch side; both sides of what is found border on one.
    pub(super) fn new(scene: &Scene, patches: &Patches, [seed, stream]: [u64; 2]) -> Self {
        let widest_m = WIDEST_M.min(OF_SIZE * scene.tracer.size_m());
        let pairs: Vec<[usize; 2]> = (0..patches.sides())
            .into_par_iter()
            .filter(|&side| keeps_light_away(scene.bsdf(patches.triangle(side))))
            .flat_map_iter(|side| {
                let mut rng = Rng::new(seed, stream, ITEM + side as u64);
                let places = Stratified::new(&mut rng);
                (0..PLACES).filter_map(move |number| {
                    let at = place(patches, side, places.point(number, &mut rng));
                    if !is_shut(scene, widest_m, &at) {
                        return None;
                    }
                    let hit = scene.tracer.closest(at.origin(scene, true), at.normal, &[])?;
                    let lid = scene.bsdf(hit.triangle);
                    // Mirrors and panes have no patches.
                    let other = || match lid.specular(1.0) {
                        Some(_) => side,
                        None => patches.side_at(hit.triangle, hit.barycentric, hit.front),
                    };
                    keeps_light_away(lid).then(|| [side, other()])
                })
            })
            .collect();
        let mut beside = vec![false; patches.sides()];
        for side in pairs.into_iter().flatten() {
            beside[side] = true;
        }
        Self { widest_m, beside }
    }

    /// Whether a patch side borders on a gap somewhere.
    pub(super) fn beside(&self, side: usize) -> bool {
        self.beside.get(side).copied().unwrap_or(false)
    }

    /// Whether a place of `side` lies in a gap.
    pub(super) fn hold(&self, scene: &Scene, place: &Landing, side: usize) -> bool {
        self.beside(side) && is_shut(scene, self.widest_m, place)
    }
}

/// Whether something that lets nothing through straight lies right before a place.
fn is_shut(scene: &Scene, widest_m: f64, place: &Landing) -> bool {
    !(scene.tracer.transmittance(place.origin(scene, true), place.normal, widest_m, &[]) > 0.0)
}

/// Whether a surface keeps light away: neither shines nor passes any, as opals do. Panes shut no place.
fn keeps_light_away(bsdf: &Bsdf) -> bool {
    let (_, transmittance) = bsdf.diffuse();
    !(transmittance > 0.0 || bsdf.emitted() > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::mesh::Mesh;
    use crate::material::{Bsdf, Material};
    use glam::DVec3;

    fn level(mesh: &mut Mesh, surface: u32, [x0, x1, y0, y1]: [f64; 4], z: f64, is_up: bool) {
        let p = |x: f64, y: f64| DVec3::new(x, y, z);
        let up = [p(x0, y0), p(x1, y0), p(x1, y1), p(x0, y1)];
        let down = [p(x0, y0), p(x0, y1), p(x1, y1), p(x1, y0)];
        mesh.add_quad(if is_up { up } else { down }, surface);
    }

    /// A desk of 2 × 1 m on which lie, a millimetre above it, a book, a mirror and a luminous plate, and 1 cm above it a
    /// shelf; `scale` changes all lengths.
    fn desk(scale: f64) -> Scene {
        let mut mesh = Mesh::default();
        let materials = vec![
            Material { name: "wood".into(), bsdf: Bsdf::Lambert { reflectance: 0.5 } },
            Material { name: "plate".into(), bsdf: Bsdf::Emitter { luminance_cd_m2: 9.0, reflectance: 0.9 } },
            Material { name: "mirror".into(), bsdf: Bsdf::Mirror { reflectance: 0.9 } },
        ];
        for (name, material, box_m, z, is_up) in [
            ("desk", 0, [0.0, 2.0, 0.0, 1.0], 0.0, true),
            ("book", 0, [0.2, 0.5, 0.2, 0.4], 0.001, false),
            ("mirror", 2, [0.6, 1.0, 0.2, 0.4], 0.001, false),
            ("plate", 1, [0.2, 0.3, 0.7, 0.8], 0.001, false),
            ("shelf", 0, [1.4, 1.9, 0.2, 0.8], 0.01, false),
        ] {
            let surface = mesh.add_surface(name, material, false);
            level(&mut mesh, surface, box_m.map(|x| scale * x), scale * z, is_up);
        }
        Scene::new(mesh, materials, Vec::new()).expect("a scene")
    }

    /// Catches: a gap missed because what covers it is smaller than a patch, a patch of a mirror asked for, a shelf
    /// or what shines taken for a lid, a small model that is all gaps.
    #[test]
    fn under_a_book_there_is_a_gap_and_under_a_shelf_there_is_none() {
        for scale in [1.0, 0.01] {
            let scene = desk(scale);
            let patches = Patches::of_scene(&scene, 0.01 * scale * scale);
            let gaps = Gaps::new(&scene, &patches, [1, 0]);
            let mut rng = Rng::new(2, 3, 4);
            let (mut held, mut wrong) = (0, 0);
            for side in 0..patches.sides() {
                for _ in 0..200 {
                    let at = place(&patches, side, rng.uniforms());
                    let p = at.point / scale;
                    let inside = |lo: f64, hi: f64, x: f64| (lo..hi).contains(&x);
                    let between = p.z < 0.002 && (p.z < 1e-6) == (at.normal.z > 0.0);
                    let covered = inside(0.2, 0.5, p.x) || inside(0.6, 1.0, p.x);
                    let expected = between && covered && inside(0.2, 0.4, p.y);
                    held += i32::from(expected);
                    wrong += i32::from(gaps.hold(&scene, &at, side) != expected);
                }
            }
            assert!(held > 100, "{held} places lie under the book, scale {scale}");
            assert_eq!(wrong, 0, "of {held}, scale {scale}");
        }
    }
}
