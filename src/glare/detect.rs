//! Glare sources in an image: pixels above a threshold, joined where they lie close together. Joining
//! is transitive and takes no order of pixels, so turning an image over changes nothing.

use glam::{DVec2, DVec3};

use super::field::{Cone, Field, Pixel};
use super::source::GlareSource;
use crate::units::{Nits, Undefined};

/// Above what luminance a pixel belongs to a glare source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Threshold {
    /// A luminance.
    Absolute(Nits),
    /// A multiple of the image's mean luminance weighted by solid angle.
    TimesMean(f64),
    /// A multiple of the mean luminance of the task.
    TimesTask(f64, Cone),
}

/// How sources are searched.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Search {
    /// Above what luminance.
    pub threshold: Threshold,
    /// Pixels within *half* of this angle belong together, rad.
    pub radius_rad: f64,
    /// Pixels above this luminance make sources of their own; `None`: no peaks are split off.
    pub peak: Option<Nits>,
}

impl Default for Search {
    /// 2000 cd/m², 0.2 rad, peaks from 50 000 cd/m² on: evalglare's.
    fn default() -> Self {
        Self { threshold: Threshold::Absolute(Nits(2000.0)), radius_rad: 0.2, peak: Some(Nits(50_000.0)) }
    }
}

/// A source found in an image; its pixels are known by its number in [`Found::labels`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Detected {
    /// Direction of the centre of its light: to the right, up and ahead of the eye. The centre is taken
    /// in the plane of angles, where a direction lies at θ from the middle (an angular fisheye's image
    /// plane), weighted by L ω: as evalglare has it, but for every projection alike. For a source that
    /// fills much of the view it differs from the mean of the unit vectors: 0.7 UGR in one image.
    pub direction: DVec3,
    /// Mean luminance weighted by solid angle.
    pub luminance: Nits,
    /// Highest luminance of a pixel.
    pub highest: Nits,
    /// Solid angle, sr.
    pub solid_angle_sr: f64,
    /// Illuminance on the plane of the eye, Σ L ω cos θ, lx.
    pub eye_lx: f64,
    /// Whether it was split off as a peak.
    pub is_peak: bool,
}

/// Sources of an image.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// The sources, in the order of their first pixels.
    pub sources: Vec<Detected>,
    /// For every pixel of the field its source, counted from 1; 0 for none.
    pub labels: Vec<u32>,
    /// The threshold as a luminance.
    pub threshold: Nits,
}

/// Finds the sources of a field.
///
/// # Errors
/// The task zone holds no pixel, or the field is empty.
pub fn detect(field: &Field, search: &Search) -> Result<Found, Undefined> {
    let threshold = match search.threshold {
        Threshold::Absolute(luminance) => luminance,
        Threshold::TimesMean(factor) => {
            let mean = field.mean(|_| true).ok_or_else(|| Undefined::because("the image shows nothing"))?;
            mean * factor
        }
        Threshold::TimesTask(factor, cone) => {
            let mean = field.mean(|pixel| cone.contains(pixel.direction));
            mean.ok_or_else(|| Undefined::because("no pixel of the image lies in the task zone"))? * factor
        }
    };
    let is_peak = |pixel: &Pixel| search.peak.is_some_and(|peak| pixel.luminance > peak.0);
    let mut labels = vec![0u32; field.pixels.len()];
    let mut groups: Vec<(u32, bool)> = Vec::new();
    for peaks in [false, true] {
        let members: Vec<u32> = (0..field.pixels.len() as u32)
            .filter(|&member| {
                let pixel = &field.pixels[member as usize];
                pixel.luminance > threshold.0 && is_peak(pixel) == peaks
            })
            .collect();
        // Number the groups by their first pixel: roots are the smallest members.
        let roots = joined(field, &members, 0.5 * search.radius_rad);
        for (&member, root) in members.iter().zip(roots) {
            if root == member {
                groups.push((root, peaks));
                labels[member as usize] = groups.len() as u32;
            } else {
                labels[member as usize] = labels[root as usize];
            }
        }
    }
    let mut sources: Vec<Detected> = Vec::with_capacity(groups.len());
    let mut sums = vec![(DVec2::ZERO, 0.0, 0.0, 0.0, 0.0f64); groups.len()];
    for (pixel, &label) in field.pixels.iter().zip(&labels).filter(|(_, label)| **label > 0) {
        let sum = &mut sums[label as usize - 1];
        let light = pixel.luminance * pixel.solid_angle_sr;
        sum.0 += in_plane_of_angles(pixel.direction) * light;
        sum.1 += light;
        sum.2 += pixel.solid_angle_sr;
        sum.3 += pixel.luminance * pixel.projected_sr;
        sum.4 = sum.4.max(pixel.luminance);
    }
    for ((centre, light, solid_angle_sr, eye_lx, highest), (_, is_peak)) in sums.into_iter().zip(groups) {
        sources.push(Detected {
            direction: of_plane_of_angles(centre / light),
            luminance: Nits(light / solid_angle_sr),
            highest: Nits(highest),
            solid_angle_sr,
            eye_lx,
            is_peak,
        });
    }
    Ok(Found { sources, labels, threshold })
}

