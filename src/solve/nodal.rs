//! The paper's field, solved: every number of a [`NodalField`] is estimated without bias where its node is, by
//! rays that gather into the frozen field of patches and walks that mend it. What is looked up between nodes and
//! directions errs by interpolation beyond that, so nothing here has an interval, and nothing judges: it is
//! there for the error to be measured. Direct light may be stored, as in the paper, or be left to the look-up.

mod sight;
mod split;

use glam::DVec3;
use rayon::prelude::*;

use super::Prepared;
use super::answer::{ANALOG, Desk, SIGHT, see, walk};
use super::lobe::scatter_at;
use super::look::{Landing, Way, add_direct};
use crate::estimate::Estimate;
use crate::field::angular::Form;
use crate::field::nodal::{NodalField, Spot, Stored};
use crate::field::nodes::Nodes;
use crate::rng::{Rng, Stratified};
use crate::scene::Scene;
use crate::sphere;

pub use sight::nodal_luminance;

/// Stream of what nodes draw; item = side of a node.
const STREAM: u64 = u64::MAX - 7;
/// Tables are sampled at least this far above the horizon (cos θ): *at* it lobes are dark, their limit is not.
const HORIZON: f64 = 1e-3;

/// Rays of one estimate, for the diffuse part and for the lobe each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NodeRays {
    /// Rays into the field of patches, at least 1.
    pub gather: u32,
    /// Those of them that are walked on from, at most `gather`; without any the errors of the patches stay.
    pub walks: u32,
}

impl NodeRays {
    /// Every ray walked on from.
    pub fn walked(rays: u32) -> Self {
        Self { gather: rays, walks: rays }
    }

    /// Shares of ray number `ray` in what is gathered and in what walks add.
    fn shares(self, ray: u32) -> [f64; 2] {
        let walked = if ray < self.walks { 1.0 / f64::from(self.walks) } else { 0.0 };
        [1.0 / f64::from(self.gather), walked]
    }
}

/// Which light the nodes store.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StoredLight {
    /// All of it, as in the paper.
    All,
    /// All but what luminaires send straight to the node; that is computed at every look-up.
    Indirect,
    /// All, direct light in channels of its own before those of the rest: for studies, which compare both.
    Apart,
}

/// How a nodal field is built.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodalEffort {
    /// Form of the tables of glossy surfaces.
    pub form: Form,
    /// Which light is stored.
    pub light: StoredLight,
    /// Independent estimates of every number, at least 2; their scatter gives its standard error.
    pub blocks: u32,
    /// Rays of each estimate.
    pub rays: NodeRays,
    /// Whether and how cells are split.
    pub splitting: Option<Splitting>,
}

/// Splits cells where |L(middle of an edge) − interpolated| > max(tolerance, 2 · standard error).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Splitting {
    /// Luminance, cd/m²; for tables root mean square over directions.
    pub tolerance_cd_m2: f64,
    /// How often a cell may be split, at most [`crate::field::nodes::DEEPEST`].
    pub deepest: u32,
}

impl Default for NodalEffort {
    fn default() -> Self {
        Self {
            form: Form::Harmonics { order: 8 },
            light: StoredLight::Indirect,
            blocks: 8,
            rays: NodeRays { gather: 16, walks: 8 },
            splitting: None,
        }
    }
}

/// Reflected luminance by where its light comes from, cd/m² per channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Reflected {
    /// From luminaires straight, their images in planar mirrors included.
    pub direct: Vec<f64>,
    /// All other.
    pub indirect: Vec<f64>,
}

impl Reflected {
    fn dark(channels: usize) -> Self {
        Self { direct: vec![0.0; channels], indirect: vec![0.0; channels] }
    }

    /// What a table of such light holds of it.
    fn stored(&self, light: StoredLight) -> Vec<f64> {
        match light {
            StoredLight::All => self.direct.iter().zip(&self.indirect).map(|(a, b)| a + b).collect(),
            StoredLight::Indirect => self.indirect.clone(),
            StoredLight::Apart => [self.direct.as_slice(), &self.indirect].concat(),
        }
    }
}

/// Nodes on all surfaces but mirrors and panes, `spacing_m` from each other and `inset_m` from edges.
pub fn scattering_nodes(scene: &Scene, spacing_m: f64, inset_m: f64) -> Nodes {
    Nodes::new(&scene.mesh, spacing_m, inset_m, |triangle| {
        scene.bsdf(triangle as u32).specular(1.0).is_none()
    })
}

