//! Luminaires seen by two mirrors or more, one after the other. No image owns that light: rays find it by chance, and
//! where a small or narrow luminaire is seldom met, blocks may agree on values that lack it. Here it is known how
//! much of it there is at a place, and how often rays come to it, so that intervals can tell.

use glam::DVec3;

use super::{Arrival, Emitters, Mirror, Source};
use crate::query::Kernel;

/// Pairs of mirrors that reflect less of what is seen in both are left to chance alone: pairs of panes, or of a
/// mirror and a pane.
const LEAST: f64 = 0.1;
/// Rows of mirrors that reflect less are left to chance too …
const LEAST_OF_ROW: f64 = 0.02;
/// … and where there are more rows than this for one luminaire, nobody knows how much light they send.
const MOST_ROWS: usize = 512;
/// Points of an opening along each of its two parameters, for two mirrors; for more its middle will do.
const POINTS: u32 = 4;

/// Light of a channel that comes to one kernel by two mirrors or more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ByChance {
    /// Channel of the scene.
    pub channel: usize,
    /// How much of it there is, lx; infinite where mirrors repeat one another too often to tell.
    pub lx: f64,
    /// How many of the rays that follow the receiver's responses find it on average; 0 for a point source.
    pub per_ray: f64,
}

/// Pairs of mirrors, the one nearer to the eye first, in which a luminaire may be seen one after the other.
pub fn facing_pairs(emitters: &Emitters) -> Vec<[usize; 2]> {
    let strengths: Vec<f64> = emitters.mirrors.iter().map(|mirror| strength(emitters, mirror)).collect();
    let all = (0..strengths.len()).flat_map(|first| (0..strengths.len()).map(move |second| [first, second]));
    all.filter(|&[first, second]| first != second && strengths[first] * strengths[second] >= LEAST).collect()
}

/// Largest reflectance of a mirror's parts.
fn strength(emitters: &Emitters, mirror: &Mirror) -> f64 {
    let of = |&triangle: &u32| emitters.scene.bsdf(triangle).specular(1.0).map_or(0.0, |(part, _)| part);
    mirror.triangles.iter().map(of).fold(0.0, f64::max)
}

/// A luminaire as a row of mirrors shows it.
struct Shown {
    source: Source,
    /// The mirrors, the one nearest to the eye first.
    row: Vec<usize>,
    strength: f64,
}

/// Images of a luminaire by two mirrors and more, or `None` if there are too many of them.
fn images(emitters: &Emitters, pairs: &[[usize; 2]], own: &Source) -> Option<Vec<Shown>> {
    let strengths: Vec<f64> = emitters.mirrors.iter().map(|mirror| strength(emitters, mirror)).collect();
    let by = |shown: &Source, mirror: usize| shown.image(&emitters.mirrors[mirror], Some(mirror));
    let mut all: Vec<Shown> = pairs
        .iter()
        .map(|&[near, far]| Shown {
            source: by(&by(own, far), near),
            row: vec![near, far],
            strength: strengths[near] * strengths[far],
        })
        .collect();
    let mut first = 0;
    while first < all.len() {
        let (last, mut next) = (all.len(), Vec::new());
        for shown in &all[first..last] {
            for &[near, _] in pairs.iter().filter(|[_, far]| *far == shown.row[0]) {
                let strength = shown.strength * strengths[near];
                if strength >= LEAST_OF_ROW {
                    let row = [&[near][..], &shown.row].concat();
                    next.push(Shown { source: by(&shown.source, near), row, strength });
                }
            }
            if last + next.len() > MOST_ROWS {
                return None;
            }
        }
        first = last;
        all.extend(next);
    }
    Some(all)
}

