//! Glare of solved scenes against closed forms: luminous surfaces as sources, what is background and
//! what is not, every index of a viewpoint, and conventions that converge.

mod projects;

use std::f64::consts::PI;

use gershun::glare::position_index::{Position, PositionModel};
use gershun::measure::glare_sources::{Convention, SourceModel};
use gershun::observe::map::maps;
use gershun::observe::{CONVENTIONS, observe};
use gershun::outcome::{Outcome, ViewpointOutcome};
use gershun::project::{LoadOptions, load};
use gershun::solve::Effort;
use glam::DVec3;
use projects::{folder, gltf, run, shell};

fn view(outcome: &Outcome) -> &ViewpointOutcome {
    &outcome.rooms[0].viewpoints[0]
}

/// ∫ dω and ∫ dω/P² over what lies before an eye that looks along +x, where `lit`; P of CIE 117.
fn integrals(lit: impl Fn(DVec3) -> bool) -> [f64; 2] {
    let (rows, columns) = (1200, 2400);
    let mut sums = [0.0; 2];
    for row in 0..rows {
        let z = -1.0 + 2.0 * (f64::from(row) + 0.5) / f64::from(rows);
        for column in 0..columns {
            let azimuth = -0.5 * PI + PI * (f64::from(column) + 0.5) / f64::from(columns);
            let sin = (1.0 - z * z).sqrt();
            let direction = DVec3::new(sin * azimuth.cos(), sin * azimuth.sin(), z);
            if !lit(direction) {
                continue;
            }
            let piece_sr = 2.0 / f64::from(rows) * PI / f64::from(columns);
            sums[0] += piece_sr;
            match PositionModel::Table.position(DVec3::X, DVec3::Z, direction) {
                Position::Index(p) | Position::BelowTable(p) => sums[1] += piece_sr / (p * p),
                Position::Ignored => {}
            }
        }
    }
    sums
}

/// Catches: emitted light left in L_b, one P for a source that surrounds the eye, light of the half
/// space behind counted, the emission counted twice.
#[test]
fn a_glowing_room_has_its_reflected_light_as_background() {
    // All surfaces emit 20 cd/m² and reflect half: L = 40 everywhere, 20 of them reflected.
    let text = "[scene]\nfile = \"scene.gltf\"\n[materials]\nshell = { emit = 20, reflectance = 0.5 }\n\
                [[viewpoint]]\nname = \"V\"\neye = [1, 1.5, 1.2]\ndirection = [1, 0, 0]\n";
    let outcome = run(text, &gltf(&shell([4.0, 3.0, 3.0])), 64, Effort::default());
    let view = view(&outcome);
    let value = |l_b: f64| 8.0 * (0.25 / l_b * 400.0 * integrals(|_| true)[1]).log10();
    let ugr = view.ugr.clone().expect("a value");
    println!(
        "L_b {} E_v {} UGR {} ± {} ({})",
        view.background_cd_m2,
        view.e_v_lx,
        ugr.value,
        ugr.se,
        value(20.0)
    );
    assert!((view.e_v_lx / (40.0 * PI) - 1.0).abs() < 0.01);
    assert!((view.background_cd_m2 / 20.0 - 1.0).abs() < 5e-4, "{}", view.background_cd_m2);
    assert!(ugr.se < 0.03 && (ugr.value - value(20.0)).abs() < 3.0 * ugr.se + 0.01);
    // The twin that leaves the emission in the background is told apart.
    assert!((ugr.value - value(40.0)).abs() > 2.0);
}

/// A square that faces the eye at (2, 2, 1.5) from a direction (right, up, ahead of +x) at 1.5 m.
fn facing(name: &'static str, azimuth_deg: f64, tilt_deg: f64, half_m: f64) -> (projects::Sheet, DVec3) {
    let (sin_a, cos_a) = azimuth_deg.to_radians().sin_cos();
    let (sin_t, cos_t) = tilt_deg.to_radians().sin_cos();
    let direction = DVec3::new(cos_t * cos_a, cos_t * sin_a, sin_t);
    let side = direction.cross(DVec3::Z).normalize();
    let up = side.cross(direction);
    let centre = DVec3::new(2.0, 2.0, 1.5) + 1.5 * direction;
    let corner = |u: f64, v: f64| (centre + half_m * (u * side + v * up)).to_array();
    let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    ((name, name, corners), direction)
}

