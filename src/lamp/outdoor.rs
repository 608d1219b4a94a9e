//! Classes of road and area luminaires: luminous intensity G* and glare index D (EN 13201-2, annex A)
//! and BUG (IES TM-15-11). For a luminaire mounted as its file lies, γ = 0 straight down. No limit was
//! compared with the standards themselves: what stands in one public source says so, the rest is
//! *unverified*.

use glam::DVec3;

use crate::photometry::{Format, IntensityDistribution, Photometry, Symmetry};
use crate::units::Undefined;

/// How well the limits of a class are known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Known {
    /// One public source has the same numbers.
    OneSource,
    /// From memory.
    Unverified,
}

impl Known {
    /// The word in files for machines.
    pub fn key(self) -> &'static str {
        match self {
            Self::OneSource => "one-source",
            Self::Unverified => "unverified",
        }
    }
}

/// Of G*1 … G*3, and of G*4 … G*6: W. van Bommel, Road Lighting (2015), table 11.2, after CIE 115:2010, whose
/// classes are those of EN 13201-2.
pub fn g_star_known(class: u8) -> Known {
    if class >= 4 { Known::OneSource } else { Known::Unverified }
}

/// Of D1 … D6. The index itself, with the largest I at 85° over all azimuths and the area seen from there, is
/// that of GOST R 55706-2023, annex Б.
pub const D_KNOWN: Known = Known::Unverified;
/// Of B, U and G. B and U: as in the crate eulumdat 0.7.0, whose limits of G differ from these.
pub const BUG_KNOWN: [Known; 3] = [Known::OneSource, Known::OneSource, Known::Unverified];

/// Largest cd/klm at γ ≥ 70°, 80°, 90° and from 95° on, for G*1 … G*6; `None`: no limit. Per 1000 lm of
/// the luminaire's own flux.
const G_STAR: [[Option<f64>; 4]; 6] = [
    [None, Some(200.0), Some(50.0), None],
    [None, Some(150.0), Some(30.0), None],
    [None, Some(100.0), Some(20.0), None],
    [Some(500.0), Some(100.0), Some(10.0), Some(0.0)],
    [Some(350.0), Some(100.0), Some(10.0), Some(0.0)],
    [Some(350.0), Some(100.0), Some(0.0), Some(0.0)],
];
/// γ from which the columns of the G* table count, degrees.
pub const G_GAMMAS_DEG: [f64; 4] = [70.0, 80.0, 90.0, 95.0];
/// Largest glare index for D1 … D6, cd/m.
const D_CLASSES: [f64; 6] = [7000.0, 5500.0, 4000.0, 2000.0, 1000.0, 500.0];
/// What counts as no intensity at all, cd/klm: where the classes ask for 0, van Bommel's table has 1.
const NONE_CD_PER_KLM: f64 = 1.0;

/// Largest zonal lumens for ratings 0 … 4: back 60–80°, 30–60°, 0–30°.
const BACK_LM: [[f64; 3]; 5] = [
    [110.0, 220.0, 110.0],
    [500.0, 1000.0, 500.0],
    [1000.0, 2500.0, 1000.0],
    [2500.0, 5000.0, 2500.0],
    [5000.0, 8500.0, 5000.0],
];
/// Largest zonal lumens for ratings 0 … 4: up 100–180° and 90–100° alike.
const UP_LM: [f64; 5] = [0.0, 10.0, 50.0, 500.0, 1000.0];
/// Largest zonal lumens for ratings 0 … 4: 80–90° (front and back alike), front 60–80°, back 60–80°
/// (asymmetric; a quadrilaterally symmetric luminaire may have as much behind as in front).
const GLARE_LM: [[f64; 3]; 5] = [
    [10.0, 660.0, 110.0],
    [100.0, 1800.0, 500.0],
    [225.0, 5000.0, 1000.0],
    [500.0, 7500.0, 2500.0],
    [750.0, 12000.0, 5000.0],
];

/// All classes of one luminaire.
#[derive(Clone, Debug)]
pub struct Outdoor {
    /// The best class that is met, 1 … 6; 0 if none.
    pub g_star: u8,
    /// Largest cd/klm at and above each of [`G_GAMMAS_DEG`].
    pub g_cd_per_klm: [f64; 4],
    /// Glare index I·A^(−1/2) at γ = 85°, cd/m, and its class 0 … 6.
    pub glare_index: Result<(f64, u8), Undefined>,
    /// Backlight, uplight, glare, 0 … 5 each.
    pub bug: Bug,
}

