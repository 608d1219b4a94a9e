//! A placed luminaire seen from a point: the illuminance it gives by any kernel, the part of it
//! that is visible, its luminance and solid angle. Solvers and glare use the same functions, so
//! what lights a desk and what dazzles an eye cannot differ.
//!
//! Light leaves every point of an opening alike: dE = I(C,γ)/A · R(ω) / d² dA, so illuminance never
//! divides by a projected area. A luminaire is also seen as its image in a planar mirror or pane.

mod direct;
mod images;
mod seen;

use glam::{DMat3, DVec3};

use crate::geometry::trace::Tracer;
use crate::luminaire::Luminaire;
use crate::photometry::Opening;
use crate::scene::Scene;

pub use direct::{TOLERANCE, unshadowed};
pub use images::Mirror;
pub use seen::{Seen, seen_from};

/// All luminaires of a scene and their images.
#[derive(Debug)]
pub struct Emitters<'s> {
    /// The scene.
    pub scene: &'s Scene,
    /// Luminaires first (same index as in the scene), then images.
    pub sources: Vec<Source>,
    /// Planar specular surfaces in which images are taken.
    pub mirrors: Vec<Mirror>,
    /// For each triangle, whether it belongs to one of `mirrors`.
    pub imaged: Vec<bool>,
}

/// A luminaire or its image in one plane.
#[derive(Clone, Debug)]
pub struct Source {
    /// Luminaire index in the scene.
    pub luminaire: usize,
    /// Channel of the scene.
    pub channel: usize,
    /// Plane in which the image is taken; `None` for the luminaire itself.
    pub mirror: Option<usize>,
    /// Centre of the opening (or of its image), m.
    pub position: DVec3,
    /// Axes of the luminaire frame (mirrored for an image).
    world_from_luminaire: DMat3,
    /// Plane area of the opening, m²; 0 for a point.
    pub area_m2: f64,
    /// Half the opening's largest extent, m.
    pub radius_m: f64,
    opening: Opening,
    dim: f64,
}

/// Light that would arrive at a point from one point of an opening if nothing stood between.
#[derive(Clone, Copy, Debug)]
pub struct Arrival {
    /// Unit direction from the receiving point towards the source.
    pub direction: DVec3,
    /// Distance, m.
    pub distance_m: f64,
    /// I(C,γ)/d² in lx on a surface that faces the source, panes and mirrors not yet taken off.
    pub normal_lx: f64,
}

impl<'s> Emitters<'s> {
    /// Collects luminaires and their images.
    pub fn new(scene: &'s Scene) -> Self {
        let (mirrors, imaged) = images::mirrors(scene);
        let mut sources: Vec<Source> = scene
            .luminaires
            .iter()
            .enumerate()
            .map(|(index, luminaire)| Source {
                luminaire: index,
                channel: scene.channel_of[index],
                mirror: None,
                position: luminaire.position,
                world_from_luminaire: luminaire.world_from_luminaire,
                area_m2: luminaire.kind.opening.area_m2(),
                radius_m: luminaire.kind.opening.outline().iter().map(|p| p.length()).fold(0.0, f64::max),
                opening: luminaire.kind.opening,
                dim: luminaire.dim,
            })
            .collect();
        for (index, mirror) in mirrors.iter().enumerate() {
            for luminaire in 0..scene.luminaires.len() {
                let original = &sources[luminaire];
                let image = Source {
                    mirror: Some(index),
                    position: mirror.image(original.position),
                    world_from_luminaire: mirror.reflection() * original.world_from_luminaire,
                    ..original.clone()
                };
                sources.push(image);
            }
        }
        Self { scene, sources, mirrors, imaged }
    }

