//! A placed luminaire seen from a point: the illuminance it gives by any kernel, the part of it
//! that is visible, its luminance and solid angle. Solvers and glare use the same functions, so
//! what lights a desk and what dazzles an eye cannot differ.
//!
//! Light leaves every point of a flat opening alike: dE = I(C,γ)/A · R(ω) / d² dA, so its illuminance
//! never divides by a projected area; bodies are weighted by what is seen of them, see
//! [`crate::photometry::Opening`]. A luminaire is also seen as its image in a planar mirror or pane.

mod direct;
mod glimpsed;
mod glints;
mod images;
mod level;
mod mirror;
mod rings;
mod seen;
mod shining;
mod twice;

use glam::{DMat3, DVec3};

use crate::geometry::trace::Hit;
use crate::luminaire::Luminaire;
use crate::photometry::{Met, Opening, Shine};
use crate::scene::Scene;

pub use direct::{TOLERANCE, contour, unshadowed};
pub use glimpsed::Lookout;
pub use glints::{Glint, GlintPiece, glints_from};
pub use images::planes;
pub use mirror::{Glimpse, Mirror};
pub use rings::{INNERMOST_DEG, Ring, Shiner, rings};
pub use seen::{Seen, SeenPiece, Sighted, seen_by_points, seen_from, sighted_from};
pub use shining::{Piece, Shining, shining_from, shining_in_pieces};
pub use twice::{ByChance, facing_pairs, twice_mirrored};

/// All luminaires of a scene and their images.
#[derive(Debug)]
pub struct Emitters<'s> {
    /// The scene.
    pub scene: &'s Scene,
    /// Luminaires first (same index as in the scene), then images.
    pub sources: Vec<Source>,
    /// Planar specular surfaces in which images are taken.
    pub mirrors: Vec<Mirror>,
    /// Planes of glossy surfaces in which highlights are looked for.
    pub glossy: Vec<Mirror>,
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
    /// Area of the opening as seen from γ = 0, m².
    pub area_m2: f64,
    /// Radius of a ball that holds the opening, m; 0 for a point.
    pub radius_m: f64,
    opening: Opening,
    dim: f64,
    /// Flat, without light at γ ≥ 90°: what lies behind its plane gets none.
    one_sided: bool,
}

/// Light that would arrive at a point from one point of an opening if nothing stood between.
#[derive(Clone, Copy, Debug)]
pub struct Arrival {
    /// Unit direction from the receiving point towards the source.
    pub direction: DVec3,
    /// Distance, m.
    pub distance_m: f64,
    /// I(C,γ)/d² in lx on a surface that faces the source, panes and mirrors not yet taken off; the
    /// weight of the point ([`Shine`]) is in it.
    pub normal_lx: f64,
    /// That weight.
    pub weight: f64,
    /// Where light of an image meets its mirror, if that is known: distance, m, and triangle.
    pub mirrored: Option<(f64, u32)>,
}

impl Source {
    /// All light leaves from one point.
    pub fn is_point(&self) -> bool {
        !(self.radius_m > 0.0)
    }

    /// Whether a point lies where no point of the opening sends light to, by a cheap test that only ever errs
    /// towards no.
    #[inline]
    pub fn is_behind(&self, point: DVec3) -> bool {
        self.one_sided && self.world_from_luminaire.z_axis.dot(point - self.position) > 0.0
    }

    /// A point in the luminaire frame.
    fn place(&self, point: DVec3) -> DVec3 {
        self.world_from_luminaire.transpose() * (point - self.position)
    }

