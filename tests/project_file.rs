//! The reference of the project file: its examples load, and it names every key that there is.

mod projects;

use gershun::project::{LoadOptions, load};

const REFERENCE: &str = include_str!("../docs/project-file.md");
const SCHEMA: &str = include_str!("../src/project/schema.rs");

/// The TOML of the reference as one file.
fn examples() -> String {
    let mut inside = false;
    let mut text = String::new();
    for line in REFERENCE.lines() {
        if line.starts_with("```") {
            inside = line == "```toml";
        } else if inside {
            text.push_str(line);
            text.push('\n');
        }
    }
    text
}

/// Catches: an example that the program refuses, with or without the parts that stand as comments.
#[test]
fn the_examples_of_the_reference_load() {
    let whole = examples();
    // What is commented out needs a box less, or a file more.
    let room: String =
        whole.lines().map(|line| line.strip_prefix('#').unwrap_or(line)).collect::<Vec<_>>().join("\n");
    let (before, after) = room.split_once("[scene]").expect("it has a scene");
    let (_, after) = after.split_once("[materials]").expect("it has materials");
    let ward = "[[room]]\nname = \"Ward\"\nfootprint = [[0, 0], [8, 0], [8, 5], [0, 5]]\nheight = 2.8\nreflectances = { floor = \"Floor\", walls = 0.5, ceiling = \"Acoustic\" }\n";
    let rooms =
        format!("{before}[materials]{after}").replacen("[[room]]", &ward.replace("name = \"Ward\"\n", ""), 1);
    let rooms = rooms
        .replace("surface = \"Wall_N\"", "rect = { origin = [1, 4.9, 1], u = [1, 0, 0], v = [0, 0, 1] }");
    for (what, text) in [("a box", whole.clone()), ("rooms", rooms)] {
        let places = ("places.csv".to_owned(), b"x,y,z,nx,ny,nz\n1,1,1,0,0,1\n".to_vec());
        let folder = projects::folder(&text, &[places]);
        if let Err(errors) = load(folder.path(), &LoadOptions::default()) {
            let all: Vec<String> = errors.iter().map(ToString::to_string).collect();
            panic!("{what}: {}\n{text}", all.join("\n"));
        }
    }
}

/// Catches: a key that users cannot find.
#[test]
fn the_reference_names_every_key() {
    let fields = SCHEMA
        .lines()
        .filter_map(|line| line.strip_prefix("    pub ")?.split_once(": ").map(|(name, _)| name));
    // What the program keeps beside the keys of the file, and what is spelt otherwise there.
    let inner = ["rooms_lost", "lost", "has_light_scenes"];
    let spelt = [
        ("rooms", "[[room]]"),
        ("places", "[[place]]"),
        ("areas", "[[area]]"),
        ("viewpoints", "[[viewpoint]]"),
        ("glare_maps", "[[glare_map]]"),
        ("cameras", "[[camera]]"),
        ("requirements", "[[require]]"),
    ];
    let mut count = 0;
    for field in fields.filter(|field| !inner.contains(field) && !field.starts_with("fn ")) {
        let word = spelt.iter().find(|(name, _)| *name == field).map_or(field, |(_, spelt)| spelt);
        assert!(REFERENCE.contains(word), "docs/project-file.md says nothing of `{word}`");
        count += 1;
    }
    assert!(count > 100, "{count} keys were found in the schema");
}
