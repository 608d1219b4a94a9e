//! How far a room may be dimmed, by all luminaires or by groups, and what its light takes of the installed power.

mod projects;

use gershun::outcome::{Dimming, Outcome, Verdict};
use gershun::report::{Lang, Options, files};
use gershun::solve::Effort;
use projects::run;

const DESK: &str =
    "[[area]]\nname = \"Desk\"\nrect = { origin = [3, 2, 0.75], u = [1.6, 0, 0], v = [0, 0.8, 0] }\n";

/// A room of 8 × 5 × 2.8 m with a desk, and what a test adds.
fn room(rest: &str) -> String {
    format!(
        "[project]\nname = \"Room\"\n[scene]\nbox = {{ size = [8, 5, 2.8], floor = 0.2, walls = 0.5, ceiling = 0.7 }}\n\
         [luminaires.A]\nlambert = {{ flux = 6000 }}\narea = {{ rect = [1.2, 0.3] }}\n\
         [[place]]\nluminaire = \"A\"\nfield = {{ rows = 2, columns = 3, height = 2.79 }}\n{rest}"
    )
}

fn solved(text: &str) -> Outcome {
    run(text, &[], 32, Effort::default())
}

fn page(outcome: &Outcome, lang: Lang) -> String {
    let options = Options { languages: vec![lang], ..Options::default() };
    let files = files(outcome, &options).expect("a report");
    let (_, bytes) = files.into_iter().find(|(name, _)| name == "report.html").expect("a page");
    String::from_utf8(bytes).expect("text")
}

/// Catches: a dimming factor from values instead of interval ends, one that another requirement
/// forbids, one that is not the least.
#[test]
fn a_room_dimmed_as_far_as_is_said_still_complies_and_no_further() {
    let desks = "[[require]]\narea = \"Desk\"\nquantity = \"E_h\"\nmin = 500\n[[require]]\narea = \"Desk\"\nquantity = \"E_cyl\"\nmin = 150\n\
                 [[require]]\narea = \"Desk\"\nquantity = \"E_h\"\nstatistic = \"U0\"\nmin = 0.5\n";
    let text = room(&format!("{DESK}{desks}"));
    let solve =
        |dim: f64| solved(&text.replace("height = 2.79 }", &format!("height = 2.79 }}\ndim = {dim}")));
    let full = solve(1.0);
    let dimming = full.rooms[0].dimming.clone().expect("illuminances are required");
    assert!(dimming.factor < 0.9 && dimming.others_pass, "{dimming:?}");
    assert_eq!(dimming.subject, "Desk");
    let passes = |outcome: &Outcome| outcome.requirements.iter().all(|r| r.verdict == Verdict::Pass);
    assert!(passes(&solve(dimming.factor * 1.000_001)));
    assert!(!passes(&solve(dimming.factor * 0.97)), "3 % less must be noticed");
    let without = room(DESK);
    assert_eq!(solved(&without).rooms[0].dimming, None, "nothing is required");
    assert_eq!(full.rooms[0].power, None, "a Lambertian luminaire has no power");
}

/// A room with two groups, a desk under each, and what they ask for.
fn two_groups(rest: &str) -> String {
    let desk = |name: &str, x: f64| {
        format!(
            "[[area]]\nname = \"{name}\"\nrect = {{ origin = [{x}, 2, 0.75], u = [1.6, 0, 0], v = [0, 0.8, 0] }}\n"
        )
    };
    let row = |group: &str, x: f64| {
        format!(
            "[[place]]\nluminaire = \"A\"\ngroup = \"{group}\"\narray = {{ from = [{x}, 1.25, 2.79], step = [0, 2.5, 0], count = 2 }}\n"
        )
    };
    let require = |area: &str, statistic: &str, min: f64| {
        format!(
            "[[require]]\narea = \"{area}\"\nquantity = \"E_h\"\nstatistic = \"{statistic}\"\nmin = {min}\n"
        )
    };
    format!(
        "[project]\nname = \"Room\"\n[scene]\nbox = {{ size = [8, 5, 2.8], floor = 0.2, walls = 0.5, ceiling = 0.7 }}\n\
         [luminaires.A]\nlambert = {{ flux = 6000 }}\narea = {{ rect = [1.2, 0.3] }}\n{}{}{}{}{}{}{}{rest}",
        row("west", 2.0),
        row("east", 6.0),
        desk("West", 1.2),
        desk("East", 5.2),
        require("West", "mean", 400.0),
        require("East", "mean", 200.0),
        require("East", "U0", 0.6),
    )
}

