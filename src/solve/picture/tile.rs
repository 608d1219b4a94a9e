//! A tile: a square of pixels that are worked on together.

use std::cell::OnceCell;

use glam::DVec3;

use super::openings::Beam;
use super::spots::Lines;
use super::{Counts, Detail, Path, Picture, STREAM, Seen, Sight, TILE, direct, lobes};
use crate::image::Raster;
use crate::rng::Rng;

/// Corners of its pixels along an edge.
const CORNERS: usize = TILE + 1;

/// A square of pixels, or what of it lies in the image.
pub(super) struct Tile<'v> {
    raster: &'v Raster,
    size: [usize; 2],
    corner: [usize; 2],
    /// Lines of sight through the pixels' centres, row by row.
    centres: [Option<DVec3>; TILE * TILE],
    /// Lines of sight through the pixels' corners, row by row; only pixels with openings ask for them.
    corners: OnceCell<[Option<DVec3>; CORNERS * CORNERS]>,
}

impl<'v> Tile<'v> {
    pub(super) fn of(raster: &'v Raster, size: [usize; 2], corner: [usize; 2]) -> Self {
        let mut tile = Self { raster, size, corner, centres: [None; TILE * TILE], corners: OnceCell::new() };
        for (k, centre) in tile.centres.iter_mut().enumerate() {
            let [x, y] = [corner[0] + k % TILE, corner[1] + k / TILE];
            if x < size[0] && y < size[1] {
                *centre = raster.direction([x as f64 + 0.5, y as f64 + 0.5]);
            }
        }
        tile
    }

    fn corners(&self) -> &[Option<DVec3>; CORNERS * CORNERS] {
        self.corners.get_or_init(|| {
            std::array::from_fn(|k| {
                let [x, y] = [self.corner[0] + k % CORNERS, self.corner[1] + k / CORNERS];
                let inside = x <= self.size[0] && y <= self.size[1];
                inside.then(|| self.raster.direction([x as f64, y as f64])).flatten()
            })
        })
    }

    fn beam(&self, eye: DVec3, index: usize) -> Option<Beam> {
        let [column, row] = [index % TILE, index / TILE];
        let first = row * CORNERS + column;
        let corners = [first, first + 1, first + CORNERS, first + CORNERS + 1].map(|k| self.corners()[k]);
        let number = (self.corner[1] + row) * self.size[0] + self.corner[0] + column;
        Beam::of_pixel(eye, corners, number as u64)
    }

    /// Those openings that a straight line of sight of the tile may meet.
    fn before(&self, picture: &Picture, eye: DVec3) -> Vec<usize> {
        let is_whole = self.centres.iter().all(Option::is_some);
        let others: &[Option<DVec3>] = if is_whole { &[] } else { self.corners() };
        let lines = || self.centres.iter().chain(others).flatten();
        let Some(middle) = lines().sum::<DVec3>().try_normalize() else {
            return picture.openings.clone();
        };
        // The corners of a whole tile lie by a fifteenth farther out than the centres.
        let least = lines().map(|line| line.dot(middle)).fold(1.0, f64::min);
        let width = 1.2 * least.max(-1.0).acos();
        let may_be_met = |&index: &usize| {
            let source = &picture.emitters.sources[index];
            let towards = source.position - eye;
            let distance_m = towards.length();
            let size = 1.000_001 * source.radius_m / distance_m;
            let aside = (towards.dot(middle) / distance_m).clamp(-1.0, 1.0).acos();
            !(size < 1.0) || aside <= width + size.asin() + 1e-6
        };
        picture.openings.iter().copied().filter(may_be_met).collect()
    }

    pub(super) fn work(
        &self,
        picture: &Picture,
        eye: DVec3,
        sights: &mut [Sight; TILE * TILE],
        [values, squares]: [&mut [f64]; 2],
        counts: &mut Counts,
    ) {
        let Self { size, corner, .. } = *self;
        let scene = picture.emitters.scene;
        let openings = self.before(picture, eye);
        let out = |index: usize| index / TILE * size[0] + corner[0] + index % TILE;
        for (index, sight) in sights.iter_mut().enumerate() {
            sight.luminance = 0.0;
            sight.places.clear();
            let Some(direction) = self.centres[index] else { continue };
            counts.rays += 1;
            let hit = scene.tracer.closest(eye, direction, &[]);
            let turns = hit.is_some_and(|hit| scene.bsdf(hit.triangle).specular(1.0).is_some());
            let beam = if turns || !openings.is_empty() { self.beam(eye, index) } else { None };
            sight.look(picture, (eye, direction), hit, &Path::fresh(beam, &openings), counts);
            let reflected = |place: &Seen| place.share * picture.reflected(&place.landing);
            values[out(index)] = sight.luminance + sight.places.iter().map(reflected).sum::<f64>();
        }
        if picture.detail == Detail::Exact {
            let number = (corner[1] / TILE) * size[0].div_ceil(TILE) + corner[0] / TILE;
            let mut rng = Rng::new(picture.seed, STREAM, number as u64);
            let lines = Lines { eye, centres: &self.centres };
            direct::add(picture, sights, lines, &mut rng, counts, |index, luminance| {
                values[out(index)] += luminance;
            });
            if picture.whole.is_some() {
                lobes::add(picture, sights, &mut rng, counts, |index, luminance, square| {
                    values[out(index)] += luminance;
                    squares[out(index)] += square;
                });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::image::{Projection, View};
    use crate::project::{LoadOptions, load};
    use crate::solve::picture::expose;

    /// Catches: an opening that a tile leaves out though one of its lines of sight meets it.
    #[test]
    fn no_tile_leaves_out_an_opening_that_it_sees() {
        let project = load(Path::new("scenes/box"), &LoadOptions::default()).expect("an example");
        let scene = &project.worlds[0].scene;
        let exposure = expose(scene, 1);
        let picture = exposure.picture(&vec![1.0; scene.channels.len()], Detail::Stored);
        let fisheye = |deg: f64| Projection::AngularFisheye { horizontal_deg: deg, vertical_deg: deg };
        let half = Projection::HemisphericalFisheye { horizontal_deg: 180.0, vertical_deg: 180.0 };
        let flat = Projection::Perspective { horizontal_deg: 100.0, vertical_deg: 100.0 };
        let (mut left_out, mut met) = (0, 0);
        for (projection, size) in [(fisheye(180.0), 150), (fisheye(360.0), 90), (half, 100), (flat, 10)] {
            let eye = DVec3::new(1.1, 1.3, 1.2);
            let view = View::new(projection, eye, DVec3::new(0.3, 0.4, 1.0), DVec3::Y).expect("a view");
            let (raster, size) = (view.raster([size; 2]), [size; 2]);
            for corner in (0..size[0].div_ceil(TILE).pow(2))
                .map(|k| [k % size[0].div_ceil(TILE), k / size[0].div_ceil(TILE)].map(|k| TILE * k))
            {
                let tile = Tile::of(&raster, size, corner);
                let before = tile.before(&picture, eye);
                for index in 0..scene.luminaires.len() {
                    let lines = tile.centres.iter().chain(tile.corners()).flatten();
                    let seen =
                        lines.filter(|line| picture.emitters.opening_along(index, eye, **line).is_some());
                    met += seen.clone().count();
                    left_out += usize::from(!before.contains(&index));
                    assert!(seen.count() == 0 || before.contains(&index), "{index} at {corner:?}");
                }
            }
        }
        assert!(met > 100 && left_out > 100, "{met} {left_out}");
    }
}
