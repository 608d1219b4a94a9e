//! How often a verdict near its limit is wrong: 1 000 seeds of a small room, each judged as `check` does,
//! looks included, on four quantities with a limit a little above the truth and one a little below, beside
//! the verdicts of a naive twin: the bare value after the first look against the limit. And how often the 95 % intervals of the same four contain the truth after a fixed number of blocks, U0's
//! among them, which is decided by contrasts. The truth is one long run with another seed. Writes CSV and
//! a table to reports/risk:
//!
//!     cargo run --release --example risk [SEEDS]
#![allow(clippy::print_stdout, reason = "a study prints")]

use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use gershun::grid::GridRule;
use gershun::outcome::{Interval, Outcome, Value, Verdict};
use gershun::project::{
    AreaKind, AreaShape, AreaSpec, CustomRequirement, CustomSubject, LoadOptions, Project, Task, Viewpoint,
    load,
};
use gershun::quantity::{Quantity, Statistic};
use gershun::solve::Effort;
use gershun::{Settings, Watch, run};
use glam::DVec3;

/// Blocks after which the coverage of intervals is counted, and the naive twin judges: those of the first look.
const COVERAGE_BLOCKS: usize = 32;
/// Blocks of the long run.
const TRUTH_BLOCKS: usize = 16_384;
/// Blocks at which a run gives up: looks after 32, 64, 128 and 256.
const MOST_BLOCKS: usize = 256;

/// What is judged: name, subject, quantity, statistic, and how far from the truth its limits lie, as a
/// share of it (UGR: in UGR). More than the indifference margin of 0.5 % and 0.1 UGR.
const JUDGED: [(&str, CustomSubject, Quantity, Statistic, f64); 4] = [
    ("Ē", CustomSubject::Area(0), Quantity::Horizontal, Statistic::Mean, 0.006),
    ("U0", CustomSubject::Area(0), Quantity::Horizontal, Statistic::U0, 0.015),
    ("E_cyl", CustomSubject::Area(0), Quantity::Cylindrical, Statistic::Mean, 0.008),
    ("UGR", CustomSubject::Viewpoint(0), Quantity::Ugr, Statistic::Value, 0.2),
];

fn main() -> Result<(), Box<dyn Error>> {
    let seeds: u64 = std::env::args().nth(1).map_or(Ok(1000), |text| text.parse())?;
    let mut project = small_room()?;
    let truth = truth(&mut project)?;
    let mut limits = Vec::new();
    let world = &mut project.worlds[0];
    world.requirements.clear();
    for (&(_, subject, quantity, statistic, distance), &value) in JUDGED.iter().zip(&truth) {
        let by = if quantity == Quantity::Ugr { distance } else { distance * value };
        for limit in [value - by, value + by] {
            limits.push(limit);
            world.requirements.push(CustomRequirement {
                subject,
                quantity,
                statistic,
                min: Some(limit),
                max: None,
                light_scene: None,
                instead: None,
            });
        }
    }
    let settings = Settings { most_blocks: MOST_BLOCKS, effort: effort(), ..Settings::default() };
    let fixed =
        Settings { exact_blocks: Some(vec![COVERAGE_BLOCKS]), effort: effort(), ..Settings::default() };
    let (mut counts, mut families) = (vec![[0usize; 3]; limits.len()], 0usize);
    let mut covered = vec![[0usize; 3]; JUDGED.len()];
    let (mut naive, mut naive_families) = (vec![0usize; limits.len()], 0usize);
    for seed in 1..=seeds {
        project.accuracy.seed = seed;
        let outcome = solve(&project, &fixed)?;
        let mut any_naive = false;
        for (number, ((judged, value), covered)) in JUDGED.iter().zip(&truth).zip(&mut covered).enumerate() {
            let interval = found(&outcome, judged)?;
            for (index, wrong) in [
                (2 * number, interval.value < limits[2 * number]),
                (2 * number + 1, interval.value >= limits[2 * number + 1]),
            ] {
                naive[index] += usize::from(wrong);
                any_naive |= wrong;
            }
            let side = if interval.hi < *value {
                1
            } else if interval.lo > *value {
                2
            } else {
                0
            };
            covered[side] += 1;
        }
        naive_families += usize::from(any_naive);
        let outcome = solve(&project, &settings)?;
        let mut any = false;
        for (index, requirement) in outcome.requirements.iter().enumerate() {
            // "At least": a limit below the truth is met, one above it is not.
            let right = if index % 2 == 0 { Verdict::Pass } else { Verdict::Fail };
            let column = match requirement.verdict {
                verdict if verdict == right => 0,
                Verdict::Pass | Verdict::Fail => 1,
                _ => 2,
            };
            counts[index][column] += 1;
            any |= column == 1;
        }
        families += usize::from(any);
    }
    let naive = (naive.as_slice(), naive_families);
    write(seeds, &truth, &limits, (&counts, families), naive, &covered, 1.0 - project.accuracy.confidence)
}

