//! Answers a person can work out with a pencil, asked through whole project files: reader, plan,
//! solver and measure together. A factor lost anywhere on the line fails here.

#![allow(clippy::float_cmp, reason = "what is exact is compared exactly")]

mod projects;

use std::f64::consts::PI;

use gershun::outcome::{Outcome, PointValue};
use gershun::solve::Effort;
use projects::{File, agrees, check, facing, gltf, point, point_in, points, run, shell, spot, square, ugr};

/// Flux of a point source of 1000 cd.
const FLUX: f64 = 4.0 * PI * 1000.0;

fn exact(what: &str, found: PointValue, truth: f64) {
    assert!(found.se == 0.0 && found.lo == found.value && found.hi == found.value, "{what}: {found:?}");
    check(what, found.value, found.se, truth, 0.0);
}

fn quick() -> Effort {
    Effort { particles: 16, ..Effort::default() }
}

fn thorough() -> Effort {
    Effort { gather: 256, walks: 64, particles: 16, ..Effort::default() }
}

fn few(text: &str) -> Outcome {
    run(text, &[], 2, quick())
}

/// A black box of 4 × 4 × 3 m with a point source of 1000 cd at (2, 2, 2.75).
fn black(luminaire: &str, place: &str, rest: &str) -> String {
    format!(
        "[scene]\nbox = {{ size = [4, 4, 3], floor = 0, walls = 0, ceiling = 0 }}\n\
         [luminaires.A]\npoint = {{ flux = {FLUX} }}\n{luminaire}\n\
         [[place]]\nluminaire = \"A\"\nat = [2, 2, 2.75]\n{place}\n{rest}"
    )
}

