//! Tests of the table method against published tables. The EULUMDAT reader below knows just enough
//! for them and is independent of the crate's own.

use super::*;
use crate::glare::reference_data;

/// A rotational or two-fold symmetric luminaire of the reference data.
struct Sample {
    c_step_deg: f64,
    gamma_step_deg: f64,
    /// Absolute candelas by C plane; one plane if rotational.
    planes_cd: Vec<Vec<f64>>,
    length_m: f64,
    /// 0 for a disc of diameter `length_m`.
    width_m: f64,
    side_m: [f64; 2],
}

impl Sample {
    fn read(name: &str) -> Option<Self> {
        let text = reference_data(&format!("ugr_tables/ugr_sample_{name}.ldt"))?;
        let lines: Vec<&str> = text.lines().map(str::trim).collect();
        let number = |line: usize| lines[line - 1].parse::<f64>().unwrap();
        let (symmetry, planes, gammas) = (number(3) as usize, number(4) as usize, number(6) as usize);
        let stored = match symmetry {
            1 => 1,
            4 => planes / 4 + 1,
            other => panic!("symmetry {other} is not in the samples"),
        };
        assert_eq!(number(26) as usize, 1, "one lamp set");
        let first = 26 + 6 + 10 + planes + gammas;
        let cd_per_klm = number(29) / 1000.0;
        let planes_cd = (0..stored)
            .map(|plane| {
                (0..gammas).map(|gamma| number(first + 1 + plane * gammas + gamma) * cd_per_klm).collect()
            })
            .collect();
        Some(Self {
            c_step_deg: number(5),
            gamma_step_deg: number(7),
            planes_cd,
            length_m: number(16) / 1000.0,
            width_m: number(17) / 1000.0,
            side_m: [number(18) / 1000.0, number(19) / 1000.0],
        })
    }

    /// Bilinear in C and γ; C90 lies along +x, C0 along −y.
    fn intensity_cd(&self, direction: DVec3) -> f64 {
        let gamma = direction.x.hypot(direction.y).atan2(-direction.z).to_degrees() / self.gamma_step_deg;
        let c = direction.x.abs().atan2(direction.y.abs()).to_degrees() / self.c_step_deg;
        let at = |plane: usize| {
            let values = &self.planes_cd[plane.min(self.planes_cd.len() - 1)];
            let index = (gamma.floor() as usize).min(values.len() - 2);
            let part = gamma - index as f64;
            values[index] * (1.0 - part) + values[index + 1] * part
        };
        let plane = c.floor() as usize;
        at(plane) * (1.0 - c.fract()) + at(plane + 1) * c.fract()
    }

    fn projected_area_m2(&self, direction: DVec3) -> f64 {
        let (cos, sin) = (-direction.z, direction.x.hypot(direction.y));
        if self.width_m > 0.0 {
            // Towards C0 (∓y) the eye sees the sides along the length.
            let sides = self.length_m * self.side_m[0] * direction.y.abs()
                + self.width_m * self.side_m[1] * direction.x.abs();
            self.length_m * self.width_m * cos + sides
        } else {
            std::f64::consts::FRAC_PI_4 * self.length_m * self.length_m * cos
                + self.length_m * self.side_m[0] * sin
        }
    }

    fn zonal_flux_lm(&self, from_deg: f64, to_deg: f64) -> f64 {
        let (steps, azimuths) = (((to_deg - from_deg) * 4.0).round() as usize, 96);
        let step = (to_deg - from_deg).to_radians() / steps as f64;
        (0..steps)
            .map(|k| {
                let (sin, cos) = (from_deg.to_radians() + (k as f64 + 0.5) * step).sin_cos();
                let mean = (0..azimuths)
                    .map(|a| (f64::from(a) + 0.5) * std::f64::consts::TAU / f64::from(azimuths))
                    .map(|a| self.intensity_cd(DVec3::new(sin * a.cos(), sin * a.sin(), -cos)))
                    .sum::<f64>()
                    / f64::from(azimuths);
                mean * std::f64::consts::TAU * sin * step
            })
            .sum()
    }

    fn table(&self, shr: f64) -> UgrTable {
        // The zones are asked for once per room and set; tabulate them by degree.
        let degrees: Vec<f64> =
            (0..180).map(|d| self.zonal_flux_lm(f64::from(d), f64::from(d + 1))).collect();
        let zones = |from: f64, to: f64| degrees[from as usize..to as usize].iter().sum::<f64>();
        let input = TableInput {
            intensity_cd: &|direction| self.intensity_cd(direction),
            projected_area_m2: &|direction| self.projected_area_m2(direction),
            zonal_flux_lm: &zones,
            flux_lm: zones(0.0, 180.0),
        };
        table(&input, shr).unwrap()
    }
}

