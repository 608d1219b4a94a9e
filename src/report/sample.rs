//! Outcomes for tests: names that break naive writers, undefined values, an L-shaped area with
//! points left out, two light scenes, a wall, listed points.

use glam::{DVec2, DVec3};

use crate::grid::{Exclusion, Grid, GridPoint};
use crate::outcome::*;
use crate::photometry::IntensityDistribution;
use crate::project::{AreaKind, Compare, Info, InputFile};
use crate::quantity::{Quantity, Statistic};

use crate::units::{Lumens, Undefined};

/// A name of a task area that must be escaped everywhere.
pub const NASTY: &str = "Desk <&\"'; a/b\\c, стол №1";

fn interval(value: f64) -> Interval {
    let se = 0.004 * value.abs();
    Interval { value, se, lo: value - 1.96 * se, hi: value + 1.96 * se }
}

fn point(value: f64) -> PointValue {
    let Interval { value, se, lo, hi } = interval(value);
    PointValue { value, se, lo, hi, direct: 0.7 * value, indirect: 0.3 * value }
}

fn grid(origin: DVec3, edge_u: DVec3, edge_v: DVec3, [columns, rows]: [usize; 2], border_m: f64) -> Grid {
    let (u, v) = (edge_u.normalize(), edge_v.normalize());
    let spacing_m = [
        (edge_u.length() - 2.0 * border_m) / columns as f64,
        (edge_v.length() - 2.0 * border_m) / rows as f64,
    ];
    let normal = u.cross(v);
    let place = |row: usize, column: usize| {
        origin
            + u * (border_m + (column as f64 + 0.5) * spacing_m[0])
            + v * (border_m + (row as f64 + 0.5) * spacing_m[1])
    };
    let points = (0..rows)
        .flat_map(|row| (0..columns).map(move |column| (row, column)))
        .map(|(row, column)| GridPoint { row, column, position: place(row, column), normal, excluded: None })
        .collect();
    let outline = vec![origin, origin + edge_u, origin + edge_u + edge_v, origin + edge_v];
    Grid { origin, edge_u, edge_v, normal, columns, rows, spacing_m, border_m, points, outline }
}

fn field(grid: &Grid, light_scene: &str, quantity: Quantity, value: impl Fn(DVec3) -> f64) -> PointField {
    let at = |place: &GridPoint| place.excluded.is_none().then(|| point(value(place.position)));
    PointField {
        light_scene: light_scene.into(),
        quantity,
        condition: crate::outcome::Condition::MAINTAINED,
        n: 64,
        points: grid.points.iter().map(at).collect(),
    }
}

/// A smooth illuminance under two rows of luminaires.
fn lit(at: DVec3) -> f64 {
    let lamps = [(2.0, 1.25), (4.0, 1.25), (6.0, 1.25), (2.0, 3.75), (4.0, 3.75), (6.0, 3.75)];
    let one = |(x, y): (f64, f64)| 430.0 / (1.0 + 0.45 * ((at.x - x).powi(2) + (at.y - y).powi(2))).powf(1.5);
    110.0 + lamps.into_iter().map(one).sum::<f64>()
}

fn l_shaped() -> AreaOutcome {
    let mut grid = grid(DVec3::new(0.0, 0.0, 0.8), DVec3::X * 8.0, DVec3::Y * 5.0, [16, 10], 0.0);
    grid.outline = [(0.0, 0.0), (8.0, 0.0), (8.0, 3.0), (5.0, 3.0), (5.0, 5.0), (0.0, 5.0)]
        .map(|(x, y)| DVec3::new(x, y, 0.8))
        .to_vec();
    for point in &mut grid.points {
        let at = point.position;
        point.excluded = if at.x > 5.0 && at.y > 3.0 {
            Some(Exclusion::OutsideArea)
        } else if at.x < 1.0 && at.y < 1.5 {
            Some(Exclusion::InsideFurniture)
        } else {
            None
        };
    }
    let fields = vec![
        field(&grid, "full", Quantity::Horizontal, lit),
        field(&grid, "половина / half", Quantity::Horizontal, |at| {
            0.45 * lit(at) * (0.2 + at.x / 8.0)
        }),
        field(&grid, "full", Quantity::Cylindrical, |at| 0.35 * lit(at)),
    ];
    AreaOutcome { name: NASTY.into(), kind: AreaKind::Task, of: None, row: Some("34.2".into()), grid, fields }
}