/// Catches: 4π or π mixed up, a distance or cosine applied twice, noise where there can be none.
#[test]
fn a_point_source_gives_its_candelas_over_the_distance_squared() {
    let rest = spot("below", [2.0, 2.0, 0.75], r#""E_h""#) + &spot("aside", [0.5, 2.0, 0.75], r#""E_h""#);
    let outcome = few(&black("", "", &rest));
    exact("below", point(&outcome, "below", "E_h"), 250.0);
    // To the last digits: a receiver in free space is not moved.
    assert!((point(&outcome, "below", "E_h").value - 250.0).abs() < 1e-9);
    exact("aside", point(&outcome, "aside", "E_h"), 1000.0 * 2.0 / 6.25f64.powf(1.5));
}

/// Catches: maintenance, a room's RSMF or `dim` left out, or applied twice.
#[test]
fn maintenance_and_dimming_are_factors_of_illuminance() {
    let rest = spot("below", [2.0, 2.0, 0.75], r#""E_h""#);
    let value = |luminaire: &str, place: &str, more: &str| {
        point(&few(&black(luminaire, place, &(rest.clone() + more))), "below", "E_h")
    };
    exact("whole factor", value("maintenance = 0.8", "", ""), 200.0);
    let parts = "maintenance = { llmf = 0.9, lsf = 0.95, lmf = 0.8 }";
    exact("parts", value(parts, "", ""), 250.0 * 0.9 * 0.95 * 0.8);
    let room = "[[room]]\nname = \"R\"\nmf = { llmf = 0.9, lsf = 1, lmf = 0.5, rsmf = 0.7 }";
    exact("the room's factors", value("", "", room), 250.0 * 0.9 * 0.5 * 0.7);
    exact("the type's own win, RSMF stays", value("maintenance = 0.8", "", room), 250.0 * 0.8 * 0.7);
    exact("dim", value("", "dim = 0.5", ""), 125.0);
    exact("flux overrides", value("", "dim = 0.25", ""), 62.5);
}

/// Catches: a scene that leaves unlisted groups on, factors not multiplied with `dim`, scenes mixed up.
#[test]
fn light_scenes_are_sums_of_groups_and_unlisted_groups_are_off() {
    let rest = "group = \"a\"\n[[place]]\nluminaire = \"A\"\nat = [3, 2, 2.75]\ngroup = \"b\"\ndim = 0.5\n\
                [light_scenes]\nboth = { a = 1, b = 1 }\nonly-a = { a = 1 }\nhalf-b = { b = 0.5 }\nnone = {}\n"
        .to_owned()
        + &spot("below", [2.0, 2.0, 0.75], r#""E_h""#);
    let outcome = few(&black("", "", &rest));
    let e = |scene: &str| point_in(&outcome, "below", "E_h", scene);
    let (a, b) = (250.0, 0.5 * 1000.0 * 2.0 / 5f64.powf(1.5));
    exact("both", e("both"), a + b);
    exact("only a", e("only-a"), a);
    exact("half of b", e("half-b"), 0.5 * b);
    assert_eq!(e("none").value, 0.0);
}

const GREY: &str = "[scene]\nbox = { size = [6, 4, 3], floor = 0.2, walls = 0.5, ceiling = 0.7 }\n";

fn observer(luminaire: &str, place: &str, scenes: &str) -> String {
    format!(
        "{GREY}[luminaires.A]\nlambert = {{ flux = 3000 }}\narea = {{ rect = [1.25, 0.25] }}\n{luminaire}\n\
         [[place]]\nluminaire = \"A\"\nat = [4, 2.5, 2.875]\n{place}\n{scenes}\n\
         [[viewpoint]]\nname = \"V\"\neye = [1, 2, 1.25]\ndirection = [1, 0, 0]\n{}",
        spot("desk", [2.0, 2.0, 0.75], r#""E_h""#)
    )
}

/// Catches: UGR from maintained flux, L² or L_b not scaled, dimming that changes the random numbers.
#[test]
fn maintenance_leaves_ugr_alone_and_half_the_light_takes_2_408() {
    let run = |text: &str| run(text, &[], 8, quick());
    let full = run(&observer("", "", ""));
    let (e, glare) = (point(&full, "desk", "E_h").value, ugr(&full, "V", "all").value);
    let maintained = run(&observer("maintenance = 0.8", "", ""));
    let close = |a: f64, b: f64, tolerance: f64| assert!((a - b).abs() <= tolerance, "{a} is not {b}");
    close(point(&maintained, "desk", "E_h").value, 0.8 * e, 1e-9 * e);
    close(ugr(&maintained, "V", "all").value, glare, 1e-12);
    let dimmed = run(&observer("", "dim = 0.5", ""));
    close(point(&dimmed, "desk", "E_h").value, 0.5 * e, 1e-9 * e);
    close(ugr(&dimmed, "V", "all").value, glare - 2.408, 0.005);
    let scenes = run(&observer("", "", "[light_scenes]\nfull = { A = 1 }\nhalf = { A = 0.5 }"));
    close(point_in(&scenes, "desk", "E_h", "half").value, 0.5 * e, 1e-9 * e);
    close(point_in(&scenes, "desk", "E_h", "full").value, e, 1e-9 * e);
    close(ugr(&scenes, "V", "half").value, glare - 2.408, 0.005);
    let twice = run(&observer("flux = 6000", "", "")
        .replace("lambert = { flux = 3000 }\n", "")
        .replace("flux = 6000", "lambert = { flux = 6000 }"));
    close(ugr(&twice, "V", "all").value, glare + 2.408, 0.005);
}

/// Catches: a response with a wrong constant, the semicylinder facing away, angles from the wrong axis.
#[test]
fn spatial_illuminances_of_a_point_source_are_their_closed_forms() {
    // From (0.5, 0.75, 0.75) to (2, 2, 2.75): (1.5, 1.25, 2).
    let keys = r#""E_cyl", "E_semi@0", "E_semi@130", "E_semi@219.80557109226518", "E_hemi", "E_sph", "E_v@0", "E_v@90", "E_v@180", "E_n", "modelling""#;
    let outcome = few(&black("", "", &spot("P", [0.5, 0.75, 0.75], keys)));
    let d2 = 1.5f64 * 1.5 + 1.25 * 1.25 + 4.0;
    let (sin, cos) = ((1.5f64 * 1.5 + 1.25 * 1.25).sqrt() / d2.sqrt(), 2.0 / d2.sqrt());
    let normal = 1000.0 / d2;
    let azimuth = 1.25f64.atan2(1.5);
    let semi = |facing_deg: f64| normal * sin * (1.0 + (facing_deg.to_radians() - azimuth).cos()) / PI;
    let of = |key: &str| point(&outcome, "P", key);
    exact("E_cyl", of("E_cyl"), normal * sin / PI);
    exact("E_semi@0", of("E_semi@0"), semi(0.0));
    exact("E_semi@130", of("E_semi@130"), semi(130.0));
    assert!(
        of("E_semi@219.80557109226518").value.abs() < 1e-9 * normal,
        "a semicylinder sees nothing behind it"
    );
    exact("E_hemi", of("E_hemi"), normal * (1.0 + cos) / 4.0);
    exact("E_sph", of("E_sph"), normal / 4.0);
    exact("E_v@0", of("E_v@0"), normal * 1.5 / d2.sqrt());
    exact("E_v@90", of("E_v@90"), normal * 1.25 / d2.sqrt());
    assert_eq!(of("E_v@180").value, 0.0);
    exact("E_n", of("E_n"), normal * cos);
    let modelling = of("modelling");
    assert!((modelling.value - sin / PI / cos).abs() < 1e-7, "{modelling:?}");
}

/// cd towards γ and the azimuth from the luminaire's length (+x) towards +y. Different on all sides.
fn lopsided(azimuth_deg: f64, gamma_deg: f64) -> f64 {
    let (a, g) = (azimuth_deg.to_radians(), gamma_deg.to_radians());
    1000.0 * g.cos() * (1.0 + g.sin() * (0.6 * a.cos() + 0.3 * a.sin()) + 0.2 * g.sin() * (2.0 * a).cos())
}

/// The lopsided luminaire of 1.2 × 0.1 m (or without an opening) as EULUMDAT: C0 lies towards −y.
fn ldt(sized: bool) -> File {
    let (length, width) = if sized { (1200, 100) } else { (0, 0) };
    let mut lines: Vec<String> =
        ["gershun", "1", "0", "24", "15", "19", "5", "", "lopsided", "", "lop.ldt", "today"]
            .map(str::to_owned)
            .into();
    lines.extend([length, width, 0, length, width, 0, 0, 0, 0].map(|mm| mm.to_string()));
    lines.extend(["100", "100", "1", "0", "1", "1", "LED", "1000", "4000", "80", "10"].map(str::to_owned));
    lines.extend(std::iter::repeat_n("0".to_owned(), 10));
    lines.extend((0..24).map(|c| (15 * c).to_string()));
    lines.extend((0..19).map(|g| (5 * g).to_string()));
    for c in 0..24 {
        for g in 0..19 {
            lines.push(format!("{:.4}", lopsided(f64::from(15 * c) - 90.0, f64::from(5 * g))));
        }
    }
    ("lop.ldt".into(), (lines.join("\r\n") + "\r\n").into_bytes())
}

/// The same as LM-63: the 0° plane lies towards +x.
fn ies(sized: bool) -> File {
    let (width, length) = if sized { ("0.1", "1.2") } else { ("0", "0") };
    let mut text = format!(
        "IESNA:LM-63-2002\r\n[TEST] 1\r\n[TESTLAB] none\r\n[ISSUEDATE] today\r\n[MANUFAC] gershun\r\nTILT=NONE\r\n\
         1 -1 1 19 25 1 2 {width} {length} 0\r\n1 1 10\r\n"
    );
    let row = |values: Vec<String>| values.join(" ") + "\r\n";
    text += &row((0..19).map(|g| (5 * g).to_string()).collect());
    text += &row((0..25).map(|c| (15 * c).to_string()).collect());
    for c in 0..25 {
        text +=
            &row((0..19).map(|g| format!("{:.4}", lopsided(f64::from(15 * c), f64::from(5 * g)))).collect());
    }
    ("lop.ies".into(), text.into_bytes())
}

/// Both files at the middle of a black cube of 4 m, once for each way of hanging: groups L0, I0, L1 …
fn hung(ways: &[&str], areas: &str, sized: bool) -> Outcome {
    let mut text = "[scene]\nbox = { size = [4, 4, 4], floor = 0, walls = 0, ceiling = 0 }\n\
                    [luminaires.L]\nfile = \"lop.ldt\"\n[luminaires.I]\nfile = \"lop.ies\"\n"
        .to_owned();
    let mut scenes = "[light_scenes]\n".to_owned();
    for (number, way) in ways.iter().enumerate() {
        for kind in ["L", "I"] {
            let group = format!("{kind}{number}");
            text +=
                &format!("[[place]]\nluminaire = \"{kind}\"\nat = [2, 2, 2]\ngroup = \"{group}\"\n{way}\n");
            scenes += &format!("{group} = {{ {group} = 1 }}\n");
        }
    }
    run(&(text + &scenes + areas), &[ldt(sized), ies(sized)], 2, quick())
}

/// E of I(azimuth, 45°) at √2 m under 45°… with the wall or floor 1 m away.
fn at_45(azimuth_deg: f64) -> f64 {
    lopsided(azimuth_deg, 45.0) * 0.5f64.sqrt() / 2.0
}

fn sides(outcome: &Outcome, way: usize, expected: [(&str, f64); 4]) {
    for kind in ["L", "I"] {
        let scene = format!("{kind}{way}");
        for (side, azimuth_deg) in expected {
            let (found, truth) = (point_in(outcome, side, "E_n", &scene).value, at_45(azimuth_deg));
            assert!((found / truth - 1.0).abs() < 1e-5, "{scene} {side}: {found} lx is not {truth}");
        }
    }
}

/// Catches: EULUMDAT's C0 taken for the length axis (the 90° trap), LM-63's 0° taken across, planes
/// counted clockwise, `rotate` turning the wrong way.
#[test]
fn an_asymmetric_luminaire_lights_the_side_it_should_in_both_formats_at_four_rotations() {
    let areas = spot("+x", [3.0, 2.0, 1.0], r#""E_n""#)
        + &spot("+y", [2.0, 3.0, 1.0], r#""E_n""#)
        + &spot("-x", [1.0, 2.0, 1.0], r#""E_n""#)
        + &spot("-y", [2.0, 1.0, 1.0], r#""E_n""#);
    let ways = ["", "rotate = 90", "rotate = 180", "rotate = 270"];
    let outcome = hung(&ways, &areas, false);
    for (way, turned) in [0.0, 90.0, 180.0, 270.0].into_iter().enumerate() {
        // Seen against the aim, from below, counter-clockwise: clockwise in plan.
        let local = |world: f64| world + turned;
        let expected = [("+x", local(0.0)), ("+y", local(90.0)), ("-x", local(180.0)), ("-y", local(270.0))];
        sides(&outcome, way, expected);
    }
}

/// Catches: an aim that rolls the luminaire, `target` taken for a direction, +z without a defined roll.
#[test]
fn an_aimed_luminaire_keeps_its_sides() {
    let look = [[0.0, 0.25, 0.0], [0.0, 0.0, -0.25]];
    let onto_x = |name: &str, at: [f64; 3]| facing(name, at, look, r#""E_n""#);
    let areas = onto_x("up", [3.0, 2.0, 3.0])
        + &onto_x("down", [3.0, 2.0, 1.0])
        + &onto_x("+y", [3.0, 3.0, 2.0])
        + &onto_x("-y", [3.0, 1.0, 2.0]);
    let ways = ["aim = [5, 0, 0]", "target = [4, 2, 2]", "aim = [1, 0, 0]\nrotate = 90"];
    let outcome = hung(&ways, &areas, false);
    // The shortest turn from −z to +x lifts the length axis to +z.
    let straight = [("up", 0.0), ("+y", 90.0), ("down", 180.0), ("-y", 270.0)];
    sides(&outcome, 0, straight);
    sides(&outcome, 1, straight);
    // Against the aim +y is on the right: counter-clockwise takes the length axis from +z to −y.
    sides(&outcome, 2, [("-y", 0.0), ("up", 90.0), ("+y", 180.0), ("down", 270.0)]);

    let down = [[0.0, 0.25, 0.0], [0.25, 0.0, 0.0]];
    let onto_z = |name: &str, at: [f64; 3]| facing(name, at, down, r#""E_n""#);
    let areas = onto_z("+x", [3.0, 2.0, 3.0])
        + &onto_z("+y", [2.0, 3.0, 3.0])
        + &onto_z("-x", [1.0, 2.0, 3.0])
        + &onto_z("-y", [2.0, 1.0, 3.0]);
    let outcome = hung(&["aim = [0, 0, 1]"], &areas, false);
    sides(&outcome, 0, [("+x", 0.0), ("-y", 90.0), ("-x", 180.0), ("+y", 270.0)]);
}

/// Catches: the opening's length laid across in one of the formats; near it that is a third of E.
#[test]
fn an_opening_lies_the_same_way_in_both_formats() {
    let areas = spot("end", [2.75, 2.0, 1.75], r#""E_h""#) + &spot("side", [2.0, 2.75, 1.75], r#""E_h""#);
    let outcome = hung(&["", "rotate = 90", "rotate = 180", "rotate = 270"], &areas, true);
    let e = |area: &str, scene: &str| point_in(&outcome, area, "E_h", scene).value;
    for way in 0..4 {
        for area in ["end", "side"] {
            let (l, i) = (e(area, &format!("L{way}")), e(area, &format!("I{way}")));
            assert!((l / i - 1.0).abs() < 2e-3, "{area} {way}: {l} as LDT, {i} as IES");
        }
    }
    assert!(e("end", "I0") > 1.5 * e("end", "I1"), "the length lies along x until it is turned");
    assert!(e("end", "L0") > 1.5 * e("end", "L1"));
}

fn cad(materials: &str, rest: &str) -> String {
    format!(
        "[scene]\nfile = \"scene.gltf\"\n[materials]\nshell = {{ reflectance = 0 }}\n{materials}\n\
         [luminaires.A]\npoint = {{ flux = {FLUX} }}\n[[place]]\nluminaire = \"A\"\nat = [2, 2, 2.75]\n{rest}"
    )
}

fn with_sheets(sheets: &[projects::Sheet]) -> Vec<File> {
    let mut all = shell([4.0, 4.0, 3.0]);
    all.extend_from_slice(sheets);
    gltf(&all)
}

/// Catches: transmittance per surface instead of per pane, a pane counted once for each of the two
/// triangles when a ray meets their common edge, panes that do not multiply.
#[test]
fn a_clear_pane_at_normal_incidence_multiplies_by_its_transmittance() {
    let rest = spot("below", [2.0, 2.0, 0.75], r#""E_h""#);
    let text = cad("pane = { glass = 0.875 }", &rest);
    let beside = with_sheets(&[square("Pane", "pane", [2.25, 2.0, 1.5], 0.75)]);
    exact("beside the diagonal", point(&run(&text, &beside, 2, quick()), "below", "E_h"), 250.0 * 0.875);
    let diagonal = with_sheets(&[square("Pane", "pane", [2.0, 2.0, 1.5], 0.75)]);
    exact("on the diagonal", point(&run(&text, &diagonal, 2, quick()), "below", "E_h"), 250.0 * 0.875);
    let two = with_sheets(&[
        square("Pane", "pane", [2.0, 2.0, 1.5], 0.75),
        square("Pane 2", "pane", [2.25, 2.0, 2.0], 0.75),
    ]);
    exact("two panes", point(&run(&text, &two, 2, quick()), "below", "E_h"), 250.0 * 0.875 * 0.875);
}

/// Catches: a measured pane read at another angle than that between ray and normal, or by its cosine.
#[test]
fn a_measured_pane_passes_what_its_table_says_at_the_angle_of_incidence() {
    let pane = "pane = { glass = { angle = [0, 30, 60, 90], transmittance = [0.6, 0.5, 0.3, 0], reflectance = [0, 0, 0, 0] } }";
    let wide = with_sheets(&[square("Pane", "pane", [2.0, 2.0, 1.5], 1.9)]);
    for (angle_deg, passed) in [(0.0f64, 0.6), (30.0, 0.5), (40.0, 0.5 - 0.2 / 3.0)] {
        let (sin, cos) = angle_deg.to_radians().sin_cos();
        let text = cad(pane, &spot("below", [2.0 + 2.0 * sin / cos, 2.0, 0.75], r#""E_h""#));
        let direct = 250.0 * cos.powi(3) * passed;
        exact(&format!("{angle_deg}°"), point(&run(&text, &wide, 2, quick()), "below", "E_h"), direct);
    }
}

/// Catches: `body` that frees all luminaires of the plate, or frees none.
#[test]
fn a_body_is_transparent_to_its_own_luminaire_only() {
    let rest = "[luminaires.B]\npoint = { flux = 1256.6370614359173 }\n[[place]]\nluminaire = \"B\"\nat = [2, 2, 2.5]\n\
                [light_scenes]\nown = { A = 1 }\nother = { B = 1 }\n"
        .to_owned()
        + &spot("below", [2.0, 2.0, 0.75], r#""E_h""#);
    let text = cad("plate = { reflectance = 0 }", &rest)
        .replace("[[place]]\nluminaire = \"A\"", "body = [\"Plate\"]\n[[place]]\nluminaire = \"A\"");
    let outcome = run(&text, &with_sheets(&[square("Plate", "plate", [2.25, 2.0, 2.0], 0.5)]), 2, quick());
    exact("own", point_in(&outcome, "below", "E_h", "own"), 250.0);
    assert_eq!(point_in(&outcome, "below", "E_h", "other").value, 0.0);
}

/// Catches: an image at the wrong distance, ρ squared or forgotten, light behind the mirror.
#[test]
fn a_mirror_wall_shows_the_lamp_at_its_image() {
    let rest = "[materials]\nWall_E = { mirror = 0.9 }\n".to_owned()
        + &spot("desk", [1.0, 2.0, 0.75], r#""E_h", "E_v@0", "E_v@180""#);
    let outcome = few(&black("", "", &rest));
    // The image of (2, 2, 2.75) in x = 4 is (6, 2, 2.75).
    let (d, image) = (5f64, 29f64);
    let e = |key: &str| point(&outcome, "desk", key);
    exact("E_h", e("E_h"), 1000.0 * 2.0 / d.powf(1.5) + 0.9 * 1000.0 * 2.0 / image.powf(1.5));
    exact("E_v@0", e("E_v@0"), 1000.0 * 1.0 / d.powf(1.5) + 0.9 * 1000.0 * 5.0 / image.powf(1.5));
    assert_eq!(e("E_v@180").value, 0.0);
    let direct = e("E_h").direct;
    assert!((direct - 2000.0 / d.powf(1.5)).abs() < 1e-6, "the image is not direct light: {direct}");
}

/// E on a point that faces a horizontal square sheet (half-edge 0.75 at (2, 2, 1.5)) which is lit by the
/// point source and scatters `factor` of it diffusely: midpoint rule, 1e-6.
fn scattered(factor: f64, x: f64, y: f64, distance: f64) -> f64 {
    let n = 400;
    let cell = 1.5 / f64::from(n);
    let mut sum = 0.0;
    for i in 0..n {
        for j in 0..n {
            let at = [1.25 + (f64::from(i) + 0.5) * cell, 1.25 + (f64::from(j) + 0.5) * cell];
            let lamp = (at[0] - 2.0).powi(2) + (at[1] - 2.0).powi(2) + 1.25 * 1.25;
            let luminance = factor / PI * 1000.0 * 1.25 / lamp.powf(1.5);
            let r2 = (at[0] - x).powi(2) + (at[1] - y).powi(2) + distance * distance;
            sum += luminance * distance * distance / (r2 * r2) * cell * cell;
        }
    }
    sum
}

fn sheet_answers(material: &str, flipped: bool) -> [PointValue; 2] {
    let down = [[0.0, 0.25, 0.0], [0.25, 0.0, 0.0]];
    let rest =
        spot("below", [2.0, 2.25, 0.5], r#""E_n""#) + &facing("above", [2.5, 2.0, 2.25], down, r#""E_n""#);
    let (name, of, mut corners) = square("Sheet", "sheet", [2.0, 2.0, 1.5], 0.75);
    if flipped {
        corners.reverse();
    }
    let files = with_sheets(&[(name, of, corners)]);
    let outcome = run(&cad(&format!("sheet = {material}"), &rest), &files, 128, thorough());
    ["below", "above"].map(|area| point(&outcome, area, "E_n"))
}

/// Catches: τ and ρ swapped, light lost on the far side, a back side that is black, π twice.
#[test]
fn an_opal_sheet_scatters_to_both_sides_and_a_white_one_to_the_lit_side_however_it_is_drawn() {
    let truth = |factor: f64| [scattered(factor, 2.0, 2.25, 1.0), scattered(factor, 2.5, 2.0, 0.75)];
    let (below, above) = (truth(0.5)[0], truth(0.25)[1]);
    let white = truth(0.75)[1];
    for flipped in [false, true] {
        let found = sheet_answers("{ opal = { reflectance = 0.25, transmittance = 0.5 } }", flipped);
        check("through opal", found[0].value, found[0].se, below, 0.02);
        check("back from opal", found[1].value, found[1].se, above, 0.02);
        let found = sheet_answers("{ reflectance = 0.75 }", flipped);
        assert_eq!(found[0].value, 0.0, "a white sheet is opaque");
        check("white", found[1].value, found[1].se, white, 0.02);
    }
    // The broken twin: 4 % more transmittance is noticed.
    let twin = sheet_answers("{ opal = { reflectance = 0.25, transmittance = 0.52 } }", false);
    assert!(agrees(twin[0].value, twin[0].se, below, 0.02).is_err(), "the check cannot fail");
}

/// Catches: `emit` taken for luminous exitance (π), emission of one side only, a light scene that
/// does not switch the surface.
#[test]
fn a_luminous_ceiling_gives_its_luminance_times_the_form_factor() {
    let text = |emit: f64| {
        format!(
            "[scene]\nbox = {{ size = [4, 3, 2.5], floor = 0, walls = 0, ceiling = \"Sky\" }}\n\
             [materials]\nSky = {{ emit = {emit} }}\n[light_scenes]\non = {{ Sky = 1 }}\nhalf = {{ Sky = 0.5 }}\noff = {{}}\n{}",
            spot("desk", [2.0, 1.5, 0.5], r#""E_h""#)
        )
    };
    // Four parallel rectangles of 2 × 1.5 m over a corner at 2 m: F of one, closed form.
    let (a, b) = (2.0f64 / 2.0, 1.5f64 / 2.0);
    let (sa, sb) = ((1.0 + a * a).sqrt(), (1.0 + b * b).sqrt());
    let corner = (a / sa * (b / sa).atan() + b / sb * (a / sb).atan()) / (2.0 * PI);
    let truth = PI * 1000.0 * 4.0 * corner;
    let outcome = run(&text(1000.0), &[], 128, thorough());
    let e = |scene: &str| point_in(&outcome, "desk", "E_h", scene);
    check("on", e("on").value, e("on").se, truth, 0.02);
    assert!((e("half").value / e("on").value - 0.5).abs() < 1e-12);
    assert_eq!(e("off").value, 0.0);
    let twin = point_in(&run(&text(1040.0), &[], 128, thorough()), "desk", "E_h", "on");
    assert!(agrees(twin.value, twin.se, truth, 0.02).is_err(), "the check cannot fail");
}

fn furnace(rho: f64) -> Outcome {
    let text = format!(
        "[scene]\nbox = {{ size = [4, 3, 2.5], floor = \"Hot\", walls = \"Hot\", ceiling = \"Hot\" }}\n\
         [materials]\nHot = {{ emit = 100, reflectance = {rho} }}\n{}{}",
        spot(
            "air",
            [1.0, 1.0, 1.0],
            r#""E_h", "E_v@30", "E_cyl", "E_semi@10", "E_hemi", "E_sph", "L@20,10""#
        ),
        "[[area]]\nname = \"floor\"\nsurface = \"Floor\"\ngrid = { count = [3, 2] }\nquantities = [\"E_n\"]\n"
    );
    let effort = Effort { patch_m2: Some(0.25), ..thorough() };
    run(&text, &[], 64, effort)
}

/// Catches: energy gained or lost at a bounce, a bias of the stored field that walks do not remove,
/// a series cut short.
#[test]
fn a_furnace_is_uniform_at_every_reflectance() {
    for (rho, resolve) in [(0.0, 1e-6), (0.5, 0.01), (0.9, 0.02)] {
        let outcome = furnace(rho);
        let truth = PI * 100.0 / (1.0 - rho);
        for key in ["E_h", "E_v@30", "E_cyl", "E_semi@10", "E_hemi", "E_sph"] {
            let found = point(&outcome, "air", key);
            // A mixture of densities leaves some noise in each response even of a uniform field.
            check(&format!("{key} at {rho}"), found.value, found.se, truth, f64::max(resolve, 0.01));
        }
        let luminance = point(&outcome, "air", "L@20,10");
        check("L", luminance.value, luminance.se, truth / PI, f64::max(resolve, 0.03));
        for found in points(&outcome, "floor", "E_n", "all") {
            check(&format!("floor at {rho}"), found.value, found.se, truth, resolve);
        }
    }
    let twin = points(&furnace(0.51), "floor", "E_n", "all");
    let truth = PI * 100.0 / 0.5;
    assert!(twin.iter().all(|p| agrees(p.value, p.se, truth, 0.01).is_err()), "the check cannot fail");
}

/// Catches: walks cut at high reflectance, the field's sweeps ended early without the residual that
/// makes up for it, a tally that loses particles. The room as an integrating sphere: Σ E A (1 − ρ) = Φ.
#[test]
fn at_99_percent_the_surfaces_absorb_what_the_lamp_gives() {
    let names = ["Floor", "Ceiling", "Wall_S", "Wall_N", "Wall_E", "Wall_W"];
    let areas = names.map(|name| {
        format!("[[area]]\nname = \"{name}\"\nsurface = \"{name}\"\ngrid = {{ count = [4, 4] }}\nquantities = [\"E_n\"]\n")
    });
    let areas = areas.concat();
    let text = format!(
        "[scene]\nbox = {{ size = [4, 4, 3], floor = 0.99, walls = 0.99, ceiling = 0.99 }}\n\
         [luminaires.A]\npoint = {{ flux = 1000 }}\n[[place]]\nluminaire = \"A\"\nat = [2, 2, 1.5]\n{areas}"
    );
    let effort = Effort { patch_m2: Some(0.25), particles: 256, walks: 4, ..Effort::default() };
    let outcome = run(&text, &[], 64, effort);
    let (mut absorbed, mut error) = (0.0, 0.0);
    for name in names {
        let cell = if matches!(name, "Floor" | "Ceiling") { 1.0 } else { 0.75 };
        for p in points(&outcome, name, "E_n", "all") {
            absorbed += 0.01 * p.value * cell;
            // Points share the field but not their rays: adding errors linearly bounds them.
            error += 0.01 * p.se * cell;
        }
    }
    println!("absorbed {absorbed} ± {error} lm of 1000");
    // The grid's midpoint rule for the direct 1 % costs at most 0.05 %.
    assert!(5.0 * error <= 0.05 * 1000.0, "cannot resolve 5 %: {error}");
    assert!((absorbed - 1000.0).abs() <= 5.0 * error + 0.5, "{absorbed} ± {error}");
    let balance = &outcome.rooms[0].flux[0];
    assert!((balance.emitted_lm - 1000.0).abs() < 1e-6);
    check("tally", balance.absorbed.value, balance.absorbed.se, 1000.0, 1e-6);
    let incident: f64 = balance.surfaces.iter().map(|s| s.incident.value).sum();
    let se: f64 = balance.surfaces.iter().map(|s| s.incident.se).sum();
    check("incident", incident, se, 100_000.0, 0.15);
}

/// Catches: a wall measured on its back, since its edges were listed the other way round; a ceiling likewise.
#[test]
fn walls_and_ceilings_are_measured_in_the_room_whichever_way_their_edges_run() {
    let area = |name: &str, shape: &str| {
        format!(
            "[[area]]\nname = \"{name}\"\nkind = \"surface\"\n{shape}\ngrid = {{ count = [3, 1] }}\nquantities = [\"E_n\"]\n"
        )
    };
    let wall = [("u = [4, 0, 0], v = [0, 0, 3]", "a"), ("u = [0, 0, 3], v = [4, 0, 0]", "b")];
    let ceiling = [("u = [4, 0, 0], v = [0, 4, 0]", "c"), ("u = [0, 4, 0], v = [4, 0, 0]", "d")];
    let rect = |z: f64, (edges, name): (&str, &str)| {
        area(name, &format!("rect = {{ origin = [0, 0.001, {z}], {edges} }}"))
    };
    let polygon = area("p", "polygon = [[0, 0, 3], [4, 0, 3], [4, 4, 3], [0, 4, 3]]");
    let rest: String = wall.iter().map(|one| rect(0.0, *one)).collect::<String>()
        + &ceiling.iter().map(|one| rect(2.999, *one)).collect::<String>()
        + &polygon;
    let outcome = few(&black("", "aim = [0, -1, 1]", &rest));
    let mean = |name: &str| {
        let values = points(&outcome, name, "E_n", "all");
        values.iter().map(|point| point.value).sum::<f64>() / values.len() as f64
    };
    for [one, other] in [["a", "b"], ["c", "d"], ["c", "p"]] {
        assert!(
            mean(one) > 20.0 && (mean(one) / mean(other) - 1.0).abs() < 0.5,
            "{one} {}, {other} {}",
            mean(one),
            mean(other)
        );
    }
}

/// Catches: a grid of a corridor with a bend that has one line of points, or none; a strip round a large task
/// whose points all lie on the task's edge.
#[test]
fn narrow_areas_have_points_across_whatever_their_outline() {
    let room = "[[room]]\nname = \"C\"\nfootprint = [[0, 0], [20, 0], [20, 1.2], [1.2, 1.2], [1.2, 20], [0, 20]]\nheight = 3\nrow = \"9.1\"\n\
                reflectances = { floor = 0, walls = 0, ceiling = 0 }\n[luminaires.A]\npoint = { flux = 1000 }\n\
                [[place]]\nluminaire = \"A\"\nat = [0.6, 0.6, 2.9]\n[norm]\nstandard = \"en-12464-1-2021\"\n";
    let outcome = few(room);
    let plane = outcome.rooms[0].areas.iter().find(|area| area.name.contains("working plane")).expect("made");
    let kept: Vec<_> = plane.grid.points.iter().filter(|point| point.excluded.is_none()).collect();
    let far = kept.iter().filter(|point| point.position.x > 10.0).map(|point| point.position.y);
    let mut across: Vec<i64> = far.map(|y| (1e6 * y).round() as i64).collect();
    across.sort_unstable();
    across.dedup();
    assert!(across.len() >= 4, "lines across the corridor: {across:?}");
    let hall = "[scene]\nbox = { size = [16, 16, 4], floor = 0, walls = 0, ceiling = 0 }\n[luminaires.A]\npoint = { flux = 1000 }\n\
                [[place]]\nluminaire = \"A\"\nat = [8, 8, 3.9]\n[norm]\nstandard = \"en-12464-1-2021\"\nrow = \"34.2\"\n\
                [[area]]\nname = \"Task\"\nrect = { origin = [2, 2, 0.8], u = [12, 0, 0], v = [0, 12, 0] }\n\
                [[area]]\nname = \"Strip\"\nkind = \"surrounding\"\nof = \"Task\"\n";
    let outcome = few(hall);
    let strip = outcome.rooms[0].areas.iter().find(|area| area.name == "Strip").expect("drawn");
    let kept =
        || strip.grid.points.iter().filter(|point| point.excluded.is_none()).map(|point| point.position);
    let sides: [fn(glam::DVec3) -> f64; 4] = [|p| 2.0 - p.x, |p| p.x - 14.0, |p| 2.0 - p.y, |p| p.y - 14.0];
    for side in sides {
        let deep: Vec<f64> = kept().map(side).filter(|depth| *depth > 0.0).collect();
        assert!(deep.len() >= 20 && deep.iter().all(|d| (0.1..0.4).contains(d)), "{deep:?}");
    }
}

/// Catches: a lit ground with nothing over it, from which no light can come back, that is never decided.
#[test]
fn ground_under_a_black_sky_hides_no_light_from_planes_that_look_up() {
    let ground = "[scene]\nbox = { size = [9, 9, 9], floor = 0.3, walls = 0, ceiling = 0 }\n\
                  [luminaires.A]\npoint = { flux = 1000 }\n[[place]]\nluminaire = \"A\"\nat = [4.5, 4.5, 8]\n"
        .to_owned()
        + &spot("P", [4.5, 4.5, 0.5], r#""E_h""#);
    exact("ground", point(&few(&ground), "P", "E_h"), 1000.0 / (4.0 * PI) / 56.25);
}