/// Differences ours − published over all cells that hold a number, with the cell's place.
fn differences(sample: &str, program: &str, shr: f64) -> Option<Vec<(f64, String)>> {
    let ours = Sample::read(sample)?.table(shr);
    let text = reference_data(&format!("ugr_tables/ugr_table_{sample}_{program}.csv"))?;
    let mut all = Vec::new();
    for (room, line) in text.lines().enumerate() {
        for (column, field) in line.trim().split(',').enumerate() {
            let Ok(published) = field.parse::<f64>() else {
                continue;
            };
            let row = if column < 5 { &ours.crosswise[room] } else { &ours.endwise[room] };
            let (x, y) = ours.rooms[room];
            let place = format!("sample {sample} {x}H×{y}H column {column}, {program} {published}");
            all.push((row[column % 5].clone().unwrap() - published, place));
        }
    }
    Some(all)
}

/// Share of cells within `tolerance`, and the largest difference; prints both.
fn summary(title: &str, all: &[(f64, String)], tolerance: f64) -> (f64, f64) {
    let inside = all.iter().filter(|(difference, _)| difference.abs() <= tolerance).count();
    let worst = all.iter().map(|(difference, _)| difference.abs()).fold(0.0, f64::max);
    let mean = all.iter().map(|(difference, _)| difference).sum::<f64>() / all.len() as f64;
    let share = inside as f64 / all.len() as f64;
    println!(
        "{title}: {inside}/{} within {tolerance} ({:.1} %), mean {mean:+.3}, worst {worst:.3}",
        all.len(),
        100.0 * share
    );
    (share, worst)
}

/// [`summary`], then what lies outside.
fn report(title: &str, all: &[(f64, String)], tolerance: f64) -> (f64, f64) {
    for (difference, place) in all.iter().filter(|(difference, _)| difference.abs() > tolerance) {
        println!("  {difference:+.3} {place}");
    }
    summary(title, all, tolerance)
}

#[test]
fn the_worked_example_of_cie_190_comes_out() {
    // Catches crosswise and endwise swapped, C0 along the lamp, flux counted twice, void cells used.
    let Some(all) = differences("11", "cie190", 1.0) else {
        return;
    };
    let (_, worst) = report("CIE 190 example, SHR 1", &all, 0.15);
    assert!(worst <= 0.15);
}

// Sample 03 is a strip 24 mm wide: with CIE 147's small-source form its tables come out 0.7 low, so
// the programs weight the luminance of sources of any size.
#[test]
fn relux_tables_come_out() {
    let mut every = Vec::new();
    for sample in ["01", "02", "03", "04", "05", "11"] {
        let Some(all) = differences(sample, "Relux", 0.25) else {
            return;
        };
        summary(&format!("Relux {sample}, SHR 0.25"), &all, 0.3);
        every.extend(all);
    }
    let (share, worst) = report("Relux, all", &every, 0.3);
    assert!(share >= 0.99 && worst <= 0.3);
}

// The outliers are narrow beams (01, 02, 05) in small rooms with dark walls or ceilings, where the
// published values lie 0.5 to 0.85 lower than ours and Relux': the crosswise and endwise columns of
// a room are off alike, which points to another background luminance, not to other sources.
#[test]
fn dialux_tables_come_out() {
    let mut every = Vec::new();
    for sample in ["01", "02", "03", "04", "05", "11"] {
        let Some(all) = differences(sample, "Dialux", 0.25) else {
            return;
        };
        summary(&format!("DIALux {sample}, SHR 0.25"), &all, 0.5);
        every.extend(all);
    }
    let (share, worst) = report("DIALux, all", &every, 0.5);
    assert!(share >= 0.95 && worst <= 1.0);
}

#[test]
fn the_spacing_moves_a_narrow_beam_by_several_ugr_and_a_diffuse_strip_hardly() {
    // Why a table names its SHR: at SHR 1 the luminaires seen under γ from 30° to 50° fall into void
    // cells, and with them all that a narrow beam shows the eye. Catches a spacing without effect.
    let mut means = Vec::new();
    for name in ["01", "02", "03", "04", "05", "11"] {
        let Some(sample) = Sample::read(name) else {
            return;
        };
        let (dense, wide) = (sample.table(0.25), sample.table(1.0));
        let mut steps = Vec::new();
        for room in 0..ROOMS.len() {
            for set in 0..REFLECTANCES.len() {
                for (dense, wide) in [(&dense.crosswise, &wide.crosswise), (&dense.endwise, &wide.endwise)] {
                    steps.push(dense[room][set].clone().unwrap() - wide[room][set].clone().unwrap());
                }
            }
        }
        let mean = steps.iter().sum::<f64>() / steps.len() as f64;
        let [least, most] =
            steps.iter().fold([f64::MAX, f64::MIN], |[a, b], step| [a.min(*step), b.max(*step)]);
        println!("sample {name}: SHR 0.25 less SHR 1: {least:+.2} … {most:+.2}, mean {mean:+.2}");
        means.push(mean);
    }
    assert!(means[0] > 3.0 && means[1] > 3.0, "narrow beams");
    assert!(means[2].abs() < 0.3 && means[5].abs() < 0.3, "diffuse ones");
}