/// What every luminaire sends to the `kernels` at a point by two mirrors and more, one list for each kernel.
pub fn twice_mirrored(
    emitters: &Emitters,
    pairs: &[[usize; 2]],
    point: DVec3,
    kernels: &[Kernel],
) -> Vec<Vec<ByChance>> {
    let mut found = vec![Vec::new(); kernels.len()];
    for own in &emitters.sources[..emitters.scene.luminaires.len()] {
        let Some(images) = images(emitters, pairs, own) else {
            let unknown = ByChance { channel: own.channel, lx: f64::INFINITY, per_ray: 0.0 };
            for found in &mut found {
                found.push(unknown);
            }
            continue;
        };
        for Shown { source: image, row, .. } in &images {
            if !emitters.may_show(image, point) {
                continue;
            }
            let count = if own.is_point() || row.len() > 2 { 1 } else { POINTS };
            let mut lx = vec![0.0; kernels.len()];
            let mut per_ray = 0.0;
            for number in 0..count * count {
                let u = [number / count, number % count].map(|k| (f64::from(k) + 0.5) / f64::from(count));
                let responds = |direction| kernels.iter().any(|kernel| kernel.response(direction) > 0.0);
                let Some(arrival) = emitters.arrival_if(image, point, u, responds) else { continue };
                let passed = passed_all(emitters, image, row, point, &arrival);
                if !(passed > 0.0) {
                    continue;
                }
                let share = passed / f64::from(count * count);
                for (lx, kernel) in lx.iter_mut().zip(kernels) {
                    *lx += share * arrival.normal_lx * kernel.response(arrival.direction);
                }
                let density = kernels.iter().map(|kernel| kernel.pdf(arrival.direction)).sum::<f64>();
                let visible_sr = share / emitters.density(image, &arrival);
                per_ray += if own.is_point() { 0.0 } else { visible_sr * density / kernels.len() as f64 };
            }
            for (found, lx) in found.iter_mut().zip(lx) {
                if lx > 0.0 {
                    found.push(ByChance { channel: own.channel, lx, per_ray });
                }
            }
        }
    }
    found
}

