//! `instead = "why"` of a `[[require]]`: a limit of the norm that the project sets aside.

mod common;
mod projects;

use gershun::outcome::{Bound, Outcome, Requirement, Verdict};
use gershun::project::{LoadOptions, load};
use gershun::report::words::said;
use gershun::report::{Lang, overall};
use gershun::solve::Effort;
use projects::{folder, run};

/// An office of EN 12464-1 whose desk has about 380 lx.
const OFFICE: &str = "[scene]\nbox = { size = [4, 3, 2.8], floor = 0.3, walls = 0.5, ceiling = 0.8 }\n\
    [luminaires.A]\nlambert = { flux = 4000 }\narea = { rect = [0.6, 0.6] }\n\
    [[place]]\nluminaire = \"A\"\nat = [2, 1.5, 2.7]\n\
    [norm]\nstandard = \"en-12464-1-2021\"\n\
    [[area]]\nname = \"Desk\"\nrect = { origin = [1, 1, 0.75], u = [1.6, 0, 0], v = [0, 0.8, 0] }\nrow = \"34.2\"\n";

fn require(limit: &str) -> String {
    format!("[[require]]\narea = \"Desk\"\nquantity = \"E_h\"\n{limit}\n")
}

fn judged(requirements: &str) -> Outcome {
    run(&format!("{OFFICE}{requirements}"), &[], 32, Effort::default())
}

/// What the norm and the project ask of the mean on the desk.
fn of<'a>(outcome: &'a Outcome, by: &str) -> &'a Requirement {
    let mut all = outcome.requirements.iter();
    let found = all.find(|one| {
        one.subject == "Desk"
            && one.statistic.key() == "mean"
            && one.quantity.key() == "E_h"
            && (one.standard == "project") == (by == "project")
    });
    found.unwrap_or_else(|| panic!("nothing of {by}"))
}

/// Catches: a norm's limit judged beside the one that stands instead of it, gone without a word, or passed; another
/// limit set aside with it.
#[test]
fn a_limit_that_is_set_aside_stays_in_sight_and_is_not_assessed() {
    let beyond = judged(&require("min = 250"));
    let norm = of(&beyond, "norm");
    assert_eq!((norm.verdict, of(&beyond, "project").verdict), (Verdict::Fail, Verdict::Pass));
    let outcome = judged(&require("min = 250\ninstead = \"a store, as agreed\""));
    let norm = of(&outcome, "norm");
    assert_eq!(norm.verdict, Verdict::NotAssessed);
    assert!(matches!(norm.bound, Bound::Min(limit) if (limit - 500.0).abs() < 1e-9), "{:?}", norm.bound);
    let reason = norm.value.as_ref().expect_err("no value").reason.as_str();
    assert_eq!(reason, "set aside, the project has a limit of its own: a store, as agreed");
    let russian = said(Lang::Ru, reason);
    assert!(russian.contains("a store, as agreed") && !russian.contains("set aside"), "{russian}");
    assert_eq!(of(&outcome, "project").verdict, Verdict::Pass);
    // Nobody reads "complies" without a word of what was taken out.
    let mut all_well = outcome.clone();
    all_well.requirements.retain(|one| one.verdict != Verdict::Fail && one.verdict != Verdict::Undecided);
    let headline = overall(Lang::En, &all_well);
    assert!(headline.contains("limits set aside by the project: 1"), "{headline}");
    assert!(headline.ends_with("of these 1 set aside by the project"), "{headline}");
    assert!(!overall(Lang::En, &beyond).contains("set aside"));
    let others = |outcome: &Outcome| {
        let rest = outcome.requirements.iter().filter(|one| one.standard != "project");
        rest.filter(|one| one.verdict == Verdict::NotAssessed).count()
    };
    assert_eq!(others(&outcome), others(&beyond) + 1);
    let uniformity = |outcome: &Outcome| {
        let mut all = outcome.requirements.iter();
        all.find(|one| one.subject == "Desk" && one.statistic.key() == "U0").map(|one| one.verdict)
    };
    assert_eq!(uniformity(&outcome), uniformity(&beyond));
    assert!(uniformity(&outcome).is_some_and(|verdict| verdict != Verdict::NotAssessed));
}

/// Catches: a wish to set aside what is not there, heeded in silence; a limit set aside without a word of why, or by
/// one on the other side.
#[test]
fn nothing_is_set_aside_by_mistake() {
    for (requirement, text, message) in [
        (require("min = 250\ninstead = \" \""), OFFICE.to_owned(), "set aside without a reason"),
        (
            require("min = 250\ninstead = \"so\""),
            OFFICE.replace("[norm]\nstandard = \"en-12464-1-2021\"\n", "").replace("row = \"34.2\"\n", ""),
            "there is no norm",
        ),
    ] {
        let text = format!("{text}{requirement}");
        let errors = load(folder(&text, &[]).path(), &LoadOptions::default()).expect_err("refused");
        assert!(errors.iter().any(|error| error.message.contains(message)), "{errors:?}");
    }
    for limit in ["max = 900", "statistic = \"max\"\nmin = 250"] {
        let text = format!("{OFFICE}{}", require(&format!("{limit}\ninstead = \"so\"")));
        let project = load(folder(&text, &[]).path(), &LoadOptions::default()).expect("it loads");
        let errors = gershun::plan::plan(&project, &project.worlds[0]).expect_err("refused");
        let message = errors[0].to_string();
        assert!(
            message.contains("the norm has no such limit on") && message.contains("\"Desk\""),
            "{message}"
        );
        assert!(message.contains(&format!("project.toml:{}:", text.lines().count())), "{message}");
    }
}