fn wall() -> AreaOutcome {
    // u × v points south, into the room.
    let grid = grid(DVec3::new(0.0, 5.0, 0.0), DVec3::X * 8.0, DVec3::Z * 2.8, [12, 5], 0.0);
    let fields = vec![field(&grid, "full", Quantity::Normal, |at| {
        30.0 + 95.0 * (at.z / 2.8) * (1.0 + 0.4 * (at.x * 1.6).sin())
    })];
    AreaOutcome { name: "Wall_N".into(), kind: AreaKind::Surface, of: None, row: None, grid, fields }
}

fn listed() -> AreaOutcome {
    let places = [(1.0, 0.5), (2.5, 1.0), (6.0, 0.8), (9.0, 1.2)];
    let points: Vec<GridPoint> = places
        .iter()
        .enumerate()
        .map(|(column, (x, y))| GridPoint {
            row: 0,
            column,
            position: DVec3::new(20.0 + x, *y, 0.1),
            normal: DVec3::Z,
            excluded: None,
        })
        .collect();
    let grid = Grid {
        origin: DVec3::new(20.0, 0.0, 0.1),
        edge_u: DVec3::ZERO,
        edge_v: DVec3::ZERO,
        normal: DVec3::Z,
        columns: 0,
        rows: 0,
        spacing_m: [0.0, 0.0],
        border_m: 0.0,
        points,
        outline: Vec::new(),
    };
    let fields = vec![field(&grid, "full", Quantity::Horizontal, |at| 2.0 * at.x - 34.0)];
    AreaOutcome {
        name: "Ось прохода".into(), kind: AreaKind::Task, of: None, row: None, grid, fields
    }
}

fn luminaires() -> Vec<LuminaireOutcome> {
    let mut luminaires = Vec::new();
    for row in 0..2_u32 {
        for column in 0..3_u32 {
            let position = DVec3::new(2.0 + 2.0 * f64::from(column), 1.25 + 2.5 * f64::from(row), 2.8);
            let corner = |x: f64, y: f64| position + DVec3::new(x, y, 0.0);
            luminaires.push(LuminaireOutcome {
                kind: if row == 0 { "A".into() } else { "B&".into() },
                group: format!("row-{}", row + 1),
                position,
                outline: vec![corner(-0.6, -0.15), corner(0.6, -0.15), corner(0.6, 0.15), corner(-0.6, 0.15)],
                c0: -DVec3::Y,
                aim: -DVec3::Z,
            });
        }
    }
    luminaires
}

fn viewpoint(name: &str, ugr: Result<Interval, Undefined>) -> ViewpointOutcome {
    let source = |i: u32| GlareSourceOutcome {
        label: format!("A @ row-{} #{}", 1 + i % 2, 1 + i / 2),
        luminance_cd_m2: 4210.0 / f64::from(i + 1),
        solid_angle_sr: 0.0123 / f64::from(i + 1),
        position_index: 1.5 + f64::from(i),
        visible_fraction: if i == 2 { 0.61 } else { 1.0 },
        share: [0.48, 0.22, 0.12, 0.08, 0.05, 0.03, 0.02][i as usize],
    };
    ViewpointOutcome {
        name: name.into(),
        light_scene: "full".into(),
        eye: DVec3::new(0.5, 2.5, 1.2),
        direction: DVec3::X,
        azimuth_deg: 0.0,
        tilt_deg: -5.0,
        sources: if ugr.is_ok() { (0..7).map(source).collect() } else { Vec::new() },
        ugr,
        indices: vec![
            crate::outcome::IndexOutcome {
                key: "DGP".into(),
                name: "daylight glare probability".into(),
                unit: "1".into(),
                estimate: Ok(Interval { value: 0.31, se: 0.002, lo: 0.306, hi: 0.314 }),
                notes: vec!["E_v 312 lx is below the 380 lx from which on DGP holds".into()],
            },
            crate::outcome::IndexOutcome {
                key: "VCP".into(),
                name: "visual comfort probability".into(),
                unit: "%".into(),
                estimate: Err(Undefined::because("the mean luminance of the field of view is not known")),
                notes: Vec::new(),
            },
        ],
        convention: "one source per luminaire, ω-weighted mean luminance, CIE 117 position table".into(),
        background_cd_m2: 38.123456789,
        e_v_lx: 311.5,
        notes: vec!["ω of 2 sources lies outside 0.0003…0.1 sr".into()],
        card: Some(card()),
    }
}