/// IES TM-15-11.
#[derive(Clone, Debug)]
pub struct Bug {
    /// B, U, G.
    pub rating: [u8; 3],
    /// The zone that decides each rating, and its lumens.
    pub decided_by: [(&'static str, f64); 3],
    /// Lumens: FL, FM, FH, FVH, BL, BM, BH, BVH, UL, UH.
    pub zones_lm: [f64; 10],
    /// Azimuth of the street side in the luminaire frame, degrees.
    pub front_azimuth_deg: f64,
    /// All quadrants alike: the limits of types V and V square.
    pub quadrilateral: bool,
}

/// Names of [`Bug::zones_lm`].
pub const ZONES: [&str; 10] = ["FL", "FM", "FH", "FVH", "BL", "BM", "BH", "BVH", "UL", "UH"];

/// Computes all classes.
pub fn outdoor(photometry: &Photometry, symmetry: Symmetry) -> Outdoor {
    let distribution = &photometry.distribution;
    let per_klm = 1000.0 / distribution.flux().0;
    let g_cd_per_klm = G_GAMMAS_DEG.map(|gamma| largest_from(distribution, gamma).0 * per_klm);
    Outdoor {
        g_star: g_star(g_cd_per_klm),
        g_cd_per_klm,
        glare_index: glare_index(photometry),
        bug: bug(photometry, symmetry),
    }
}

fn g_star(cd_per_klm: [f64; 4]) -> u8 {
    let meets = |limits: &[Option<f64>; 4]| {
        let within = |(value, limit): (&f64, &Option<f64>)| {
            limit.is_none_or(|limit| *value <= limit.max(NONE_CD_PER_KLM))
        };
        cd_per_klm.iter().zip(limits).all(within)
    };
    (1..=6).rev().find(|class| meets(&G_STAR[usize::from(*class) - 1])).unwrap_or(0)
}

/// The largest intensity in cd at γ and above, and its azimuth in degrees: the interpolant has it at a
/// node or on the edge.
fn largest_from(distribution: &IntensityDistribution, gamma_deg: f64) -> (f64, f64) {
    let degrees: (Vec<f64>, Vec<f64>) =
        ((0..=360).map(f64::from).collect(), (0..=180).map(f64::from).collect());
    let (azimuths, gammas) = distribution.grid().unwrap_or((&degrees.0, &degrees.1));
    let above = gammas.iter().copied().filter(|gamma| *gamma > gamma_deg);
    let mut best = (0.0, 0.0);
    for gamma in std::iter::once(gamma_deg).chain(above) {
        for azimuth in azimuths {
            let cd = distribution.intensity_at(*azimuth, gamma);
            if cd > best.0 {
                best = (cd, *azimuth);
            }
        }
    }
    best
}

/// D = I·A^(−1/2): I the largest intensity at γ = 85°, A the area of the opening seen from there, m².
fn glare_index(photometry: &Photometry) -> Result<(f64, u8), Undefined> {
    const GAMMA_DEG: f64 = 85.0;
    let distribution = &photometry.distribution;
    let azimuths: Vec<f64> = (0..360).map(f64::from).collect();
    let azimuths = distribution.grid().map_or(&azimuths[..], |(azimuths, _)| azimuths);
    let cd = |azimuth: &&f64| distribution.intensity_at(**azimuth, GAMMA_DEG);
    let azimuth = azimuths.iter().max_by(|a, b| cd(a).total_cmp(&cd(b))).copied().unwrap_or(0.0);
    let cd = distribution.intensity_at(azimuth, GAMMA_DEG);
    let (sin, cos) = GAMMA_DEG.to_radians().sin_cos();
    let (sin_a, cos_a) = azimuth.to_radians().sin_cos();
    let area_m2 = photometry.opening.projected_area_m2(DVec3::new(sin * cos_a, sin * sin_a, -cos));
    if !(area_m2 > 0.0) {
        return Err(Undefined::because("no luminous area is seen from γ = 85°"));
    }
    let index = cd / area_m2.sqrt();
    Ok((index, d_class(index)))
}

fn d_class(index: f64) -> u8 {
    (1..=6).rev().find(|class| index <= D_CLASSES[usize::from(*class) - 1]).unwrap_or(0)
}

/// Where the street is: EULUMDAT's C90; LM-63's 90° where the file mirrors about that plane, else its 0°.
fn front_azimuth_deg(format: Format, symmetry: Symmetry) -> f64 {
    match (format, symmetry) {
        (Format::Lm63 { .. }, Symmetry::AboutWidth) => 90.0,
        _ => 0.0,
    }
}

fn bug(photometry: &Photometry, symmetry: Symmetry) -> Bug {
    let distribution = &photometry.distribution;
    let front_azimuth_deg = front_azimuth_deg(photometry.format, symmetry);
    let quadrilateral = matches!(symmetry, Symmetry::Rotational | Symmetry::Quadrant);
    let half = |from: f64, to: f64, turn: f64| half_zone_lm(distribution, from, to, front_azimuth_deg + turn);
    let bands = [(0.0, 30.0), (30.0, 60.0), (60.0, 80.0), (80.0, 90.0)];
    let mut zones_lm = [0.0; 10];
    for (k, (from, to)) in bands.into_iter().enumerate() {
        (zones_lm[k], zones_lm[4 + k]) = (half(from, to, 0.0), half(from, to, 180.0));
    }
    (zones_lm[8], zones_lm[9]) =
        (distribution.zonal_flux(90.0, 100.0).0, distribution.zonal_flux(100.0, 180.0).0);
    let [_, _, fh, fvh, bl, bm, bh, bvh, ul, uh] = zones_lm;
    let glare = |column: usize| GLARE_LM.map(|row| row[column]);
    let high_behind = if quadrilateral { glare(1) } else { glare(2) };
    let decisions = [
        worst([
            ("BH", bh, BACK_LM.map(|row| row[0])),
            ("BM", bm, BACK_LM.map(|row| row[1])),
            ("BL", bl, BACK_LM.map(|row| row[2])),
        ]),
        worst([("UH", uh, UP_LM), ("UL", ul, UP_LM)]),
        worst([
            ("FVH", fvh, glare(0)),
            ("BVH", bvh, glare(0)),
            ("FH", fh, glare(1)),
            ("BH", bh, high_behind),
        ]),
    ];
    Bug {
        rating: decisions.map(|(rating, _)| rating),
        decided_by: decisions.map(|(_, zone)| zone),
        zones_lm,
        front_azimuth_deg,
        quadrilateral,
    }
}

/// The highest rating that a zone asks for, and that zone; lumens are compared to a tenth.
fn worst<const N: usize>(zones: [(&'static str, f64, [f64; 5]); N]) -> (u8, (&'static str, f64)) {
    let rating =
        |lm: f64, limits: &[f64; 5]| limits.iter().filter(|limit| lm >= **limit + 0.05).count() as u8;
    let rated = zones.map(|(name, lm, limits)| (rating(lm, &limits), (name, lm)));
    rated.into_iter().reduce(|best, next| if next.0 > best.0 { next } else { best }).unwrap_or((0, ("", 0.0)))
}

/// Flux between two γ within 90° of an azimuth, lm: midpoints of 1° × 0.5° on the interpolant.
fn half_zone_lm(distribution: &IntensityDistribution, from_deg: f64, to_deg: f64, azimuth_deg: f64) -> f64 {
    const STEP_DEG: f64 = 0.5;
    let rings = ((to_deg - from_deg) / STEP_DEG).round() as i32;
    let ring = |i: i32| {
        let gamma = from_deg + STEP_DEG * (f64::from(i) + 0.5);
        let half = (0..180).map(|k| distribution.intensity_at(azimuth_deg - 89.5 + f64::from(k), gamma));
        half.sum::<f64>() * gamma.to_radians().sin()
    };
    (0..rings).map(ring).sum::<f64>() * STEP_DEG.to_radians() * 1f64.to_radians()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::photometry::{Opening, parse};

    /// γ in 5° steps, planes 0, 90, 180, 270; cd(plane, γ).
    fn lamp(cd: impl Fn(u32, f64) -> f64) -> Photometry {
        let gammas: Vec<f64> = (0..=36).map(|k| 5.0 * f64::from(k)).collect();
        let row =
            |plane: u32| gammas.iter().map(|g| format!("{:.6}", cd(plane, *g))).collect::<Vec<_>>().join(" ");
        let list = gammas.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
        let planes = (0..=4).map(|k| row(k % 4)).collect::<Vec<_>>().join("\n");
        let text = format!(
            "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 37 5 1 2 0.3 0.6 0\n1 1 40\n{list}\n0 90 180 270 360\n{planes}\n"
        );
        parse(text.as_bytes(), "a.ies").expect("sound")
    }

    fn classes(photometry: &Photometry) -> Outdoor {
        outdoor(photometry, Symmetry::of(&photometry.distribution, 1e-3))
    }

    /// Catches: limits read "below" instead of "at and above", cd for cd/klm, the order of the classes.
    #[test]
    fn intensity_classes_by_hand() {
        assert_eq!(g_star([340.0, 90.0, 0.0, 0.0]), 6);
        assert_eq!(g_star([340.0, 90.0, 9.0, 0.0]), 5);
        assert_eq!(g_star([400.0, 90.0, 9.0, 0.0]), 4);
        assert_eq!(g_star([600.0, 90.0, 9.0, 0.0]), 3);
        assert_eq!(g_star([600.0, 90.0, 9.0, 2.0]), 3);
        assert_eq!(g_star([600.0, 120.0, 9.0, 0.0]), 2);
        assert_eq!(g_star([600.0, 160.0, 9.0, 0.0]), 1);
        assert_eq!(g_star([600.0, 210.0, 9.0, 0.0]), 0);
        // Lambertian: 1000/π cosγ = 108.9 cd/klm at 70°, 55.3 at 80°, nothing above.
        let flat = classes(&lamp(|_, gamma| 100.0 * gamma.to_radians().cos().max(0.0)));
        assert!((flat.g_cd_per_klm[0] - 108.9).abs() < 0.3 && (flat.g_cd_per_klm[1] - 55.3).abs() < 0.2);
        assert_eq!(flat.g_star, 6);
    }

    /// Catches: a limit read "below" instead of "up to", one that is compared with another column or row.
    #[test]
    fn both_sides_of_every_limit() {
        for (row, class) in G_STAR.iter().zip(1u8..) {
            let at_limits = row.map(|limit| limit.map_or(9000.0, |limit| limit.max(NONE_CD_PER_KLM)));
            assert!(g_star(at_limits) >= class, "G*{class}: {at_limits:?}");
            for column in (0..4).filter(|column| row[*column].is_some()) {
                let mut above = at_limits;
                above[column] += 0.01;
                assert!(g_star(above) < class, "G*{class}: {above:?}");
            }
        }
        for (limit, class) in D_CLASSES.into_iter().zip(1u8..) {
            assert_eq!((d_class(limit), d_class(limit + 0.01)), (class, class - 1));
        }
        let rated = |lm: f64, limits: [f64; 5]| worst([("zone", lm, limits)]).0;
        let glare = |column: usize| GLARE_LM.map(|row| row[column]);
        let back = |column: usize| BACK_LM.map(|row| row[column]);
        for limits in [back(0), back(1), back(2), UP_LM, glare(0), glare(1), glare(2)] {
            for (limit, rating) in limits.into_iter().zip(0u8..) {
                assert_eq!(
                    (rated(limit, limits), rated(limit + 0.06, limits)),
                    (rating, rating + 1),
                    "{limits:?}"
                );
            }
        }
    }

    /// Catches: area not projected, or not under the root. 0.6 × 0.3 m, 100 cd at 85°: A = 0.18 cos 85° =
    /// 0.015688 m², D = 100/0.12525 = 798.4: D5.
    #[test]
    fn glare_index_by_hand() {
        let found = classes(&lamp(|_, gamma| if gamma <= 90.0 { 100.0 } else { 0.0 }));
        let (index, class) = found.glare_index.expect("an area");
        assert!((index - 798.4).abs() < 0.1 && class == 5, "{index} {class}");
        let mut point = lamp(|_, _| 100.0);
        point.opening = Opening::Point;
        assert!(classes(&point).glare_index.is_err());
    }

    /// Catches: front and back exchanged, a zone's bounds, the street side of a file that mirrors about 90°.
    /// 1000 cd within γ 60–80° on one side: FH = 1000 · π (cos 60° − cos 80°) = 1025 lm at its core.
    #[test]
    fn bug_by_hand() {
        // Constant 500 cd below 90°: L 500·π(1 − cos 30°) = 210.4, M 500·π·0.36603 = 575.0, H 512.6,
        // VH 500·π·0.17365 = 272.8 per half: B2 (BM 575 ≤ 1000 is B1, BH 512.6 > 500 is B2), U by the ramp
        // from 90° to 95°, G3 (VH 272.8 > 225).
        let even = classes(&lamp(|_, gamma| if gamma <= 90.0 { 500.0 } else { 0.0 })).bug;
        for (zone, truth) in [(0, 210.4), (1, 575.0), (2, 512.6), (3, 272.8), (6, 512.6)] {
            assert!((even.zones_lm[zone] - truth).abs() < 0.1, "{}: {}", ZONES[zone], even.zones_lm[zone]);
        }
        assert!(even.quadrilateral && even.rating[0] == 2 && even.rating[2] == 3, "{even:?}");
        assert_eq!((even.decided_by[0].0, even.decided_by[2].0), ("BH", "FVH"));
        let street = |front: u32| {
            move |plane: u32, gamma: f64| match gamma {
                g if g > 80.0 => 0.0,
                _ if plane == front => 1000.0,
                _ => 100.0,
            }
        };
        let [along, across] = [street(0), street(1)].map(|cd| classes(&lamp(cd)).bug);
        assert!(
            (along.front_azimuth_deg - 0.0).abs() < 1e-9 && (across.front_azimuth_deg - 90.0).abs() < 1e-9
        );
        for bug in [along, across] {
            assert!(bug.zones_lm[1] > 3.0 * bug.zones_lm[5] && bug.rating[1] == 0, "{bug:?}");
        }
        let up = classes(&lamp(|_, gamma| if gamma > 100.0 { 10.0 } else { 100.0 })).bug;
        assert!(up.zones_lm[9] > 50.0 && up.rating[1] == 3, "{up:?}");
    }
}
