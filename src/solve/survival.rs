//! How often residual walks go on: less often in places that are darker than where they began.

/// Walks go on in places darker than their start no less than this often for each time that the albedo would have it:
/// their weight grows by no more than its inverse.
const RAREST: f64 = 0.05;

/// Chance that a walk goes on. What it may still bring is in proportion to the luminance about it, so its weight times
/// that luminance is kept near what it was at the start: it has less to do in places that are dim in every channel.
/// `whole`: its weight in terms of that at the start, all absorption taken off; luminances per channel, none where they
/// are not known.
pub(super) fn survival(whole: f64, albedo: f64, at_start: &[f64], here: &[f64]) -> f64 {
    let ratios = at_start.iter().zip(here).filter(|(start, _)| **start > 0.0);
    let brighter = ratios.map(|(start, here)| here / start).fold(f64::NEG_INFINITY, f64::max);
    let wanted = if brighter.is_finite() { whole * brighter.max(RAREST) } else { albedo };
    // Weights fall back to that of the start, and not below it: walks would have no end.
    wanted.min(whole.max(albedo)).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches: walks that go on in the dark as if it were light, or give up where only one channel is dark; a weight that
    /// grows without end, or falls below that of the start; a chance above 1.
    #[test]
    fn walks_go_on_as_there_is_light_about_them() {
        let albedo = 0.8;
        for (weight, at_start, here, expected) in [
            (1.0, &[2.0][..], &[2.0][..], albedo),
            (1.0, &[2.0], &[0.2], 0.1 * albedo),
            (1.0, &[2.0], &[0.0], RAREST * albedo),
            (1.0, &[2.0], &[20.0], albedo),
            (1.0, &[2.0, 1.0], &[0.2, 1.0], albedo),
            (1.0, &[2.0, 0.0], &[0.2, 9.0], 0.1 * albedo),
            (1.0, &[0.0], &[1.0], albedo),
            (1.0, &[], &[1.0], albedo),
            (1.0, &[1.0], &[], albedo),
            // Heavy from the dark, it keeps going where it is dark and grows no heavier; in the light it falls back.
            (10.0, &[2.0], &[0.2], albedo),
            (10.0, &[2.0], &[2.0], 1.0),
            (1.1, &[2.0], &[2.0], 1.1 * albedo),
        ] {
            let found = survival(weight * albedo, albedo, at_start, here);
            assert!(
                (found - expected).abs() < 1e-12,
                "{weight} {at_start:?} {here:?}: {found} for {expected}"
            );
            let after = weight * albedo / found;
            assert!(
                after >= 1.0f64.min(weight) - 1e-12 && after <= weight.max(1.0 / RAREST) + 1e-12,
                "{after}"
            );
        }
    }
}
