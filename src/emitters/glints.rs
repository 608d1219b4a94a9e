//! How an eye sees the highlights of luminaires in glossy planes: luminances in small pieces about the
//! mirror image of every luminaire, each by points drawn on the opening *and* rays drawn from the lobe
//! (balance heuristic), so that it holds for lobes sharper than the opening and wider than it.

use glam::DVec3;

use super::{Emitters, Mirror, Source};
use crate::material::{Bsdf, Lobe};
use crate::rng::Rng;
use crate::scene::Scene;
use crate::sphere;

/// At most this many planes, the largest.
const MOST_PLANES: usize = 4;
/// Lobes whose peak ρ_s (n + 1)/2π is less than this many times a white diffuser's 1/π make no highlight
/// worth the name.
const DULL: f64 = 4.0;
/// Half the field about an image that is searched, in widths of the lobe, of 1/√n, and of the opening.
const REACH: [f64; 2] = [3.5, 1.3];
/// Widest half field, as a tangent.
const WIDEST: f64 = 1.0;
/// Cells along each edge of the field, and parts along each edge of a cell where it shines.
const CELLS: usize = 16;
const PARTS: usize = 3;
/// Cells are divided where they, or a neighbour, shine by this share of the brightest.
const SHINES: f64 = 0.02;
/// Independent replicates, each with two estimates of every luminance.
const REPLICATES: usize = 4;
/// Points on the opening, and rays from the lobe, for an estimate.
const POINTS: usize = 4;

/// The highlight of one luminaire in one plane, channel at initial flux and full factor.
#[derive(Clone, Debug)]
pub struct Glint {
    /// Index into [`Emitters::sources`], the luminaire itself.
    pub source: usize,
    /// Surface of the mesh in which it is seen.
    pub surface: u32,
    /// Its pieces, those of every replicate one after the other.
    pub pieces: Vec<Vec<GlintPiece>>,
}

/// A piece of a highlight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlintPiece {
    /// Unit direction from the eye.
    pub direction: DVec3,
    /// Solid angle, sr.
    pub solid_angle_sr: f64,
    /// Luminance, cd/m², unbiased.
    pub luminance_cd_m2: f64,
    /// Its square, the product of two independent estimates: the square of one would read high by its
    /// variance.
    pub square: f64,
}

/// Planes in which highlights are looked for.
pub(super) fn glossy(scene: &Scene) -> Vec<Mirror> {
    let sharp = |bsdf: &Bsdf| {
        bsdf.lobe().is_some_and(|lobe| 0.5 * lobe.albedo(1.0) * (lobe.sharpness() + 1.0) >= DULL)
    };
    super::planes(scene, MOST_PLANES, sharp)
}

/// All highlights that an eye sees. Draws from `seed` only.
pub fn glints_from(emitters: &Emitters, eye: DVec3, seed: u64) -> Vec<Glint> {
    let mut found = Vec::new();
    for (number, plane) in emitters.glossy.iter().enumerate() {
        for index in 0..emitters.scene.luminaires.len() {
            let item = (number * emitters.scene.luminaires.len() + index) as u64;
            let mut rng = Rng::new(seed, STREAM, item);
            found.extend(glint(emitters, plane, index, eye, &mut rng));
        }
    }
    found
}

/// Stream of highlights; see docs/architecture.md for the others.
const STREAM: u64 = u64::MAX - 5;

/// The field about the image of a luminaire in a plane.
struct Field {
    axis: DVec3,
    across: [DVec3; 2],
}

impl Field {
    fn direction(&self, at: [f64; 2]) -> (DVec3, f64) {
        let way = self.axis + self.across[0] * at[0] + self.across[1] * at[1];
        let length = way.length();
        (way / length, 1.0 / (length * length * length))
    }
}

