//! Every bias that a run meets stands in its list, with its effect: a project that meets all of
//! those of solving, and one that meets none but the quadrature of openings.

mod projects;

use gershun::outcome::Outcome;
use gershun::solve::Effort;

fn project(materials: &str, lamp: &str, furniture: &str) -> Outcome {
    let text = format!(
        "[scene]\nbox = {{ size = [5, 4, 3], floor = 0.3, walls = 0.5, ceiling = 0.7 }}\n\
         [materials]\n{materials}\n[luminaires.A]\n{lamp}\n\
         [[place]]\nluminaire = \"A\"\nat = [2, 2, 2.5]\n{furniture}\n{}",
        projects::spot("desk", [2.5, 1.0, 0.8], "\"E_h\"")
    );
    projects::run(&text, &[], 4, Effort { particles: 4096, ..Effort::default() })
}

fn listed(outcome: &Outcome, words: &str) -> bool {
    outcome.biases.iter().any(|bias| bias.what.contains(words) && !bias.effect.is_empty())
}

#[test]
fn what_a_run_leaves_out_stands_in_its_list() {
    let materials = "Wall_N = { mirror = 0.9 }\nWall_S = { mirror = 0.9 }\n\
                     Opal = { opal = { reflectance = 0.4, transmittance = 0.5 } }\n\
                     Floor = { reflectance = 0.2, specular = 0.1, phong_paper = 20 }\n\
                     Lit = { emit = 100, reflectance = 0.3 }";
    let furniture = "[[furniture]]\nat = [0.5, 0.5, 0.1]\nsize = [0.4, 0.4, 0.5]\nmaterial = \"Opal\"\n\
                     [[furniture]]\nat = [4.0, 3.0, 0.1]\nsize = [0.4, 0.4, 0.5]\nmaterial = \"Lit\"";
    let met = project(materials, "point = { flux = 1000 }", furniture);
    for words in [
        "two or more specular reflections",
        "two or more mirrors",
        "Images of bright surfaces",
        "Opal surfaces",
        "Luminous surfaces",
        "phong_paper",
        "Highlights",
    ] {
        assert!(listed(&met, words), "\"{words}\" is not listed: {:?}", met.biases);
    }
    // Facing mirrors of 0.9 carry much of a point's light by double reflections: the figure is measured.
    let omitted = met.biases.iter().find(|bias| bias.what.contains("two or more")).expect("asserted above");
    let percent: f64 = omitted.effect.split(' ').next().and_then(|n| n.parse().ok()).expect("a figure");
    assert!((1.0..60.0).contains(&percent), "{}", omitted.effect);

    let plain = project("", "lambert = { flux = 1000 }\narea = { rect = [0.6, 0.6] }", "");
    assert_eq!(plain.biases.len(), 1, "{:?}", plain.biases);
    assert!(listed(&plain, "integrated numerically"));
}

/// Catches: dimmed gear whose power is taken for granted, and a remark on luminaires that nobody dims.
#[test]
fn power_of_dimmed_luminaires_is_said_to_be_in_proportion() {
    let file = ("panel.ldt".to_owned(), std::fs::read("scenes/office/panel.ldt").expect("an example"));
    let with = |dim: f64| {
        let text = format!(
            "[scene]\nbox = {{ size = [5, 4, 3], floor = 0.3, walls = 0.5, ceiling = 0.7 }}\n\
             [luminaires.A]\nfile = \"panel.ldt\"\n\
             [[place]]\nluminaire = \"A\"\nat = [2, 2, 2.9]\ndim = {dim}\n{}",
            projects::spot("desk", [2.5, 1.0, 0.8], "\"E_h\"")
        );
        let effort = Effort { particles: 256, ..Effort::default() };
        projects::run(&text, std::slice::from_ref(&file), 2, effort)
    };
    assert!(listed(&with(0.5), "need power in proportion"));
    for undimmed in [0.0, 1.0] {
        assert!(!listed(&with(undimmed), "need power in proportion"), "{undimmed}");
    }
}
