//! What some indices ask beside sources and background: the mean luminance of the field of view, the luminous share of
//! the ceiling, an illuminated area. Against closed forms; lists of viewpoints; eyes where nobody can be.

use std::f64::consts::{PI, TAU};
use std::path::Path;

use gershun::outcome::{Interval, Outcome, Verdict};
use gershun::project::{LoadOptions, load};
use gershun::report::words::{Lang, said as words};
use gershun::solve::Effort;

use crate::projects::{File, agrees, check, folder, gltf, run, shell};

/// An index of the view with this name.
fn figure(outcome: &Outcome, view: &str, key: &str) -> Result<Interval, String> {
    let views = &outcome.rooms[0].viewpoints;
    let view = views.iter().find(|one| one.name == view).unwrap_or_else(|| panic!("no {view}"));
    if key == "UGR" {
        return view.ugr.clone().map_err(|why| why.reason);
    }
    let index = view.indices.iter().find(|index| index.key == key).unwrap_or_else(|| panic!("no {key}"));
    index.estimate.clone().map_err(|why| why.reason)
}

fn value(outcome: &Outcome, view: &str, key: &str) -> f64 {
    figure(outcome, view, key).unwrap_or_else(|why| panic!("{view}, {key}: {why}")).value
}

fn notes(outcome: &Outcome, view: &str, key: &str) -> String {
    let view = outcome.rooms[0].viewpoints.iter().find(|one| one.name == view).expect("a view");
    view.indices.iter().filter(|index| index.key == key).flat_map(|index| index.notes.clone()).collect()
}

/// Catches: a field of view of another size, luminances that leave the sources out, E for L, a room where the mean
/// depends on the direction.
#[test]
fn the_field_of_a_glowing_room_has_its_luminance() {
    // All surfaces emit 20 cd/m² and reflect half: L = 40 everywhere.
    let text = "[scene]\nfile = \"scene.gltf\"\n[materials]\nshell = { emit = 20, reflectance = 0.5 }\n\
                [[viewpoint]]\nname = \"V\"\neye = [1, 1.5, 1.2]\ndirection = [1, 0.3, -0.2]\nindices = [\"L_mean\"]\n";
    let outcome = run(text, &gltf(&shell([4.0, 3.0, 3.0])), 256, Effort::default());
    let mean = figure(&outcome, "V", "L_mean").expect("a mean");
    check("L_mean", mean.value, mean.se, 40.0, 0.02);
    assert!(notes(&outcome, "V", "L_mean").contains("a cone of 5 sr, 78.2°"));
}

