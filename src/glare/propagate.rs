//! Standard error of any index by the delta method: its inputs' errors, declared here, times its
//! derivatives. L_b and E_v share the indirect light, so the inputs are not they but what they are
//! made of: E_i, the light and solid angle of each source, and what stands beside them (the mean luminance of the
//! field of view, the light of an illuminated area), which receivers of their own have found.

use super::source::{GlareSource, Ground, Sight};
use crate::units::{Nits, Undefined};

/// Relative step of the difference quotients.
const STEP: f64 = 1e-4;

/// Standard errors of what a view is made of.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SightError {
    /// Of E_i, lx; it moves E_v by as much and L_b by 1/π of it.
    pub e_indirect_lx: f64,
    /// Of E_dir, lx, where it was estimated on its own; it moves E_v by as much. `None`: E_dir is what the
    /// sources add up to, and moves with them.
    pub e_direct_lx: Option<f64>,
    /// Of the mean luminance of the field of view, cd/m²; 0 where none is known.
    pub mean_cd_m2: f64,
    /// Of the mean illuminance of the ground, lx; 0 where none is known.
    pub ground_lx: f64,
    /// Of every source, in the order of the view.
    pub sources: Vec<SourceError>,
}

/// Relative standard errors of one source.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SourceError {
    /// Of ∫ L dω: luminance, intensity, illuminance at the eye.
    pub light: f64,
    /// Of ω at the same light: a larger ω means a lower luminance.
    pub solid_angle: f64,
    /// Relative covariance of the two. Both come from the same rays: what hides half of an opening takes light
    /// and solid angle alike, and L²ω then moves by as much as ω, not by three times as much. `None` where it is
    /// not known: the effects are added, which no covariance can exceed.
    pub together: Option<f64>,
    /// Degrees of freedom from which these errors are known.
    pub degrees: usize,
}

/// A standard error and how well it is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// Standard error.
    pub se: f64,
    /// Degrees of freedom of Student's interval about the value.
    pub degrees: usize,
}

/// Standard error of an index of first order. Sources, indirect light, the field's mean and the ground are
/// independent: each has rays of its own.
///
/// Degrees of freedom by Welch and Satterthwaite, ν = (Σ v)²/Σ(v²/ν_i) over the variances v of the inputs;
/// the light at the eye has `degrees` of them.
///
/// # Errors
/// The index is undefined here or next to here.
pub fn standard_error(
    index: impl Fn(&Sight) -> Result<f64, Undefined>,
    sight: &Sight,
    error: &SightError,
    degrees: usize,
) -> Result<Spread, Undefined> {
    let mut changed = sight.clone();
    let mut slope = |change: &dyn Fn(&mut Sight, f64), touched: Option<usize>, step: f64| {
        let mut at = |step: f64| {
            change(&mut changed, step);
            let value = index(&changed);
            changed.e_v_lx = sight.e_v_lx;
            changed.e_direct_lx = sight.e_direct_lx;
            changed.background = sight.background;
            (changed.mean, changed.given) = (sight.mean, sight.given);
            if let Some(position) = touched {
                changed.sources[position] = sight.sources[position];
            }
            value
        };
        Ok::<f64, Undefined>((at(step)? - at(-step)?) / (2.0 * step))
    };
    let mut parts: Vec<(f64, usize)> = Vec::new();
    if error.e_indirect_lx > 0.0 {
        let per_lx = slope(
            &|sight, step_lx| {
                sight.e_v_lx += step_lx;
                sight.background = Nits(sight.background.0 + step_lx / std::f64::consts::PI);
            },
            None,
            STEP * sight.e_indirect_lx().abs(),
        )?;
        parts.push(((per_lx * error.e_indirect_lx).powi(2), degrees));
    }
    if let Some(se_lx) = error.e_direct_lx.filter(|se_lx| *se_lx > 0.0) {
        let per_lx = slope(
            &|sight, step_lx| {
                sight.e_v_lx += step_lx;
                sight.e_direct_lx += step_lx;
            },
            None,
            STEP * sight.e_v_lx.abs(),
        )?;
        parts.push(((per_lx * se_lx).powi(2), degrees));
    }
    if let Some(mean) = sight.mean.filter(|_| error.mean_cd_m2 > 0.0) {
        let change = |sight: &mut Sight, step| sight.mean = Some(Nits(mean.0 + step));
        let slope = slope(&change, None, STEP * mean.0.abs())?;
        parts.extend((slope.abs() > 0.0).then(|| ((slope * error.mean_cd_m2).powi(2), degrees)));
    }
    if let Some(ground) = sight.given.ground.filter(|_| error.ground_lx > 0.0) {
        let change = |sight: &mut Sight, step| {
            sight.given.ground = Some(Ground { mean_lx: ground.mean_lx + step, ..ground });
        };
        let slope = slope(&change, None, STEP * ground.mean_lx.abs())?;
        parts.extend((slope.abs() > 0.0).then(|| ((slope * error.ground_lx).powi(2), degrees)));
    }
    let own = error.e_direct_lx.is_some();
    for (position, source) in error.sources.iter().enumerate() {
        let (mut by_light, mut by_size) = (0.0, 0.0);
        if source.light > 0.0 {
            by_light = slope(&|sight, step| brighten(sight, position, step, own), Some(position), STEP)?;
        }
        if source.solid_angle > 0.0 {
            let change = |sight: &mut Sight, step| widen(&mut sight.sources[position], step);
            by_size = slope(&change, Some(position), STEP)?;
        }
        let alone = [by_light * source.light, by_size * source.solid_angle];
        let variance = match source.together {
            // Rounding may leave a covariance a little beyond what its variances allow.
            Some(together) => {
                (alone[0] * alone[0] + alone[1] * alone[1] + 2.0 * by_light * by_size * together).max(0.0)
            }
            None => (alone[0].abs() + alone[1].abs()).powi(2),
        };
        parts.push((variance, source.degrees));
    }
    let variance: f64 = parts.iter().map(|(variance, _)| variance).sum();
    let shares = parts.iter().filter(|(part, _)| *part > 0.0);
    let doubt: f64 = shares.map(|(part, degrees)| part * part / (*degrees).max(1) as f64).sum();
    let degrees = if doubt > 0.0 { (variance * variance / doubt).floor() as usize } else { degrees };
    Ok(Spread { se: variance.sqrt(), degrees: degrees.max(1) })
}