/// Place of a direction in the plane of angles, rad from the middle to the right and up.
fn in_plane_of_angles(direction: DVec3) -> DVec2 {
    let aside = DVec2::new(direction.x, direction.y);
    let sin = aside.length();
    if sin > 1e-12 { aside * (sin.atan2(direction.z) / sin) } else { aside }
}

/// The direction at a place in the plane of angles.
fn of_plane_of_angles(place: DVec2) -> DVec3 {
    let theta = place.length();
    let (sin, cos) = theta.sin_cos();
    let aside = if theta > 1e-12 { place * (sin / theta) } else { place };
    DVec3::new(aside.x, aside.y, cos)
}

impl Detected {
    /// As a source of the indices, at a position index.
    pub fn at(&self, position_index: f64, off_table: bool) -> GlareSource {
        GlareSource {
            luminance: self.luminance,
            solid_angle_sr: self.solid_angle_sr,
            position_index,
            ugr_share: if off_table { 0.0 } else { 1.0 },
            off_axis_deg: super::field::angle(DVec3::Z, self.direction).to_degrees(),
            eye_lx: self.eye_lx,
            extent: None,
        }
    }
}

/// For each member the smallest member of its group, where all that lie within `reach_rad` of each
/// other, directly or over others, are one group.
///
/// Members are sorted into cells so small that all of a cell belong together; two cells within reach
/// are compared until one pair is found.
fn joined(field: &Field, members: &[u32], reach_rad: f64) -> Vec<u32> {
    let chord = 2.0 * (0.5 * reach_rad.clamp(0.0, std::f64::consts::PI)).sin();
    let at = |position: usize| field.pixels[members[position] as usize].direction;
    if !(chord > 0.0) {
        return members.to_vec();
    }
    let side = chord / 3f64.sqrt();
    let key = |position: usize| (at(position) / side).floor().to_array().map(|x| x as i64);
    let mut order: Vec<usize> = (0..members.len()).collect();
    order.sort_by_key(|&position| (key(position), position));
    let mut cells: Vec<Cell> = Vec::new();
    for (rank, &position) in order.iter().enumerate() {
        let place = at(position);
        match cells.last_mut() {
            Some(cell) if cell.key == key(position) => {
                cell.end = rank + 1;
                cell.low = cell.low.min(place);
                cell.high = cell.high.max(place);
            }
            _ => cells.push(Cell { key: key(position), start: rank, end: rank + 1, low: place, high: place }),
        }
    }
    let mut groups = Groups::new(cells.len());
    // Near cells first: what they join need not be compared from afar.
    for offset in forward_offsets() {
        for first in 0..cells.len() {
            let wanted: [i64; 3] = std::array::from_fn(|axis| cells[first].key[axis] + offset[axis]);
            let Ok(second) = cells.binary_search_by_key(&wanted, |cell| cell.key) else { continue };
            if groups.root(first) == groups.root(second) || cells[first].gap(&cells[second]) > chord {
                continue;
            }
            let own = &order[cells[first].start..cells[first].end];
            let touches = own.iter().filter(|&&a| cells[second].distance(at(a)) <= chord).any(|&a| {
                let others = &order[cells[second].start..cells[second].end];
                others.iter().any(|&b| (at(a) - at(b)).length() <= chord)
            });
            if touches {
                groups.join(first, second);
            }
        }
    }
    // The smallest member of each group of cells.
    let mut least = vec![u32::MAX; cells.len()];
    let mut root_of = vec![0usize; members.len()];
    for (number, cell) in cells.iter().enumerate() {
        let root = groups.root(number);
        for &position in &order[cell.start..cell.end] {
            root_of[position] = root;
            least[root] = least[root].min(members[position]);
        }
    }
    root_of.into_iter().map(|root| least[root]).collect()
}

/// Members that lie in one cube, as a range of the sorted order, with the box around them.
struct Cell {
    key: [i64; 3],
    start: usize,
    end: usize,
    low: DVec3,
    high: DVec3,
}

impl Cell {
    /// Distance of a place from the box.
    fn distance(&self, place: DVec3) -> f64 {
        (place - place.clamp(self.low, self.high)).length()
    }

    /// Distance between the boxes of two cells.
    fn gap(&self, other: &Self) -> f64 {
        (other.low - self.high).max(self.low - other.high).max(DVec3::ZERO).length()
    }
}

/// Half of the cells around one that can be within reach, √3 cells away; the nearest first.
fn forward_offsets() -> Vec<[i64; 3]> {
    let all = (-2..=2).flat_map(|x| (-2..=2).flat_map(move |y| (-2..=2).map(move |z| [x, y, z])));
    let mut half: Vec<[i64; 3]> = all.filter(|offset| *offset > [0, 0, 0]).collect();
    half.sort_by_key(|offset| offset.iter().map(|x| x * x).sum::<i64>());
    half
}

/// Union–find with the smaller root on top.
struct Groups(Vec<usize>);

impl Groups {
    fn new(count: usize) -> Self {
        Self((0..count).collect())
    }

    fn root(&mut self, mut item: usize) -> usize {
        while self.0[item] != item {
            self.0[item] = self.0[self.0[item]];
            item = self.0[item];
        }
        item
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b)] = a.min(b);
    }
}

#[cfg(test)]
mod tests;