/// Catches: groups dimmed by their values instead of bounds, one dimmed further than its own desk allows, a
/// choice that costs more than need be, a promise for a room that does not pass.
#[test]
fn groups_dimmed_as_far_as_is_said_still_comply_and_none_goes_further() {
    let full = solved(&two_groups(""));
    let dimming = full.rooms[0].dimming.clone().expect("illuminances are required");
    let groups = dimming.groups.expect("two groups");
    assert_eq!((groups.of.as_str(), groups.groups.len()), ("flux", 2), "Lambertian luminaires have no power");
    let factor = |name: &str| groups.groups.iter().find(|own| own.group == name).expect("a group").factor;
    let (west, east) = (factor("west"), factor("east"));
    assert!((groups.share - 0.5 * (west + east)).abs() < 1e-12);
    assert!(
        groups.share < dimming.factor - 0.05,
        "{} is no better than all at {}",
        groups.share,
        dimming.factor
    );
    let passes = |west: f64, east: f64| {
        let scene = format!("[light_scenes]\ndimmed = {{ west = {west}, east = {east} }}\n");
        solved(&two_groups(&scene)).requirements.iter().all(|r| r.verdict == Verdict::Pass)
    };
    assert!(passes(west, east), "{west} {east}");
    assert!(!passes(0.97 * west, east) && !passes(west, 0.97 * east), "3 % less must be noticed");
    // Another split of the same flux does not comply: the point is the cheapest.
    assert!(!passes(west - 0.05, east + 0.03) && !passes(west + 0.03, east - 0.05));
    let failing = two_groups("[[require]]\narea = \"West\"\nquantity = \"E_h\"\nmin = 5000\n");
    assert_eq!(solved(&failing).rooms[0].dimming.clone().and_then(|dimming| dimming.groups), None);
}

/// A room 5 × 4 m with a desk, a screen and an observer, all luminaires at `dim`.
fn screen(dim: &str, desk_lx: f64, screen_lx: f64, ugr: f64) -> String {
    format!(
        "[project]\nname = \"Room\"\n[scene]\nbox = {{ size = [5, 4, 2.8], floor = 0.2, walls = 0.5, ceiling = 0.7 }}\n\
         [luminaires.A]\nlambert = {{ flux = 4300 }}\narea = {{ rect = [1.2, 0.6] }}\nmaintenance = 0.8\n\
         [[place]]\nluminaire = \"A\"\nfield = {{ rows = 2, columns = 2, height = 2.799 }}\ndim = {dim}\n\
         [[area]]\nname = \"T\"\nrect = {{ origin = [0.5, 0.5, 0.75], u = [4, 0, 0], v = [0, 3, 0] }}\n\
         [[area]]\nname = \"Screen\"\nrect = {{ origin = [2.5, 1, 1], u = [0, 1, 0], v = [0, 0, 0.3] }}\nquantities = [\"E_n\"]\n\
         [[viewpoint]]\nname = \"V\"\neye = [0.3, 2, 1.2]\ndirection = [1, 0, 0]\n\
         [[require]]\narea = \"T\"\nquantity = \"E_h\"\nstatistic = \"mean\"\nmin = {desk_lx}\n\
         [[require]]\narea = \"Screen\"\nquantity = \"E_n\"\nstatistic = \"mean\"\nmax = {screen_lx}\n\
         [[require]]\nviewpoint = \"V\"\nquantity = \"UGR\"\nmax = {ugr}\n"
    )
}

/// Catches: a factor rounded to nearest on the page, at which the room fails; too few figures of a low one.
#[test]
fn the_factor_holds_as_it_is_printed() {
    let full = solved(&screen("1", 52.0, 300.0, 20.0));
    let dimming = full.rooms[0].dimming.clone().expect("an illuminance is required");
    assert!(dimming.factor < 0.2 && dimming.others_pass, "{dimming:?}");
    let page = page(&full, Lang::En);
    let (_, after) = page.split_once("all luminaires at ").expect("it is printed");
    let printed = after.split(' ').next().expect("a number");
    assert_eq!(printed.parse::<f64>().ok(), Some(dimming.factor), "what is printed is what was found");
    let at = |dim: &str| solved(&screen(dim, 52.0, 300.0, 20.0)).requirements[0].verdict;
    assert_eq!(at(printed), Verdict::Pass);
    assert_ne!(at(&format!("{}", 0.97 * dimming.factor)), Verdict::Pass, "3 % less must be noticed");
}