/// More light from a source of the same size; E_dir is left alone where it was estimated on its own.
fn brighten(sight: &mut Sight, position: usize, step: f64, own_direct: bool) {
    let source = &mut sight.sources[position];
    let added_lx = source.eye_lx * step;
    source.luminance = source.luminance * (1.0 + step);
    source.eye_lx += added_lx;
    if let Some(extent) = &mut source.extent {
        extent.intensity_cd *= 1.0 + step;
    }
    if !own_direct {
        sight.e_v_lx += added_lx;
        sight.e_direct_lx += added_lx;
    }
}

/// A larger solid angle with the same light.
fn widen(source: &mut GlareSource, step: f64) {
    source.solid_angle_sr *= 1.0 + step;
    source.luminance = source.luminance * (1.0 / (1.0 + step));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::glare::index::{INDICES, parse};
    use crate::glare::source::Given;
    use crate::rng::Rng;

    /// Two sources under 250 lx of indirect light, 80 cd/m² background.
    fn view(light: [f64; 2], size: [f64; 2], indirect_lx: f64) -> Sight {
        let cos = [0.9, 0.8];
        let source = |i: usize| {
            let solid_angle_sr = [0.01, 0.03][i] * size[i];
            let luminance = [5000.0, 1500.0][i] * light[i] / size[i];
            GlareSource {
                luminance: Nits(luminance),
                solid_angle_sr,
                position_index: [1.8, 3.0][i],
                ugr_share: 1.0,
                off_axis_deg: f64::acos(cos[i]).to_degrees(),
                eye_lx: luminance * solid_angle_sr * cos[i],
                extent: None,
            }
        };
        let sources = vec![source(0), source(1)];
        let e_direct_lx = sources.iter().map(|source| source.eye_lx).sum();
        Sight {
            sources,
            e_v_lx: e_direct_lx + indirect_lx,
            e_direct_lx,
            background: Nits(indirect_lx / std::f64::consts::PI),
            mean: Some(Nits(120.0)),
            ..Sight::default()
        }
    }

    #[test]
    fn ugr_moves_as_the_method_says() {
        // 0.0347 per 1 % of E_i, 0.0695 per 1 % of one source's light. Catches a wrong derivative.
        let sight = view([1.0; 2], [1.0; 2], 250.0);
        let ugr = parse("UGR").unwrap().value;
        let error = SightError { e_indirect_lx: 2.5, ..SightError::default() };
        let se = standard_error(ugr, &sight, &error, 31).unwrap().se;
        assert!((se - 0.08 / std::f64::consts::LN_10).abs() < 1e-6, "{se}");
        let mut single = sight.clone();
        single.sources.truncate(1);
        let of = |light: f64, solid_angle: f64, together: Option<f64>| {
            let error = SourceError { light, solid_angle, together, degrees: 15 };
            let error = SightError { sources: vec![error], ..SightError::default() };
            let spread = standard_error(ugr, &single, &error, 31).unwrap();
            assert_eq!(spread.degrees, 15, "the only error there is");
            spread.se
        };
        let per_percent = 0.08 / std::f64::consts::LN_10;
        assert!((of(0.01, 0.0, None) - 2.0 * per_percent).abs() < 1e-6);
        assert!((of(0.0, 0.01, None) - per_percent).abs() < 1e-6);
        // Half hidden: L stays, ω moves. Apart, and where nothing is known.
        assert!((of(0.01, 0.01, Some(1e-4)) - per_percent).abs() < 1e-6);
        assert!((of(0.01, 0.01, Some(0.0)) - 5f64.sqrt() * per_percent).abs() < 1e-6);
        assert!((of(0.01, 0.01, None) - 3.0 * per_percent).abs() < 1e-6);
    }

    #[test]
    fn degrees_of_freedom_lie_between_those_of_the_parts() {
        // Two equal variances of 31 and 15 degrees: 4/(1/31 + 1/15) = 40.4. Catches the smaller or the sum taken.
        let ugr = parse("UGR").unwrap().value;
        let mut single = view([1.0; 2], [1.0; 2], 250.0);
        single.sources.truncate(1);
        let source = SourceError { light: 0.005, solid_angle: 0.0, together: Some(0.0), degrees: 15 };
        let error = SightError {
            e_indirect_lx: 2.5,
            e_direct_lx: Some(0.0),
            sources: vec![source],
            ..SightError::default()
        };
        assert_eq!(standard_error(ugr, &single, &error, 31).unwrap().degrees, 40);
    }

    #[test]
    fn every_index_spreads_as_its_error_says() {
        // Inputs drawn with their errors: the spread of the index is the error of first order. Catches
        // an input that is not moved, moved twice, or E_v that forgets the indirect light.
        let relative = [0.01, 0.02];
        let error = SightError {
            e_indirect_lx: 4.0,
            mean_cd_m2: 3.0,
            ground_lx: 5.0,
            e_direct_lx: None,
            sources: relative
                .map(|light| SourceError { light, degrees: 31, ..SourceError::default() })
                .to_vec(),
        };
        let beside = |sight: Sight, steps: [f64; 2]| {
            let ground = Ground { mean_lx: 200.0 + 5.0 * steps[1], reflectance: 0.2 };
            let given = Given { ground: Some(ground), ..sight.given };
            Sight { mean: Some(Nits(120.0 + 3.0 * steps[0])), given, ..sight }
        };
        let sight = beside(view([1.0; 2], [1.0; 2], 250.0), [0.0; 2]);
        for index in INDICES {
            let Ok(Spread { se, .. }) = standard_error(index.value, &sight, &error, 31) else { continue };
            let mut rng = Rng::new(3, 0, 0);
            let mut normal = || (0..12).map(|_| rng.uniform()).sum::<f64>() - 6.0;
            let drawn: Vec<f64> = (0..4000)
                .map(|_| {
                    let light = relative.map(|relative| 1.0 + relative * normal());
                    let seen = view(light, [1.0; 2], 250.0 + 4.0 * normal());
                    (index.value)(&beside(seen, [normal(), normal()])).unwrap()
                })
                .collect();
            let mean = drawn.iter().sum::<f64>() / 4000.0;
            let spread = (drawn.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / 3999.0).sqrt();
            // 4000 draws know a spread within 1.1 %; 5 sigma and the second order.
            assert!((spread / se - 1.0).abs() < 0.07, "{}: {spread} against {se}", index.key);
        }
    }
}