/// Less than the usual effort, so that limits beside the truth lie within the noise of a look; no flux is judged.
fn effort() -> Effort {
    Effort { gather: 4, walks: 1, particles: 16, ..Effort::default() }
}

/// The box of the example scenes with a plane, an observer, and no norm.
fn small_room() -> Result<Project, Box<dyn Error>> {
    let mut project =
        load(Path::new("scenes/box"), &LoadOptions::default()).map_err(|_| "scenes/box does not load")?;
    project.norm = None;
    let world = &mut project.worlds[0];
    world.areas = vec![AreaSpec {
        name: "Plane".into(),
        kind: AreaKind::Task,
        of: None,
        room: 0,
        row: None,
        modified: None,
        light_scene: None,
        shape: AreaShape::Rect { origin: DVec3::new(0.2, 0.2, 0.75), u: DVec3::X * 4.6, v: DVec3::Y * 3.6 },
        rule: GridRule::Count([4, 3]),
        border_m: 0.0,
        quantities: vec![Quantity::Horizontal, Quantity::Cylindrical],
        written: None,
    }];
    world.viewpoints = vec![Viewpoint {
        name: "Eye".into(),
        room: 0,
        eye: DVec3::new(0.6, 2.0, 1.2),
        directions: vec![DVec3::X],
        azimuths_deg: vec![0.0],
        indices: Vec::new(),
        light_scene: None,
        highlights: true,
        task: Task::default(),
        area: None,
        area_reflectance: None,
        given: gershun::glare::source::Given::default(),
        written: None,
    }];
    Ok(project)
}

fn solve(project: &Project, settings: &Settings) -> Result<Outcome, Box<dyn Error>> {
    let never = AtomicBool::new(false);
    Ok(run(project, settings, &Watch { progress: &|_| {}, interrupted: &never })?)
}

/// Values of one long run.
fn truth(project: &mut Project) -> Result<Vec<f64>, Box<dyn Error>> {
    project.accuracy.seed = u64::MAX;
    project.worlds[0].requirements.clear();
    let settings =
        Settings { exact_blocks: Some(vec![TRUTH_BLOCKS]), effort: effort(), ..Settings::default() };
    let outcome = solve(project, &settings)?;
    JUDGED.iter().map(|judged| Ok(found(&outcome, judged)?.value)).collect()
}

/// The interval of a judged quantity.
fn found(
    outcome: &Outcome,
    (name, _, quantity, statistic, _): &(&str, CustomSubject, Quantity, Statistic, f64),
) -> Result<Interval, Box<dyn Error>> {
    let (quantity, statistic) = (quantity.key(), statistic.key());
    let same = |value: &&Value| value.quantity == quantity && value.statistic == statistic;
    let found = outcome.values.iter().find(same).and_then(|value| value.estimate.as_ref().ok());
    found.copied().ok_or_else(|| format!("{name} has no value").into())
}