/// Seven sources in a row; the picture is grey, darker below.
fn card() -> crate::outcome::Card {
    use crate::outcome::{PlacedSource, Remedy, Shift};
    let placed = |i: u32| {
        let x = 0.1 + 0.1 * f64::from(i);
        PlacedSource {
            centre: [x, 0.3],
            outline: vec![[x - 0.03, 0.28], [x + 0.03, 0.28], [x + 0.03, 0.32], [x - 0.03, 0.32]],
        }
    };
    let luminances = (0..16).map(|pixel| 80.0 / f64::from(1 + pixel / 4)).collect();
    crate::outcome::Card {
        picture: crate::image::LuminanceImage::new(4, 4, None, luminances),
        sources: (0..7).map(placed).collect(),
        dimmed: Some(Remedy { luminaire: "A @ row-1 #1".into(), ugr: 16.2, shift: None, mirror: None }),
        moved: Some(Remedy {
            luminaire: "A @ row-1 #1".into(),
            ugr: 17.3,
            shift: Some(Shift::Left),
            mirror: None,
        }),
    }
}

fn balance(light_scene: &str, emitted_lm: f64) -> FluxBalance {
    let surface = |surface: &str, area_m2: f64, share: f64, reflectance: f64| SurfaceFlux {
        surface: surface.into(),
        area_m2,
        incident: interval(share * emitted_lm),
        leaving: interval(share * reflectance * emitted_lm),
    };
    FluxBalance {
        light_scene: light_scene.into(),
        emitted_lm,
        absorbed: interval(0.9987 * emitted_lm),
        escaped: interval(0.0011 * emitted_lm),
        residual_share: Interval { value: 0.0002, se: 0.0004, lo: -0.0006, hi: 0.001 },
        utilisation: Some(interval(0.71)),
        surfaces: vec![
            surface("Floor", 40.0, 0.78, 0.2),
            surface("Ceiling", 40.0, 0.31, 0.7),
            surface("Wall <N> & Ко", 22.4, 0.14, 0.5),
        ],
    }
}

fn office() -> RoomOutcome {
    let kind = |name: &str, description: &str, power_w| TypeOutcome {
        distribution: IntensityDistribution::lambert(Lumens(3900.0)),
        name: name.into(),
        description: description.into(),
        file: format!("photometry/{name}.ldt"),
        count: 3,
        flux_lm: 4215.3,
        rated_flux_lm: Some(4200.0),
        power_w,
        maintenance_factor: 0.8,
        maintenance: [0.95, 1.0, 0.9, 0.94],
    };
    let rectangle = |x: f64, y: f64, w: f64, h: f64| {
        vec![DVec2::new(x, y), DVec2::new(x + w, y), DVec2::new(x + w, y + h), DVec2::new(x, y + h)]
    };
    RoomOutcome {
        name: "Office <R&D> \"Кабинет\"".into(),
        number: "2.01".into(),
        footprint: rectangle(0.0, 0.0, 8.0, 5.0),
        floor_m: 0.0,
        height_m: 2.8,
        row: Some("34.2".into()),
        reflectances: [0.7, 0.5, 0.2],
        areas: vec![l_shaped(), wall()],
        viewpoints: vec![
            viewpoint("Observer 1", Ok(Interval { value: 18.43, se: 0.05, lo: 18.33, hi: 18.53 })),
            viewpoint("Наблюдатель 2", Err(Undefined::because("no source is visible"))),
        ],
        luminaires: luminaires(),
        types: vec![
            kind("A", "Panel 1200×300, <micro-prism> & co", Some(31.5)),
            kind("B&", "Светильник линейный 31 Вт", None),
        ],
        furniture: vec![
            rectangle(0.0, 0.0, 1.0, 1.5),
            rectangle(3.0, 1.8, 1.6, 0.8),
            rectangle(4.6, 1.8, 1.6, 0.8),
        ],
        flux: vec![balance("full", 25_291.8), balance("половина / half", 12_645.9)],
        power: Some(Power {
            installed_w: 240.0,
            area_m2: 40.0,
            density_w_m2: 6.0,
            mean_lx: Some(520.0),
            density_w_m2_100lx: Some(6.0 / 5.2),
            light_scene: "full".into(),
            scene_w: 240.0,
        }),
        dimming: Some(Dimming {
            factor: 0.96,
            subject: NASTY.into(),
            quantity: "E_h".into(),
            groups: Some(GroupDimming {
                share: 0.81,
                of: "power".into(),
                groups: vec![GroupFactor { group: NASTY.into(), factor: 0.75 }],
            }),
            others_pass: false,
        }),
        ugr_table: vec![
            UgrTableOutcome {
                kind: "A".into(),
                shr: 0.25,
                crosswise: Ok(18.2),
                endwise: Ok(17.4),
                notes: vec!["room index clamped to 2H × 2H".into()],
            },
            UgrTableOutcome {
                kind: "B&".into(),
                shr: 0.25,
                crosswise: Err(Undefined::because("table not applicable: asymmetric luminaire")),
                endwise: Err(Undefined::because("table not applicable: asymmetric luminaire")),
                notes: Vec::new(),
            },
        ],
    }
}

