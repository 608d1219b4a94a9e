//! What a run approximated or left out, with its effect: every entry of a report's list of biases
//! that comes from solving (those of loading come with the project).

use crate::emitters::{Emitters, facing_pairs};
use crate::material::{Bsdf, Lobe};
use crate::measure::{Answers, flux};
use crate::outcome::{Bias, Requirement};
use crate::project::{LightScene, World};
use crate::quantity::Quantity;
use crate::scene::{Channel, Scene};
use crate::{Method, Settings};

pub(crate) fn add(
    biases: &mut Vec<Bias>,
    world: &World,
    light_scenes: &[LightScene],
    settings: &Settings,
    answers: &Answers,
    emitters: &Emitters,
) {
    let scene = &world.scene;
    of_method(biases, scene, settings.method);
    of_mirrors(biases, scene, answers, emitters);
    of_materials(biases, scene);
    if is_dimmed(world, light_scenes) {
        note(
            biases,
            "A dimmed luminaire is taken to need power in proportion to its light.",
            "real gear needs more when dimmed: W/m² per 100 lx, and what dimming saves, flatter".into(),
            Some(0.0),
        );
    }
    of_rays(biases, answers);
}

fn note(biases: &mut Vec<Bias>, what: &str, effect: String, share: Option<f64>) {
    biases.push(Bias { what: what.into(), effect, share });
}

fn of_method(biases: &mut Vec<Bias>, scene: &Scene, method: Method) {
    if method != Method::Path && !scene.luminaires.is_empty() {
        note(
            biases,
            "Unshadowed light of openings is integrated numerically.",
            format!("at most about {:e} of each luminaire's illuminance", crate::emitters::TOLERANCE),
            Some(crate::emitters::TOLERANCE),
        );
    }
    if let Some(what) = found_by_chance(method) {
        note(
            biases,
            what,
            "value and interval may both lack what is rare; the method links aims at it".into(),
            None,
        );
    }
}

fn of_mirrors(biases: &mut Vec<Bias>, scene: &Scene, answers: &Answers, emitters: &Emitters) {
    let specular = (0..scene.mesh.triangles.len() as u32).any(|t| scene.bsdf(t).specular(1.0).is_some());
    if !specular {
        return;
    }
    let share = flux::omitted_share(answers);
    if share > 0.0 {
        note(
            biases,
            "Light of point sources that reaches diffuse surfaces only by two or more specular reflections, or by curved mirrors, is left out.",
            format!("{:.3} % of the luminous flux (measured)", 100.0 * share),
            None,
        );
    }
    let shines = scene.surfaces().any(|bsdf| bsdf.emitted() > 0.0);
    let by_two = !scene.luminaires.is_empty() && !facing_pairs(emitters).is_empty();
    if by_two || shines {
        note(biases, "Light of luminaires that comes by two or more mirrors, one after the other, and that of luminous surfaces by any mirror, is found by chance.",
            "intervals may miss what is rare; at points and areas their upper ends allow for what they send there straight"
                .into(),
            None,
        );
    }
    let glowing = emitters.mirrors.len();
    note(
        biases,
        "Images of bright surfaces that do not emit, and images by more than one reflection, are part of the background, not glare sources.",
        format!(
            "{glowing} specular planes; images of luminaires and luminous surfaces by one reflection in them do count as glare sources"
        ),
        Some(0.0),
    );
}

