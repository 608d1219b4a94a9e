//! How an eye sees luminous surfaces (`emit`): each is cut into small pieces with their own direction,
//! exact solid angle and visibility, since a luminous ceiling has no one place in the field of view.

use glam::DVec3;

use super::{Emitters, Mirror};
use crate::rng::Rng;
use crate::scene::Channel;

/// Solid angle above which a piece is cut into four, sr.
const PIECE_SR: f64 = 0.004;
/// The same for maps.
const COARSE_SR: f64 = 0.02;
/// Depth of cutting at which it ends: four million pieces of one triangle.
const DEEPEST: u32 = 11;
/// Rays by which the visibility of a piece is known; their spread is its error.
const REPLICATES: usize = 16;

/// A luminous surface as seen from one point, at full factor.
#[derive(Clone, Debug)]
pub struct Shining {
    /// Index into the mesh's surfaces.
    pub surface: usize,
    /// Plane in which it is seen; `None` for the surface itself.
    pub mirror: Option<usize>,
    /// Channel of its light.
    pub channel: usize,
    /// Emitted luminance, cd/m²; what it reflects besides belongs to the background.
    pub luminance_cd_m2: f64,
    /// Its pieces of which anything is visible.
    pub pieces: Vec<Piece>,
    /// Solid angle of the whole surface, hidden parts included, sr.
    pub whole_sr: f64,
    /// Area projected toward the eye, m².
    pub projected_area_m2: f64,
}

/// A piece of a luminous surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// Unit direction from the eye to its middle.
    pub direction: DVec3,
    /// Visible solid angle in each replicate, summed up from rays that met nothing opaque, sr.
    pub visible_sr: f64,
    /// The same, times the transmittance of panes before it, sr.
    pub passed_sr: f64,
    /// ∫ d dω over it, transmittances included: its light on a plane is L times the part along the normal.
    pub passed_vector: DVec3,
    /// Standard error of `passed_sr`, sr; 0 where all of it is visible.
    pub se_sr: f64,
}

/// All luminous surfaces of which anything is visible from `eye`. Draws from `seed` only.
pub fn shining_from(emitters: &Emitters, eye: DVec3, seed: u64) -> Vec<Shining> {
    shining_in_pieces(emitters, eye, seed, PIECE_SR)
}

/// [`shining_from`] in coarse pieces, for maps of many eyes.
pub(super) fn shining_coarsely(emitters: &Emitters, eye: DVec3, seed: u64) -> Vec<Shining> {
    shining_in_pieces(emitters, eye, seed, COARSE_SR)
}

/// [`shining_from`] with pieces of at most `piece_sr`.
pub fn shining_in_pieces(emitters: &Emitters, eye: DVec3, seed: u64, piece_sr: f64) -> Vec<Shining> {
    let mut found = Vec::new();
    if !emitters.scene.channels.iter().any(|channel| matches!(channel, Channel::Surfaces { .. })) {
        return found;
    }
    for mirror in std::iter::once(None).chain((0..emitters.mirrors.len()).map(Some)) {
        found.extend(shining_in(emitters, mirror, eye, seed, piece_sr));
    }
    found
}

/// Luminous surfaces themselves, or their images in one plane.
fn shining_in(
    emitters: &Emitters,
    mirror: Option<usize>,
    eye: DVec3,
    seed: u64,
    piece_sr: f64,
) -> Vec<Shining> {
    let scene = emitters.scene;
    let mesh = &scene.mesh;
    let mut found: Vec<Shining> = Vec::new();
    for triangle in 0..mesh.triangles.len() {
        let luminance_cd_m2 = scene.bsdf(triangle as u32).emitted();
        if !(luminance_cd_m2 > 0.0) {
            continue;
        }
        let surface = mesh.triangles[triangle].surface as usize;
        let material = mesh.surfaces[surface].material;
        let Some(channel) = scene.channels.iter().position(|c| *c == Channel::Surfaces { material }) else {
            continue;
        };
        let mut parts = vec![mesh.corners(triangle)];
        if let Some(mirror) = mirror {
            let plane = &emitters.mirrors[mirror];
            parts = before(plane, mesh.corners(triangle), eye, scene.tracer.offset_m());
            parts = parts.iter().map(|part| part.map(|corner| plane.image(corner))).collect();
        }
        if parts.is_empty() {
            continue;
        }
        let index = found.iter().position(|known| known.surface == surface).unwrap_or_else(|| {
            found.push(Shining {
                surface,
                mirror,
                channel,
                luminance_cd_m2,
                pieces: Vec::new(),
                whole_sr: 0.0,
                projected_area_m2: 0.0,
            });
            found.len() - 1
        });
        // An image's draws differ from those of the surface and of other images.
        let item = triangle as u64 + mirror.map_or(0, |mirror| (mirror as u64 + 1) << 32);
        let mut rng = Rng::new(seed, u64::MAX - 1, item);
        let cutter = Cutter { emitters, eye, piece_sr };
        for corners in parts {
            cutter.cut(corners, [0, DEEPEST], &mut rng, &mut found[index]);
        }
    }
    found.retain(|surface| !surface.pieces.is_empty());
    found
}