/// Catches: F over the half-space or weighted by the cosine, P squared, an exponent of another number of sources, the
/// error of F forgotten.
#[test]
fn vcp_of_a_disc_in_the_dark_is_its_closed_form() {
    // A regular polygon of 64 corners, 6° of radius, faces the eye from 20° to the left, 1.5 m away.
    let (luminance, radius, corners) = (3000.0, 6f64.to_radians().tan() * 1.5, 64);
    let (sin, cos) = 20f64.to_radians().sin_cos();
    let middle = [2.0 + 1.5 * cos, 2.0 + 1.5 * sin, 1.5];
    let corner = |k: usize| {
        let (v, u) = (TAU * k as f64 / f64::from(corners)).sin_cos();
        [middle[0] + radius * u * sin, middle[1] - radius * u * cos, middle[2] + radius * v]
    };
    let mut sheets = shell([4.0, 4.0, 3.0]);
    // Two wedges of the disc to a sheet.
    for k in (0..corners as usize).step_by(2) {
        sheets.push(("disc", "disc", [middle, corner(k), corner(k + 1), corner(k + 2)]));
    }
    let project = |text: &str| {
        format!(
            "[scene]\nfile = \"scene.gltf\"\n[materials]\nshell = {{ reflectance = 0.0 }}\n\
             disc = {{ emit = {luminance}, reflectance = 0.0 }}\n\
             [[viewpoint]]\nname = \"V\"\neye = [2, 2, 1.5]\ndirection = [1, 0, 0]\n{text}"
        )
    };
    let text = project("indices = [\"DGR\", \"VCP\", \"L_mean\", \"E_dir\"]\n");
    let outcome = run(&text, &gltf(&sheets), 512, Effort::default());
    let view = &outcome.rooms[0].viewpoints[0];
    let size_sr: f64 = view.sources.iter().map(|source| source.solid_angle_sr).sum();
    let by_radius = TAU * (1.0 - 6f64.to_radians().cos());
    assert!((size_sr / by_radius - 1.0).abs() < 0.01, "{size_sr} for {by_radius}");
    let field = luminance * size_sr / 5.0;
    let mean = figure(&outcome, "V", "L_mean").expect("a mean");
    check("F", mean.value, mean.se, field, 0.1);
    let (n, position) = (view.sources.len() as f64, view.sources[0].position_index);
    let dgr = |field: f64| {
        let all = view.sources.iter().map(|source| {
            let size_sr = source.solid_angle_sr;
            let q = 20.4 * size_sr + 1.52 * size_sr.powf(0.2) - 0.075;
            0.5 * luminance * q / (source.position_index * field.powf(0.44))
        });
        all.sum::<f64>().powf(n.powf(-0.0914))
    };
    assert!(position > 1.05 && position < 1.6, "{position}");
    let found = figure(&outcome, "V", "DGR").expect("a rating");
    check("DGR", found.value, found.se, dgr(field), 0.05);
    // d ln DGR/d ln F = −0.44 n^−0.0914.
    let expected = 0.44 * n.powf(-0.0914) * mean.se / mean.value * found.value;
    assert!((found.se / expected - 1.0).abs() < 0.02, "{} for {expected}", found.se);
    // The twin: F over the half-space.
    let twin = dgr(luminance * size_sr / TAU);
    assert!(agrees(found.value, found.se, twin, 0.05).is_err(), "{} is not told from {twin}", found.value);
    let comfort = figure(&outcome, "V", "VCP").expect("a probability");
    let z = (6.374 - 1.3227 * found.value.ln()) / std::f64::consts::SQRT_2;
    let expected = 50.0 + 50.0 * statrs::function::erf::erf(z);
    assert!((comfort.value - expected).abs() < 1e-9 && comfort.lo < expected && comfort.hi > expected);
    let limits = "[[require]]\nviewpoint = \"V\"\nquantity = \"VCP\"\nmin = ";
    for (limit, verdict) in [(expected - 5.0, Verdict::Pass), (expected + 5.0, Verdict::Fail)] {
        let outcome = run(&project(&format!("{limits}{limit}\n")), &gltf(&sheets), 512, Effort::default());
        assert_eq!(outcome.requirements[0].verdict, verdict);
    }
}

/// A hall of 6 × 5 m with some panels of 1.2 × 0.6 m in two groups.
fn hall(panels: usize, further: &str) -> String {
    let mut text = "[scene]\nbox = { size = [6, 5, 3], floor = 0.2, walls = 0.5, ceiling = 0.7 }\n\
         [luminaires.A]\nlambert = { flux = 2000 }\narea = { rect = [1.2, 0.6] }\n"
        .to_owned();
    for k in 0..panels {
        let (x, y) = (0.8 + 1.4 * (k % 4) as f64, 0.6 + 0.9 * (k / 4) as f64);
        let group = if k % 2 == 0 { "even" } else { "odd" };
        text += &format!("[[place]]\nluminaire = \"A\"\nat = [{x}, {y}, 2.95]\ngroup = \"{group}\"\n");
    }
    text + "[light_scenes]\nfull = { even = 1, odd = 1 }\nhalf = { even = 0.5 }\n\
            [[viewpoint]]\nname = \"V\"\neye = [0.7, 2.5, 1.2]\ndirection = [1, 0, 0]\n\
            indices = [\"UGR\", \"GGR\", \"E_v\", \"E_dir\"]\n"
        + further
}