/// Share of an arrival that passes all mirrors of a row and what stands before, between and behind them.
fn passed_all(emitters: &Emitters, source: &Source, row: &[usize], point: DVec3, arrival: &Arrival) -> f64 {
    let scene = emitters.scene;
    let lift = scene.tracer.offset_m();
    let body = &emitters.luminaire(source).body;
    let (mut origin, mut direction, mut rest_m, mut passed) =
        (point, arrival.direction, arrival.distance_m, 1.0);
    for mirror in row.iter().map(|&index| &emitters.mirrors[index]) {
        let Some((distance_m, triangle)) = mirror.meet(origin, direction, rest_m) else { return 0.0 };
        let cos = direction.dot(mirror.normal);
        let Some((reflectance, _)) = scene.bsdf(triangle).specular(cos.abs()) else { return 0.0 };
        passed *= reflectance * scene.tracer.transmittance(origin, direction, distance_m - lift, &[]);
        if !(passed > 0.0) {
            return 0.0;
        }
        origin += direction * distance_m - mirror.normal * (cos.signum() * lift);
        direction -= 2.0 * cos * mirror.normal;
        rest_m -= distance_m + lift;
    }
    passed * scene.tracer.transmittance(origin, direction, rest_m - 2.0 * lift, body)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::mesh::Mesh;
    use crate::luminaire::{Luminaire, LuminaireType, Maintenance, orientation};
    use crate::material::{Bsdf, Material};
    use crate::photometry::{IntensityDistribution, Opening};
    use crate::scene::Scene;
    use crate::units::Lumens;
    use std::f64::consts::PI;

    /// A point of 1000 cd at (1, 0, 1); mirrors of 0.9 in x = 0 and in z = 0, the latter only from `gap` on; a dark
    /// plate hides the lamp from the eye.
    fn corner(gap: f64) -> Scene {
        let mut mesh = Mesh::default();
        let wall = mesh.add_surface("Wall", 0, true);
        let p = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
        mesh.add_quad([p(0.0, -5.0, 0.0), p(0.0, 5.0, 0.0), p(0.0, 5.0, 5.0), p(0.0, -5.0, 5.0)], wall);
        let floor = mesh.add_surface("Floor", 0, true);
        mesh.add_quad([p(gap, -5.0, 0.0), p(9.0, -5.0, 0.0), p(9.0, 5.0, 0.0), p(gap, 5.0, 0.0)], floor);
        let material = Material { name: "Mirror".into(), bsdf: Bsdf::Mirror { reflectance: 0.9 } };
        let flux = 4.0 * PI * 1000.0;
        let kind = LuminaireType {
            name: "A".into(),
            description: String::new(),
            flux_lm: flux,
            distribution: IntensityDistribution::isotropic(Lumens(flux)),
            opening: Opening::Point,
            rated_flux_lm: None,
            power_w: None,
            maintenance: Maintenance::NEW,
            emergency: None,
            file: String::new(),
            declared_ra: None,
        };
        let lamp = Luminaire {
            kind: std::sync::Arc::new(kind),
            position: p(1.0, 0.0, 1.0),
            world_from_luminaire: orientation(DVec3::NEG_Z, 0.0),
            group: "A".into(),
            dim: 1.0,
            body: Vec::new(),
        };
        Scene::new(mesh, vec![material], vec![lamp]).expect("a scene")
    }

    /// Catches: a second image in the wrong place, a mirror that counts where it does not reach, once instead of
    /// twice its reflectance.
    #[test]
    fn a_corner_of_mirrors_shows_a_lamp_a_third_time() {
        let found = |gap: f64| {
            let scene = corner(gap);
            let emitters = Emitters::new(&scene);
            let pairs = facing_pairs(&emitters);
            assert_eq!(pairs.len(), 2);
            let kernels = [Kernel::Planar { normal: DVec3::NEG_X }, Kernel::Spherical];
            let lists = twice_mirrored(&emitters, &pairs, DVec3::new(3.0, 0.0, 2.0), &kernels);
            lists.iter().map(|list| list.iter().map(|one| one.lx).sum::<f64>()).collect::<Vec<_>>()
        };
        // The image lies at (−1, 0, −1), 4 m aside and 3 m below: 25 m². One order of the two mirrors shows it.
        let normal_lx = 0.81 * 1000.0 / 25.0;
        let [planar, spherical] = found(0.0)[..] else { unreachable!("two kernels") };
        assert!((planar / (0.8 * normal_lx) - 1.0).abs() < 1e-6, "{planar}");
        assert!((spherical / (0.25 * normal_lx) - 1.0).abs() < 1e-6, "{spherical}");
        // The floor is met at x = 1/3: where it begins behind that, nothing is seen by both.
        assert!(found(0.5)[0].abs() < 1e-9, "{:?}", found(0.5));
        assert!(found(0.3)[0] > 0.0);
    }

    /// A point lamp between two mirrors of `strength` that face each other, seen past a plate: light comes by many
    /// reflections.
    fn hall(strength: f64, third: bool) -> Scene {
        let mut scene = corner(9.0);
        let mut mesh = Mesh::default();
        let p = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
        for (name, y) in [("S", 0.0), ("N", 4.0)] {
            let surface = mesh.add_surface(name, 0, true);
            mesh.add_quad([p(-9.0, y, -9.0), p(9.0, y, -9.0), p(9.0, y, 9.0), p(-9.0, y, 9.0)], surface);
        }
        if third {
            for (name, x) in [("W", -9.0), ("E", 9.0)] {
                let surface = mesh.add_surface(name, 0, true);
                mesh.add_quad([p(x, 0.0, -9.0), p(x, 4.0, -9.0), p(x, 4.0, 9.0), p(x, 0.0, 9.0)], surface);
            }
        }
        let mut lamp = scene.luminaires.remove(0);
        lamp.position = p(0.0, 1.0, 0.0);
        let material = Material { name: "Mirror".into(), bsdf: Bsdf::Mirror { reflectance: strength } };
        Scene::new(mesh, vec![material], vec![lamp]).expect("a scene")
    }

    /// Catches: a series that ends at its second term, terms that are there twice, endless ones that pass for none.
    #[test]
    fn mirrors_that_face_each_other_repeat_a_lamp() {
        let scene = hall(0.8, false);
        let emitters = Emitters::new(&scene);
        let (point, kernels) = (DVec3::new(0.5, 2.5, 0.5), [Kernel::Spherical]);
        let lists = twice_mirrored(&emitters, &facing_pairs(&emitters), point, &kernels);
        let found: f64 = lists[0].iter().map(|one| one.lx).sum();
        // Images at 8 k ± 1 m: even numbers 2k of reflections show +1, odd ones 2k + 1 … −1.
        let mut expected = 0.0;
        for k in -40i32..=40 {
            for (y, order) in
                [(8.0 * f64::from(k) + 1.0, 2 * k.abs()), (8.0 * f64::from(k) - 1.0, (2 * k - 1).abs())]
            {
                let strength = 0.8f64.powi(order);
                if order >= 2 && strength >= LEAST_OF_ROW {
                    expected += 0.25 * strength * 1000.0 / (DVec3::new(0.0, y, 0.0) - point).length_squared();
                }
            }
        }
        assert!((found / expected - 1.0).abs() < 1e-6, "{found} lx, {expected} expected");
        let scene = hall(0.95, true);
        let emitters = Emitters::new(&scene);
        let lists = twice_mirrored(&emitters, &facing_pairs(&emitters), point, &kernels);
        assert!(lists[0].iter().any(|one| one.lx.is_infinite()), "too many rows to tell");
    }
}