fn corridor() -> RoomOutcome {
    RoomOutcome {
        name: "Коридор / Corridor".into(),
        number: String::new(),
        footprint: [(20.0, 0.0), (30.0, 0.0), (30.0, 1.8), (20.0, 1.8)].map(DVec2::from).to_vec(),
        floor_m: 0.0,
        height_m: 3.0,
        row: Some("9.1".into()),
        reflectances: [0.7, 0.5, 0.3],
        areas: vec![listed()],
        viewpoints: Vec::new(),
        luminaires: Vec::new(),
        types: Vec::new(),
        furniture: Vec::new(),
        flux: Vec::new(),
        ugr_table: Vec::new(),
        power: None,
        dimming: None,
    }
}

fn requirement(
    quantity: Quantity,
    statistic: Statistic,
    bound: Bound,
    value: f64,
    verdict: Verdict,
) -> Requirement {
    let margin = match bound {
        Bound::Min(limit) if quantity != Quantity::Ugr => value / limit - 1.0,
        Bound::Max(limit) if quantity != Quantity::Ugr => 1.0 - value / limit,
        Bound::Min(limit) => value - limit,
        Bound::Max(limit) => limit - value,
    };
    Requirement {
        standard: "en-12464-1-2021".into(),
        clause: "34.2".into(),
        room: office().name,
        subject: NASTY.into(),
        light_scene: "full".into(),
        quantity,
        statistic,
        bound,
        value: Ok(value),
        lo_joint: 0.985 * value,
        hi_joint: 1.015 * value,
        margin: Some(margin),
        verdict,
        at_the_limit: false,
        other_comparison: None,
        blocks_needed: None,
        modified: None,
        verified: "two-sources".into(),
        note: String::new(),
        at_risk: Vec::new(),
    }
}

/// UGR by table, and of an observer who sees no source.
fn glare_requirements() -> [Requirement; 2] {
    use Bound::Max;
    let mut undefined = requirement(Quantity::Ugr, Statistic::Value, Max(19.0), 0.0, Verdict::Undefined);
    undefined.value = Err(Undefined::because("no source is visible"));
    (undefined.lo_joint, undefined.hi_joint, undefined.margin) = (f64::NAN, f64::NAN, None);
    let mut table =
        on(requirement(Quantity::Ugr, Statistic::Value, Max(19.0), 18.2, Verdict::Pass), &office().name);
    (table.lo_joint, table.hi_joint) = (f64::NAN, f64::NAN);
    table.note = "table method, SHR 0.25".into();
    table.at_risk = vec!["the luminaires' sides are not in the file: up to 0.4 UGR".into()];
    [table, undefined]
}

fn on(mut requirement: Requirement, subject: &str) -> Requirement {
    requirement.subject = subject.into();
    requirement
}

