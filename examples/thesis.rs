//! What a program misses that knows diffuse reflection only: the hall with its polished floor, the office with
//! its mirror and a polished lobby, solved as they are and with every glossy and mirroring material replaced by
//! a diffuse one of the same albedo. Writes CSV, a figure and a page to reports/thesis; equal for equal code:
//!
//!     cargo run --release --example thesis
#![allow(clippy::print_stdout, reason = "a study prints")]

#[path = "figure/mod.rs"]
mod figure;

use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use figure::{Figure, Series};
use gershun::estimate::quantile;
use gershun::material::Bsdf;
use gershun::outcome::{Interval, Outcome, Value};
use gershun::project::{LoadOptions, Project, load};
use gershun::{Settings, Watch, run};

const FOLDER: &str = "reports/thesis";
const SCENES: [(&str, &str); 3] =
    [("hall", "scenes/hall"), ("office", "scenes/office"), ("lobby", "reports/thesis/lobby")];
const BLOCKS: usize = 128;
/// Of the two solutions: apart, so that their errors are independent.
const SEEDS: [u64; 2] = [1, 2];
/// Differences of fewer standard errors are not told from none.
const CONFIDENCE: f64 = 0.95;

/// A lobby with a polished stone floor, a polished metal wall and a mirror.
const LOBBY: &str = r#"# A polished lobby, made for the study `cargo run --release --example thesis`.

[project]
name = "lobby"

[scene]
box = { size = [9, 6, 3.6], floor = 0.3, walls = 0.6, ceiling = 0.8 }

[materials]
Floor = { reflectance = 0.12, specular = 0.10, ward = 0.05 }     # polished dark stone
Wall_N = { reflectance = 0.05, specular = 0.60, ward = 0.10 }    # brushed metal
Wall_E = { mirror = 0.85 }

[luminaires.D]
lambert = { flux = 2400 }
area = { disc = 0.2 }
maintenance = 0.8

[[room]]
name = "Lobby"

[[place]]
luminaire = "D"
field = { room = "Lobby", rows = 3, columns = 4, height = 3.599 }

[[area]]
name = "Floor"
surface = "Floor"
row = "9.1"

[[area]]
name = "Faces"
kind = "volume"
rect = { origin = [1, 1, 1.6], u = [7, 0, 0], v = [0, 4, 0] }
quantities = ["E_cyl", "E_v@0", "E_v@90", "L@0,-30", "L@90,0"]

[[viewpoint]]
name = "Entrance"
eye = [0.8, 3, 1.6]
direction = [1, 0, 0]

[[viewpoint]]
name = "Desk"
eye = [6, 1, 1.2]
direction = [0, 1, 0]

[norm]
standard = "en-12464-1-2021"
row = "9.1"
"#;

/// One quantity solved twice.
struct Row {
    scene: &'static str,
    value: Value,
    full: Interval,
    diffuse: Interval,
}

impl Row {
    /// Diffuse minus full, and half its interval.
    fn difference(&self) -> (f64, f64) {
        let se = self.full.se.hypot(self.diffuse.se);
        (self.diffuse.value - self.full.value, quantile(0.5 + 0.5 * CONFIDENCE, 2 * (BLOCKS - 1)) * se)
    }

    /// UGR differs in units, all else in shares.
    fn is_ugr(&self) -> bool {
        self.value.quantity.starts_with("UGR") || self.value.unit.is_empty()
    }

    /// The difference as it is told, and half its interval: percent, or units.
    fn told(&self) -> (f64, f64) {
        let (by, half) = self.difference();
        let unit = if self.is_ugr() { 1.0 } else { 0.01 * self.full.value.abs().max(1e-12) };
        (by / unit, half / unit)
    }
}

/// Mean albedo under even light from all sides, 2 ∫ ρ(μ) μ dμ: what a diffuse twin must reflect.
fn mean_albedo(bsdf: &Bsdf) -> f64 {
    const STEPS: u32 = 400;
    let at = |k: u32| (f64::from(k) + 0.5) / f64::from(STEPS);
    (0..STEPS).map(|k| 2.0 * bsdf.albedo(at(k)) * at(k) / f64::from(STEPS)).sum()
}

