//! A convex luminous body put together from pieces of surface, as its onlookers see it. The drawing
//! of a point goes by what each piece *shows*, so hidden pieces take none.

use glam::DVec3;

use super::face::{Face, Onlooker};
use super::opening::Shine;

/// A convex luminous body about the origin.
#[derive(Clone, Copy, Debug)]
pub(super) struct Body {
    pub faces: [Face; 6],
    pub count: usize,
}

impl Body {
    /// Bottom, top, and sides facing +x, +y, −x, −y of these heights, centred in height.
    pub(super) fn cuboid(length_m: f64, width_m: f64, sides_m: [f64; 4]) -> Self {
        let height_m = sides_m.into_iter().fold(0.0, f64::max);
        let (x, y, z) =
            (DVec3::X * (0.5 * length_m), DVec3::Y * (0.5 * width_m), DVec3::Z * (0.5 * height_m));
        let side = |centre: DVec3, a: DVec3, height_m: f64| Face::Plane {
            centre,
            a,
            b: DVec3::Z * (0.5 * height_m),
            normal: centre.normalize_or_zero(),
            round: false,
        };
        let level = |centre: DVec3, normal: DVec3| Face::Plane { centre, a: x, b: y, normal, round: false };
        let [east, north, west, south] = sides_m;
        let faces = [
            level(-z, DVec3::NEG_Z),
            level(z, DVec3::Z),
            side(x, y, east),
            side(y, x, north),
            side(-x, y, west),
            side(-y, x, south),
        ];
        Self { faces, count: 6 }
    }

    /// Mantle and both ends.
    pub(super) fn cylinder(axis: DVec3, a: DVec3, b: DVec3) -> Self {
        let end =
            |axis: DVec3| Face::Plane { centre: axis, a, b, normal: axis.normalize_or_zero(), round: true };
        let mantle = Face::Mantle { axis, a, b };
        Self { faces: [mantle, end(axis), end(-axis), mantle, mantle, mantle], count: 3 }
    }

    pub(super) fn projected_area_m2(&self, toward: DVec3) -> f64 {
        self.faces[..self.count].iter().map(|face| face.projected_area_m2(toward)).sum()
    }

    /// What each piece shows, m²; see [`Face::visible_m2`].
    pub(super) fn visible_m2(&self, eye: Onlooker) -> [f64; 6] {
        let mut seen_m2 = [0.0; 6];
        for (seen_m2, face) in seen_m2.iter_mut().zip(&self.faces[..self.count]) {
            *seen_m2 = face.visible_m2(eye);
        }
        seen_m2
    }

    /// A piece drawn by what it shows, and what is left of u; `None` if nothing is seen.
    pub(super) fn choose(&self, seen_m2: &[f64; 6], u: [f64; 2]) -> Option<(usize, [f64; 2])> {
        let total: f64 = seen_m2.iter().sum();
        if !(total > 0.0) {
            return None;
        }
        let mut x = u[0] * total;
        let mut last = None;
        for (index, &area_m2) in
            seen_m2[..self.count].iter().enumerate().filter(|(_, area_m2)| **area_m2 > 0.0)
        {
            if x < area_m2 {
                return Some((index, [x / area_m2, u[1]]));
            }
            x -= area_m2;
            last = Some((index, [1.0, u[1]]));
        }
        last
    }

    /// A point of one piece, with the weight that belongs to a visible area of `seen_m2`.
    pub(super) fn shine_of(&self, index: usize, seen_m2: f64, place: DVec3, u: [f64; 2]) -> Option<Shine> {
        if !(seen_m2 > 0.0) {
            return None;
        }
        let eye = Onlooker::at(place);
        let (at, normal) = self.faces[index].visible_point(eye, u);
        let leaving = (place - at).normalize_or_zero();
        let weight = self.weight(seen_m2, normal, place, leaving);
        (weight > 0.0 && weight.is_finite()).then_some(Shine { at, weight })
    }

    /// Weight V (n·ω) / ((n·w) A_p(ω)) of a point with normal n that sends ω to the place in direction w
    /// from the centre, where points are drawn uniformly from the visible area V.
    pub(super) fn weight(&self, seen_m2: f64, normal: DVec3, place: DVec3, leaving: DVec3) -> f64 {
        let towards = place.normalize_or_zero();
        seen_m2 * normal.dot(leaving) / (normal.dot(towards) * self.projected_area_m2(leaving))
    }
}
