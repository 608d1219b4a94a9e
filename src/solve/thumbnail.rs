//! A small picture of what an eye sees, from the frozen field of a solution as it stands: for cards, which
//! show where sources are. Patches show as they are stored, so no number is to be read off it.

use rayon::prelude::*;

use super::answer::{ANALOG, Desk, mirrored_openings, see, straight_openings};
use super::{PARTS, Prepared};
use crate::image::{LuminanceImage, View};
use crate::query::Ray;
use crate::rng::Rng;

/// Stream of thumbnails; the last three are those of eyes, pictures and glances.
const STREAM: u64 = u64::MAX - 3;
/// Rays of a pixel, one in each quarter.
const QUARTERS: [[f64; 2]; 4] = [[0.0, 0.0], [0.5, 0.0], [0.0, 0.5], [0.5, 0.5]];

/// Luminances along a camera's rays with a factor for each channel, cd/m²; `None` where the method
/// stores no field.
pub fn thumbnail(
    prepared: &Prepared,
    view: &View,
    size: [usize; 2],
    weights: &[f64],
) -> Option<LuminanceImage> {
    prepared.field.as_ref()?;
    let [width, height] = size;
    let channels = weights.len();
    let rows: Vec<Vec<f64>> = (0..height)
        .into_par_iter()
        .map(|row| {
            let mut rng = Rng::new(prepared.seed, STREAM, row as u64);
            let mut desk = Desk::new(channels);
            let mut openings = vec![0.0; channels * PARTS];
            let mut line = vec![0.0; width];
            for (column, value) in line.iter_mut().enumerate() {
                for [right, down] in QUARTERS {
                    let [u, v] = rng.uniforms();
                    let at = [column as f64 + right + 0.5 * u, row as f64 + down + 0.5 * v];
                    let Some(direction) = view.direction(size, at) else { continue };
                    let ray = Ray { point: view.eye, direction };
                    openings.fill(0.0);
                    straight_openings(prepared, &ray, &mut openings);
                    mirrored_openings(prepared, &ray, &mut rng, 1.0, &mut openings);
                    see(prepared, view.eye, direction, ANALOG, &mut rng, &mut desk);
                    let of_channel = |channel: usize| {
                        desk.seen[channel]
                            + openings[channel * PARTS..(channel + 1) * PARTS].iter().sum::<f64>()
                    };
                    *value += (0..channels).map(|k| weights[k] * of_channel(k)).sum::<f64>()
                        / QUARTERS.len() as f64;
                }
            }
            line
        })
        .collect();
    Some(LuminanceImage::new(width, height, Some(*view), rows.concat()))
}