/// Every glossy and mirroring material becomes a diffuse one; clear glass stays, since light passes it.
fn make_diffuse(project: &mut Project) -> Vec<(String, f64)> {
    let mut replaced = Vec::new();
    for world in &mut project.worlds {
        for material in &mut world.scene.materials {
            if matches!(material.bsdf, Bsdf::Glossy { .. } | Bsdf::Mirror { .. }) {
                let reflectance = mean_albedo(&material.bsdf);
                material.bsdf = Bsdf::Lambert { reflectance };
                replaced.push((material.name.clone(), reflectance));
            }
        }
    }
    replaced
}

fn loaded(folder: &str, seed: u64) -> Result<Project, Box<dyn Error>> {
    let mut project = load(Path::new(folder), &LoadOptions::default())
        .map_err(|mistakes| mistakes.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))?;
    project.accuracy.seed = seed;
    Ok(project)
}

fn solved(project: &Project) -> Result<Outcome, Box<dyn Error>> {
    let never = AtomicBool::new(false);
    let watch = Watch { progress: &|_| {}, interrupted: &never };
    let settings = Settings { exact_blocks: Some(vec![BLOCKS]), ..Settings::default() };
    Ok(run(project, &settings, &watch)?)
}

fn main() -> Result<(), Box<dyn Error>> {
    std::fs::create_dir_all(format!("{FOLDER}/lobby"))?;
    std::fs::write(format!("{FOLDER}/lobby/project.toml"), LOBBY)?;
    let (mut rows, mut verdicts, mut twins) = (Vec::new(), Vec::new(), Vec::new());
    for (scene, folder) in SCENES {
        let full = solved(&loaded(folder, SEEDS[0])?)?;
        let mut project = loaded(folder, SEEDS[1])?;
        for (material, albedo) in make_diffuse(&mut project) {
            twins.push((scene, material, albedo));
        }
        let diffuse = solved(&project)?;
        let same = |a: &Value, b: &Value| {
            (&a.room, &a.subject, &a.light_scene, &a.quantity, &a.statistic)
                == (&b.room, &b.subject, &b.light_scene, &b.quantity, &b.statistic)
        };
        for value in &full.values {
            let twin = diffuse.values.iter().find(|other| same(value, other));
            if let (Ok(full), Some(Ok(diffuse))) = (&value.estimate, twin.map(|twin| twin.estimate.as_ref()))
            {
                rows.push(Row { scene, value: value.clone(), full: *full, diffuse: *diffuse });
            }
        }
        for (a, b) in full.requirements.iter().zip(&diffuse.requirements) {
            let what = format!("{} {:?} {:?}", a.subject, a.quantity, a.statistic);
            verdicts.push([
                scene.to_owned(),
                a.light_scene.clone(),
                what,
                format!("{:?}", a.verdict),
                format!("{:?}", b.verdict),
            ]);
        }
        println!("{scene}: {} values", rows.iter().filter(|row| row.scene == scene).count());
    }
    std::fs::write(format!("{FOLDER}/values.csv"), values_csv(&rows)?)?;
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(["scene", "light_scene", "requirement", "full", "diffuse"])?;
    for verdict in &verdicts {
        writer.write_record(verdict)?;
    }
    std::fs::write(format!("{FOLDER}/verdicts.csv"), writer.into_inner()?)?;
    std::fs::write(format!("{FOLDER}/differences.svg"), drawn(&rows))?;
    std::fs::write(format!("{FOLDER}/README.md"), page(&rows, &verdicts, &twins))?;
    Ok(())
}