fn glint(emitters: &Emitters, plane: &Mirror, index: usize, eye: DVec3, rng: &mut Rng) -> Option<Glint> {
    let source = &emitters.sources[index];
    let lobe = emitters.scene.bsdf(*plane.triangles.first()?).lobe()?;
    let image = source.image(plane, None);
    let towards = image.position - eye;
    let distance_m = towards.length();
    let axis = towards.try_normalize()?;
    let height_m = (eye.dot(plane.normal) - plane.offset_m).abs();
    let slope = axis.dot(plane.normal).abs();
    if !(slope > 1e-6) || (eye - image.position).dot(plane.normal).abs() <= height_m {
        return None;
    }
    // Turning the ray by ω turns the mirror direction at its foot by ω (1 + d_eye/d_lamp).
    let turn = distance_m / (distance_m - height_m / slope).max(1e-3 * distance_m);
    let half =
        (REACH[0] / (lobe.sharpness().sqrt() * turn) + REACH[1] * image.radius_m / distance_m).min(WIDEST);
    let frame = sphere::frame(axis);
    let field = Field { axis, across: [frame.x_axis, frame.y_axis] };
    let look = Look { emitters, plane, source, eye };
    let edge = 2.0 * half / CELLS as f64;
    let corner =
        |cell: usize| [(cell % CELLS) as f64, (cell / CELLS) as f64].map(|place| -half + edge * place);
    let mut surface = None;
    let mut first = vec![0.0; CELLS * CELLS];
    for (cell, luminance) in first.iter_mut().enumerate() {
        for _ in 0..2 {
            let [x, y] = corner(cell);
            let [u, v] = rng.uniforms();
            let (direction, _) = field.direction([x + edge * u, y + edge * v]);
            if let Some(seen) = look.along(direction, rng) {
                *luminance += seen.luminance;
                surface.get_or_insert(seen.surface);
            }
        }
    }
    let brightest = first.iter().copied().fold(0.0, f64::max);
    let surface = surface.filter(|_| brightest > 0.0)?;
    let shines = |cell: usize| {
        let [x, y] = [cell % CELLS, cell / CELLS];
        let near = |at: usize| at.saturating_sub(1)..=(at + 1).min(CELLS - 1);
        near(x).any(|x| near(y).any(|y| first[y * CELLS + x] > SHINES * brightest))
    };
    let chosen: Vec<usize> = (0..CELLS * CELLS).filter(|&cell| shines(cell)).collect();
    let part = edge / PARTS as f64;
    let replicate = |rng: &mut Rng| {
        let mut pieces = Vec::new();
        for &cell in &chosen {
            for number in 0..PARTS * PARTS {
                let [x, y] = corner(cell);
                let [u, v] = rng.uniforms();
                let at = [x + part * ((number % PARTS) as f64 + u), y + part * ((number / PARTS) as f64 + v)];
                let (direction, cubed) = field.direction(at);
                let Some(seen) = look.along(direction, rng) else { continue };
                if seen.luminance > 0.0 {
                    pieces.push(GlintPiece {
                        direction,
                        solid_angle_sr: part * part * cubed,
                        luminance_cd_m2: seen.luminance,
                        square: seen.square,
                    });
                }
            }
        }
        pieces
    };
    Some(Glint { source: index, surface, pieces: (0..REPLICATES).map(|_| replicate(rng)).collect() })
}

struct Look<'e> {
    emitters: &'e Emitters<'e>,
    plane: &'e Mirror,
    source: &'e Source,
    eye: DVec3,
}

struct Seen {
    luminance: f64,
    square: f64,
    surface: u32,
}

impl Look<'_> {
    /// What the lobe sends back along a line of sight; `None` where it does not meet the plane.
    fn along(&self, direction: DVec3, rng: &mut Rng) -> Option<Seen> {
        let scene = self.emitters.scene;
        let reach = f64::INFINITY;
        let (distance_m, triangle) = self.plane.meet(self.eye, direction, reach)?;
        let lift = scene.tracer.offset_m();
        let passed = scene.tracer.transmittance(self.eye, direction, distance_m - 2.0 * lift, &[]);
        if !(passed > 0.0 && self.emitters.lights(self.source, triangle)) {
            return None;
        }
        let side = self.plane.normal * -direction.dot(self.plane.normal).signum();
        let lobe = scene.bsdf(triangle).lobe()?;
        let point = self.eye + direction * distance_m + side * lift;
        let world = sphere::frame(side);
        let to_eye = world.transpose() * -direction;
        let [a, b] = [(); 2].map(|()| passed * self.estimate(lobe, point, world, to_eye, rng));
        Some(Seen { luminance: 0.5 * (a + b), square: a * b, surface: scene.tracer.surface(triangle) })
    }

    /// ∫ f L cos dω over the opening, cd/m².
    fn estimate(&self, lobe: &Lobe, point: DVec3, world: glam::DMat3, to_eye: DVec3, rng: &mut Rng) -> f64 {
        let (emitters, source) = (self.emitters, self.source);
        let mut sum = 0.0;
        for _ in 0..POINTS {
            let above = |direction: DVec3| world.z_axis.dot(direction) > 0.0;
            if let Some(arrival) = emitters.arrival_if(source, point, rng.uniforms(), above) {
                let local = world.transpose() * arrival.direction;
                let mut light = arrival.normal_lx * lobe.f(local, to_eye) * local.z;
                if !source.is_point() {
                    let drawn = emitters.density(source, &arrival);
                    light *= drawn / (drawn + lobe.pdf(local, to_eye));
                }
                if light > 0.0 && light.is_finite() {
                    sum += light * emitters.passed(source, point, &arrival);
                }
            }
            let Some((local, share)) = lobe.sample(to_eye, rng.uniforms()) else { continue };
            let direction = world * local;
            let Some((luminance, arrival)) = emitters.along(source, point, direction) else { continue };
            let found = lobe.pdf(local, to_eye);
            let drawn = emitters.density(source, &arrival);
            sum += share * luminance * emitters.passed(source, point, &arrival) * found / (found + drawn);
        }
        sum / POINTS as f64
    }
}
