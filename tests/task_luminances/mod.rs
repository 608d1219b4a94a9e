//! Luminances of a task, its surround and the far field at a viewpoint: against closed forms, against a picture of
//! the same view, as requirements, and what is said of mistakes.

use std::f64::consts::{PI, TAU};

use gershun::glare::field::Cone;
use gershun::glare::of_image::{Options as OfImage, glare_of_image};
use gershun::image::{Projection, View};
use gershun::measure::weights;
use gershun::observe::{CONVENTIONS, observe};
use gershun::outcome::{Interval, Outcome, Verdict};
use gershun::project::{LoadOptions, load};
use gershun::report::{Colour, Lang, Options, Style, csv::Dialect, files, table};
use gershun::solve::Effort;
use gershun::solve::picture::{Detail, expose, render};
use glam::DVec3;

use crate::common::office_with;
use crate::projects::{Sheet, agrees, check, folder, gltf, run, shell};

const KEYS: [&str; 5] = ["L_task", "L_surround", "L_far", "L_task/L_surround", "L_task/L_far"];

/// A figure of the only view.
fn figure(outcome: &Outcome, key: &str) -> Result<Interval, String> {
    let view = &outcome.rooms[0].viewpoints[0];
    let index = view.indices.iter().find(|index| index.key == key).unwrap_or_else(|| panic!("no {key}"));
    index.estimate.clone().map_err(|why| why.reason)
}

/// All five.
fn figures(outcome: &Outcome) -> [Interval; 5] {
    KEYS.map(|key| figure(outcome, key).unwrap_or_else(|why| panic!("{key}: {why}")))
}

fn notes(outcome: &Outcome) -> String {
    outcome.rooms[0].viewpoints[0].indices.iter().flat_map(|index| index.notes.clone()).collect()
}

/// Catches: a zone that is not divided by its own solid angle, by the half-angle's or with what lies behind the eye, a
/// ratio turned round, emission left out.
#[test]
fn a_glowing_room_has_one_luminance_in_every_zone() {
    // All surfaces emit 20 cd/m² and reflect half: L = 40 everywhere.
    for (task, cut) in [("task_deg = 20", false), ("task = [1.5, 1.5, 0.334]", true)] {
        let text = format!(
            "[scene]\nfile = \"scene.gltf\"\n[materials]\nshell = {{ emit = 20, reflectance = 0.5 }}\n\
             [[viewpoint]]\nname = \"V\"\neye = [1, 1.5, 1.2]\ndirection = [1, 0, 0]\n{task}\n"
        );
        let outcome = run(&text, &gltf(&shell([4.0, 3.0, 3.0])), 512, Effort::default());
        for (key, (found, truth)) in
            KEYS.iter().zip(figures(&outcome).iter().zip([40.0, 40.0, 40.0, 1.0, 1.0]))
        {
            println!("{key}: {} ± {}", found.value, found.se);
            check(key, found.value, found.se, truth, 0.02);
        }
        let said = notes(&outcome);
        assert_eq!(said.contains("behind the plane of the eye"), cut, "{said}");
        assert_eq!(said.contains("at 60.0° from the line of sight"), cut, "{said}");
    }
}

/// A square that faces the eye at (2, 2, 1.5) from so many degrees to the left of +x, at 1.5 m.
fn facing(name: &'static str, azimuth_deg: f64, half_m: f64) -> Sheet {
    let (sin, cos) = azimuth_deg.to_radians().sin_cos();
    let direction = DVec3::new(cos, sin, 0.0);
    let side = direction.cross(DVec3::Z);
    let corner = |u: f64, v: f64| {
        (DVec3::new(2.0, 2.0, 1.5) + 1.5 * direction + half_m * (u * side + v * DVec3::Z)).to_array()
    };
    (name, name, [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)])
}

/// Solid angle between two cones of these half-angles.
fn ring_sr([from_deg, to_deg]: [f64; 2]) -> f64 {
    TAU * (from_deg.to_radians().cos() - to_deg.to_radians().cos())
}