fn values_csv(rows: &[Row]) -> Result<Vec<u8>, Box<dyn Error>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record([
        "scene",
        "room",
        "subject",
        "light_scene",
        "quantity",
        "statistic",
        "unit",
        "full",
        "full_se",
        "diffuse",
        "diffuse_se",
        "difference",
        "difference_half",
    ])?;
    for row in rows {
        let value = &row.value;
        let (by, half) = row.difference();
        let words = [
            row.scene,
            &value.room,
            &value.subject,
            &value.light_scene,
            &value.quantity,
            &value.statistic,
            &value.unit,
        ];
        let numbers =
            [row.full.value, row.full.se, row.diffuse.value, row.diffuse.se, by, half].map(|n| n.to_string());
        writer.write_record(words.into_iter().map(str::to_owned).chain(numbers))?;
    }
    Ok(writer.into_inner()?)
}

/// Each quantity by its rank, in percent; UGR is left to the table.
fn drawn(rows: &[Row]) -> String {
    let series: Vec<Series> = SCENES
        .iter()
        .map(|(scene, _)| {
            let mut points: Vec<(f64, f64)> =
                rows.iter().filter(|row| row.scene == *scene && !row.is_ugr()).map(Row::told).collect();
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            let last = points.len().saturating_sub(1).max(1) as f64;
            let at = |(k, (by, half)): (usize, (f64, f64))| [100.0 * k as f64 / last, by, half];
            Series {
                name: (*scene).to_owned(),
                points: points.into_iter().enumerate().map(at).collect(),
                line: false,
            }
        })
        .collect();
    let figure = Figure {
        title: "Diffuse-only against full, every quantity of the reports",
        axes: ["rank, %", "difference, %"],
        log: [false, false],
        series: &series,
    };
    figure.svg()
}

fn page(rows: &[Row], verdicts: &[[String; 5]], twins: &[(&str, String, f64)]) -> String {
    let mut page = String::from(WORDS);
    page.push_str(
        "\n## Replaced materials\n\n| scene | material | diffuse twin's reflectance |\n|---|---|---|\n",
    );
    for (scene, material, albedo) in twins {
        let _ = writeln!(page, "| {scene} | {material} | {albedo:.4} |");
    }
    page.push_str("\n## What changes\n\nLargest differences first, diffuse-only minus full, with half of the 95 % interval.\n");
    for (scene, _) in SCENES {
        let of_scene: Vec<&Row> = rows.iter().filter(|row| row.scene == scene).collect();
        let clear = of_scene.iter().filter(|row| row.told().0.abs() > row.told().1).count();
        let _ = write!(
            page,
            "\n### {scene}\n\n{clear} of {} values differ by more than their interval.\n\n| what | full | diffuse-only | difference |\n|---|---|---|---|\n",
            of_scene.len()
        );
        let mut shown = of_scene;
        shown.sort_by(|a, b| b.told().0.abs().total_cmp(&a.told().0.abs()));
        for row in shown.into_iter().filter(|row| row.full.value.abs() > 0.0).take(14) {
            let (value, (by, half)) = (&row.value, row.told());
            let unit = if row.is_ugr() { "" } else { " %" };
            let _ = writeln!(
                page,
                "| {} {} {} {} | {:.4} {u} | {:.4} {u} | {by:+.2} ± {half:.2}{unit} |",
                value.light_scene,
                value.subject,
                value.quantity,
                value.statistic,
                row.full.value,
                row.diffuse.value,
                u = value.unit
            );
        }
    }
    let changed: Vec<&[String; 5]> = verdicts.iter().filter(|verdict| verdict[3] != verdict[4]).collect();
    let _ = write!(
        page,
        "\n## Verdicts\n\n{} of {} requirements get another verdict.\n\n",
        changed.len(),
        verdicts.len()
    );
    if !changed.is_empty() {
        page.push_str("| scene | light scene | requirement | full | diffuse-only |\n|---|---|---|---|---|\n");
        for [scene, light_scene, what, full, diffuse] in changed {
            let _ = writeln!(page, "| {scene} | {light_scene} | {what} | {full} | {diffuse} |");
        }
    }
    page
}

const WORDS: &str = include_str!("thesis_words.md");