/// Catches: a source at the wrong place, one lost, ω or P or E of another, an index computed with the
/// wrong E. Squares on the line of sight, 20° aside, above, far aside, below.
#[test]
fn squares_of_known_luminance_give_every_index_its_closed_form() {
    let places =
        [("Q0", 0.0, 0.0), ("Q1", 20.0, 0.0), ("Q2", -20.0, 10.0), ("Q3", 60.0, 5.0), ("Q4", 0.0, -25.0)];
    let half_m = 0.06;
    let mut sheets = shell([4.0, 4.0, 3.0]);
    let mut directions = Vec::new();
    let mut materials = String::new();
    for (name, azimuth, tilt) in places {
        let (sheet, direction) = facing(name, azimuth, tilt, half_m);
        sheets.push(sheet);
        directions.push(direction);
        materials += &format!("{name} = {{ emit = 5000, reflectance = 0.0 }}\n");
    }
    let text = format!(
        "[scene]\nfile = \"scene.gltf\"\n[materials]\nshell = {{ reflectance = 0.6 }}\n{materials}\
         [[viewpoint]]\nname = \"V\"\neye = [2, 2, 1.5]\ndirection = [1, 0, 0]\n\
         indices = [\"DGP\", \"DGPs\", \"DGI\", \"DGI_mod\", \"CGI\", \"UGP\", \"UGP2\", \"UGR_exp\", \"M\", \"E_v\", \
         \"E_dir\", \"L_b\"]\n"
    );
    let outcome = run(&text, &gltf(&sheets), 64, Effort::default());
    let view = view(&outcome);
    // Solid angle of a facing square of half side s at distance d, and its mean cosine to first order.
    let share: f64 = half_m / 1.5;
    let size_sr = 4.0 * (share * share / (1.0 + share * share)).asin();
    let model = PositionModel::Table;
    let p = directions.iter().map(|&direction| match model.position(DVec3::X, DVec3::Z, direction) {
        Position::Index(p) | Position::BelowTable(p) => p,
        Position::Ignored => panic!("inside the table"),
    });
    let p: Vec<f64> = p.collect();
    let (l, l_b, e_v) = (5000.0f64, view.background_cd_m2, view.e_v_lx);
    let e_dir: f64 = directions.iter().map(|direction| l * size_sr * direction.x).sum();
    let s2: f64 = p.iter().map(|p| l * l * size_sr / (p * p)).sum();
    let s1: f64 = p.iter().map(|p| l * size_sr / (p * p)).sum();
    let dgi = |adaptation: f64| {
        let terms = p.iter().map(|p| {
            0.478 * l.powf(1.6) * (size_sr / (p * p)).powf(0.8) / (adaptation + 0.07 * size_sr.sqrt() * l)
        });
        10.0 * terms.sum::<f64>().log10()
    };
    let ugr = 8.0 * (0.25 / l_b * s2).log10();
    let expected = [
        ("DGP", 5.87e-5 * e_v + 0.092 * (1.0 + s2 / e_v.powf(1.87)).log10() + 0.159),
        ("DGPs", 6.22e-5 * e_v + 0.184),
        ("DGI", dgi(l_b)),
        ("DGI_mod", dgi((e_v / PI).powf(0.85))),
        ("CGI", 8.0 * (2.0 * (1.0 + e_dir / 500.0) / e_v * s2).log10()),
        ("UGP", 0.26 * (0.25 * s2 / l_b).log10()),
        ("UGP2", (1.0 + 2.0 / 7.0 * (s2 / l_b).powf(-0.2)).powi(-10)),
        ("UGR_exp", 8.0 * (e_v / PI).log10() + 8.0 * (s1 / l_b).log10()),
        ("M", 10f64.powf((ugr + 4.8) / 16.0)),
        ("E_v", e_dir + PI * l_b),
        ("E_dir", e_dir),
        ("L_b", l_b),
    ];
    assert_eq!(view.sources.len(), 5);
    let ours = view.ugr.clone().expect("a value");
    assert!(
        (ours.value - ugr).abs() < 3.0 * ours.se + 0.005,
        "UGR {} ± {} is not {ugr}",
        ours.value,
        ours.se
    );
    assert_eq!(view.indices.len(), expected.len());
    for (index, (key, truth)) in view.indices.iter().zip(expected) {
        assert_eq!(index.key, key);
        let found = index.estimate.clone().expect("a value");
        // The closed forms take P and the cosine at the middle of a square 5° wide: 0.1 %.
        let allowed = 3.0 * found.se + 1e-3 * truth.abs();
        assert!((found.value - truth).abs() < allowed, "{key} {} ± {} is not {truth}", found.value, found.se);
    }
}

