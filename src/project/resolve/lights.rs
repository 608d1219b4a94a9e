//! `[scene] lights = true`: light sources of the CAD file as luminaires, one type and one group per name.
//! Without it they are listed and stay dark: most of them only make a model look lit.

use glam::DVec3;

use super::draft::Draft;
use super::luminaires::{Kind, profile};
use super::places::{Hanging, hang};
use crate::geometry::gltf::{ImportedLight, LightKind};
use crate::luminaire::orientation;
use crate::photometry::IntensityDistribution;
use crate::project::context::Context;
use crate::project::schema::{At, SceneSection};
use crate::units::Lumens;

/// Steps between the cones of a spot.
const CONE_STEPS: i32 = 64;

/// Hangs the lights of the CAD file, or says that they are ignored.
pub fn add(scene: Option<&At<SceneSection>>, drafts: &mut [Draft], context: &mut Context) {
    let Some(scene) = scene.map(At::get_ref) else { return };
    let Some(file) = &scene.file else {
        if let Some(lights) = &scene.lights {
            context.error(&lights.span(), "there is no CAD file whose lights could shine", "");
        }
        return;
    };
    let lights =
        drafts.iter_mut().map(|draft| std::mem::take(&mut draft.lights)).find(|lights| !lights.is_empty());
    let lights = lights.unwrap_or_default();
    let wanted = scene.lights.as_ref().filter(|lights| *lights.get_ref());
    let Some(wanted) = wanted else {
        if !lights.is_empty() && scene.lights.is_none() {
            let names = names(&lights);
            context.note(format!(
                "{} light sources of {} are ignored ({names}); `lights = true` in [scene] makes them luminaires",
                lights.len(),
                file.get_ref()
            ));
        }
        return;
    };
    if lights.is_empty() && !drafts.is_empty() {
        context.error(&wanted.span(), format!("{} has no light sources", file.get_ref()), "");
    }
    let mut kinds: Vec<(LightKind, usize)> = Vec::new();
    let mut types: Vec<Kind> = Vec::new();
    for light in &lights {
        let label = format!("light \"{}\" of {}", light.name, file.get_ref());
        if let Some(range_m) = light.range_m {
            context.note(format!("{label}: its range of {range_m} m is ignored, light goes on"));
        }
        let known = kinds.iter().find(|(kind, _)| *kind == light.kind).map(|(_, index)| *index);
        let index = if let Some(index) = known {
            index
        } else {
            let Some(kind) = kind_of(light, &label, file, wanted, context) else { continue };
            kinds.push((light.kind.clone(), types.len()));
            types.push(kind.named(free_name(&light.name, &types, drafts)));
            types.len() - 1
        };
        let aim = if light.direction == DVec3::ZERO { DVec3::NEG_Z } else { light.direction };
        let rotate_deg = turn_deg(aim, light.right);
        let hanging = Hanging { kind: index, group: light.name.clone(), rotate_deg, dim: 1.0 };
        let mut report =
            |context: &mut Context, message: String, hint: &str| context.error(&wanted.span(), message, hint);
        hang(&hanging, &mut types, light.position, aim, drafts, context, &mut report);
    }
}

/// A type's name stands for it wherever types are told apart, so lights that are called alike and shine unlike
/// get a number: `P`, `P (2)`.
fn free_name(name: &str, types: &[Kind], drafts: &[Draft]) -> String {
    let mut hung = drafts.iter().flat_map(|draft| &draft.luminaires).map(|luminaire| &luminaire.kind.name);
    let mut taken: Vec<&str> = types.iter().map(|kind| kind.name.as_str()).collect();
    taken.extend(hung.by_ref().map(String::as_str));
    let numbered = (2..).map(|number| format!("{name} ({number})"));
    let mut names = std::iter::once(name.to_owned()).chain(numbered);
    names.find(|name| !taken.contains(&name.as_str())).unwrap_or_default()
}

/// `rotate` that lays a luminaire's +x, a photometric file's 0° plane, towards the node's +X.
fn turn_deg(aim: DVec3, right: DVec3) -> f64 {
    let unturned = orientation(aim, 0.0) * DVec3::X;
    let across = right - aim * aim.dot(right);
    aim.dot(unturned.cross(across)).atan2(unturned.dot(across)).to_degrees()
}

