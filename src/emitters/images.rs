//! Planar specular surfaces and the images of luminaires in them. Light that is reflected exactly
//! once by such a plane is owned by its image; more reflections are found by following rays.

use glam::{DMat3, DVec3};

use crate::material::Bsdf;
use crate::scene::Scene;

/// At most this many planes get images, and only those with this share of the scene's area; light
/// reflected by others is found by rays that happen to hit an opening (right, but noisier, and lost
/// for point sources, which is measured and listed).
const MOST_PLANES: usize = 12;
const LEAST_SHARE: f64 = 2e-4;

/// Triangles of specular material in one plane.
#[derive(Clone, Debug)]
pub struct Mirror {
    /// Unit normal of the plane.
    pub normal: DVec3,
    /// normal · point for points of the plane, m.
    pub offset_m: f64,
    /// Triangles in the plane.
    pub triangles: Vec<u32>,
    /// Probability with which a random estimate considers the images in it: faint reflections (clear
    /// panes) are taken more rarely and weighted up, which saves more time than it adds noise.
    pub chance: f64,
    /// Centre and radius of a ball around them, m.
    centre: DVec3,
    radius_m: f64,
}

impl Mirror {
    /// The image of a point.
    pub fn image(&self, point: DVec3) -> DVec3 {
        point - 2.0 * (point.dot(self.normal) - self.offset_m) * self.normal
    }

    /// The linear part of the reflection, I − 2 n nᵀ.
    pub fn reflection(&self) -> DMat3 {
        let n = self.normal;
        DMat3::IDENTITY - DMat3::from_cols(n * n.x, n * n.y, n * n.z) * 2.0
    }

    /// Whether an image of an opening of `radius_m` about `image` may be seen from `point`.
    #[inline]
    pub fn may_show(&self, point: DVec3, image: DVec3, radius_m: f64) -> bool {
        let here = point.dot(self.normal) - self.offset_m;
        let there = image.dot(self.normal) - self.offset_m;
        if there.abs() <= radius_m {
            return true;
        }
        if here * there >= 0.0 {
            return false;
        }
        // Where the ray to another point of the opening meets the plane: it is turned by at most
        // `radius_m`, and cut earlier or later where that point lies nearer to the plane or farther.
        let towards = image - point;
        let share = here / (here - there);
        let largest = here.abs() / (here.abs() + there.abs() - radius_m);
        let at = point + towards * share;
        let reach_m = self.radius_m + largest * radius_m + (largest - share) * towards.length();
        (at - self.centre).length_squared() <= reach_m * reach_m
    }

    /// Where the ray meets the plane inside one of its triangles, before `reach_m`.
    pub fn meet(&self, scene: &Scene, origin: DVec3, direction: DVec3, reach_m: f64) -> Option<(f64, u32)> {
        let distance_m = (self.offset_m - origin.dot(self.normal)) / direction.dot(self.normal);
        if !(distance_m > 0.0 && distance_m < reach_m) {
            return None;
        }
        let at = origin + direction * distance_m;
        if (at - self.centre).length_squared() > self.radius_m * self.radius_m {
            return None;
        }
        let inside = |triangle: u32| {
            let [a, b, c] = scene.mesh.corners(triangle as usize);
            let side = |p: DVec3, q: DVec3| (q - p).cross(at - p).dot(self.normal);
            let (u, v, w) = (side(a, b), side(b, c), side(c, a));
            (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0)
        };
        self.triangles.iter().copied().find(|&t| inside(t)).map(|t| (distance_m, t))
    }
}

/// Specular planes by size, the largest [`MOST_PLANES`], and for each triangle whether it is in one.
pub(super) fn mirrors(scene: &Scene) -> (Vec<Mirror>, Vec<bool>) {
    let found = planes(scene, MOST_PLANES, |bsdf| bsdf.specular(1.0).is_some());
    let mut imaged = vec![false; scene.mesh.triangles.len()];
    for triangle in found.iter().flat_map(|mirror| &mirror.triangles) {
        imaged[*triangle as usize] = true;
    }
    (found, imaged)
}

/// At most `most` planes of surfaces that `belongs` picks, the largest first.
pub fn planes(scene: &Scene, most: usize, belongs: impl Fn(&Bsdf) -> bool) -> Vec<Mirror> {
    let mesh = &scene.mesh;
    let size_m = mesh.bounds().map_or(1.0, |(lo, hi)| (hi - lo).length());
    let mut found: Vec<(Mirror, f64)> = Vec::new();
    for triangle in 0..mesh.triangles.len() as u32 {
        if !belongs(scene.bsdf(triangle)) {
            continue;
        }
        let (normal, area_m2) = mesh.normal_and_area(triangle as usize);
        let offset_m = normal.dot(mesh.corners(triangle as usize)[0]);
        let same = found.iter().position(|(mirror, _)| {
            let sign = mirror.normal.dot(normal).signum();
            mirror.normal.dot(normal).abs() > 1.0 - 1e-12
                && (offset_m * sign - mirror.offset_m).abs() < 1e-9 * size_m
        });
        match same {
            Some(known) => {
                found[known].0.triangles.push(triangle);
                found[known].1 += area_m2;
            }
            None if found.len() < 4096 => {
                found.push((
                    Mirror {
                        normal,
                        offset_m,
                        triangles: vec![triangle],
                        chance: 1.0,
                        centre: DVec3::ZERO,
                        radius_m: 0.0,
                    },
                    area_m2,
                ));
            }
            None => {}
        }
    }
    found.sort_by(|a, b| b.1.total_cmp(&a.1));
    // Point sources have no opening to be hit: for them every plane counts.
    let has_points = scene.luminaires.iter().any(|luminaire| luminaire.kind.opening.is_point());
    let total_m2: f64 = mesh.surface_areas_m2().iter().sum();
    found.retain(|(_, area_m2)| has_points || *area_m2 >= LEAST_SHARE * total_m2);
    found.truncate(most);
    for (mirror, _) in &mut found {
        let triangles = mirror.triangles.clone();
        let corners = || triangles.iter().flat_map(|&t| mesh.corners(t as usize));
        let reflectances = mirror.triangles.iter().filter_map(|&t| scene.bsdf(t).specular(1.0));
        let reflectance = reflectances.map(|(reflected, _)| reflected).fold(0.0, f64::max);
        mirror.chance = (2.5 * reflectance).clamp(0.2, 1.0);
        mirror.centre = corners().sum::<DVec3>() / (3.0 * mirror.triangles.len() as f64);
        mirror.radius_m = corners().map(|p| p.distance(mirror.centre)).fold(0.0, f64::max) * (1.0 + 1e-9);
    }
    found.into_iter().map(|(mirror, _)| mirror).collect()
}
