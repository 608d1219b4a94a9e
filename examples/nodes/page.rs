//! What the study writes.

use std::error::Error as Failure;
use std::fmt::Write as _;
use std::path::Path;

use crate::figure::{Figure, Series};
use crate::looks::HEIGHT_M;
use crate::today::WAYS;
use crate::{EXPONENTS, LIGHTS, Row};

const WORDS: &str = include_str!("words.md");
const FORMS: [&str; 3] = ["θ–φ grid", "spherical harmonics", "octahedral map"];

pub fn write(rows: &[Row], largest: &[(u32, [f64; 2])]) -> Result<(), Box<dyn Failure>> {
    let folder = Path::new("reports/nodes");
    std::fs::create_dir_all(folder)?;
    std::fs::write(folder.join("nodes.csv"), csv(rows))?;
    std::fs::write(folder.join("effort.csv"), effort(rows))?;
    let pages = [
        ("{largest}", brightest(largest)),
        ("{directions}", directions(rows)),
        ("{positions}", positions(rows)),
        ("{law}", law(rows)),
        ("{whole}", whole(rows)),
        ("{meshes}", meshes(rows)),
        ("{today}", today(rows)),
    ];
    let text = pages.iter().fold(WORDS.to_owned(), |text, (key, table)| text.replace(key, table.trim_end()));
    std::fs::write(folder.join("README.md"), text)?;
    for (light, named) in LIGHTS.into_iter().enumerate() {
        std::fs::write(folder.join(format!("directions-{named}.svg")), by_directions(rows, light))?;
        std::fs::write(folder.join(format!("law-{named}.svg")), by_spacing(rows, light))?;
    }
    for (key, table) in pages {
        println!("{key}\n{table}");
    }
    Ok(())
}

fn shown(exponent: Option<u32>) -> String {
    exponent.map_or("–".into(), |n| n.to_string())
}

/// Everything that is the same at every run.
fn csv(rows: &[Row]) -> String {
    let mut text = String::from(
        "part,light,exponent,way,numbers_per_node_or_rays_per_look,spacing_m,nodes_on_floor,bytes_on_floor,rays_per_number,rms_percent,largest_percent,interpolation_rms_percent,reference_se_percent\n",
    );
    for row in rows {
        let Row { part, light, exponent, way, numbers, spacing_m, nodes, rays, error, .. } = row;
        let (light, exponent, interpolation) = (LIGHTS[*light], shown(*exponent), error.interpolation_text());
        let _ = writeln!(
            text,
            "{part},{light},{exponent},\"{way}\",{numbers},{spacing_m},{nodes},{},{rays},{:.3},{:.3},{interpolation},{:.3}",
            row.bytes(),
            error.rms,
            error.largest,
            error.reference
        );
    }
    text
}

/// CPU times, which differ from run to run.
fn effort(rows: &[Row]) -> String {
    let mut text = String::from(
        "part,light,exponent,way,numbers_per_node_or_rays_per_look,spacing_m,cpu_s_of_floor_or_look,cpu_s_of_look_at_field\n",
    );
    for row in rows.iter().filter(|row| row.cpu_s > 0.0) {
        let Row { part, light, exponent, way, numbers, spacing_m, cpu_s, look_s, .. } = row;
        let (light, exponent) = (LIGHTS[*light], shown(*exponent));
        let _ = writeln!(
            text,
            "{part},{light},{exponent},\"{way}\",{numbers},{spacing_m},{cpu_s:.3e},{look_s:.3e}"
        );
    }
    text
}

fn brightest(largest: &[(u32, [f64; 2])]) -> String {
    let one = |(n, [all, indirect]): &(u32, [f64; 2])| format!("| {n} | {all:.0} | {indirect:.1} |\n");
    largest.iter().map(one).collect()
}

fn of<'r>(rows: &'r [Row], part: &'r str, light: usize, exponent: u32) -> impl Iterator<Item = &'r Row> {
    rows.iter().filter(move |row| row.part == part && row.light == light && row.exponent == Some(exponent))
}