/// Catches: zones mixed up, an opening taken for its half, an interval that does not hold.
#[test]
fn squares_of_known_luminance_make_their_zones() {
    let half_m = 0.06;
    let squares = [("Q0", 0.0, 5000.0), ("Q1", 20.0, 1000.0), ("Q2", -45.0, 700.0)];
    let mut sheets = shell([4.0, 4.0, 3.0]);
    let mut materials = "shell = { reflectance = 0.0 }\n".to_owned();
    for (name, azimuth_deg, luminance) in squares {
        sheets.push(facing(name, azimuth_deg, half_m));
        materials += &format!("{name} = {{ emit = {luminance}, reflectance = 0.0 }}\n");
    }
    let of = |opening_deg: f64| {
        let text = format!(
            "[scene]\nfile = \"scene.gltf\"\n[materials]\n{materials}\
             [[viewpoint]]\nname = \"V\"\neye = [2, 2, 1.5]\ndirection = [1, 0, 0]\ntask_deg = {opening_deg}\n"
        );
        figures(&run(&text, &gltf(&sheets), 256, Effort::default()))
    };
    let share: f64 = half_m / 1.5;
    let size_sr = 4.0 * (share * share / (1.0 + share * share)).asin();
    let zones = [[0.0, 10.0], [10.0, 30.0], [30.0, 60.0]];
    let means: Vec<f64> = squares
        .iter()
        .zip(zones)
        .map(|((_, _, luminance), zone)| luminance * size_sr / ring_sr(zone))
        .collect();
    let truths = [means[0], means[1], means[2], means[0] / means[1], means[0] / means[2]];
    let (found, twin) = (of(20.0), of(22.0));
    for (key, (one, truth)) in KEYS.iter().zip(found.iter().zip(truths)) {
        println!("{key}: {} ± {}, {truth}", one.value, one.se);
        check(key, one.value, one.se, truth, 0.1);
    }
    // A cone of 22° is told apart.
    assert!(agrees(twin[0].value, twin[0].se, truths[0], 0.1).is_err(), "{twin:?} resolves nothing");
}

/// Catches: an opening that the edge of a cone cuts integrated as a whole or not at all, light of a luminaire left
/// out of the luminances or counted twice.
#[test]
fn a_luminaire_across_the_edge_of_the_task_lights_both_zones() {
    // 0.6 × 0.6 m of 3000 cd/m² 1.5 m over the eye, 2 m ahead; the task's middle lies on its far edge.
    let (luminance, half_m) = (3000.0, 0.3);
    let (eye, middle) = (DVec3::new(0.5, 2.0, 1.2), DVec3::new(2.5, 2.0, 2.7));
    let task = DVec3::new(2.8, 2.0, 2.7);
    let text = format!(
        "[scene]\nfile = \"scene.gltf\"\n[materials]\nshell = {{ reflectance = 0.0 }}\n\
         [luminaires.A]\nlambert = {{ flux = {} }}\narea = {{ rect = [0.6, 0.6] }}\n\
         [[place]]\nluminaire = \"A\"\nat = [2.5, 2, 2.7]\n\
         [[viewpoint]]\nname = \"V\"\neye = [0.5, 2, 1.2]\ndirection = [1, 0, 0]\ntask = [2.8, 2, 2.7]\ntask_deg = 12\n",
        luminance * PI * 4.0 * half_m * half_m
    );
    let outcome = run(&text, &gltf(&shell([5.0, 4.0, 3.0])), 256, Effort::default());
    let found = [0, 1, 2].map(|k| figure(&outcome, KEYS[k]).expect("a luminance"));
    let (axis, parts) = ((task - eye).normalize(), 2000);
    let mut sizes_sr = [0.0; 2];
    for i in 0..parts {
        for j in 0..parts {
            let at = [i, j].map(|k| half_m * (2.0 * (f64::from(k) + 0.5) / f64::from(parts) - 1.0));
            let away = middle + DVec3::new(at[0], at[1], 0.0) - eye;
            let piece_sr = (2.0 * half_m / f64::from(parts)).powi(2) * away.z / away.length().powi(3);
            sizes_sr[usize::from(axis.angle_between(away).to_degrees() > 6.0)] += piece_sr;
        }
    }
    let zones = [[0.0, 6.0], [6.0, 30.0]];
    let truths = [0, 1].map(|k| luminance * sizes_sr[k] / ring_sr(zones[k]));
    for k in 0..2 {
        println!("{}: {} ± {}, {}", KEYS[k], found[k].value, found[k].se, truths[k]);
        check(KEYS[k], found[k].value, found[k].se, truths[k], 0.05);
    }
    assert!(found[2].value.abs() < 1e-12, "no part of it lies in the far field: {:?}", found[2]);
    assert_eq!(
        figure(&outcome, "L_task/L_far").expect_err("nothing to compare with"),
        "the far field is dark"
    );
    // Taken as a whole it would be another number, and none.
    let whole = luminance * (sizes_sr[0] + sizes_sr[1]) / ring_sr(zones[0]);
    assert!(agrees(found[0].value, found[0].se, whole, 0.05).is_err());
    assert!(
        sizes_sr.iter().all(|sr| *sr > 0.1 * (sizes_sr[0] + sizes_sr[1])),
        "the edge cuts it: {sizes_sr:?}"
    );
}

