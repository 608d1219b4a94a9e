//! Luminous bodies that stick in a surface. A body's centre hangs at the luminaire's position, so one that
//! is placed at the ceiling's height has half of itself above it, and that light is lost.

use crate::project::context::Context;
use crate::scene::Scene;

/// Points looked at per luminaire.
const POINTS: u32 = 64;

/// Says of every type how much of its luminous body lies behind surfaces, where some does.
pub fn check(scene: &Scene, context: &mut Context) {
    let mut worst: Vec<(&str, f64, usize)> = Vec::new();
    for luminaire in scene.luminaires.iter().filter(|luminaire| !luminaire.kind.opening.is_flat()) {
        let cut = (0..POINTS).filter(|point| {
            // A spiral of directions: even enough to find a half or a corner.
            let z = 1.0 - (2.0 * f64::from(*point) + 1.0) / f64::from(POINTS);
            let azimuth = 2.399_963 * f64::from(*point);
            let sine = (1.0 - z * z).sqrt();
            let direction = glam::DVec3::new(sine * azimuth.cos(), sine * azimuth.sin(), z);
            let at = luminaire.world_from_luminaire * luminaire.kind.opening.leaving(direction, [0.5, 0.5]);
            let reach = at.length() - 2.0 * scene.tracer.offset_m();
            let free = scene.tracer.transmittance(
                luminaire.position,
                at.normalize_or_zero(),
                reach,
                &luminaire.body,
            );
            reach > 0.0 && !(free > 0.0)
        });
        let share = cut.count() as f64 / f64::from(POINTS);
        if share > 0.0 {
            let name = luminaire.kind.name.as_str();
            match worst.iter_mut().find(|(known, ..)| *known == name) {
                Some((_, most, count)) => (*most, *count) = (most.max(share), *count + 1),
                None => worst.push((name, share, 1)),
            }
        }
    }
    for (name, share, count) in worst {
        context.note(format!(
            "luminaire \"{name}\": up to {:.0} % of its luminous body lies behind a surface ({count} placed so), and that \
             light is lost; its centre hangs at `at`, so lower it by half its luminous height, name its housing in \
             `body`, or give it a flat `area`",
            100.0 * share
        ));
    }
}