    /// Its image in a plane.
    #[must_use]
    pub fn image(&self, plane: &Mirror, mirror: Option<usize>) -> Self {
        Self {
            mirror,
            position: plane.image(self.position),
            world_from_luminaire: plane.reflection() * self.world_from_luminaire,
            ..self.clone()
        }
    }
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
                radius_m: if luminaire.kind.opening.is_point() {
                    0.0
                } else {
                    luminaire.kind.opening.radius_m()
                },
                opening: luminaire.kind.opening,
                dim: luminaire.dim,
                one_sided: luminaire.kind.opening.is_level() && luminaire.kind.distribution.is_dark_above(),
            })
            .collect();
        for (index, mirror) in mirrors.iter().enumerate() {
            for luminaire in 0..scene.luminaires.len() {
                let image = sources[luminaire].image(mirror, Some(index));
                sources.push(image);
            }
        }
        let glossy = glints::glossy(scene);
        Self { scene, sources, mirrors, glossy, imaged }
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

    /// Whether a source can light `triangle` straight: a luminaire's own light passes its body, so that
    /// it cannot be reflected by it either. What a mirror sends back does not pass it.
    #[inline]
    pub fn lights(&self, source: &Source, triangle: u32) -> bool {
        let body = &self.luminaire(source).body;
        source.mirror.is_some() || body.is_empty() || !body.contains(&self.scene.tracer.surface(triangle))
    }

    /// Probability with which a random estimate should consider a source; see [`Mirror::chance`].
    pub fn chance(&self, source: &Source) -> f64 {
        source.mirror.map_or(1.0, |mirror| self.mirrors[mirror].chance)
    }

    /// Intensity in cd with which a source shines along the unit `direction` from its place.
    pub fn intensity_cd(&self, source: &Source, direction: DVec3) -> f64 {
        let leaving = source.world_from_luminaire.transpose() * direction;
        self.luminaire(source).kind.distribution.intensity_along(leaving) * source.dim
    }

    /// Light from the point of the opening at `u` (in the unit square) to `point`.
    pub fn arrival(&self, source: &Source, point: DVec3, u: [f64; 2]) -> Arrival {
        self.arrival_if(source, point, u, |_| true).unwrap_or(Arrival {
            direction: (source.position - point).normalize_or_zero(),
            distance_m: source.position.distance(point),
            normal_lx: 0.0,
            weight: 1.0,
            mirrored: None,
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
        if source.is_behind(point) {
            return None;
        }
        let shine = source.opening.shine(source.place(point), u)?;
        self.arrival_from(source, point, shine, wanted)
    }

    /// [`Emitters::arrival_if`] for random points of which no density is asked ([`Opening::shine_evenly`]).
    #[inline]
    pub fn arrival_evenly(
        &self,
        source: &Source,
        point: DVec3,
        u: [f64; 2],
        wanted: impl FnOnce(DVec3) -> bool,
    ) -> Option<Arrival> {
        if source.is_behind(point) {
            return None;
        }
        let shine = source.opening.shine_evenly(source.place(point), u)?;
        self.arrival_from(source, point, shine, wanted)
    }

    #[inline]
    fn arrival_from(
        &self,
        source: &Source,
        point: DVec3,
        shine: Shine,
        wanted: impl FnOnce(DVec3) -> bool,
    ) -> Option<Arrival> {
        let mut mirrored = None;
        let arrival = self.arriving(source, point, shine, |direction, distance_m| {
            wanted(direction)
                && source.mirror.is_none_or(|mirror| {
                    mirrored = self.mirrors[mirror].meet(point, direction, distance_m);
                    mirrored.is_some()
                })
        })?;
        Some(Arrival { mirrored, ..arrival })
    }

    /// Light from a point of an opening, the edges of an image's mirror apart.
    #[inline]
    fn arriving(
        &self,
        source: &Source,
        point: DVec3,
        shine: Shine,
        wanted: impl FnOnce(DVec3, f64) -> bool,
    ) -> Option<Arrival> {
        let from = source.position + source.world_from_luminaire * shine.at;
        let towards = from - point;
        let distance_squared = towards.length_squared();
        // A receiver that touches the opening has no finite point illuminance; it gets none.
        if !(distance_squared > 0.0) {
            return None;
        }
        let distance_m = distance_squared.sqrt();
        let direction = towards / distance_m;
        if !wanted(direction, distance_m) {
            return None;
        }
        let leaving = source.world_from_luminaire.transpose() * -direction;
        let distribution = &self.luminaire(source).kind.distribution;
        let intensity_cd = distribution.intensity_along(leaving) * source.dim;
        (intensity_cd > 0.0).then(|| Arrival {
            direction,
            distance_m,
            normal_lx: shine.weight * intensity_cd / distance_squared,
            weight: shine.weight,
            mirrored: None,
        })
    }

    /// Unit direction from `point` to the point of an opening at `u`, and the distance, m.
    pub fn towards(&self, source: &Source, point: DVec3, u: [f64; 2]) -> Option<(DVec3, f64)> {
        let shine = source.opening.shine(source.place(point), u)?;
        let towards = source.position + source.world_from_luminaire * shine.at - point;
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

    /// Share of the light of a place that reaches `point`, straight (0 behind anything opaque, pane
    /// transmittances) or, where `place` is an image, by its plane.
    fn clear(&self, point: DVec3, place: DVec3, mirror: Option<usize>) -> f64 {
        let towards = place - point;
        let distance_m = towards.length();
        let direction = towards / distance_m;
        let tracer = &self.scene.tracer;
        let Some(mirror) = mirror else {
            return tracer.transmittance(point, direction, distance_m - 2.0 * tracer.offset_m(), &[]);
        };
        let arrival = Arrival { direction, distance_m, normal_lx: 0.0, weight: 1.0, mirrored: None };
        self.passed_by_mirror(&self.mirrors[mirror], tracer, point, &arrival, &[])
    }

    /// Luminance in cd/m² with which transport sees the opening of `luminaire` along `direction`
    /// (unit, from the eye), and the distance to it; `None` if the ray misses it or it is a point.
    ///
    /// L = I(C,γ)/A_p(C,γ): the same light that [`Emitters::arrival`] integrates.
    pub fn opening_along(&self, luminaire: usize, origin: DVec3, direction: DVec3) -> Option<(f64, f64)> {
        let (luminance, arrival) = self.along(&self.sources[luminaire], origin, direction)?;
        Some((luminance, arrival.distance_m))
    }

    /// [`Emitters::opening_along`] of a luminaire or an image, as if nothing stood between.
    #[inline]
    pub fn along(&self, source: &Source, origin: DVec3, direction: DVec3) -> Option<(f64, Arrival)> {
        // Most rays pass it by far: then its ball is missed too.
        let away = source.position - origin;
        let squared = away.length_squared();
        let forward = away.dot(direction);
        let aside = squared - forward * forward;
        if aside > 1.000_001 * source.radius_m * source.radius_m + 1e-9 * squared {
            return None;
        }
        let into = source.world_from_luminaire.transpose();
        let (o, d) = (into * (origin - source.position), into * direction);
        let Met { distance_m, projected_m2, weight } = source.opening.along(o, d)?;
        let distribution = &self.luminaire(source).kind.distribution;
        let intensity_cd = distribution.intensity_along(-d) * source.dim;
        let normal_lx = weight * intensity_cd / (distance_m * distance_m);
        let arrival = Arrival { direction, distance_m, normal_lx, weight, mirrored: None };
        Some((intensity_cd / projected_m2, arrival))
    }

    /// Share of the light of an opening at `distance_m` that reaches the origin of a ray which meets
    /// `hit` first: a luminaire's own body does not hide it.
    pub fn uncovered(
        &self,
        luminaire: usize,
        (origin, direction): (DVec3, DVec3),
        distance_m: f64,
        hit: Option<&Hit>,
    ) -> f64 {
        let tracer = &self.scene.tracer;
        // The opening may lie *in* the surface that ends the ray.
        let reach = distance_m - 2.0 * tracer.offset_m();
        let Some(hit) = hit.filter(|hit| hit.distance_m <= reach) else { return 1.0 };
        let body = &self.scene.luminaires[luminaire].body;
        if body.contains(&tracer.surface(hit.triangle)) {
            tracer.transmittance(origin, direction, reach, body)
        } else {
            0.0
        }
    }

    /// Outline of an opening in the room, m; none of a point.
    pub fn outline(&self, source: &Source) -> Vec<DVec3> {
        let place = |corner: DVec3| source.position + source.world_from_luminaire * corner;
        source.opening.outline().into_iter().map(place).collect()
    }

    /// Luminance I/A_p in cd/m² and solid angle A_p/d² in sr of an opening seen from `point` were it shifted
    /// by `shift`, as if nothing stood between; `None` for points and from behind.
    pub fn shifted(&self, source: &Source, point: DVec3, shift: DVec3) -> Option<[f64; 2]> {
        let away = point - source.position - shift;
        let distance_m = away.length();
        let leaving = away / distance_m;
        let seen_m2 = source.opening.projected_area_m2(source.world_from_luminaire.transpose() * leaving);
        let intensity_cd = self.intensity_cd(source, leaving);
        (seen_m2 > 0.0 && distance_m > 0.0)
            .then(|| [intensity_cd / seen_m2, seen_m2 / (distance_m * distance_m)])
    }

    /// Density in 1/sr, seen from the receiving point, with which [`Emitters::arrival`] draws the
    /// direction of an arrival: d²/(weight · A_p); infinite for points.
    pub fn density(&self, source: &Source, arrival: &Arrival) -> f64 {
        let leaving = source.world_from_luminaire.transpose() * -arrival.direction;
        let projected_m2 = source.opening.seen_m2(leaving);
        arrival.distance_m * arrival.distance_m / (arrival.weight * projected_m2)
    }
}