/// Catches: zones about another direction than a picture has them, light that one of the two leaves out.
#[test]
fn a_picture_of_the_view_has_the_same_luminances() {
    let more = "[[viewpoint]]\nname = \"Reader\"\neye = [2.39, 1.6, 1.2]\ndirection = [0, 1, 0]\n\
                task = [2.39, 2.0, 0.75]\ntask_deg = 24\n";
    let project = office_with(more);
    let observed = observe(&project, &CONVENTIONS[..1], 512);
    let reader = observed.iter().find(|view| view.viewpoint == "Reader").expect("observed");
    let world = &project.worlds[0];
    let weights = weights(world, &project.light_scenes[0], &world.rooms[0], false);
    let projection = Projection::AngularFisheye { horizontal_deg: 180.0, vertical_deg: 180.0 };
    let view = View::new(projection, reader.eye, DVec3::Y, DVec3::Z).expect("a view");
    let (image, _) =
        render(&expose(&world.scene, 1).picture(&weights, Detail::Exact), &view, [500; 2], &|_| {});
    let towards = (DVec3::new(2.39, 2.0, 0.75) - reader.eye).normalize();
    let axes = [view.right(), view.up(), view.forward()];
    let direction = DVec3::from_array(axes.map(|axis| towards.dot(axis)));
    let task = Some(Cone { direction, opening_rad: 24f64.to_radians() });
    let glare = glare_of_image(&image, None, &OfImage { task, ..OfImage::default() }).expect("evaluated");
    for key in KEYS {
        let reading = glare.readings.iter().find(|reading| reading.key == key).expect("read");
        let of_image = *reading.value.as_ref().expect("a value");
        let index = reader.indices.iter().find(|index| index.key == key).expect("asked for");
        let ours = index.estimate.clone().expect("a value");
        println!("{key}: {} ± {}, picture {of_image}", ours.value, ours.se);
        assert!(5.0 * ours.se < 0.06 * ours.value, "{key}: {ours:?} resolves nothing");
        assert!((of_image / ours.value - 1.0).abs() < 0.04, "{key}: {of_image} is not {}", ours.value);
    }
    // The broken twin: the same picture about the line of sight.
    let ahead = Some(Cone { direction: DVec3::Z, opening_rad: 24f64.to_radians() });
    let twin =
        glare_of_image(&image, None, &OfImage { task: ahead, ..OfImage::default() }).expect("evaluated");
    let (own, other) = (glare.zones.unwrap().unwrap(), twin.zones.unwrap().unwrap());
    assert!((other.task.0 / own.task.0 - 1.0).abs() > 0.1, "{own:?} {other:?}");
    assert!(twin.readings.len() > KEYS.len());
    let none = glare_of_image(&image, None, &OfImage::default()).expect("evaluated");
    assert!(
        none.readings.iter().all(|reading| !KEYS.contains(&reading.key)),
        "no task, no luminances of one"
    );
}

const ROOM: &str = "[scene]\nbox = { size = [6, 4, 2.8], floor = 0.3, walls = 0.5, ceiling = 0.8 }\n\
    [luminaires.A]\nlambert = { flux = 3000 }\narea = { rect = [1.2, 0.3] }\n\
    [[place]]\nluminaire = \"A\"\nat = [4.5, 2.0, 2.7]\n\
    [[viewpoint]]\nname = \"Seat\"\neye = [1, 2, 1.2]\ndirection = [1, 0, 0]\n";