/// The part of a triangle that lies on the eye's side of a plane, in triangles: what touches the plane or reaches
/// through it has an image as far as it stands before it. What lies in the plane, within `flat_m`, has none.
fn before(plane: &Mirror, corners: [DVec3; 3], eye: DVec3, flat_m: f64) -> Vec<[DVec3; 3]> {
    let height_m = |point: DVec3| point.dot(plane.normal) - plane.offset_m;
    let sign = height_m(eye).signum();
    let heights = corners.map(|corner| sign * height_m(corner));
    if !(height_m(eye).abs() > 0.0 && heights.iter().any(|height| *height > flat_m)) {
        return Vec::new();
    }
    let mut outline = Vec::with_capacity(4);
    for (index, (&corner, &height)) in corners.iter().zip(&heights).enumerate() {
        let (next, next_height) = (corners[(index + 1) % 3], heights[(index + 1) % 3]);
        if height >= 0.0 {
            outline.push(corner);
        }
        if height * next_height < 0.0 {
            outline.push(corner + (next - corner) * (height / (height - next_height)));
        }
    }
    (2..outline.len()).map(|third| [outline[0], outline[third - 1], outline[third]]).collect()
}

struct Cutter<'e> {
    emitters: &'e Emitters<'e>,
    eye: DVec3,
    piece_sr: f64,
}

impl Cutter<'_> {
    fn cut(&self, corners: [DVec3; 3], [depth, deepest]: [u32; 2], rng: &mut Rng, shining: &mut Shining) {
        let eye = self.eye;
        let solid_angle_sr = solid_angle(corners.map(|corner| corner - eye));
        if !(solid_angle_sr > 0.0) {
            return;
        }
        let [a, b, c] = corners;
        if solid_angle_sr > self.piece_sr && depth < deepest {
            let [ab, bc, ca] = [0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)];
            for part in [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]] {
                self.cut(part, [depth + 1, deepest], rng, shining);
            }
            return;
        }
        let middle = (a + b + c) / 3.0;
        let towards = middle - eye;
        let normal = (b - a).cross(c - a);
        let distance_m = towards.length();
        shining.whole_sr += solid_angle_sr;
        shining.projected_area_m2 += 0.5 * normal.dot(towards / distance_m).abs();
        let (mut visible, mut passed, mut squares) = (0.0, 0.0, 0.0);
        for replicate in 0..REPLICATES {
            // Strata along one edge, random across: all parts of the piece are asked.
            let along = ((replicate as f64 + rng.uniform()) / REPLICATES as f64).sqrt();
            let across = rng.uniform();
            let at = a + along * ((b - a) + across * (c - b));
            let through = self.emitters.clear(eye, at, shining.mirror);
            visible += f64::from(u8::from(through > 0.0));
            passed += through;
            squares += through * through;
        }
        if passed > 0.0 {
            let n = REPLICATES as f64;
            let variance = (squares / n - (passed / n) * (passed / n)).max(0.0) / (n - 1.0);
            shining.pieces.push(Piece {
                direction: towards / distance_m,
                visible_sr: solid_angle_sr * visible / n,
                passed_sr: solid_angle_sr * passed / n,
                passed_vector: vector(corners.map(|corner| corner - eye), towards) * (passed / n),
                se_sr: solid_angle_sr * variance.sqrt(),
            });
        }
    }
}

/// Solid angle of a triangle seen from the origin, sr (Van Oosterom and Strackee 1983).
fn solid_angle([a, b, c]: [DVec3; 3]) -> f64 {
    let (la, lb, lc) = (a.length(), b.length(), c.length());
    let triple = a.dot(b.cross(c)).abs();
    let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    2.0 * triple.atan2(below)
}