fn write(
    seeds: u64,
    truth: &[f64],
    limits: &[f64],
    (counts, families): (&[[usize; 3]], usize),
    (naive, naive_families): (&[usize], usize),
    covered: &[[usize; 3]],
    alpha: f64,
) -> Result<(), Box<dyn Error>> {
    let mut csv =
        "quantity,truth,limit_at_least,runs,right,wrong,undecided,wrong_by_the_bare_value\n".to_owned();
    let mut table = String::new();
    for (index, ((limit, [right, wrong, open]), bare)) in limits.iter().zip(counts).zip(naive).enumerate() {
        let (name, value) = (JUDGED[index / 2].0, truth[index / 2]);
        writeln!(csv, "{name},{value},{limit},{seeds},{right},{wrong},{open},{bare}")?;
        writeln!(table, "| {name} | {value:.3} | {limit:.3} | {right} | {wrong} | {open} | {bare} |")?;
    }
    let mut coverage = "quantity,truth,runs,blocks,covered,below,above\n".to_owned();
    let mut intervals = String::new();
    for ((judged, value), [inside, below, above]) in JUDGED.iter().zip(truth).zip(covered) {
        let (name, percent) = (judged.0, |count: &usize| 100.0 * *count as f64 / seeds as f64);
        writeln!(coverage, "{name},{value},{seeds},{COVERAGE_BLOCKS},{inside},{below},{above}")?;
        let shares = [inside, below, above].map(percent).map(|share| format!("{share:.1} %"));
        writeln!(intervals, "| {name} | {value:.3} | {} |", shares.join(" | "))?;
    }
    let expected = alpha * seeds as f64;
    let most = expected + 5.0 * (expected * (1.0 - alpha)).sqrt();
    let [share, naive_share] = [families, naive_families].map(|count| 100.0 * count as f64 / seeds as f64);
    let text = format!(
        "# Risk of a wrong verdict\n\n{seeds} seeds of a small room, each judged on eight limits just beside the truth, at most\n{MOST_BLOCKS} blocks, a look at every doubling from 32 on, 4 gather rays and a walk a block. Made by `cargo run --release --example risk {seeds}`.\n\n\
         | quantity | truth | limit, at least | right | wrong | undecided | wrong by the bare value after {COVERAGE_BLOCKS} blocks |\n|---|---|---|---|---|---|---|\n{table}\n\
         Runs with any wrong verdict: {families}, {share:.1} %; stated: at most {:.0} % for all verdicts of a room together. By bare values: {naive_families}, {naive_share:.1} %.\nAn undecided verdict is not a wrong one: it asks for more blocks.\n\n\
         ## Coverage\n\nHow often the {:.0} % interval of one quantity alone contains the truth after {COVERAGE_BLOCKS} blocks, lies below it, or above.\nU0's is made of the contrasts of all points, the upper end corrected for their number: it may cover more.\n\n\
         | quantity | truth | contains it | below | above |\n|---|---|---|---|---|\n{intervals}\n\
         The truth is one run of {TRUTH_BLOCKS} blocks. Illuminances in lx, maintained.\n",
        100.0 * alpha,
        100.0 - 100.0 * alpha,
    );
    let folder = Path::new("reports/risk");
    std::fs::create_dir_all(folder)?;
    std::fs::write(folder.join("risk.csv"), csv)?;
    std::fs::write(folder.join("coverage.csv"), coverage)?;
    std::fs::write(folder.join("README.md"), &text)?;
    println!("{text}");
    if (naive_families as f64) < most {
        return Err("limits lie beyond the noise: bare values are never wrong, and nothing is shown".into());
    }
    if families as f64 > most {
        return Err(format!("{families} runs with a wrong verdict, more than {most:.0}").into());
    }
    for ([inside, ..], (name, ..)) in covered.iter().zip(&JUDGED) {
        // 5 σ below the nominal share; only U0 may lie above.
        if (seeds as usize - inside) as f64 > most {
            return Err(
                format!("the interval of {name} contains the truth in {inside} of {seeds} runs").into()
            );
        }
    }
    Ok(())
}