/// Catches: a share of the ceiling of luminaires that are off, of the floor's or the walls' area, a formula used where it
/// falls without end.
#[test]
fn ggr_knows_how_much_of_the_ceiling_shines() {
    let outcome = run(&hall(16, ""), &[], 64, Effort::default());
    let share = 16.0 * 0.72 / 30.0;
    for (scene, share) in [("full", share), ("half", 0.5 * share)] {
        let view = outcome.rooms[0].viewpoints.iter().find(|view| view.light_scene == scene).expect("a view");
        let of = |key: &str| {
            let index = view.indices.iter().find(|index| index.key == key).expect("an index");
            index.estimate.as_ref().expect("a value").value
        };
        let (e_d, e_i) = (of("E_dir"), of("E_v") - of("E_dir"));
        let gain: f64 = 2.55 * (1.0 + e_d / 220.0) / (1.0 + e_d / e_i);
        let expected = view.ugr.as_ref().expect("UGR").value + (1.18 - 0.18 / share) * 8.0 * gain.log10();
        assert!((of("GGR") - expected).abs() < 1e-9, "{scene}: {} for {expected}", of("GGR"));
    }
    assert!(notes(&outcome, "V", "GGR").contains("0.384 of the ceiling shines"));
    // Five panels are 12 % of it: UGR holds.
    let reason = figure(&run(&hall(5, ""), &[], 32, Effort::default()), "V", "GGR").unwrap_err();
    assert!(reason.contains("from 0.15 to 1, here 0.120"), "{reason}");
    // All of it.
    let glowing = "[scene]\nbox = { size = [8, 6, 3], floor = 0.2, walls = 0.5, ceiling = 0.7 }\n\
         [materials]\nCeiling = { emit = 1500, reflectance = 0.5 }\n\
         [[viewpoint]]\nname = \"V\"\neye = [1, 3, 1.2]\ndirection = [1, 0, 0]\nindices = [\"GGR\"]\n";
    assert!(notes(&run(glowing, &[], 32, Effort::default()), "V", "GGR").contains("1.000 of the ceiling"));
    let hung = format!(
        "{glowing}[luminaires.A]\nlambert = {{ flux = 2000 }}\narea = {{ rect = [1.2, 0.6] }}\n\
         [[place]]\nluminaire = \"A\"\nat = [4, 3, 2.5]\n"
    );
    let said = notes(&run(&hung, &[], 32, Effort::default()), "V", "GGR");
    assert!(said.contains("1.000 of the ceiling"), "a lamp under a luminous ceiling: {said}");
    let lit = glowing.replace("Ceiling = { emit", "Wall_N = { emit");
    let reason = figure(&run(&lit, &[], 32, Effort::default()), "V", "GGR").unwrap_err();
    assert_eq!(reason, "nothing of the ceiling shines");
}

/// A dark hall with a grey floor, a bare lamp over the middle and an eye that looks down at the court.
fn court(further: &str) -> String {
    format!(
        "[scene]\nbox = {{ size = [12, 8, 6], floor = 0.25, walls = 0, ceiling = 0 }}\n\
         [luminaires.A]\npoint = {{ flux = 20000 }}\nmaintenance = 0.8\n\
         [[place]]\nluminaire = \"A\"\nat = [6, 4, 5]\n\
         [[area]]\nname = \"Court\"\nrect = {{ origin = [2, 2, 0], u = [8, 0, 0], v = [0, 4, 0] }}\n{further}\
         [[viewpoint]]\nname = \"V\"\neye = [1, 4, 1.5]\ndirection = [1, 0, -0.0349]\nindices = [\"GR\", \"E_dir\"]\n"
    )
}

