//! Sweeps over the links of all patch sides, from first light to the field; what its links tell about noise.

use crate::emitters::Emitters;
use crate::field::{LuminanceField, Reached};

/// Sweeps end when what they would still bring is less than this share of the stored flux …
const SETTLED: f64 = 1e-3;
/// … or after this many; the rest is left to the residual …
const MOST_SWEEPS: u32 = 100;
/// … or when they have followed so many links: at a reflectance near 1 hundreds of sweeps are cheap beside the walks
/// that would make up for them.
const MOST_LOOKUPS: usize = 400_000_000;
/// Every so many sweeps the field is scaled to balance: at a reflectance near 1 a sweep brings all
/// places nearer by a thousandth of what they still lack.
const BALANCED: u32 = 8;

/// What one patch side receives.
pub(super) struct Collected {
    /// The part of `first` that luminaires and their images make here.
    pub direct: Vec<f64>,
    /// Luminance that direct light and emitting surfaces make here, per channel.
    pub first: Vec<f64>,
    /// Patch sides where its links end.
    pub links: Vec<u32>,
    /// Weight of each link; empty where all are 1.
    pub shares: Vec<f64>,
    /// Sum of squares of what its links see of lamps in glossy surfaces, all channels.
    pub met_squares: f64,
    /// Number of places from which the links start.
    pub places: u32,
    /// The part of it that light reaches.
    pub reached: Reached,
}

impl Collected {
    /// A side that nothing is linked to.
    pub(super) fn without_links(reached: Reached) -> Self {
        let (direct, first) = (Vec::new(), Vec::new());
        Self { direct, first, links: Vec::new(), shares: Vec::new(), met_squares: 0.0, places: 0, reached }
    }

    /// Links with their weights.
    fn weighted(&self) -> impl Iterator<Item = (usize, f64)> {
        let share = |number: usize| self.shares.get(number).copied().unwrap_or(1.0);
        self.links.iter().enumerate().map(move |(number, &link)| (link as usize, share(number)))
    }
}

/// L(side) = first + (ρ + τ)/n Σ w L(link), w = 1 unless links are aimed, in place, in a fixed order.
pub(super) fn sweep(emitters: &Emitters, field: &mut LuminanceField, collected: &[Collected]) {
    let scene = emitters.scene;
    let channels = scene.channels.len();
    let factor: Vec<f64> = (0..collected.len())
        .map(|side| {
            let (reflectance, transmittance) = scene.bsdf(field.patches().triangle(side)).diffuse();
            (reflectance + transmittance) / f64::from(collected[side].places.max(1))
        })
        .collect();
    let mut sums = vec![0.0; channels];
    let links: usize = collected.iter().map(|entry| entry.links.len()).sum();
    let most = MOST_SWEEPS.max((MOST_LOOKUPS / (links * channels).max(1)) as u32);
    let mut before = 0.0;
    for number in 1..=most {
        if number.is_multiple_of(BALANCED) {
            balance(field, collected, &factor);
        }
        let (mut change, mut whole) = (0.0, 0.0);
        for (side, entry) in collected.iter().enumerate() {
            if entry.links.is_empty() {
                continue;
            }
            sums.fill(0.0);
            for (link, share) in entry.weighted() {
                for (sum, value) in sums.iter_mut().zip(field.at(link)) {
                    *sum += share * value;
                }
            }
            let area = field.patches().area_m2(side) * entry.reached.share();
            let stored = field.at_mut(side);
            for ((stored, first), sum) in stored.iter_mut().zip(&entry.first).zip(&sums) {
                let next = first + factor[side] * sum;
                change += (next - *stored).abs() * area;
                whole += next * area;
                *stored = next;
            }
        }
        // A geometric series of changes; just balanced, a field changes by other amounts.
        let ratio = if number.is_multiple_of(BALANCED) { 1.0 } else { (change / before).min(1.0) };
        if change * ratio <= SETTLED * whole * (1.0 - ratio) {
            break;
        }
        before = change;
    }
}

/// Scales each channel so that the flux fed in equals what the field loses,
/// Σ A first = Σ A (L − (ρ + τ)/n Σ w L(link)); the truth is left as it is.
fn balance(field: &mut LuminanceField, collected: &[Collected], factor: &[f64]) {
    let channels = collected.first().map_or(0, |entry| entry.first.len());
    for channel in 0..channels {
        let (mut fed, mut lost) = (0.0, 0.0);
        for (side, entry) in collected.iter().enumerate() {
            let sum: f64 = entry.weighted().map(|(link, share)| share * field.at(link)[channel]).sum();
            let area = field.patches().area_m2(side) * entry.reached.share();
            fed += area * entry.first[channel];
            lost += area * (field.at(side)[channel] - factor[side] * sum);
        }
        if lost > 0.0 && (fed / lost).is_finite() {
            (0..collected.len()).for_each(|side| field.at_mut(side)[channel] *= fed / lost);
        }
    }
}

/// Variance of each side's luminance, all channels together, from the scatter of its links; that they are
/// stratified makes it less.
pub(super) fn variances(emitters: &Emitters, field: &LuminanceField, collected: &[Collected]) -> Vec<f64> {
    let of_side = |(side, entry): (usize, &Collected)| {
        let count = f64::from(entry.places.max(1));
        let (mut sum, mut squares) = (0.0, 0.0);
        for (link, share) in entry.weighted() {
            let value = share * field.at(link).iter().sum::<f64>();
            sum += value;
            squares += value * value;
        }
        let (reflectance, transmittance) = emitters.scene.bsdf(field.patches().triangle(side)).diffuse();
        let factor = (reflectance + transmittance) / count;
        factor * factor * (squares - sum * sum / count + entry.met_squares).max(0.0)
    };
    collected.iter().enumerate().map(of_side).collect()
}