/// Catches: a subdivision that does not converge, or to something else than the surface it stands for.
#[test]
fn a_long_luminaire_converges_and_is_what_a_luminous_surface_of_its_kind_is() {
    // 1.2 × 0.3 m with 3000 cd/m², 2 m away over the eye, as a Lambert luminaire and as a surface.
    let flux = 3000.0 * PI * 0.36;
    let room = "[scene]\nbox = { size = [6, 4, 3], floor = 0.2, walls = 0.5, ceiling = 0.7 }\n";
    let eye = "[[viewpoint]]\nname = \"V\"\neye = [1.5, 2, 1.2]\ndirection = [1, 0, 0]\n";
    let lamp = format!(
        "{room}[luminaires.A]\nlambert = {{ flux = {flux} }}\narea = {{ rect = [1.2, 0.3] }}\n\
         [[place]]\nluminaire = \"A\"\nat = [3.2, 2, 2.25]\n{eye}"
    );
    let place = folder(&lamp, &[]);
    let project = load(place.path(), &LoadOptions::default()).expect("loads");
    let found = observe(&project, &CONVENTIONS, 32);
    assert_eq!(found.len(), CONVENTIONS.len());
    let by = |sources: SourceModel| {
        let wanted = Convention { sources, position: PositionModel::Table };
        let view = found.iter().find(|view| view.convention == wanted).expect("computed");
        (view.ugr.clone().expect("a value").value, view.background_cd_m2)
    };
    let (subdivided, l_b) = by(SourceModel::Subdivided);
    // The integral over the rectangle, 400 × 100 pieces.
    let mut sum = 0.0;
    for i in 0..400 {
        for j in 0..100 {
            let at = DVec3::new(
                2.6 + 1.2 * (f64::from(i) + 0.5) / 400.0,
                1.85 + 0.3 * (f64::from(j) + 0.5) / 100.0,
                2.25,
            ) - DVec3::new(1.5, 2.0, 1.2);
            let size_sr = 0.36 / 40_000.0 * at.z / at.length().powi(3);
            if let Position::Index(p) = PositionModel::Table.position(DVec3::X, DVec3::Z, at.normalize()) {
                sum += 3000.0 * 3000.0 * size_sr / (p * p);
            }
        }
    }
    let integral = 8.0 * (0.25 / l_b * sum).log10();
    println!(
        "subdivided {subdivided}, integral {integral}, visible {:?}, centre {:?}",
        by(SourceModel::Visible),
        by(SourceModel::Centre)
    );
    assert!((subdivided - integral).abs() < 0.02, "{subdivided} {integral}");
    // One P for the whole of it is another number: the conventions are told apart.
    assert!((by(SourceModel::Visible).0 - integral).abs() > 0.02);
}

/// Catches: a surface that is a source or none, from one step of a plate before it to the next.
#[test]
fn a_plate_moving_across_a_luminaire_changes_ugr_without_jumps() {
    let ugr = |cover: f64| {
        let x = 2.9 + cover;
        let text = "[scene]\nfile = \"scene.gltf\"\n[materials]\nshell = { reflectance = 0.5 }\nplate = { reflectance = 0.5 }\n\
                    [luminaires.A]\nlambert = { flux = 3400 }\narea = { rect = [1.2, 0.3] }\n\
                    [[place]]\nluminaire = \"A\"\nat = [3.5, 2, 2.9]\n\
                    [[viewpoint]]\nname = \"V\"\neye = [1, 2, 1.2]\ndirection = [1, 0, 0]\n";
        let mut sheets = shell([6.0, 4.0, 3.0]);
        sheets.push(("P", "plate", [[2.5, 1.6, 2.8], [x, 1.6, 2.8], [x, 2.4, 2.8], [2.5, 2.4, 2.8]]));
        let outcome = run(text, &gltf(&sheets), 32, Effort { particles: 16, ..Effort::default() });
        view(&outcome).ugr.clone().expect("a value")
    };
    // The line of sight to the luminaire's far end passes the plate's height at x = 3.9.
    let values: Vec<f64> = (0..8).map(|step| ugr(0.08 * f64::from(step)).value).collect();
    println!("{values:?}");
    let steps: Vec<f64> = values.windows(2).map(|pair| pair[0] - pair[1]).collect();
    assert!(steps.iter().all(|step| step.abs() < 1.2), "{steps:?}");
    assert!(values[0] - values[7] > 1.0);
}