/// Catches: upper limits and observers' UGR judged at full output where the factor mends them, and said to be
/// mended where it does not.
#[test]
fn upper_limits_and_glare_are_judged_at_the_factor() {
    let of = |screen_lx: f64, ugr: f64| -> (Outcome, Dimming) {
        let outcome = solved(&screen("1", 300.0, screen_lx, ugr));
        let dimming = outcome.rooms[0].dimming.clone().expect("an illuminance is required");
        (outcome, dimming)
    };
    let (full, dimming) = of(250.0, 17.0);
    let verdicts: Vec<Verdict> = full.requirements.iter().map(|r| r.verdict).collect();
    assert_eq!(verdicts, [Verdict::Pass, Verdict::Fail, Verdict::Fail], "at full output");
    assert!(dimming.others_pass && dimming.factor < 0.7, "{dimming:?}");
    let dimmed = solved(&screen(&dimming.factor.to_string(), 300.0, 250.0, 17.0));
    assert!(dimmed.requirements.iter().all(|r| r.verdict == Verdict::Pass), "{:?}", dimmed.requirements);
    assert!(!of(100.0, 17.0).1.others_pass, "the screen has more than 100 lx there");
    assert!(!of(250.0, 12.0).1.others_pass, "and the observer more than 12");
}

/// Catches: a share of the power as if groups that are off in the judged scene were on; groups that nobody sees
/// given a factor.
#[test]
fn the_share_is_that_of_the_light_scene_which_is_judged() {
    let scenes =
        |work: &str| format!("[light_scenes]\nwork = {{ {work} }}\nall = {{ west = 1, east = 1 }}\n");
    let dimmed = |work: &str| {
        let outcome = solved(&two_groups(&scenes(work)));
        outcome.rooms[0].dimming.clone().and_then(|dimming| dimming.groups)
    };
    let groups = dimmed("west = 0.9, east = 0.6").expect("two groups");
    let [west, east] = &groups.groups[..] else { panic!("two groups") };
    let expected = (0.9 * west.factor + 0.6 * east.factor) / 1.5;
    assert!((groups.share - expected).abs() < 1e-12, "{} is not {expected}", groups.share);
    assert!((groups.share - 0.5 * (west.factor + east.factor)).abs() > 0.01, "the scene must matter here");
    let one = "[light_scenes]\nwork = { west = 1 }\nall = { west = 1, east = 1 }\n";
    let one = two_groups(one).replace("min = 200", "min = 20").replace("min = 0.6", "min = 0.1");
    let dimming = solved(&one).rooms[0].dimming.clone().expect("illuminances are required");
    assert_eq!(dimming.groups, None, "the one group that shines is dimmed by the common factor");
}

const LAMP: &str = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 1 1 2 0.3 1.2 0\n1 1 50\n0 45 90\n0\n2000 1400 0\n";

/// Catches: the power of all luminaires set against the light of whatever scene stands first; a scene that the
/// page does not name.
#[test]
fn power_by_light_is_that_of_one_light_scene() {
    let project = |scenes: &str, own: &str| {
        let text = room(&format!("{DESK}{own}[light_scenes]\n{scenes}"))
            .replace("lambert = { flux = 6000 }\narea = { rect = [1.2, 0.3] }", "file = \"lamp.ies\"");
        run(&text, &[("lamp.ies".into(), LAMP.into())], 32, Effort::default())
    };
    let full = project("work = { A = 1 }\n", "");
    let dim = project("evening = { A = 0.2 }\nwork = { A = 1 }\n", "");
    let named = project("evening = { A = 0.2 }\nwork = { A = 1 }\n", "light_scene = \"work\"\n");
    let of = |outcome: &Outcome| outcome.rooms[0].power.clone().expect("the power is known");
    let per = |outcome: &Outcome| of(outcome).density_w_m2_100lx.expect("there is light");
    let (w_full, w_dim) = (of(&full), of(&dim));
    assert!((w_full.scene_w - 300.0).abs() < 1e-9 && (w_dim.scene_w - 60.0).abs() < 1e-9, "{w_dim:?}");
    assert!((w_dim.installed_w - 300.0).abs() < 1e-9 && (w_dim.density_w_m2 - 7.5).abs() < 1e-9);
    assert!((per(&full) / per(&dim) - 1.0).abs() < 1e-9, "{} {}", per(&full), per(&dim));
    assert!((per(&full) - 7.5 / of(&full).mean_lx.expect("light") * 100.0).abs() < 1e-9);
    assert_eq!([w_dim.light_scene.as_str(), of(&named).light_scene.as_str()], ["evening", "work"]);
    for (lang, said) in [(Lang::En, "light scene work"), (Lang::Ru, "световая сцена work")] {
        assert!(page(&named, lang).contains(said), "{said}");
    }
}