/// Interpolation error of every size of every form.
fn directions(rows: &[Row]) -> String {
    let mut text = String::new();
    for (light, named) in LIGHTS.into_iter().enumerate() {
        for exponent in EXPONENTS {
            let _ = write!(text, "| {named} | {exponent} |");
            for form in FORMS {
                let cells = of(rows, "direction", light, exponent).filter(|row| row.way == form);
                let list: Vec<String> =
                    cells.map(|row| format!("{}: {}", row.numbers, row.error.interpolation_text())).collect();
                let _ = write!(text, " {} |", list.join("; "));
            }
            text.push('\n');
        }
    }
    text
}

fn positions(rows: &[Row]) -> String {
    let mut text = String::new();
    for (light, named) in LIGHTS.into_iter().enumerate() {
        for exponent in EXPONENTS {
            let cells = of(rows, "position", light, exponent).map(|row| row.error.interpolation_text());
            let _ =
                writeln!(text, "| {named} | {exponent} | {} |", cells.collect::<Vec<String>>().join(" | "));
        }
    }
    text
}

/// Where the error of interpolation crosses a value between two measured spacings, straight in logarithms.
fn crossing(rows: &[Row], light: usize, exponent: u32, percent: f64) -> Option<f64> {
    let known: Vec<(f64, f64)> = of(rows, "position", light, exponent)
        .filter_map(|row| Some((row.spacing_m, row.error.interpolation()?)))
        .collect();
    known.windows(2).find_map(|pair| {
        let [(wide, worse), (close, better)] = [pair[0], pair[1]];
        (worse >= percent && better < percent).then(|| {
            let share = (percent / better).ln() / (worse / better).ln();
            close * (wide / close).powf(share)
        })
    })
}

/// The law error = k (s √n / d)²: means of k over spacings of which the bracket is between these.
const FITTED: std::ops::Range<f64> = 0.2..1.2;

fn law(rows: &[Row]) -> String {
    let mut text = String::new();
    for (light, named) in LIGHTS.into_iter().enumerate() {
        for exponent in EXPONENTS {
            let x = |spacing_m: f64| spacing_m * f64::from(exponent).sqrt() / HEIGHT_M;
            let spacing = crossing(rows, light, exponent, 1.0);
            let spacing = spacing.map_or("– | –".into(), |m| format!("{m:.2} m | {:.2}", x(m)));
            let fitted = || {
                let within = of(rows, "position", light, exponent)
                    .filter(|row| FITTED.contains(&x(row.spacing_m)) && row.error.interpolation().is_some());
                within.map(|row| (row, x(row.spacing_m).powi(2)))
            };
            let count = fitted().count() as f64;
            let rms: f64 = fitted().filter_map(|(row, x2)| Some(row.error.interpolation()? / x2)).sum();
            let largest: f64 = fitted().map(|(row, x2)| row.error.largest / x2).sum();
            let shown = |sum: f64| if count > 0.0 { format!("{:.1}", sum / count) } else { "–".into() };
            let (rms, largest) = (shown(rms), shown(largest));
            let _ = writeln!(text, "| {named} | {exponent} | {spacing} | {rms} | {largest} |");
        }
    }
    text
}

/// Rays at which patches and lobe rays err as much, and their CPU time, straight in logarithms.
fn equal(rows: &[Row], way: &str, light: usize, exponent: u32, rms: f64) -> Option<(f64, f64)> {
    let list: Vec<&Row> = of(rows, "today", light, exponent).filter(|row| row.way == way).collect();
    let between = list.windows(2).find(|pair| pair[0].error.rms >= rms && pair[1].error.rms < rms);
    let [few, many] = between.map(|pair| [pair[0], pair[1]])?;
    let share = (rms / few.error.rms).ln() / (many.error.rms / few.error.rms).ln();
    let at = |a: f64, b: f64| a * (b / a).powf(share);
    Some((at(f64::from(few.rays), f64::from(many.rays)), at(few.cpu_s, many.cpu_s)))
}

