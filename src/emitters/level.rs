//! Level openings and points for who asks the same ones millions of times: where they lie in the room, and the
//! light from one place of them.

use glam::DVec3;

use super::{Emitters, Source};

impl Emitters<'_> {
    /// Corners of a rectangle in its plane that holds a level opening or its image, m; of a point all alike.
    pub fn corners(&self, source: &Source) -> [DVec3; 4] {
        let outline = source.opening.outline();
        let (x, y) = outline.iter().fold((0.0f64, 0.0f64), |m, p| (m.0.max(p.x), m.1.max(p.y)));
        [(x, y), (x, -y), (-x, -y), (-x, y)]
            .map(|(x, y)| source.position + source.world_from_luminaire * DVec3::new(x, y, 0.0))
    }

    /// Places in the room of the points at `u` of a level opening or an image of one, m.
    pub fn places<const N: usize>(&self, source: &Source, u: [[f64; 2]; N]) -> [DVec3; N] {
        u.map(|u| source.position + source.world_from_luminaire * source.opening.plane_point(u))
    }

    /// Direction towards the place `from` of a level opening, and the light in lx that it would send from there
    /// to a surface that faces it; the edges of an image's mirror apart.
    #[inline]
    pub fn lit_from(
        &self,
        source: &Source,
        point: DVec3,
        from: DVec3,
        wanted: impl FnOnce(DVec3) -> bool,
    ) -> Option<(DVec3, f64)> {
        let towards = from - point;
        let distance_squared = towards.length_squared();
        let direction = towards / distance_squared.sqrt();
        if !(distance_squared > 0.0 && wanted(direction)) {
            return None;
        }
        let leaving = source.world_from_luminaire.transpose() * -direction;
        let intensity_cd = self.luminaire(source).kind.distribution.intensity_along(leaving) * source.dim;
        Some((direction, intensity_cd / distance_squared))
    }
}