/// Catches: a requirement that makes no zones, a limit held the wrong way, a figure that a report leaves out or names
/// as another.
#[test]
fn ratios_are_required_reported_and_named() {
    let require = |key: &str, bound: &str| {
        format!("[[require]]\nviewpoint = \"Seat\"\nquantity = \"{key}\"\n{bound}\n")
    };
    let found = figures(&run(&format!("{ROOM}task_deg = 20\n"), &[], 64, Effort::default()));
    let [_, _, _, to_surround, to_far] = found;
    let text = format!(
        "[project]\nname = \"T\"\nlanguage = [\"en\", \"ru\"]\n{ROOM}{}{}{}",
        require("L_task/L_surround", &format!("max = {}", 1.5 * to_surround.value)),
        require("L_task/L_far", &format!("min = {}", 1.5 * to_far.value)),
        require("L_surround", "min = 1000"),
    );
    let outcome = run(&text, &[], 64, Effort::default());
    let verdicts: Vec<Verdict> = outcome.requirements.iter().map(|one| one.verdict).collect();
    assert_eq!(verdicts, [Verdict::Pass, Verdict::Fail, Verdict::Fail]);
    assert!(outcome.requirements[0].note.contains("cone of 20° about the line of sight"), "the default task");
    let printed = table(&outcome, Style { lang: Lang::En, colour: Colour::Plain });
    assert!(printed.contains("L_task/L_surround") && printed.contains("L_surround"), "{printed}");
    let options = Options { languages: vec![Lang::En, Lang::Ru], dialect: Dialect::Standard };
    let written = files(&outcome, &options).expect("a report");
    let file = |name: &str| {
        let (_, bytes) = written.iter().find(|(known, _)| known == name).expect("written");
        String::from_utf8(bytes.clone()).expect("UTF-8")
    };
    let page = file("report.html");
    for words in [
        "luminance of the task to its surround",
        "отношение яркости рабочего поля к яркости окружения",
        "рабочее поле – конус 20° вокруг линии зрения",
    ] {
        assert!(page.contains(words), "{words}");
    }
    assert!(file("viewpoints.csv").lines().any(|line| line.contains(",L_task/L_surround,")));
    let json: serde_json::Value = serde_json::from_str(&file("result.json")).expect("JSON");
    let indices = json["rooms"][0]["viewpoints"][0]["indices"].as_array().expect("indices");
    let keys: Vec<&str> = indices.iter().filter_map(|index| index["index"].as_str()).collect();
    assert_eq!(keys, ["L_task/L_surround", "L_task/L_far", "L_surround"]);
}

/// Catches: a mistake without its line or hint, a number that is heeded though it cannot be.
#[test]
fn a_task_that_cannot_be_seen_is_refused_with_its_line() {
    let cases = [
        ("task = [0.5, 2, 1.2]", "the task lies behind the eye", "within 90° of the line of sight"),
        ("task = [1, 2, 1.2]", "the task lies in the eye", "the point looked at"),
        ("task_deg = 60", "task_deg must lie between 0 and 60, found 60", "its surround ends"),
        ("task_deg = 0", "task_deg must lie between 0 and 60, found 0", "full opening angle"),
        ("task = [1, nan, 1]", "coordinates must be finite", ""),
    ];
    for (line, message, hint) in cases {
        let text = format!("{ROOM}{line}\n");
        let errors = load(folder(&text, &[]).path(), &LoadOptions::default()).expect_err("refused");
        assert_eq!(errors.len(), 1, "{line}: {errors:?}");
        assert_eq!(errors[0].line, text.lines().count(), "{}", errors[0]);
        assert!(errors[0].message.contains(message) && errors[0].hint.contains(hint), "{}", errors[0]);
    }
    let map = "[[glare_map]]\nrect = { origin = [0, 0, 1.2], u = [6, 0, 0], v = [0, 4, 0] }\nstep = 1\nindices = [\"L_task\"]\n";
    let text = format!("{ROOM}{map}");
    let errors = load(folder(&text, &[]).path(), &LoadOptions::default()).expect_err("refused");
    assert!(
        errors[0].hint.contains("[[viewpoint]]") && errors[0].line == text.lines().count(),
        "{}",
        errors[0]
    );
    // Of a sweep past a task some directions have it before them, and the others say why they have no luminances.
    let sweep = ROOM.replace("direction = [1, 0, 0]", "sweep = { from = 0, to = 180, step = 180 }");
    let outcome = run(&format!("{sweep}task = [3, 2, 0.8]\n"), &[], 32, Effort::default());
    let views = &outcome.rooms[0].viewpoints;
    assert!(views[0].indices.iter().all(|index| index.estimate.is_ok()), "{:?}", views[0].indices);
    let reasons = views[1].indices.iter().filter_map(|index| index.estimate.as_ref().err());
    assert_eq!(reasons.filter(|why| why.reason == "the task lies behind the eye").count(), KEYS.len());
    // What is certain where the task is seen is not hidden by where it is not.
    for (bound, verdict) in [("max = 0.01", Verdict::Fail), ("min = 0.01", Verdict::Pass)] {
        let require = format!("[[require]]\nviewpoint = \"Seat\"\nquantity = \"L_task\"\n{bound}\n");
        let outcome = run(&format!("{sweep}task = [3, 2, 0.8]\n{require}"), &[], 32, Effort::default());
        let found = &outcome.requirements[0];
        assert_eq!(found.verdict, verdict, "{bound}: {:?}", found.value);
        assert!(found.note.contains("directions that have the task behind the eye"), "{}", found.note);
    }
}
