//! Every method against what is known exactly or to many digits: Sobolev's problem, the integrating
//! sphere up to a reflectance of 0.999, two box rooms. Writes a table and CSV to reports/oracles:
//!
//!     cargo run --release --example oracles
//!
//! With words, only the cases and methods whose names contain one of them each are run and printed:
//!
//!     cargo run --release --example oracles plates links
#![allow(clippy::print_stdout, reason = "a study prints")]

#[path = "../tests/common/mod.rs"]
mod common;
#[path = "../tests/plates/mod.rs"]
mod plates;
#[path = "../tests/sphere/mod.rs"]
mod sphere;

use std::error::Error;
use std::fmt::Write as _;

use common::{cpu_seconds, lambert, planar, point_lamp, room, row};
use gershun::estimate::Estimate;
use gershun::query::{Demand, Receiver};
use gershun::scene::Scene;
use gershun::solve::{Effort, LocalEffort, Method, answer, prepare};
use glam::DVec3;
use plates::{Plates, place};
use rayon::prelude::*;
use sphere::Sphere;

/// Standard error at which a case counts as resolved.
const RESOLVED: f64 = 0.003;

struct Case {
    name: String,
    scene: Scene,
    receivers: Vec<(Receiver, f64)>,
    places: Vec<String>,
    /// Relative error of the expected values.
    truth: f64,
    /// Most blocks of links, local and path.
    most: [u64; 3],
    chains: u32,
    /// Walks of links in a block, and its patches.
    walks: u32,
    patch_m2: Option<f64>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut csv = String::from("case,place,method,blocks,expected_lx,value_lx,se_lx,z\n");
    let mut table = String::new();
    let asked: Vec<String> = std::env::args().skip(1).collect();
    let wanted =
        |number: usize, name: &str| asked.get(number).is_none_or(|word| name.contains(word.as_str()));
    for case in cases().into_iter().filter(|case| wanted(0, &case.name)) {
        let demand = Demand {
            receivers: case.receivers.iter().map(|(receiver, _)| receiver.clone()).collect(),
            ..Demand::default()
        };
        let local =
            LocalEffort { chains: case.chains, connections: 64.0, returns: 16, ..LocalEffort::default() };
        let efforts = [
            (
                "links",
                Method::Links,
                Effort { gather: 64, walks: case.walks, patch_m2: case.patch_m2, ..Effort::default() },
            ),
            ("local", Method::Local, Effort { local, ..Effort::default() }),
            ("path", Method::Path, Effort { paths: 64, ..Effort::default() }),
        ];
        for ((name, method, effort), most) in efforts.into_iter().zip(case.most) {
            if !wanted(1, name) {
                continue;
            }
            let before = cpu_seconds();
            let prepared = prepare(&case.scene, &demand, method, effort, 1);
            let (mut sheets, mut target) = (Vec::new(), 64);
            // Blocks grow until every place is resolved: the number depends on nothing but the values.
            let estimates: Vec<Estimate> = loop {
                let first = sheets.len() as u64;
                sheets.par_extend((first..target).into_par_iter().map(|block| answer(&prepared, block)));
                let of = |index| Estimate::from_blocks(&row(&sheets, index, 1));
                let estimates: Vec<Estimate> = (0..demand.rows()).map(of).collect();
                let resolved = estimates.iter().all(|e| e.se <= RESOLVED * e.value);
                if resolved || target >= most {
                    break estimates;
                }
                // As many as the error asks for, and no more than twice those before.
                let lacking =
                    estimates.iter().map(|e| (e.se / (RESOLVED * e.value)).powi(2)).fold(1.0, f64::max);
                let wanted = (target as f64 * (1.05 * lacking).clamp(1.1, 2.0)).ceil() as u64;
                target = wanted.next_multiple_of(16).min(most);
            };
            let (mut worst, mut largest, mut se) = (0f64, 0f64, 0f64);
            for ((estimate, (_, expected)), place) in estimates.iter().zip(&case.receivers).zip(&case.places)
            {
                let z = (estimate.value - expected) / estimate.se.hypot(case.truth * expected);
                worst = worst.max(z.abs());
                largest = largest.max((estimate.value / expected - 1.0).abs());
                se = se.max(estimate.se / expected);
                writeln!(
                    csv,
                    "\"{}\",{place},{name},{target},{expected},{},{},{z:.3}",
                    case.name, estimate.value, estimate.se
                )?;
            }
            let line = format!(
                "| {} | {} | {name} | {worst:.2} | {:.2} % | {:.2} %{} | {:.1} s |",
                case.name,
                case.places.len(),
                100.0 * largest,
                100.0 * se,
                if se <= RESOLVED { "" } else { " (not resolved)" },
                cpu_seconds() - before
            );
            println!("{line}");
            writeln!(table, "{line}")?;
        }
    }
    if !asked.is_empty() {
        return Ok(());
    }
    let text = format!(
        "# Methods against oracles\n\nSobolev's problem is exact by Hankel's transform (`tests/plates`; discs of radius 30 h, 120 h at ρ = 0.99, 500 h in patches of 50 h² at 0.999), the sphere is a polyhedron of 5 120 triangles with the sphere's area, the box rooms are known to 1e-6 … 4e-5 from a converged radiosity solution. Blocks grow, to twice as many at most, until the largest standard error is at most {} %, or until a limit (then \"not resolved\"). Made by `cargo run --release --example oracles`; all values in [oracles.csv](oracles.csv). With three places or more, the largest of them exceeds 3 standard errors by chance in about 1 to 3 % of all lines.\n\n| case | places | method | largest difference, standard errors | largest difference | largest standard error | CPU |\n|---|---|---|---|---|---|---|\n{table}{}",
        100.0 * RESOLVED,
        include_str!("oracles_words.md")
    );
    std::fs::create_dir_all("reports/oracles")?;
    std::fs::write("reports/oracles/oracles.csv", csv)?;
    std::fs::write("reports/oracles/README.md", &text)?;
    Ok(())
}

fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for (source, rho, radius, chains, most) in [
        (0.5, [0.5, 0.5], 30.0, 64, [8192, 16_384, 8192]),
        (0.5, [0.8, 0.2], 30.0, 64, [8192, 16_384, 8192]),
        (0.01, [0.5, 0.5], 30.0, 64, [8192, 16_384, 8192]),
        (0.5, [0.99, 0.99], 120.0, 16, [16_384, 1024, 1024]),
        (0.5, [0.999, 0.999], 500.0, 4, [16_384, 256, 256]),
    ] {
        let plates = Plates { source, rho };
        let distances = [0.0, 0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 5.0];
        let of = |r: f64| (planar(place(r), DVec3::Z), plates.exact(place(r).length()));
        cases.push(Case {
            name: format!("plates, ρ {} / {}, a = {source} h", rho[0], rho[1]),
            scene: plates.scene(radius),
            receivers: distances.map(of).to_vec(),
            places: distances.map(|r| format!("r={r}")).to_vec(),
            // Receivers on a surface are lifted by 1e-9 of the scene's size: with it E = 1/a² falls.
            truth: 2.0 * 1e-9 * 2.0 * radius / source,
            most,
            chains,
            walks: if rho[0] > 0.98 { 64 } else { 16 },
            patch_m2: (rho[0] > 0.995).then_some(50.0),
        });
    }
    for rho in [0.1, 0.5, 0.8, 0.9, 0.95, 0.99, 0.999] {
        let sphere = Sphere { rho, flux_lm: 1000.0 };
        let scene = sphere.scene();
        let receivers = sphere.receivers(&scene);
        let places = (1..=receivers.len()).map(|k| format!("triangle {k}")).collect();
        let most = if rho > 0.98 { [64, 256, 256] } else { [1024, 8192, 2048] };
        let chains = if rho > 0.98 { 16 } else { 64 };
        cases.push(Case {
            name: format!("sphere, ρ {rho}"),
            scene,
            receivers,
            places,
            truth: 1e-4,
            most,
            chains,
            walks: 16,
            patch_m2: None,
        });
    }
    cases.extend(rooms());
    cases
}

/// Two box rooms; total illuminance from a converged radiosity solution.
fn rooms() -> Vec<Case> {
    let a = DVec3::new(4.0, 3.0, 2.8);
    let rooms = [
        (
            "room 4 × 3 × 2.8 m",
            a,
            [0.2, 0.5, 0.7],
            point_lamp(1000.0, DVec3::new(2.0, 1.5, 2.0)),
            [40.855_501_69, 24.184_367_02, 16.532_860_18, 21.271_217_16, 32.353_483_98, 43.553_744_61],
        ),
        (
            "cube 4 m",
            DVec3::splat(4.0),
            [0.5; 3],
            point_lamp(10_000.0, DVec3::splat(2.0)),
            [310.982_414_85, 161.073_763_9, 112.949_947_23, 161.073_763_9, 270.574_590_65, 261.262_350_1],
        ),
    ];
    rooms
        .into_iter()
        .map(|(name, s, rho, lamp, expected)| {
            let materials =
                vec![lambert("floor", rho[0]), lambert("walls", rho[1]), lambert("ceiling", rho[2])];
            let receivers = [
                planar(DVec3::new(s.x / 2.0, s.y / 2.0, 0.0), DVec3::Z),
                planar(DVec3::new(0.5, 0.5, 0.0), DVec3::Z),
                planar(DVec3::new(0.05, 0.05, 0.0), DVec3::Z),
                planar(DVec3::new(0.5, 0.5, s.z), DVec3::NEG_Z),
                planar(DVec3::new(s.x, s.y / 2.0, 1.2), DVec3::NEG_X),
                planar(DVec3::new(1.0, 1.0, 0.75), DVec3::Z),
            ];
            let places = ["floor, middle", "floor, 0.5 m", "floor, 5 cm", "ceiling", "wall", "table"];
            Case {
                name: name.into(),
                scene: Scene::new(room(s), materials, vec![lamp]).expect("the scene is valid"),
                receivers: receivers.into_iter().zip(expected).collect(),
                places: places.map(|place| format!("\"{place}\"")).to_vec(),
                truth: 5e-5,
                most: [2048, 8192, 8192],
                chains: 64,
                walks: 16,
                patch_m2: None,
            }
        })
        .collect()
}
