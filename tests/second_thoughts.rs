//! What a project may say and probably does not mean: it loads, and says so with its line; and what looks
//! odd and is right. Catches light that is counted twice in silence, factors that are dropped without a word,
//! percentages taken for factors, rooms in millimetres.

mod projects;

use gershun::outcome::Verdict;
use gershun::project::{Diagnostic, LoadOptions, Project, load};
use gershun::solve::Effort;
use projects::{File, folder, run};

const GOOD: &str = r#"[project]
name = "Office"

[scene]
box = { size = [6, 4, 3], floor = 0.2, walls = 0.5, ceiling = 0.7 }

[luminaires.A]
lambert = { flux = 3600 }
area = { rect = [0.6, 0.6] }

[[place]]
luminaire = "A"
at = [3, 2, 2.9]

[[area]]
name = "Desk"
rect = { origin = [1, 1, 0.8], u = [1, 0, 0], v = [0, 1, 0] }
"#;

fn loaded(text: &str, files: &[File]) -> Result<Project, Vec<Diagnostic>> {
    load(folder(text, files).path(), &LoadOptions::default())
}

fn good(text: &str) -> Project {
    loaded(text, &[]).unwrap_or_else(|errors| panic!("{}", all(&errors)))
}

fn all(errors: &[Diagnostic]) -> String {
    errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

/// The line, from 1, of the last occurrence of `part`.
fn line(text: &str, part: &str) -> usize {
    text[..text.rfind(part).expect(part)].matches('\n').count() + 1
}

/// Catches: a luminaire listed twice, or an array without a step, that doubles the light in silence; and a
/// warning about spotlights that share a place and aim apart, or about groups that are switched apart.
#[test]
fn two_luminaires_in_one_place_are_warned_of() {
    assert!(good(GOOD).warnings.is_empty());
    let twice = format!("{GOOD}[[place]]\nluminaire = \"A\"\nat = [3, 2, 2.9]\n");
    let array = format!(
        "{GOOD}[[place]]\nluminaire = \"A\"\narray = {{ from = [1, 1, 2.9], step = [0, 0, 0], count = 3 }}\n"
    );
    for text in [&twice, &array] {
        let project = good(text);
        let [warning] = &project.warnings[..] else { panic!("{:?}", project.warnings) };
        assert_eq!(warning.line, line(text, "[[place]]"), "{}", warning.as_warning());
        assert!(warning.as_warning().starts_with("warning: luminaire \"A\" hangs at ("), "{warning}");
        assert!(project.biases.iter().any(|bias| bias.contains("their light adds up")));
    }
    let aside = format!("{GOOD}[[place]]\nluminaire = \"A\"\nat = [3, 2, 2.9]\naim = [1, 0, -1]\n");
    let group = format!("{GOOD}[[place]]\nluminaire = \"A\"\nat = [3, 2, 2.9]\ngroup = \"evening\"\n");
    for text in [aside, group] {
        assert!(good(&text).warnings.is_empty());
    }
    let list = format!("{GOOD}[lists]\nplaces = \"places.csv\"\n");
    let places = ("places.csv".to_owned(), b"luminaire,x,y,z\nA,1,1,2.9\nA,3,2,2.9\n".to_vec());
    let project = loaded(&list, &[places]).unwrap_or_else(|errors| panic!("{}", all(&errors)));
    let [warning] = &project.warnings[..] else { panic!("{:?}", project.warnings) };
    assert_eq!((warning.file.as_str(), warning.line), ("places.csv", 3));
}

/// Catches: 60 meant as percent and taken as sixty times the light.
#[test]
fn a_factor_of_a_light_scene_dims() {
    for (factor, hint) in
        [("60", "60 % is 0.6"), ("1.5", "1.5 % is 0.015"), ("-0.1", "off 0"), ("nan", "off 0")]
    {
        let text = format!("{GOOD}[light_scenes]\nfull = {{ A = {factor} }}\n");
        let errors = loaded(&text, &[]).expect_err("a factor beyond 0 … 1");
        let [error] = &errors[..] else { panic!("{}", all(&errors)) };
        assert_eq!(error.line, line(&text, "full"));
        assert!(error.message.contains("0 … 1") && error.hint.contains(hint), "{error}");
    }
    for factor in ["0", "0.6", "1"] {
        good(&format!("{GOOD}[light_scenes]\nfull = {{ A = {factor} }}\n"));
    }
}

/// Catches: factors of a room that hold for no luminaire there, without a word.
#[test]
fn factors_of_a_room_that_do_not_hold_are_named() {
    let room = "[[room]]\nname = \"R\"\nmf = { lmf = 0.5, rsmf = 0.9 }\n";
    let own =
        GOOD.replace("flux = 3600 }\n", "flux = 3600 }\nmaintenance = { llmf = 0.9, lsf = 1, lmf = 0.9 }\n");
    let text = format!("{own}{room}");
    let project = good(&text);
    let [warning] = &project.warnings[..] else { panic!("{:?}", project.warnings) };
    assert_eq!(warning.line, line(&text, "mf = { lmf = 0.5"));
    assert!(
        warning.message.contains("\"A\"") && warning.message.contains(": lmf of room \"R\""),
        "{warning}"
    );
    assert!((project.worlds[0].scene.luminaires[0].kind.maintenance.factor() - 0.81).abs() < 1e-12);
    assert!(good(&format!("{GOOD}{room}")).warnings.is_empty(), "the room's factors hold");
    let rsmf = room.replace("lmf = 0.5, ", "");
    assert!(good(&format!("{own}{rsmf}")).warnings.is_empty(), "rsmf holds for every luminaire");
}

const ANGLED: &str = r#"[project]
name = "Angled"
[luminaires.P]
point = { flux = 2000 }
[[room]]
name = "L"
footprint = [[0, 0], [10, 0], [10, 1], [1, 1], [1, 10], [0, 10]]
height = 3
reflectances = { floor = 0.2, walls = 0.5, ceiling = 0.7 }
[[room]]
name = "Beside"
footprint = [[1, 1], [10, 1], [10, 10], [1, 10]]
height = 3
reflectances = { floor = 0.2, walls = 0.5, ceiling = 0.7 }
[[place]]
luminaire = "P"
at = [0.5, 0.5, 2.5]
"#;

/// Catches: an area of an angled room that is looked for in the middle of its corners, which lies in another
/// room or in none.
#[test]
fn an_area_belongs_to_the_room_that_holds_its_points() {
    let outline =
        "polygon = [[0, 0, 0.8], [10, 0, 0.8], [10, 1, 0.8], [1, 1, 0.8], [1, 10, 0.8], [0, 10, 0.8]]\n";
    let points = ("p.csv".to_owned(), b"x,y,z\n0.5,9,0.8\n0.5,5,0.8\n9,0.5,0.8\n5,0.5,0.8\n".to_vec());
    let other = "rect = { origin = [1, 1, 0.8], u = [9, 0, 0], v = [0, 9, 0] }\n";
    for beside in [true, false] {
        let rooms = if beside {
            ANGLED.to_owned()
        } else {
            let [start, rest] =
                [ANGLED.find("[[room]]\nname = \"Beside\""), ANGLED.find("[[place]]")].map(Option::unwrap);
            format!("{}{}", &ANGLED[..start], &ANGLED[rest..])
        };
        let mut text =
            format!("{rooms}[[area]]\nname = \"a\"\n{outline}[[area]]\nname = \"b\"\npoints = \"p.csv\"\n");
        if beside {
            text += &format!("[[area]]\nname = \"c\"\n{other}");
        }
        let project =
            loaded(&text, std::slice::from_ref(&points)).unwrap_or_else(|errors| panic!("{}", all(&errors)));
        let of = |name: &str| {
            let mut worlds = project.worlds.iter();
            let world = worlds.find(|world| world.areas.iter().any(|area| area.name == name)).expect(name);
            world.rooms[0].name.clone()
        };
        assert_eq!((of("a").as_str(), of("b").as_str()), ("L", "L"));
        if beside {
            assert_eq!(of("c"), "Beside");
        }
    }
    let astride = format!(
        "{ANGLED}[[area]]\nname = \"a\"\nrect = {{ origin = [0.2, 2, 0.8], u = [2, 0, 0], v = [0, 1, 0] }}\n"
    );
    let errors = loaded(&astride, &[]).expect_err("it lies in two rooms");
    assert!(all(&errors).contains("reaches outside of room"), "{}", all(&errors));
}

/// Catches: a drawing in millimetres that is computed, or laid out in millions of points, without a word.
#[test]
fn rooms_of_kilometres_are_asked_about_and_a_million_points_refused() {
    let large = GOOD.replace("[6, 4, 3]", "[6000, 4000, 3000]");
    let project = good(&large);
    let [warning] = &project.warnings[..] else { panic!("{:?}", project.warnings) };
    assert_eq!(warning.line, line(&large, "box"));
    assert!(warning.message.contains("6000 m × 4000 m × 3000 m") && warning.hint.contains("6000 mm are 6"));
    let area = |n: usize| {
        format!(
            "[[area]]\nname = \"{n}\"\nrect = {{ origin = [0, 0, 0.8], u = [6, 0, 0], v = [0, 4, 0] }}\ngrid = {{ count = [700, 700] }}\n"
        )
    };
    for (areas, fits) in [(2, true), (3, false)] {
        let text = (0..areas).fold(GOOD.replace("\"Desk\"", "\"Table\""), |text, n| text + &area(n));
        let project = good(&text);
        let planned = gershun::plan::plan(&project, &project.worlds[0]);
        match planned {
            Ok(_) => assert!(fits),
            Err(errors) => {
                let said = errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n");
                assert!(
                    !fits && said.contains("1000000") && said.contains("hint: lengths are metres"),
                    "{said}"
                );
            }
        }
    }
}

const THREE_ROOMS: &str = r#"[project]
name = "Rooms"
[luminaires.P]
lambert = { flux = 3600 }
area = { disc = 0.3 }
[[room]]
name = "A"
footprint = [[0, 0], [6, 0], [6, 4], [0, 4]]
height = 3
reflectances = { floor = 0.2, walls = 0.5, ceiling = 0.7 }
ROW
[[room]]
name = "C"
footprint = [[12, 0], [18, 0], [18, 4], [12, 4]]
height = 3
reflectances = { floor = 0.2, walls = 0.5, ceiling = 0.7 }
[[place]]
luminaire = "P"
field = { room = "A", rows = 2, columns = 4, height = 2.95 }
[[area]]
name = "Cd"
rect = { origin = [13, 1, 0.8], u = [1, 0, 0], v = [0, 1, 0] }
[norm]
standard = "en-12464-1-2021"
"#;

/// Catches: a room of which no row is given and that is missing from the table; compliance with a norm of
/// which nothing was judged.
#[test]
fn a_room_without_a_row_is_not_assessed() {
    for row in ["row = \"9.1\"\n", ""] {
        let outcome = run(&THREE_ROOMS.replace("ROW\n", row), &[], 32, Effort::default());
        let without = |room: &str| {
            let mut own = outcome.requirements.iter().filter(|r| r.room == room);
            own.any(|r| {
                let says = |reason: &str| reason.contains("no row of the norm is given");
                r.verdict == Verdict::NotAssessed && r.value.as_ref().is_err_and(|why| says(&why.reason))
            })
        };
        assert!(without("C"));
        assert_eq!(without("A"), row.is_empty());
        if row.is_empty() {
            assert_eq!(outcome.requirements.len(), 2);
            let said = gershun::report::overall(gershun::report::Lang::En, &outcome);
            assert_eq!(said, "EN 12464-1:2021 is not assessed: 2 not assessed");
        }
    }
    let own = "[[require]]\narea = \"Cd\"\nquantity = \"E_h\"\nmax = 100000\n";
    let text = format!("{}{own}", THREE_ROOMS.replace("ROW\n", ""));
    let outcome = run(&text, &[], 32, Effort::default());
    let said = gershun::report::overall(gershun::report::Lang::En, &outcome);
    assert!(said.starts_with("complies with the project's own requirements: 1 of 1"), "{said}");
    assert!(said.contains("EN 12464-1:2021 is not assessed"), "{said}");
}

/// Catches: a new project that writes its report over that of the example.
#[test]
fn a_new_project_is_named_after_its_folder() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["my-office", "Зал 2", "a'b"] {
        let made = std::process::Command::new(env!("CARGO_BIN_EXE_gershun"))
            .current_dir(folder.path())
            .args(["new", name])
            .output()
            .expect("the program starts");
        assert!(made.status.success(), "{made:?}");
        let project = load(&folder.path().join(name), &LoadOptions::default()).expect("loads");
        assert_eq!(project.info.name, name);
        let text = std::fs::read_to_string(folder.path().join(name).join("project.toml")).expect("text");
        assert!(!text.contains("out/box") && !text.contains("scenes/box"), "{text}");
    }
}

/// Catches: a list whose second column of a name is passed over, a line of sight beyond the zenith.
#[test]
fn lists_are_read_strictly() {
    let text = format!("{GOOD}[lists]\nviewpoints = \"views.csv\"\n");
    for (list, line, says) in [
        ("name,x,y,z,azimuth,x\nS,1,1,1.2,0,2\n", 1, "a second column \"x\""),
        ("name,x,y,z,azimuth,tilt\nS,1,1,1.2,0,95\n", 2, "tilt must lie in −90 … 90, found 95"),
    ] {
        let file = ("views.csv".to_owned(), list.as_bytes().to_vec());
        let errors = loaded(&text, &[file]).expect_err("a mistake");
        let [error] = &errors[..] else { panic!("{}", all(&errors)) };
        assert_eq!((error.file.as_str(), error.line, error.message.as_str()), ("views.csv", line, says));
    }
}
