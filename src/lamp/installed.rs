//! Luminaires as installed, as one photometric file: the far field of a group with its housing. C90 lies
//! along +x of the project and γ = 0 straight down, so a lone luminaire, placed without `aim` and `rotate`,
//! gives its own file back.

use glam::DVec3;

use crate::photometry::{Format, IntensityDistribution, Opening, Photometry, Places};
use crate::project::{LightScene, Project, World};
use crate::scene::Scene;
use crate::solve::far_field::FarField;

/// Which luminaires of a project are meant.
#[derive(Debug)]
pub struct Chosen<'p> {
    /// The world they are in.
    pub world: &'p World,
    /// Index in the scene, factor of its flux.
    pub luminaires: Vec<(usize, f64)>,
}

/// Why no luminaires could be chosen.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ChoiceError {
    /// Neither group nor light scene lets any shine.
    #[error("no luminaire shines: groups are {0}")]
    None(String),
    /// No such light scene.
    #[error("no light scene \"{name}\": there are {known}")]
    LightScene {
        /// As asked for.
        name: String,
        /// As known.
        known: String,
    },
    /// They do not share one world.
    #[error("the luminaires are in {0} rooms that are solved apart; name a group of one room")]
    Worlds(usize),
}

/// Luminaires of the named groups (all, if none is named) with the factors of a light scene (the first).
///
/// # Errors
/// A name is not known, or nothing shines, or they are in several worlds.
pub fn choose<'p>(
    project: &'p Project,
    groups: &[String],
    light_scene: Option<&str>,
) -> Result<Chosen<'p>, ChoiceError> {
    let scene = match light_scene {
        None => project.light_scenes.first(),
        Some(name) => {
            let known = || listed(project.light_scenes.iter().map(|scene| scene.name.as_str()));
            let found = project.light_scenes.iter().find(|scene| scene.name == name);
            Some(found.ok_or_else(|| ChoiceError::LightScene { name: name.to_owned(), known: known() })?)
        }
    };
    let of_world = |world: &'p World| Chosen { world, luminaires: lit(&world.scene, groups, scene) };
    let mut chosen: Vec<Chosen> = project.worlds.iter().map(of_world).collect();
    chosen.retain(|chosen| !chosen.luminaires.is_empty());
    match chosen.len() {
        1 => Ok(chosen.remove(0)),
        0 => {
            let all = project.worlds.iter().flat_map(|world| &world.scene.luminaires);
            Err(ChoiceError::None(listed(all.map(|luminaire| luminaire.group.as_str()))))
        }
        several => Err(ChoiceError::Worlds(several)),
    }
}

fn lit(scene: &Scene, groups: &[String], light_scene: Option<&LightScene>) -> Vec<(usize, f64)> {
    let named = |group: &String| groups.is_empty() || groups.contains(group);
    let all = scene.luminaires.iter().enumerate().filter(|(_, luminaire)| named(&luminaire.group));
    let factor = |group: &str| light_scene.map_or(1.0, |scene| scene.factor(group));
    let lit = all.map(|(index, luminaire)| (index, factor(&luminaire.group)));
    lit.filter(|(index, factor)| scene.luminaires[*index].dim * factor > 0.0).collect()
}

fn listed<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let mut names: Vec<String> = names.map(|name| format!("\"{name}\"")).collect();
    names.sort();
    names.dedup();
    names.join(", ")
}

/// The far field as a photometric file's content; `None` where no light leaves the scene. The opening is
/// the rectangle around the openings on plan, the power that of the luminaires.
pub fn photometry(field: &FarField, chosen: &Chosen, description: &str) -> Option<Photometry> {
    let distribution: IntensityDistribution =
        field.distribution().ok().filter(|distribution| distribution.flux().0 > 0.0)?;
    let scene = &chosen.world.scene;
    let luminaires = || chosen.luminaires.iter().map(|(index, _)| &scene.luminaires[*index]);
    let powers: Vec<f64> = luminaires().filter_map(|luminaire| luminaire.kind.power_w).collect();
    Some(Photometry {
        format: Format::Eulumdat,
        description: description.to_owned(),
        opening: around(luminaires().flat_map(|luminaire| {
            let corners = luminaire.kind.opening.outline();
            let axes = luminaire.world_from_luminaire;
            corners.into_iter().map(move |corner| luminaire.position + axes * corner)
        })),
        rated_flux_lm: Some(distribution.flux().0),
        lamp_flux_lm: Some(field.emitted_lm),
        lor: Some(distribution.flux().0 / field.emitted_lm),
        power_w: (powers.len() == chosen.luminaires.len()).then(|| powers.iter().sum()),
        colour_rendering: None,
        distribution,
        places: Places::default(),
        findings: Vec::new(),
    })
}

/// Area of the far field's opening and the sum of the openings in it, m², where the first is more than a tenth
/// larger: then luminances from the file are too low.
pub fn spread(photometry: &Photometry, chosen: &Chosen) -> Option<(f64, f64)> {
    let luminaires = &chosen.world.scene.luminaires;
    let areas = chosen.luminaires.iter().map(|(index, _)| luminaires[*index].kind.opening.area_m2());
    let (apparent_m2, luminous_m2) = (photometry.opening.area_m2(), areas.sum::<f64>());
    (apparent_m2 > 1.1 * luminous_m2).then_some((apparent_m2, luminous_m2))
}

/// The rectangle around points on plan.
fn around(points: impl Iterator<Item = DVec3>) -> Opening {
    let start = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (low, high) = points.fold(start, |(low, high), point| (low.min(point), high.max(point)));
    let size = high - low;
    if size.x > 0.0 && size.y > 0.0 { Opening::rect(size.x, size.y) } else { Opening::Point }
}
