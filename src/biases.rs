//! What a run approximated or left out, with its effect: every entry of a report's list of biases
//! that comes from solving (those of loading come with the project).

use crate::emitters::Emitters;
use crate::measure::{Answers, flux};
use crate::outcome::Bias;
use crate::project::World;
use crate::{Method, Settings};

pub(crate) fn add(
    biases: &mut Vec<Bias>,
    world: &World,
    settings: &Settings,
    answers: &Answers,
    emitters: &Emitters,
) {
    let mut note = |what: &str, effect: String| biases.push(Bias { what: what.into(), effect });
    let scene = &world.scene;
    if settings.method == Method::Links && !scene.luminaires.is_empty() {
        note(
            "Unshadowed light of openings is integrated numerically.",
            format!("at most about {:e} of each luminaire's illuminance", crate::emitters::TOLERANCE),
        );
    }
    let specular = (0..scene.mesh.triangles.len() as u32).any(|t| scene.bsdf(t).specular(1.0).is_some());
    if specular {
        let share = flux::omitted_share(answers);
        if share > 0.0 {
            note(
                "Light of point sources that reaches diffuse surfaces only by two or more specular reflections, or by curved mirrors, is left out.",
                format!("{:.3} % of the luminous flux (measured)", 100.0 * share),
            );
        }
        let glowing = emitters.mirrors.len();
        note(
            "Specular images of bright surfaces other than luminaires are part of the background, not glare sources.",
            format!("{glowing} specular planes; images of luminaires in them do count as glare sources"),
        );
    }
    let cut: u64 = answers.sheets.iter().map(|sheet| sheet.counts.cut).sum();
    if cut > 0 {
        note("Walks between perfect mirrors were cut.", format!("{cut} walks"));
    }
    let escaped: u64 = answers.sheets.iter().map(|sheet| sheet.counts.escaped).sum();
    let rays: u64 = answers.sheets.iter().map(|sheet| sheet.counts.rays).sum();
    if escaped > 0 {
        note(
            "Some rays left the scene: it is open, or its surfaces do not meet.",
            format!("{:.4} % of all rays; see the escaped flux", 100.0 * escaped as f64 / rays.max(1) as f64),
        );
    }
    for luminaire in &scene.luminaires {
        let kind = &luminaire.kind;
        if let Some(rated) = kind.rated_flux_lm
            && (kind.flux_lm / rated - 1.0).abs() > 0.02
        {
            let text = Bias {
                what: format!(
                    "Luminaire {}: the intensities integrate to {:.0} lm, rated are {rated:.0} lm; the intensities were used.",
                    kind.name, kind.flux_lm
                ),
                effect: format!("{:+.1} % of its light", 100.0 * (kind.flux_lm / rated - 1.0)),
            };
            if !biases.contains(&text) {
                biases.push(text);
            }
        }
    }
}