/// A Lambertian panel of 1.2 m × 0.3 m and 1000 cd/m², bent by `shape`.
fn panel(shape: impl Fn(DVec3) -> f64, scale: f64, check: impl Fn(&TableInput)) {
    let area = |direction: DVec3| 0.36 * (-direction.z).max(0.0);
    let intensity = |direction: DVec3| scale * 360.0 * (-direction.z).max(0.0) * shape(direction);
    let sin2 = |deg: f64| deg.min(90.0).to_radians().sin().powi(2);
    let zones = |from: f64, to: f64| scale * std::f64::consts::PI * 360.0 * (sin2(to) - sin2(from));
    check(&TableInput {
        intensity_cd: &intensity,
        projected_area_m2: &area,
        zonal_flux_lm: &zones,
        flux_lm: zones(0.0, 180.0),
    });
}

#[test]
fn a_brighter_panel_shifts_the_whole_table() {
    let plain = |_: DVec3| 1.0;
    panel(plain, 1.0, |one| {
        let table_one = table(one, 0.25).unwrap();
        panel(plain, 3.0, |three| {
            let table_three = table(three, 0.25).unwrap();
            for room in 0..ROOMS.len() {
                let step = table_three.endwise[room][0].clone().unwrap()
                    - table_one.endwise[room][0].clone().unwrap();
                assert!((step - flux_correction(three.flux_lm, one.flux_lm)).abs() < 1e-9);
            }
        });
        // A Lambertian panel looks the same from both sides: crosswise and endwise agree.
        for room in 0..ROOMS.len() {
            let difference =
                table_one.crosswise[room][3].clone().unwrap() - table_one.endwise[room][3].clone().unwrap();
            assert!(difference.abs() < 1e-9);
        }
        assert!(table(one, 0.3).is_err() && table(one, 0.0).is_err() && table(one, f64::NAN).is_err());
    });
}

#[test]
fn rooms_between_the_tables_rooms_are_interpolated_and_outside_clamped() {
    panel(
        |_| 1.0,
        1.0,
        |input| {
            let table = table(input, 0.25).unwrap();
            let value = |x, y| table.room(x, y, [0.7, 0.5, 0.2]).unwrap();
            let at = |room: usize| table.crosswise[room][0].clone().unwrap();
            let close = |a: &Result<f64, Undefined>, b: f64| (a.clone().unwrap() - b).abs() < 1e-9;
            for (room, (x, y)) in ROOMS.into_iter().enumerate() {
                assert!(close(&value(x, y).crosswise, at(room)) && value(x, y).notes.is_empty(), "{x} {y}");
            }
            assert!(close(&value(3.0, 2.5).crosswise, (at(0) + at(1) + at(6) + at(7)) / 4.0));
            // 8H × 2H is no room of the table: its column begins at 4H.
            for (x, y, room) in [(8.0, 2.0, 12), (30.0, 30.0, 18), (1.0, 1.0, 0)] {
                assert!(close(&value(x, y).crosswise, at(room)), "{x} {y}");
                assert_eq!(value(x, y).notes.len(), 1);
            }
            let grey = table.room(4.0, 8.0, [0.65, 0.45, 0.3]).unwrap();
            assert!(grey.notes[0].contains("70/50/20 taken for 65/45/30"), "{:?}", grey.notes);
            assert!(table.room(f64::NAN, 4.0, [0.7, 0.5, 0.2]).is_err());
        },
    );
}

#[test]
fn luminaires_the_method_was_not_made_for_are_refused() {
    let reason = |input: &TableInput| table(input, 0.25).unwrap_err().reason;
    panel(
        |direction| 1.0 + 0.8 * direction.y,
        1.0,
        |washer| assert!(reason(washer).contains("axis"), "{}", reason(washer)),
    );
    panel(
        |_| 1.0,
        1.0,
        |input| {
            let up = |from: f64, to: f64| {
                if from >= 90.0 { 800.0 } else { 200.0 * (to - from) / 90.0 }
            };
            let indirect = TableInput { zonal_flux_lm: &up, flux_lm: 1000.0, ..*input };
            assert!(reason(&indirect).contains("80 % of the flux goes up"));
            let ceiling = TableInput { projected_area_m2: &|_| 2.0, ..*input };
            assert!(reason(&ceiling).contains("2.00 m²"));
            assert!(reason(&TableInput { flux_lm: 0.0, ..*input }).contains("no flux"));
        },
    );
}