fn names(lights: &[ImportedLight]) -> String {
    const SHOWN: usize = 6;
    let mut names: Vec<&str> = lights.iter().take(SHOWN).map(|light| light.name.as_str()).collect();
    if lights.len() > SHOWN {
        names.push("…");
    }
    names.join(", ")
}

fn kind_of(
    light: &ImportedLight,
    label: &str,
    file: &At<String>,
    wanted: &At<bool>,
    context: &mut Context,
) -> Option<Kind> {
    let (distribution, source) = match &light.kind {
        LightKind::Directional => {
            context.note(format!("{label} is directional and ignored: daylight is not computed"));
            return None;
        }
        LightKind::Unreadable(why) => {
            context.error(
                &wanted.span(),
                format!("{label}: {why}"),
                "repair the CAD file or leave `lights` out",
            );
            return None;
        }
        LightKind::Profile { file: stored, factor } => {
            if light.mirrored {
                context.note(format!("{label}: its node is mirrored, the photometric file is not"));
            }
            return profile(&light.name, label, stored, *factor, file, wanted, context);
        }
        LightKind::Point { cd } => {
            let flux = Lumens(4.0 * std::f64::consts::PI * cd);
            (IntensityDistribution::isotropic(flux), "point of the CAD file")
        }
        LightKind::Spot { cd, inner_rad, outer_rad } => {
            (spot(*cd, *inner_rad, *outer_rad), "spot of the CAD file")
        }
    };
    if !(distribution.flux().0 > 0.0) {
        context.note(format!("{label} is dark"));
        return None;
    }
    Some(Kind::of_light(&light.name, source, distribution))
}

/// KHR_lights_punctual: I(γ) = I0 · clamp((cosγ − cos o)/max(0.001, cos i − cos o), 0, 1)², half-angles i
/// and o of the cones.
pub fn spot(cd: f64, inner_rad: f64, outer_rad: f64) -> IntensityDistribution {
    let (inner, outer) = (inner_rad.to_degrees(), outer_rad.to_degrees().min(90.0));
    let span = (inner_rad.cos() - outer_rad.cos()).max(0.001);
    let at = |gamma_deg: f64| {
        cd * ((gamma_deg.to_radians().cos() - outer_rad.cos()) / span).clamp(0.0, 1.0).powi(2)
    };
    let between = (0..=CONE_STEPS).map(|k| inner + (outer - inner) * f64::from(k) / f64::from(CONE_STEPS));
    let gammas: Vec<f64> = (inner > 0.0).then_some(0.0).into_iter().chain(between).collect();
    let plane: Vec<f64> = gammas.iter().map(|gamma| at(*gamma)).collect();
    IntensityDistribution::from_grid(vec![0.0, 360.0], gammas, vec![plane; 2])
        .unwrap_or_else(|_| IntensityDistribution::isotropic(Lumens(0.0)))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use super::*;

    /// Catches: a profile turned the wrong way round its beam.
    #[test]
    fn the_zero_plane_lies_towards_the_nodes_x() {
        for (aim, right) in [
            (DVec3::NEG_Z, DVec3::Y),
            (DVec3::NEG_Z, DVec3::NEG_X),
            (DVec3::X, DVec3::new(0.0, 0.6, 0.8)),
            (DVec3::Z, DVec3::new(-0.8, 0.6, 0.0)),
        ] {
            let found = orientation(aim, turn_deg(aim, right)) * DVec3::X;
            assert!((found - right).length() < 1e-12, "{aim} {right}: {found}");
        }
    }

    /// Catches: full angles for half-angles, the square of the fall-off forgotten. Closed form with
    /// u = cosγ: Φ = 2π I0 [1 − cos i + (cos i − cos o)/3].
    #[test]
    fn a_spot_has_the_flux_of_its_cones() {
        let (inner, outer) = (0.3f64, 0.7f64);
        let found = spot(1000.0, inner, outer);
        let truth = TAU * 1000.0 * (1.0 - inner.cos() + (inner.cos() - outer.cos()) / 3.0);
        assert!((found.flux().0 / truth - 1.0).abs() < 3e-4, "{} {truth}", found.flux().0);
        assert!((found.intensity_at(10.0, 15.0) - 1000.0).abs() < 1e-9);
        assert!(found.intensity_at(0.0, 41.0).abs() < 1e-9);
        let default = spot(1.0, 0.0, PI / 4.0);
        assert!(
            (default.intensity_at(0.0, 0.0) - 1.0).abs() < 1e-12 && default.intensity_at(0.0, 44.9) < 1e-3
        );
    }
}
