//! One photometric format into another. What was written is read back and compared before it is
//! handed out, so the list of losses is observed, not assumed.

use crate::photometry::{Format, Opening, Photometry, PhotometryError, parse, to_ies, to_ldt};

/// Largest relative change of a stored intensity.
const TOLERANCE: f64 = 1e-6;

/// The format to write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// LM-63-2002.
    Ies,
    /// EULUMDAT.
    Ldt,
}

impl Target {
    /// By a file's extension.
    pub fn of_extension(extension: &str) -> Option<Self> {
        match extension.to_ascii_lowercase().as_str() {
            "ies" => Some(Self::Ies),
            "ldt" => Some(Self::Ldt),
            _ => None,
        }
    }
}

/// A converted file.
#[derive(Clone, Debug)]
pub struct Converted {
    /// The new file.
    pub bytes: Vec<u8>,
    /// What it does not hold or holds differently.
    pub dropped: Vec<Dropped>,
}

/// A loss on the way.
#[derive(Clone, Debug, PartialEq)]
pub enum Dropped {
    /// A light output ratio, 0 … 1, for which the new format has no place.
    OutputRatio(f64),
    /// The rated flux.
    Flux {
        /// Before.
        was_lm: f64,
        /// What the new file states.
        is_lm: Option<f64>,
    },
    /// R_a.
    ColourRendering(f64),
    /// The power.
    Power,
    /// The luminous opening.
    Opening {
        /// Before.
        was: Opening,
        /// What the new file holds.
        is: Opening,
    },
    /// The name.
    Name {
        /// Before.
        was: String,
        /// As it is written.
        is: String,
    },
    /// What the source's format may hold beyond a [`Photometry`].
    NotRead(Format, Target),
}

/// Why a conversion was not handed out.
#[derive(Clone, Debug, thiserror::Error)]
pub enum ConvertError {
    /// The written file cannot be read back.
    #[error("the converted file cannot be read back: {0}")]
    Unreadable(#[from] PhotometryError),
    /// An intensity has changed.
    #[error(
        "the intensity at azimuth {azimuth_deg}°, γ {gamma_deg}° has become {written_cd} cd, was {cd} cd"
    )]
    Changed {
        /// Azimuth in the luminaire frame.
        azimuth_deg: f64,
        /// γ.
        gamma_deg: f64,
        /// Before.
        cd: f64,
        /// After.
        written_cd: f64,
    },
}

/// Writes a photometry in another format and checks it by reading it back.
///
/// # Errors
/// The target format cannot hold these intensities.
pub fn convert(photometry: &Photometry, target: Target) -> Result<Converted, ConvertError> {
    let bytes = match target {
        Target::Ies => to_ies(photometry),
        Target::Ldt => to_ldt(photometry),
    };
    let written = parse(&bytes, "converted file")?;
    check_intensities(photometry, &written)?;
    Ok(Converted { dropped: dropped(photometry, &written, target), bytes })
}

fn check_intensities(before: &Photometry, after: &Photometry) -> Result<(), ConvertError> {
    let (from, to) = (&before.distribution, &after.distribution);
    let Some((azimuths, gammas)) = from.grid() else {
        return Ok(());
    };
    // Below 1e-9 of the largest the ten digits are those of rounding noise.
    let noise_cd = 1e-9 * from.max_intensity().0;
    for azimuth_deg in azimuths.iter().copied() {
        for gamma_deg in gammas.iter().copied() {
            let [cd, written_cd] = [from, to].map(|d| d.intensity_at(azimuth_deg, gamma_deg));
            if !((written_cd - cd).abs() <= TOLERANCE * cd + noise_cd) {
                return Err(ConvertError::Changed { azimuth_deg, gamma_deg, cd, written_cd });
            }
        }
    }
    Ok(())
}