/// Catches: a veil of the horizontal illuminance, an angle in radians, maintained light against initial, the reflectance
/// of another surface, the area's neighbour.
#[test]
fn gr_of_a_lamp_over_a_court_is_its_closed_form() {
    let second =
        "[[area]]\nname = \"Stand\"\nrect = { origin = [0, 0, 0.5], u = [1, 0, 0], v = [0, 8, 0] }\n";
    let gaze = glam::DVec3::new(1.0, 0.0, -0.0349).normalize();
    let towards = glam::DVec3::new(5.0, 0.0, 3.5);
    let candelas = 20000.0 / (4.0 * PI);
    let theta_deg = towards.angle_between(gaze).to_degrees();
    let eye_lx = candelas / towards.length_squared() * towards.normalize().dot(gaze);
    let veil = 10.0 * eye_lx / (theta_deg * theta_deg);
    let expected =
        |mean_lx: f64, rho: f64| 27.0 + 24.0 * (veil / (0.035 * rho * mean_lx / PI).powf(0.9)).log10();
    let outcome = run(&court(""), &[], 32, Effort::default());
    assert!((value(&outcome, "V", "E_dir") / eye_lx - 1.0).abs() < 1e-9);
    // Maintained light at the points of the court; GR takes initial flux.
    let field = &outcome.rooms[0].areas[0].fields[0];
    let points: Vec<f64> = field.points.iter().filter_map(|point| Some(point.as_ref()?.value)).collect();
    let mean_lx = points.iter().sum::<f64>() / points.len() as f64 / 0.8;
    let found = value(&outcome, "V", "GR");
    let truth = expected(mean_lx, 0.25);
    assert!((found - truth).abs() < 1e-6, "{found} for {truth}");
    assert!((expected(0.8 * mean_lx, 0.25) - found).abs() > 2.0, "maintained light is told apart");
    let said = notes(&outcome, "V", "GR");
    assert!(said.contains("area \"Court\"") && !said.contains("below the horizontal"), "{said}");
    // Of several areas one must be named; a reflectance of one's own wins.
    let several = court(second);
    let reason = figure(&run(&several, &[], 32, Effort::default()), "V", "GR").unwrap_err();
    assert!(reason.contains("several areas"), "{reason}");
    let named = format!("{several}ground = {{ area = \"Court\", reflectance = 0.5 }}\n");
    let outcome = run(&named, &[], 32, Effort::default());
    assert!((value(&outcome, "V", "GR") - expected(mean_lx, 0.5)).abs() < 1e-6);
    let level = run(&court("").replace("-0.0349", "0"), &[], 32, Effort::default());
    assert!(notes(&level, "V", "GR").contains("below the horizontal"));
    let limit =
        format!("{}[[require]]\nviewpoint = \"V\"\nquantity = \"GR\"\nmax = {}\n", court(""), truth - 1.0);
    assert_eq!(run(&limit, &[], 32, Effort::default()).requirements[0].verdict, Verdict::Fail);
}

/// Catches: the noise of an area's illuminance that GR's interval does not hold.
#[test]
fn the_interval_of_gr_holds_that_of_its_area() {
    let text = court("").replace("walls = 0, ceiling = 0", "walls = 0.6, ceiling = 0.7");
    let outcome = run(&text, &[], 64, Effort::default());
    let found = figure(&outcome, "V", "GR").expect("GR");
    let mean = outcome.values.iter().find(|one| one.subject == "Court" && one.statistic == "mean").unwrap();
    let mean = mean.estimate.as_ref().expect("a mean");
    let expected = 24.0 * 0.9 / std::f64::consts::LN_10 * mean.se / mean.value;
    assert!(mean.se > 0.0 && (found.se / expected - 1.0).abs() < 0.02, "{} for {expected}", found.se);
    assert!(found.lo < found.value && found.value < found.hi);
}

/// Catches: a luminous ceiling that loses, for indices without a table, the part of it for which the table of CIE 117 has
/// no P; UGR that counts it.
#[test]
fn indices_without_a_table_count_all_of_a_luminous_ceiling() {
    let text = "[scene]\nbox = { size = [8, 6, 3], floor = 0.2, walls = 0.5, ceiling = 0.7 }\n\
                [materials]\nCeiling = { emit = 1500, reflectance = 0.5 }\n\
                [[viewpoint]]\nname = \"V\"\neye = [1, 3, 1.2]\ndirection = [1, 0, 0]\n\
                indices = [\"CGI\", \"E_v\", \"E_dir\", \"L_b\"]\n";
    let outcome = run(text, &[], 64, Effort::default());
    let of = |key: &str| value(&outcome, "V", key);
    // Σ ω/P² over the ceiling by 2000 × 2000 cells: what the table knows, and with the rest by Levin's P.
    let (known, all) = (0.073_321, 0.076_642);
    let by_ugr = 10f64.powf(of("UGR") / 8.0) * of("L_b") / 0.25 / (1500.0 * 1500.0);
    let by_cgi = 10f64.powf(of("CGI") / 8.0) * of("E_v") / (2.0 * (1.0 + of("E_dir") / 500.0));
    let by_cgi = by_cgi / (1500.0 * 1500.0);
    assert!((by_ugr / known - 1.0).abs() < 0.01, "{by_ugr} for {known}");
    assert!((by_cgi / all - 1.0).abs() < 0.01, "{by_cgi} for {all}; twin {known}");
}

