//! Places that a tile of pixels sees, sorted by the planes on which they lie: light on a plane changes evenly
//! from pixel to pixel, and one shaft holds all its ways to a luminaire.

use std::f64::consts::FRAC_1_PI;
use std::ops::Range;

use glam::DVec3;

use super::super::look::Way;
use super::{BLOCK, Picture, Seen, Sight, TILE};
use crate::sphere;

/// Fewer places of a plane go among the loose ones: for so few, evenness saves nothing.
const FEWEST: usize = 10;
/// Planes among which that of a place is looked for.
const RECENT: usize = 8;
/// A plane is seen evenly if no corner of the tile sees it from this many times as far as another one.
const ASLANT: f64 = 8.0;

/// A place with the side on which light arrives.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    /// Index of the pixel within the tile.
    pub pixel: usize,
    /// Triangle on which it lies.
    pub triangle: u32,
    /// Where shadow rays start.
    pub origin: DVec3,
    pub normal: DVec3,
    /// Luminance in the pixel per illuminance, cd/m²/lx.
    pub factor: f64,
}

/// Lines of sight through the centres of a tile's pixels; `None` outside of the image.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lines<'t> {
    pub eye: DVec3,
    pub centres: &'t [Option<DVec3>; TILE * TILE],
}

/// Places in one plane, at most one for each pixel; or loose ones.
#[derive(Debug)]
pub(super) struct Group<'t> {
    pub spots: Vec<Spot>,
    /// Ranges of them that lie in one square of pixels.
    pub blocks: Vec<Range<usize>>,
    /// Of a plane: the corners of a rectangle in it that holds them, m.
    pub rectangle: Option<[DVec3; 4]>,
    /// Where straight lines of sight through all pixels of the tile meet the plane.
    pub nodes: Option<Nodes<'t>>,
}

impl Group<'_> {
    /// Places that have nothing in common.
    fn loose(mut spots: Vec<Spot>) -> Self {
        let block = |spot: &Spot| spot.pixel / TILE / BLOCK * (TILE / BLOCK) + spot.pixel % TILE / BLOCK;
        spots.sort_by_key(block);
        let mut blocks = Vec::with_capacity((TILE / BLOCK) * (TILE / BLOCK));
        let mut first = 0;
        for one in spots.chunk_by(|a, b| block(a) == block(b)) {
            blocks.push(first..first + one.len());
            first += one.len();
        }
        Self { spots, blocks, rectangle: None, nodes: None }
    }
}

/// The plane through a point, as a tile sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nodes<'t> {
    lines: Lines<'t>,
    point: DVec3,
    normal: DVec3,
}

impl Nodes<'_> {
    /// Distance along a pixel's line of sight, m.
    fn distance_m(&self, pixel: usize) -> Option<f64> {
        let line = self.lines.centres[pixel]?;
        let distance_m = (self.point - self.lines.eye).dot(self.normal) / line.dot(self.normal);
        (distance_m > 0.0).then_some(distance_m)
    }

    /// The place in the plane that a pixel sees, m.
    pub(super) fn at(&self, pixel: usize) -> DVec3 {
        let line = self.lines.centres[pixel].unwrap_or(DVec3::ZERO);
        self.lines.eye + line * self.distance_m(pixel).unwrap_or(0.0)
    }

    /// Itself, if the whole tile could see the plane.
    fn checked(self) -> Option<Self> {
        let corners = [0, TILE - 1, TILE * (TILE - 1), TILE * TILE - 1];
        let [mut nearest, mut farthest] = [f64::INFINITY, 0.0f64];
        for corner in corners {
            let distance_m = self.distance_m(corner)?;
            (nearest, farthest) = (nearest.min(distance_m), farthest.max(distance_m));
        }
        let whole = self.lines.centres.iter().all(Option::is_some);
        (whole && farthest < ASLANT * nearest).then_some(self)
    }
}

/// Places of one plane on the way.
struct Found {
    spots: Vec<Spot>,
    straight: bool,
}

impl Found {
    fn holds(&self, spot: &Spot, straight: bool) -> bool {
        let first = &self.spots[0];
        self.straight == straight
            && self.spots.last().is_none_or(|last| last.pixel != spot.pixel)
            && spot.normal.dot(first.normal) > 1.0 - 1e-9
            && first.normal.dot(spot.origin - first.origin).abs() < 1e-6
    }

    fn group(self, lines: Lines<'_>) -> Group<'_> {
        let Spot { origin: point, normal, .. } = self.spots[0];
        let nodes = Nodes { lines, point, normal };
        let frame = sphere::frame(normal);
        let axes = [frame.x_axis, frame.y_axis];
        let [mut low, mut high] = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        for spot in &self.spots {
            for (k, axis) in axes.iter().enumerate() {
                let along = axis.dot(spot.origin - point);
                (low[k], high[k]) = (low[k].min(along), high[k].max(along));
            }
        }
        let corner = |x: f64, y: f64| point + axes[0] * x + axes[1] * y;
        let rectangle = [
            corner(low[0], low[1]),
            corner(high[0], low[1]),
            corner(high[0], high[1]),
            corner(low[0], high[1]),
        ];
        let nodes = if self.straight { nodes.checked() } else { None };
        Group { rectangle: Some(rectangle), nodes, ..Group::loose(self.spots) }
    }
}

/// All places of a tile, in groups.
pub(super) fn gather<'t>(
    picture: &Picture,
    sights: &[Sight; TILE * TILE],
    lines: Lines<'t>,
) -> Vec<Group<'t>> {
    let scene = picture.emitters.scene;
    let mut planes: Vec<Found> = Vec::new();
    for (pixel, sight) in sights.iter().enumerate() {
        for Seen { landing, share } in &sight.places {
            let (reflectance, transmittance) = scene.bsdf(landing.triangle).diffuse();
            let straight = landing.way != Way::Turned;
            for (albedo, same_side) in [(reflectance, true), (transmittance, false)] {
                if !(albedo > 0.0) {
                    continue;
                }
                let normal = if same_side { landing.normal } else { -landing.normal };
                let origin = landing.origin(scene, same_side);
                let factor = share * albedo * FRAC_1_PI;
                let spot = Spot { pixel, triangle: landing.triangle, origin, normal, factor };
                match planes.iter_mut().rev().take(RECENT).find(|plane| plane.holds(&spot, straight)) {
                    Some(plane) => plane.spots.push(spot),
                    None => planes.push(Found { spots: vec![spot], straight }),
                }
            }
        }
    }
    let (planes, few): (Vec<Found>, Vec<Found>) =
        planes.into_iter().partition(|plane| plane.spots.len() >= FEWEST);
    let mut groups: Vec<Group> = planes.into_iter().map(|plane| plane.group(lines)).collect();
    let loose: Vec<Spot> = few.into_iter().flat_map(|plane| plane.spots).collect();
    if !loose.is_empty() {
        groups.push(Group::loose(loose));
    }
    groups
}