fn dropped(before: &Photometry, after: &Photometry, target: Target) -> Vec<Dropped> {
    let mut dropped = Vec::new();
    let gone = |before: Option<f64>, after: Option<f64>| match (before, after) {
        (Some(before), Some(after)) => (before - after).abs() > 1e-6 * before.abs(),
        (Some(_), None) => true,
        (None, _) => false,
    };
    if let Some(lor) = before.lor.filter(|_| gone(before.lor, after.lor)) {
        dropped.push(Dropped::OutputRatio(lor));
    }
    if let Some(was_lm) = before.rated_flux_lm.filter(|_| gone(before.rated_flux_lm, after.rated_flux_lm)) {
        dropped.push(Dropped::Flux { was_lm, is_lm: after.rated_flux_lm });
    }
    if let Some(ra) =
        before.colour_rendering.filter(|_| gone(before.colour_rendering, after.colour_rendering))
    {
        dropped.push(Dropped::ColourRendering(ra));
    }
    if gone(before.power_w, after.power_w) {
        dropped.push(Dropped::Power);
    }
    if !same_opening(before.opening, after.opening) {
        dropped.push(Dropped::Opening { was: before.opening, is: after.opening });
    }
    if before.description.trim() != after.description.trim() {
        dropped.push(Dropped::Name { was: before.description.clone(), is: after.description.clone() });
    }
    dropped.push(Dropped::NotRead(before.format, target));
    dropped
}

fn same_opening(a: Opening, b: Opening) -> bool {
    let ((name_a, a), (name_b, b)) = (a.sizes(), b.sizes());
    name_a == name_b && a.iter().zip(&b).all(|((_, a), (_, b))| (a - b).abs() < 1e-6)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Planes every 45° with γ 0, 45, 90, intensities by `cd(k)` of plane k.
    fn file(cd: impl Fn(u32) -> u32) -> String {
        let planes = (0..=8).map(|k| format!("500 {} 0", cd(k % 8))).collect::<Vec<_>>().join("\n");
        format!(
            "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 9 1 2 0.3 1.2 0.05\n1 1 40\n0 45 90\n\
             0 45 90 135 180 225 270 315 360\n{planes}\n"
        )
    }

    /// Catches: a plane stored under its mirror image, a symmetry declared that is none, the quarter
    /// turn between the formats, a symmetric file written out in full.
    #[test]
    fn every_symmetry_survives_both_ways() {
        type Planes = fn(u32) -> u32;
        let cases: [(&str, Planes); 5] = [
            ("0", |k| 100 + 10 * k),
            ("1", |_| 77),
            ("2", |k| [10, 20, 30, 20, 10, 50, 60, 50][k as usize]),
            ("3", |k| [10, 20, 30, 40, 50, 40, 30, 20][k as usize]),
            ("4", |k| [10, 20, 30, 20][k as usize % 4]),
        ];
        for (isym, cd) in cases {
            let first = parse(file(cd).as_bytes(), "a.ies").expect("sound");
            let ldt = convert(&first, Target::Ldt).expect("converted");
            let text = String::from_utf8(ldt.bytes.clone()).expect("ASCII");
            assert_eq!(text.lines().nth(2), Some(isym));
            let second = parse(&ldt.bytes, "a.ldt").expect("sound");
            let ies = convert(&second, Target::Ies).expect("converted");
            let third = parse(&ies.bytes, "a.ies").expect("sound");
            for k in 0..8 {
                let azimuth = 45.0 * f64::from(k);
                let [a, c] = [&first, &third].map(|p| p.distribution.intensity_at(azimuth, 45.0));
                assert!(
                    (a - f64::from(cd(k))).abs() < 1e-9 && (a - c).abs() < 1e-6 * a,
                    "Isym {isym}: {a} {c}"
                );
            }
            assert!(same_opening(first.opening, third.opening));
            assert!(!ldt.dropped.iter().any(|what| matches!(what, Dropped::Opening { .. } | Dropped::Power)));
        }
    }

    /// Catches: a loss that is not told.
    #[test]
    fn losses_are_told() {
        let mut photometry = parse(file(|k| 100 + k).as_bytes(), "a.ies").expect("sound");
        photometry.opening = Opening::Rect { length_m: 1.2, width_m: 0.3, side_x_m: 0.0, side_y_m: 0.1 };
        photometry.lor = Some(0.7);
        photometry.colour_rendering = Some(80.0);
        let told = convert(&photometry, Target::Ies).expect("converted").dropped;
        let [Dropped::OutputRatio(lor), Dropped::ColourRendering(ra), Dropped::Opening { was, .. }, ..] =
            told[..]
        else {
            panic!("{told:?}")
        };
        assert_eq!(([lor, ra], was), ([0.7, 80.0], photometry.opening));
    }
}