fn requirements() -> Vec<Requirement> {
    use Bound::Min;
    let [table, undefined] = glare_requirements();
    let mut limit = requirement(Quantity::Cylindrical, Statistic::Mean, Min(150.0), 149.8, Verdict::Fail);
    limit.at_the_limit = true;
    limit.verified = "unverified".into();
    limit.other_comparison = Some(Verdict::Pass);
    let mut colour =
        on(requirement(Quantity::ColourRendering, Statistic::Value, Min(80.0), 82.0, Verdict::Declared), "A");
    colour.margin = None;
    let mut missing = requirement(Quantity::Modelling, Statistic::Mean, Min(0.3), 0.0, Verdict::NotAssessed);
    missing.value = Err(Undefined::because("the norm's row has no limit"));
    missing.margin = None;
    let mut own = requirement(Quantity::Horizontal, Statistic::Min, Min(80.0), 91.2, Verdict::Pass);
    (own.standard, own.clause, own.light_scene) = ("project".into(), String::new(), "половина / half".into());
    own.verified = "project".into();
    let mut passage =
        on(requirement(Quantity::Horizontal, Statistic::Mean, Min(18.0), 13.4, Verdict::Fail), "Ось прохода");
    passage.room = corridor().name;
    passage.clause = "9.1".into();
    vec![
        requirement(Quantity::Horizontal, Statistic::Mean, Min(500.0), 599.4, Verdict::Pass),
        requirement(Quantity::Horizontal, Statistic::U0, Min(0.6), 0.6049, Verdict::Undecided),
        limit,
        on(requirement(Quantity::Normal, Statistic::Mean, Min(75.0), 82.7, Verdict::Pass), "Wall_N"),
        table,
        undefined,
        colour,
        missing,
        own,
        passage,
    ]
}

fn values() -> Vec<Value> {
    let value = |statistic: &str, estimate, location| Value {
        room: office().name,
        subject: NASTY.into(),
        light_scene: "full".into(),
        quantity: "E_h".into(),
        statistic: statistic.into(),
        location,
        unit: "lx".into(),
        estimate,
        n: 64,
    };
    vec![
        value("mean", Ok(interval(599.400_000_000_001)), None),
        value("min", Ok(interval(1.0 / 3.0 + 259.5)), Some(DVec3::new(0.25, 4.75, 0.8))),
        value("Ud", Err(Undefined::because("E_max is 0")), None),
    ]
}

/// An outcome that holds every case a report must cope with.
pub fn outcome() -> Outcome {
    Outcome {
        info: Info {
            name: "Реконструкция <корпус 2> & \"Tower\"".into(),
            client: "ООО «Свет & Ко»".into(),
            revision: "B".into(),
            date: "2026-03-01".into(),
            language: vec!["ru".into(), "en".into()],
        },
        rooms: vec![office(), corridor()],
        norm: Some(NormOutcome {
            id: "en-12464-1-2021".into(),
            short: "EN 12464-1:2021".into(),
            title: "Light and lighting - Part 1: Indoor work places".into(),
            edition: "2021".into(),
            compare: Compare::Exact,
        }),
        values: values(),
        requirements: requirements(),
        solver: Solver {
            method: "links".into(),
            blocks: 64,
            blocks_by_world: vec![64, 32],
            stopped: "block limit".into(),
            seed: 1,
            confidence: 0.95,
            triangles: 1234,
            luminaires: 6,
            lost_rays: 3,
            rays: 12_345_678,
        },
        plan: vec![
            "a field is stored: interreflection is asked for".into(),
            "no surface stores angles: all are diffuse".into(),
        ],
        biases: vec![Bias {
            what: "paths are cut after 24 reflections".into(),
            effect: "below 0.01 % of every value".into(),
            share: Some(1e-4),
        }],
        inputs: vec![InputFile { path: "photometry/A & B.ldt".into(), sha256: "ab".repeat(32) }],
    }
}

/// The office a hundred times; every tenth fails one requirement.
pub fn hundred_rooms() -> Outcome {
    let mut outcome = outcome();
    (outcome.rooms, outcome.requirements, outcome.values) = (Vec::new(), Vec::new(), Vec::new());
    for number in 1..=100 {
        let mut room = office();
        room.name = format!("Office {number}");
        room.number = format!("3.{number:02}");
        room.viewpoints.truncate(1);
        for mut requirement in requirements().into_iter().take(5) {
            let fails = number % 10 == 0 && requirement.statistic == Statistic::U0;
            requirement.verdict = if fails { Verdict::Fail } else { Verdict::Pass };
            requirement.room.clone_from(&room.name);
            if requirement.quantity == Quantity::Ugr {
                requirement.subject.clone_from(&room.name);
            }
            outcome.requirements.push(requirement);
        }
        outcome.rooms.push(room);
    }
    outcome
}