fn of_materials(biases: &mut Vec<Bias>, scene: &Scene) {
    let lobes = scene.mesh.surfaces.iter().filter_map(|s| scene.materials[s.material].bsdf.lobe());
    let papers = lobes.clone().filter_map(|lobe| match lobe {
        Lobe::PhongPaper(paper) => Some(paper.loss()),
        Lobe::Phong(_) | Lobe::Ward(_) | Lobe::Ggx(_) => None,
    });
    if let Some(loss) = papers.reduce(f64::max) {
        note(
            biases,
            "The lobe of phong_paper loses light at grazing incidence that a real surface reflects; `phong` does not.",
            format!("{:.0} % of the reflectance `specular` under uniform light", 100.0 * loss),
            None,
        );
    }
    if lobes.count() > 0 {
        note(
            biases,
            "Highlights on glossy surfaces that are dull, curved or small, and those of luminous surfaces, are part of the background, not glare sources.",
            "observers' UGR reads low where one dazzles".into(),
            Some(0.0),
        );
    }
    let lit_from_behind =
        |t: u32| matches!(*scene.bsdf(t), Bsdf::Opal { transmittance, .. } if transmittance > 0.0);
    if (0..scene.mesh.triangles.len() as u32).any(lit_from_behind) {
        note(
            biases,
            "Opal surfaces lit from behind are part of the background, not glare sources.",
            "observers' UGR reads low where one is bright".into(),
            Some(0.0),
        );
    }
    if scene.channels.iter().any(|channel| matches!(channel, Channel::Surfaces { .. })) {
        note(
            biases,
            "Luminous surfaces shine on both sides.",
            "light of a side that faces out of the room counts as emitted and escaped in the flux balance"
                .into(),
            Some(0.0),
        );
    }
}

fn of_rays(biases: &mut Vec<Bias>, answers: &Answers) {
    let rays: u64 = answers.sheets.iter().map(|sheet| sheet.counts.rays).sum();
    let cut: u64 = answers.sheets.iter().map(|sheet| sheet.counts.cut).sum();
    if cut > 0 {
        note(
            biases,
            "Walks in a cavity without absorption were cut.",
            format!("{cut} walks"),
            Some(cut as f64 / rays.max(1) as f64),
        );
    }
    let escaped: u64 = answers.sheets.iter().map(|sheet| sheet.counts.escaped).sum();
    if escaped > 0 {
        note(
            biases,
            "Some rays left the scene: it is open, or its surfaces do not meet.",
            format!("{:.4} % of all rays; see the escaped flux", 100.0 * escaped as f64 / rays.max(1) as f64),
            Some(0.0),
        );
    }
}

/// Whether a luminaire whose power is known shines with less than its full output, but not off, in some light scene.
fn is_dimmed(world: &World, light_scenes: &[LightScene]) -> bool {
    let powered = || world.scene.luminaires.iter().filter(|luminaire| luminaire.kind.power_w.is_some());
    light_scenes.iter().any(|scene| {
        powered().any(|luminaire| {
            let output = luminaire.dim * scene.factor(&luminaire.group);
            output > 0.0 && output < 1.0
        })
    })
}

/// What a method does not aim at.
fn found_by_chance(method: Method) -> Option<&'static str> {
    match method {
        Method::Links => None,
        Method::Path => Some("Path tracing finds small bright places by chance."),
        Method::Local | Method::Double => {
            Some("Local estimation finds small bright places and luminous surfaces by chance.")
        }
    }
}

/// What each omission may cost of a requirement's margin, one sentence each. Table values and
/// declared ones do not come from solving and are at no such risk; of an index of glare the share of
/// light that is missing tells nothing.
pub(crate) fn risks(biases: &[Bias], requirement: &Requirement) -> Vec<String> {
    let computed = !matches!(
        requirement.quantity,
        Quantity::Ugr | Quantity::ColourRendering | Quantity::OfView { unit: "1" | "%", .. }
    );
    let Some(margin) = requirement.margin.filter(|_| computed) else { return Vec::new() };
    biases
        .iter()
        .filter(|bias| bias.share.is_none_or(|share| share > 0.0))
        .map(|bias| {
            let what = bias.what.trim_end_matches('.');
            let margin = 100.0 * margin;
            match bias.share {
                Some(share) => {
                    format!("{what}: up to {:.2} % of the value; the margin is {margin:.1} %", 100.0 * share)
                }
                None => format!("{what}: {}; the margin is {margin:.1} %", bias.effect),
            }
        })
        .collect()
}