/// The list of a project with this room, as the mistakes or the viewpoints it makes.
fn listed(rows: &str) -> Result<gershun::project::Project, String> {
    let text = "[scene]\nbox = { size = [6, 4, 3], floor = 0.3, walls = 0.5, ceiling = 0.8 }\n\
                [luminaires.A]\npoint = { flux = 1000 }\n[[place]]\nluminaire = \"A\"\nat = [3, 2, 2.5]\n\
                [light_scenes]\nday = { A = 0.5 }\nnight = { A = 0.1 }\n\
                [[area]]\nname = \"Desk\"\nrect = { origin = [1, 1, 0.8], u = [1, 0, 0], v = [0, 1, 0] }\n\
                [lists]\nviewpoints = \"v.csv\"\n";
    let files: Vec<File> = vec![("v.csv".into(), rows.as_bytes().to_vec())];
    let folder = folder(text, &files);
    let found = load(&Path::new(folder.path()).join("project.toml"), &LoadOptions::default());
    found.map_err(|faults| faults.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))
}

/// Catches: a column of the list that is read and not heeded, or taken for its neighbour; a mistake without its line.
#[test]
fn a_list_of_viewpoints_tells_tasks_indices_light_scenes_and_areas() {
    let header = "name,x,y,z,azimuth,task_x,task_y,task_z,task_deg,indices,light_scene,area\n";
    let project = listed(&format!(
        "{header}a,1,2,1.2,0,,,,,,,\nb,1,2,1.2,0,2,2,0.8,15,DGP;GR VCP,night,Desk\nc,1,2,1.2,0,,,,30,,day,\n"
    ))
    .expect("a good list");
    let [a, b, c] = &project.worlds[0].viewpoints[..] else { panic!("three") };
    assert!(a.indices.is_empty() && a.task.at.is_none() && a.light_scene.is_none() && a.area.is_none());
    assert_eq!(b.task.at, Some(glam::DVec3::new(2.0, 2.0, 0.8)));
    assert!((b.task.opening_deg - 15.0).abs() < 1e-12 && (c.task.opening_deg - 30.0).abs() < 1e-12);
    assert_eq!(b.indices[..3], ["DGP", "GR", "VCP"]);
    assert_eq!((b.indices.len(), c.indices.len()), (8, 5), "a task asks for its five");
    assert_eq!((b.light_scene, c.light_scene, b.area), (Some(1), Some(0), Some(0)));
    for (row, said) in [
        ("a,1,2,1.2,0,2,,0.8,,,,", "task_y is missing"),
        ("a,1,2,1.2,0,0,2,1.2,,,,", "the task lies behind the eye"),
        ("a,1,2,1.2,0,,,,90,,,", "task_deg must lie between 0 and 60"),
        ("a,1,2,1.2,0,,,,,UGR;DPG,,", "\"DPG\" is no index"),
        ("a,1,2,1.2,0,,,,,,dusk,", "no light scene \"dusk\""),
        ("a,1,2,1.2,0,,,,,,,Dsek", "no area \"Dsek\""),
    ] {
        let why = listed(&format!("{header}{row}\n")).expect_err(row);
        assert!(why.contains(said) && why.contains("v.csv:2"), "{row}: {why}");
    }
}

/// Catches: an eye in the floor, from which rounding hides a quarter of a luminaire in an empty room.
#[test]
fn an_eye_in_a_surface_is_a_mistake() {
    let eye = |z: f64| listed(&format!("name,x,y,z,azimuth\na,1,2,{z},0\n"));
    assert!(eye(0.0).expect_err("the floor").contains("lies in a surface"));
    assert!(eye(0.001).is_ok());
}

/// Catches: a reason or a note that stays English in a Russian report.
#[test]
fn what_is_said_beside_a_view_is_said_in_russian() {
    let outcome = run(
        &court("").replace("\"GR\"", "\"GR\", \"VCP\", \"GGR\", \"L_mean\", \"f_TI\""),
        &[],
        32,
        Effort::default(),
    );
    let view = &outcome.rooms[0].viewpoints[0];
    let mut said: Vec<String> = view.indices.iter().flat_map(|index| index.notes.clone()).collect();
    said.extend(view.indices.iter().filter_map(|index| Some(index.estimate.as_ref().err()?.reason.clone())));
    assert!(said.len() >= 4, "{said:?}");
    for one in said {
        let russian = words(Lang::Ru, &one);
        assert!(russian.chars().any(|c| ('а'..='я').contains(&c)), "{one}");
    }
}