/// Solves the nodal field on the sides of nodes that `asked` names (node, front), by a scene that was prepared for
/// the method of links.
pub fn nodal_field(
    prepared: &Prepared,
    effort: &NodalEffort,
    nodes: Nodes,
    asked: impl Fn(usize, bool) -> bool + Sync,
) -> NodalField {
    let own = prepared.scene.channels.len();
    let channels = if effort.light == StoredLight::Apart { 2 * own } else { own };
    let mut field = NodalField { nodes, form: effort.form, channels, sides: Vec::new() };
    solve_new(prepared, effort, &asked, &mut field);
    if let Some(splitting) = &effort.splitting {
        split::refine(splitting, &mut field, |field| solve_new(prepared, effort, &asked, field));
    }
    field
}

/// Solves the nodes that have been added.
fn solve_new(
    prepared: &Prepared,
    effort: &NodalEffort,
    asked: &(impl Fn(usize, bool) -> bool + Sync),
    field: &mut NodalField,
) {
    let directions: Vec<DVec3> = effort.form.directions().into_iter().map(above_horizon).collect();
    let nodes = &field.nodes;
    let new: Vec<_> = (field.sides.len()..nodes.len())
        .into_par_iter()
        .map(|node| {
            [true, false].map(|front| {
                let (triangle, barycentric) = nodes.place(node);
                let spot = Spot { triangle, barycentric, front };
                asked(node, front).then(|| stored(prepared, effort, &spot, &directions, node))
            })
        })
        .collect();
    field.sides.extend(new);
}

fn above_horizon(direction: DVec3) -> DVec3 {
    DVec3::new(direction.x, direction.y, direction.z.max(HORIZON)).normalize()
}

/// All that one side of a node stores.
fn stored(
    prepared: &Prepared,
    effort: &NodalEffort,
    spot: &Spot,
    directions: &[DVec3],
    node: usize,
) -> Stored {
    let own = prepared.scene.channels.len();
    let channels = if effort.light == StoredLight::Apart { 2 * own } else { own };
    let mut rng = Rng::new(prepared.seed, STREAM, (2 * node + usize::from(!spot.front)) as u64);
    let mut desk = Desk::new(own);
    let mut known = |values: &mut Vec<f64>, variances: &mut Vec<f64>, to_eye: Option<DVec3>| {
        let mut blocks = vec![Vec::with_capacity(effort.blocks as usize); channels];
        for _ in 0..effort.blocks {
            let found = match to_eye {
                Some(to_eye) => by_lobe(prepared, spot, to_eye, effort.rays, &mut rng, &mut desk),
                None => diffusely(prepared, spot, effort.rays, &mut rng, &mut desk),
            };
            for (blocks, value) in blocks.iter_mut().zip(found.stored(effort.light)) {
                blocks.push(value);
            }
        }
        for estimate in blocks.iter().map(|blocks| Estimate::from_blocks(blocks)) {
            values.push(estimate.value);
            variances.push(estimate.se * estimate.se);
        }
    };
    let (mut numbers, mut variances) = (Vec::new(), Vec::new());
    known(&mut numbers, &mut variances, None);
    if prepared.scene.bsdf(spot.triangle).lobe().is_some() {
        let (mut values, mut of_values) = (Vec::new(), Vec::new());
        for direction in directions {
            known(&mut values, &mut of_values, Some(*direction));
        }
        numbers.extend(effort.form.store(&values, channels));
        variances.extend(effort.form.store_variances(&of_values, channels));
    }
    Stored { numbers, errors: variances.into_iter().map(f64::sqrt).collect() }
}

/// Reflected luminance of a spot towards `to_eye` (unit, local to its side), diffuse and glossy together: one
/// estimate, unbiased with walks. It is what a field without steps in place and direction holds.
pub fn reflected(
    prepared: &Prepared,
    spot: &Spot,
    to_eye: DVec3,
    rays: NodeRays,
    rng: &mut Rng,
) -> Reflected {
    let mut desk = Desk::new(prepared.scene.channels.len());
    let mut all = diffusely(prepared, spot, rays, rng, &mut desk);
    if prepared.scene.bsdf(spot.triangle).lobe().is_some() {
        let glossy = by_lobe(prepared, spot, above_horizon(to_eye), rays, rng, &mut desk);
        all.direct.iter_mut().zip(glossy.direct).for_each(|(sum, add)| *sum += add);
        all.indirect.iter_mut().zip(glossy.indirect).for_each(|(sum, add)| *sum += add);
    }
    all
}

/// A spot as a ray that comes along `to_eye` (local) would arrive at it.
fn landing(prepared: &Prepared, spot: &Spot, to_eye: DVec3) -> Landing {
    let scene = prepared.scene;
    let [a, b, c] = scene.mesh.corners(spot.triangle as usize);
    let [s, t] = spot.barycentric;
    let front = scene.tracer.normal(spot.triangle);
    let normal = if spot.front { front } else { -front };
    Landing {
        weight: 1.0,
        to_eye: sphere::frame(normal) * to_eye,
        point: a + (b - a) * s + (c - a) * t,
        normal,
        triangle: spot.triangle,
        barycentric: spot.barycentric,
        front: spot.front,
        way: Way::Clear,
    }
}