    /// The luminaire behind a source.
    pub fn luminaire(&self, source: &Source) -> &'s Luminaire {
        &self.scene.luminaires[source.luminaire]
    }

    /// Whether anything of a source can be seen from `point`, by a cheap test that only ever errs
    /// towards yes: an image shows only where its mirror lies between.
    #[inline]
    pub fn may_show(&self, source: &Source, point: DVec3) -> bool {
        source
            .mirror
            .is_none_or(|mirror| self.mirrors[mirror].may_show(point, source.position, source.radius_m))
    }

    /// Probability with which a random estimate should consider a source; see [`Mirror::chance`].
    pub fn chance(&self, source: &Source) -> f64 {
        source.mirror.map_or(1.0, |mirror| self.mirrors[mirror].chance)
    }

    /// Light from the point of the opening at `u` (in the unit square) to `point`.
    pub fn arrival(&self, source: &Source, point: DVec3, u: [f64; 2]) -> Arrival {
        self.arrival_if(source, point, u, |_| true).unwrap_or(Arrival {
            direction: (source.position - point).normalize_or_zero(),
            distance_m: source.position.distance(point),
            normal_lx: 0.0,
        })
    }

    /// [`Emitters::arrival`] where the direction of arrival matters (`wanted`), the opening shines
    /// that way, and an image lies behind its mirror: cheap tests first, photometry last.
    #[inline]
    pub fn arrival_if(
        &self,
        source: &Source,
        point: DVec3,
        u: [f64; 2],
        wanted: impl FnOnce(DVec3) -> bool,
    ) -> Option<Arrival> {
        let from = source.position + source.world_from_luminaire * source.opening.point(u);
        let towards = from - point;
        let distance_squared = towards.length_squared();
        // A receiver that touches the opening has no finite point illuminance; it gets none.
        if !(distance_squared > 0.0) {
            return None;
        }
        let distance_m = distance_squared.sqrt();
        let direction = towards / distance_m;
        if !wanted(direction) {
            return None;
        }
        if let Some(mirror) = source.mirror {
            self.mirrors[mirror].meet(self.scene, point, direction, distance_m)?;
        }
        let leaving = source.world_from_luminaire.transpose() * -direction;
        let distribution = &self.luminaire(source).kind.distribution;
        let intensity_cd = distribution.intensity_along(leaving) * source.dim;
        (intensity_cd > 0.0).then(|| Arrival {
            direction,
            distance_m,
            normal_lx: intensity_cd / distance_squared,
        })
    }

    /// Unit direction from `point` to the point of an opening at `u`, and the distance, m.
    pub fn towards(&self, source: &Source, point: DVec3, u: [f64; 2]) -> Option<(DVec3, f64)> {
        let towards = source.position + source.world_from_luminaire * source.opening.point(u) - point;
        let distance_m = towards.length();
        (distance_m > 0.0).then(|| (towards / distance_m, distance_m))
    }

    /// Share of an arrival that reaches `point`: 0 behind anything opaque, pane transmittances,
    /// and for an image the specular reflectance at the place where the ray meets the mirror.
    pub fn passed(&self, source: &Source, point: DVec3, arrival: &Arrival) -> f64 {
        let tracer = &self.scene.tracer;
        let blind = &self.luminaire(source).body;
        match source.mirror {
            None => {
                // The opening may lie *in* a surface: stop short of it.
                let reach = arrival.distance_m - 2.0 * tracer.offset_m();
                tracer.transmittance(point, arrival.direction, reach, blind)
            }
            Some(mirror) => self.passed_by_mirror(&self.mirrors[mirror], tracer, point, arrival, blind),
        }
    }

    fn passed_by_mirror(
        &self,
        mirror: &Mirror,
        tracer: &Tracer,
        point: DVec3,
        arrival: &Arrival,
        blind: &[u32],
    ) -> f64 {
        let Some((distance_m, triangle)) =
            mirror.meet(self.scene, point, arrival.direction, arrival.distance_m)
        else {
            return 0.0;
        };
        let cos = arrival.direction.dot(mirror.normal).abs();
        let Some((reflectance, _)) = self.scene.bsdf(triangle).specular(cos) else { return 0.0 };
        let lift = tracer.offset_m();
        let before = tracer.transmittance(point, arrival.direction, distance_m - lift, blind);
        if !(before * reflectance > 0.0) {
            return 0.0;
        }
        let side = mirror.normal * -arrival.direction.dot(mirror.normal).signum();
        let turned = point + arrival.direction * distance_m + side * lift;
        let onward = arrival.direction - 2.0 * arrival.direction.dot(mirror.normal) * mirror.normal;
        let rest = arrival.distance_m - distance_m - 2.0 * lift;
        reflectance * before * tracer.transmittance(turned, onward, rest, blind)
    }

    /// Luminance in cd/m² with which transport sees the opening of `luminaire` along `direction`
    /// (unit, from the eye), and the distance to it; `None` if the ray misses it or it is a point.
    ///
    /// L = I(C,γ)/(A |cos γ|): the same light that [`Emitters::arrival`] integrates.
    pub fn opening_along(&self, luminaire: usize, origin: DVec3, direction: DVec3) -> Option<(f64, f64)> {
        let entry = &self.scene.luminaires[luminaire];
        let kind = &entry.kind;
        let area_m2 = kind.opening.area_m2();
        let into = entry.world_from_luminaire.transpose();
        let (o, d) = (into * (origin - entry.position), into * direction);
        let t = -o.z / d.z;
        if !(area_m2 > 0.0 && t > 0.0 && t.is_finite()) {
            return None;
        }
        let at = o + d * t;
        if !kind.opening.contains(at) {
            return None;
        }
        let intensity_cd = kind.distribution.intensity_along(-d) * entry.dim;
        Some((intensity_cd / (area_m2 * d.z.abs()), t))
    }
}