/// ∫ d dω over a triangle seen from the origin, ½ Σ Γ_i (Lambert), pointing along `towards`.
fn vector(corners: [DVec3; 3], towards: DVec3) -> DVec3 {
    let mut sum = DVec3::ZERO;
    for (index, &a) in corners.iter().enumerate() {
        let b = corners[(index + 1) % 3];
        let cross = a.cross(b);
        let length = cross.length();
        if length > 0.0 {
            sum += cross * (0.5 * length.atan2(a.dot(b)) / length);
        }
    }
    if sum.dot(towards) < 0.0 { -sum } else { sum }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::mesh::Mesh;
    use crate::material::{Bsdf, Material};
    use crate::scene::Scene;

    /// A luminous square of 1 m at z = 1 over an eye at the origin, and a dark plate of `cover` × 1 m
    /// half way up that hides it from x = −0.5 (in the square's measure) on.
    fn scene(cover: f64) -> Scene {
        let mut mesh = Mesh::default();
        let bright = mesh.add_surface("Panel", 0, false);
        mesh.add_quad(
            [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]].map(|[x, y]| DVec3::new(x, y, 1.0)),
            bright,
        );
        let dark = mesh.add_surface("Plate", 1, false);
        let plate = |x: f64, y: f64| DVec3::new(0.5 * x, 0.5 * y, 0.5);
        let edge = -0.5 + cover.max(1e-6);
        mesh.add_quad([plate(-0.5, -1.0), plate(edge, -1.0), plate(edge, 1.0), plate(-0.5, 1.0)], dark);
        let materials = vec![
            Material {
                name: "Bright".into(),
                bsdf: Bsdf::Emitter { luminance_cd_m2: 1000.0, reflectance: 0.0 },
            },
            Material { name: "Dark".into(), bsdf: Bsdf::Lambert { reflectance: 0.1 } },
        ];
        Scene::new(mesh, materials, Vec::new()).unwrap()
    }

    fn visible_sr(scene: &Scene, piece_sr: f64) -> f64 {
        let emitters = Emitters::new(scene);
        let seen = shining_in_pieces(&emitters, DVec3::ZERO, 1, piece_sr);
        seen.iter().flat_map(|surface| &surface.pieces).map(|piece| piece.visible_sr).sum()
    }

    #[test]
    fn a_square_fills_its_solid_angle_and_hidden_parts_do_not_count() {
        // A square of half side s at distance 1: 4 asin(s²/(1 + s²)). Catches a lost factor, one
        // triangle only, and visibility taken for all or nothing.
        let whole = 4.0 * (0.25f64 / 1.25).asin();
        assert!((visible_sr(&scene(0.0), PIECE_SR) / whole - 1.0).abs() < 1e-3);
        let half = visible_sr(&scene(0.5), PIECE_SR);
        assert!((half / whole - 0.5).abs() < 0.01, "{}", half / whole);
        // An opaque plate over all of it: nothing is seen.
        let hidden = scene(1.0);
        assert!(shining_from(&Emitters::new(&hidden), DVec3::ZERO, 1).is_empty());
    }

    /// A luminous strip that stands upright from z = `from_m` to 1, one metre before an eye, over a mirror at z = 0.
    fn above_a_mirror(from_m: f64) -> f64 {
        let mut mesh = Mesh::default();
        let strip = mesh.add_surface("Strip", 0, false);
        let p = |y: f64, z: f64| DVec3::new(1.0, y, z);
        mesh.add_quad([p(-0.5, from_m), p(0.5, from_m), p(0.5, 1.0), p(-0.5, 1.0)], strip);
        let mirror = mesh.add_surface("Mirror", 1, false);
        mesh.add_quad(
            [[-5.0, -5.0], [5.0, -5.0], [5.0, 5.0], [-5.0, 5.0]].map(|[x, y]| DVec3::new(x, y, 0.0)),
            mirror,
        );
        let emitter = Bsdf::Emitter { luminance_cd_m2: 1000.0, reflectance: 0.0 };
        let materials = vec![
            Material { name: "Bright".into(), bsdf: emitter },
            Material { name: "Mirror".into(), bsdf: Bsdf::Mirror { reflectance: 0.9 } },
        ];
        let scene = Scene::new(mesh, materials, Vec::new()).unwrap();
        let seen = shining_from(&Emitters::new(&scene), DVec3::new(0.0, 0.0, 0.5), 1);
        let images = seen.iter().filter(|surface| surface.mirror.is_some());
        images.flat_map(|surface| &surface.pieces).map(|piece| piece.visible_sr).sum()
    }

    /// Catches: the image of a surface that stands on a mirror, or reaches through it, left out or taken too large.
    #[test]
    fn what_stands_on_a_mirror_is_mirrored_whole() {
        let before = above_a_mirror(1e-3);
        assert!(before > 0.3, "{before}");
        for from_m in [0.0, -1e-12, -0.7] {
            let here = above_a_mirror(from_m);
            assert!((here / before - 1.0).abs() < 0.01, "{from_m}: {here} is not {before}");
        }
        let plane = |z: f64| [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(|[x, y]| DVec3::new(x, y, z));
        let scene = scene(0.5);
        let mirror = &super::super::planes(&scene, 1, |_| true)[0];
        let eye = mirror.normal * (mirror.offset_m + 2.0);
        let height = |z: f64| mirror.normal.z.signum() * z + mirror.normal.z * mirror.offset_m;
        assert!(super::before(mirror, plane(height(0.0)), eye, 1e-6).is_empty(), "in the plane");
        assert_eq!(super::before(mirror, plane(height(1.0)), eye, 1e-6).len(), 1);
        assert!(super::before(mirror, plane(height(-1.0)), eye, 1e-6).is_empty(), "behind it");
    }

    #[test]
    fn a_plate_moving_across_hides_it_little_by_little() {
        // Catches jumps: 2 % of the square at a time, never more than 4 % of its solid angle.
        let whole = visible_sr(&scene(0.0), PIECE_SR);
        let mut before = whole;
        for step in 1..50 {
            let now = visible_sr(&scene(f64::from(step) * 0.02), PIECE_SR);
            assert!(before - now > 0.0 && before - now < 0.04 * whole, "{step}: {before} {now}");
            before = now;
        }
    }
}