/// Diffuse luminance: L = (ρ + τ)/π ∫ L_in |cos| dω over both sides in proportion to ρ and τ.
fn diffusely(prepared: &Prepared, spot: &Spot, rays: NodeRays, rng: &mut Rng, desk: &mut Desk) -> Reflected {
    let mut found = Reflected::dark(desk.seen.len());
    let here = landing(prepared, spot, DVec3::Z);
    let (reflectance, transmittance) = prepared.scene.bsdf(spot.triangle).diffuse();
    let albedo = reflectance + transmittance;
    if !(albedo > 0.0) {
        return found;
    }
    let sequence = Stratified::new(rng);
    for ray in 0..rays.gather {
        add_diffuse_lamps(prepared, &here, 1.0 / f64::from(rays.gather), rng, desk, &mut found.direct);
        let [u, v, side] = sequence.point(ray, rng);
        let facing = if side * albedo < reflectance { here.normal } else { -here.normal };
        let direction = sphere::frame(facing) * sphere::cosine_hemisphere([u, v]);
        let origin = here.origin(prepared.scene, here.normal.dot(direction) > 0.0);
        let shares = rays.shares(ray).map(|share| albedo * share);
        add_arriving(prepared, (origin, direction), shares, rng, desk, &mut found.indirect);
    }
    found
}

/// Adds the luminance that arrives along a ray: what is stored where it ends times the first share and, unless that
/// is none, what a walk from there adds times the second.
fn add_arriving(
    prepared: &Prepared,
    (origin, direction): (DVec3, DVec3),
    [gathered, walked]: [f64; 2],
    rng: &mut Rng,
    desk: &mut Desk,
    out: &mut [f64],
) {
    see(prepared, origin, direction, ANALOG, rng, desk);
    for (sum, seen) in out.iter_mut().zip(&desk.seen) {
        *sum += gathered * seen;
    }
    if walked > 0.0 {
        walk(prepared, rng, desk);
        for (sum, residual) in out.iter_mut().zip(&desk.residual) {
            *sum += walked * residual;
        }
    }
}

/// Adds one sample of what luminaires make diffuse luminance, times `share`.
fn add_diffuse_lamps(
    prepared: &Prepared,
    here: &Landing,
    share: f64,
    rng: &mut Rng,
    desk: &mut Desk,
    out: &mut [f64],
) {
    let sight = &mut desk.sight;
    sight.met.fill(0.0);
    let shadow_rays = prepared.effort.shadow_rays;
    add_direct(&prepared.emitters, here, shadow_rays, rng, &mut sight.scratch, &mut sight.met);
    for (sum, met) in out.iter_mut().zip(&sight.met) {
        *sum += share * met;
    }
}

/// Luminance that the lobe reflects: L = ∫ f L_in cos dω by rays drawn from it, and by points on openings.
fn by_lobe(
    prepared: &Prepared,
    spot: &Spot,
    to_eye: DVec3,
    rays: NodeRays,
    rng: &mut Rng,
    desk: &mut Desk,
) -> Reflected {
    let mut found = Reflected::dark(desk.seen.len());
    let here = landing(prepared, spot, to_eye);
    let sequence = Stratified::new(rng);
    let share = 1.0 / f64::from(rays.gather);
    for ray in 0..rays.gather {
        let point = sequence.point(ray, rng);
        let onward = add_glossy_lamps(prepared, &here, point, share, rng, desk, &mut found.direct);
        let Some((origin, direction, weight)) = onward else { continue };
        let shares = rays.shares(ray).map(|share| weight * share);
        add_arriving(prepared, (origin, direction), shares, rng, desk, &mut found.indirect);
    }
    found
}

/// Adds one sample of the luminaires that the lobe reflects, times `share`; origin, direction and weight of the
/// ray that goes on. `point` is that of the lobe ray and, its second half, of the points on openings.
fn add_glossy_lamps(
    prepared: &Prepared,
    here: &Landing,
    point: [f64; 4],
    share: f64,
    rng: &mut Rng,
    desk: &mut Desk,
    out: &mut [f64],
) -> Option<(DVec3, DVec3, f64)> {
    let lobe = prepared.scene.bsdf(here.triangle).lobe()?;
    let shadow_rays = prepared.effort.shadow_rays;
    let [u, v, s, t] = point;
    let points = |source: Option<usize>, _: &mut Rng| if source.is_some() { [s, t] } else { [u, v] };
    let sight = &mut desk.sight;
    sight.met.fill(0.0);
    let onward = scatter_at(&prepared.emitters, lobe, here, [SIGHT, shadow_rays], points, rng, sight);
    for (sum, met) in out.iter_mut().zip(&sight.met) {
        *sum += share * met;
    }
    onward.map(|onward| (onward.origin, onward.direction, onward.weight))
}