fn whole(rows: &[Row]) -> String {
    let mut text = String::new();
    for exponent in EXPONENTS {
        for row in rows.iter().filter(|row| row.part == "whole" && row.exponent == Some(exponent)) {
            // Like with like: fields that patches spoil against rays that they spoil.
            let rival = WAYS[usize::from(row.way.ends_with("as stored"))];
            let equal = equal(rows, rival, row.light, exponent, row.error.rms);
            let (rays, looks) = if let Some((rays, cpu_s)) = equal {
                let saved_s = cpu_s - row.look_s;
                let looks = 1e-3 * row.cpu_s / saved_s;
                (format!("{rays:.0}"), if saved_s > 0.0 { format!("{looks:.1}") } else { "never".into() })
            } else {
                let best = of(rows, "today", row.light, exponent).filter(|row| row.way == rival);
                let best = best.map(|row| row.error.rms).fold(f64::INFINITY, f64::min);
                (if best < row.error.rms { "fewest".into() } else { "more".into() }, "–".into())
            };
            let _ = writeln!(
                text,
                "| {exponent} | {} | {} | {} | {:.2} | {} | {:.1} | {:.2} MB | {:.0} | {:.0} | {rays} | {looks} |",
                row.way,
                row.spacing_m,
                row.numbers,
                row.error.rms,
                row.error.interpolation_text(),
                row.error.largest,
                1e-6 * row.bytes() as f64,
                row.cpu_s,
                1e6 * row.look_s
            );
        }
    }
    text
}

fn meshes(rows: &[Row]) -> String {
    let mut text = String::new();
    for row in rows.iter().filter(|row| row.part == "mesh") {
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} | {:.2} | {} | {:.1} | {:.0} kB | {:.1} |",
            shown(row.exponent),
            LIGHTS[row.light],
            row.way,
            row.spacing_m,
            row.nodes,
            row.error.rms,
            row.error.interpolation_text(),
            row.error.largest,
            1e-3 * row.bytes() as f64,
            row.cpu_s
        );
    }
    text
}

fn today(rows: &[Row]) -> String {
    let mut text = String::new();
    for way in WAYS {
        for (light, named) in LIGHTS.into_iter().enumerate() {
            for exponent in EXPONENTS {
                let cells = of(rows, "today", light, exponent)
                    .filter(|row| row.way == way)
                    .map(|row| format!("{}: {:.2}, {:.0} µs", row.rays, row.error.rms, 1e6 * row.cpu_s));
                let cells = cells.collect::<Vec<String>>().join(" | ");
                let _ = writeln!(text, "| {way} | {named} | {exponent} | {cells} |");
            }
        }
    }
    text
}

fn by_directions(rows: &[Row], light: usize) -> String {
    let mut series = Vec::new();
    for exponent in [10, 100] {
        for form in FORMS {
            let cells = of(rows, "direction", light, exponent).filter(|row| row.way == form);
            let points = cells.filter_map(|row| Some([row.numbers as f64, row.error.interpolation()?, 0.0]));
            series.push(Series {
                name: format!("{form}, n = {exponent}"),
                points: points.collect(),
                line: true,
            });
        }
    }
    Figure {
        title: &format!("Error of interpolating over directions, light: {}", LIGHTS[light]),
        axes: ["numbers per node", "rms, % of the largest luminance"],
        log: [true, true],
        series: &series,
    }
    .svg()
}

fn by_spacing(rows: &[Row], light: usize) -> String {
    let series: Vec<Series> = EXPONENTS
        .into_iter()
        .map(|exponent| {
            let x = |row: &Row| row.spacing_m * f64::from(exponent).sqrt() / HEIGHT_M;
            let points = of(rows, "position", light, exponent)
                .filter_map(|row| Some([x(row), row.error.interpolation()?, 0.0]));
            Series { name: format!("n = {exponent}"), points: points.collect(), line: true }
        })
        .collect();
    Figure {
        title: &format!("Error of interpolating between nodes, light: {}", LIGHTS[light]),
        axes: ["spacing · √n / d", "rms, % of the largest luminance"],
        log: [true, true],
        series: &series,
    }
    .svg()
}