/// Catches: eyes and directions mixed up, rows of another receiver, a map that is not what observers see.
#[test]
fn a_map_says_what_an_observer_at_its_points_says() {
    let text = "[scene]\nbox = { size = [6, 4, 3], floor = 0.2, walls = 0.5, ceiling = 0.7 }\n\
                [luminaires.A]\nlambert = { flux = 3400 }\narea = { rect = [1.2, 0.3] }\n\
                [[place]]\nluminaire = \"A\"\nat = [3.5, 2, 2.9]\n\
                [[viewpoint]]\nname = \"V\"\neye = [1.5, 1, 1.2]\nsweep = { from = 0, to = 315, step = 45 }\nindices = [\"DGP\"]\n\
                [[glare_map]]\nrect = { origin = [0, 0, 1.2], u = [6, 0, 0], v = [0, 4, 0] }\nstep = 1\nindices = [\"DGP\"]\n";
    let place = folder(text, &[]);
    let project = load(place.path(), &LoadOptions::default()).expect("loads");
    let found = maps(&project, 64);
    let observed = observe(&project, &CONVENTIONS[..1], 64);
    assert_eq!((found.len(), found[0].eyes.len(), observed.len()), (1, 24, 8));
    // The viewpoint lies between four eyes of the map; its own eye is at none, so take a second map.
    let nearest = "[[glare_map]]\nname = \"at\"\nrect = { origin = [1, 0.5, 1.2], u = [1, 0, 0], v = [0, 1, 0] }\nstep = 1\nindices = [\"DGP\"]\n";
    let place = folder(&format!("{text}{nearest}"), &[]);
    let project = load(place.path(), &LoadOptions::default()).expect("loads");
    let eye = &maps(&project, 64)[1].eyes[0];
    assert!((eye.position - DVec3::new(1.5, 1.0, 1.2)).length() < 1e-12);
    let mut compared = 0;
    for (view, (ugr, further)) in observed.iter().zip(&eye.views) {
        assert_eq!(view.ugr.is_ok(), ugr.is_ok());
        if let (Ok(ours), Ok(theirs)) = (ugr, &view.ugr) {
            let allowed = 5.0 * ours.se.hypot(theirs.se) + 0.01;
            assert!((ours.value - theirs.value).abs() < allowed && ours.se < 0.2, "{ours:?} {theirs:?}");
            compared += 1;
        }
        let (ours, theirs) = (further[0].estimate.clone(), view.indices[0].estimate.clone());
        if let (Ok(ours), Ok(theirs)) = (ours, theirs) {
            assert!((ours.value - theirs.value).abs() < 5.0 * ours.se.hypot(theirs.se) + 1e-4);
        }
    }
    assert!(compared >= 3);
    assert_eq!(eye.worst().map(|(number, _)| number), observed.iter().position(|view| view.worst));
}

/// Catches: keys that no index has, and `indices` that are read and forgotten.
#[test]
fn unknown_indices_are_refused_with_the_known_ones() {
    let text = "[scene]\nbox = { size = [4, 3, 3], floor = 0.2, walls = 0.5, ceiling = 0.7 }\n\
                [luminaires.A]\npoint = { flux = 1000 }\n[[place]]\nluminaire = \"A\"\nat = [2, 1.5, 2.7]\n\
                [[viewpoint]]\nname = \"V\"\neye = [1, 1.5, 1.2]\ndirection = [1, 0, 0]\nindices = [\"BRS\"]\n";
    let place = folder(text, &[]);
    let errors = load(place.path(), &LoadOptions::default()).expect_err("refused");
    let text: String = errors.iter().map(ToString::to_string).collect();
    assert!(text.contains("BRS") && text.contains("DGI_mod"), "{text}");
}
