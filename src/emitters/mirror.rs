//! A plane in which luminaires are mirrored: where rays meet its triangles, and what of an image a place sees in
//! it. Several triangles and gaps between them may lie in one plane.

use glam::{DMat3, DVec3};

use crate::scene::Scene;

/// Of a plane with more triangles only their common box is known.
const MOST_PIECES: usize = 64;

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
    /// Two unit vectors in the plane, along an edge and across.
    axes: [DVec3; 2],
    /// Their box along these axes.
    bounds: Area,
    /// Their edges, in the order of the triangles.
    edges: Vec<[Edge; 3]>,
    /// Boxes that hold all of them, and rectangles along the axes that they fill.
    pieces: Vec<Area>,
    windows: Vec<Area>,
    /// Whether all of them reflect alike.
    pub is_uniform: bool,
}

/// An upright rectangle in a plane, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Area {
    low: [f64; 2],
    high: [f64; 2],
}

/// normal · x − offset ≥ 0 on one side of an edge.
#[derive(Clone, Copy, Debug)]
struct Edge {
    normal: DVec3,
    offset: f64,
}

impl Area {
    const NOTHING: Self = Self { low: [f64::INFINITY; 2], high: [f64::NEG_INFINITY; 2] };

    fn with(self, [x, y]: [f64; 2]) -> Self {
        let Self { low, high } = self;
        Self { low: [low[0].min(x), low[1].min(y)], high: [high[0].max(x), high[1].max(y)] }
    }

    fn joined(self, other: Self) -> Self {
        self.with(other.low).with(other.high)
    }

    fn holds(&self, other: &Self) -> bool {
        (0..2).all(|k| self.low[k] <= other.low[k] && other.high[k] <= self.high[k])
    }

    fn is_apart_from(&self, other: &Self) -> bool {
        (0..2).any(|k| other.high[k] < self.low[k] || self.high[k] < other.low[k])
    }

    fn widened(self, by: f64) -> Self {
        Self { low: self.low.map(|x| x - by), high: self.high.map(|x| x + by) }
    }
}

/// What light from an opening by way of a plane has of the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Glimpse {
    /// No line meets any of its triangles.
    Nothing,
    /// Some may.
    Some,
    /// All lines do, and they meet the plane in this rectangle (its corners, m).
    All([DVec3; 4]),
}

impl Mirror {
    /// A triangle in its plane. More may be added; then all that follows from them is to be settled.
    pub(super) fn in_plane(normal: DVec3, offset_m: f64, triangle: u32) -> Self {
        Self {
            normal,
            offset_m,
            triangles: vec![triangle],
            chance: 1.0,
            centre: DVec3::ZERO,
            radius_m: 0.0,
            axes: [DVec3::ZERO; 2],
            bounds: Area::NOTHING,
            edges: Vec::new(),
            pieces: Vec::new(),
            windows: Vec::new(),
            is_uniform: true,
        }
    }

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
    pub fn meet(&self, origin: DVec3, direction: DVec3, reach_m: f64) -> Option<(f64, u32)> {
        let distance_m = (self.offset_m - origin.dot(self.normal)) / direction.dot(self.normal);
        if !(distance_m > 0.0 && distance_m < reach_m) {
            return None;
        }
        let at = origin + direction * distance_m;
        let place = self.place(at);
        if (0..2).any(|k| place[k] < self.bounds.low[k] || place[k] > self.bounds.high[k]) {
            return None;
        }
        let inside = |edges: &[Edge; 3]| {
            let [u, v, w] = edges.map(|edge| edge.normal.dot(at) - edge.offset);
            (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0)
        };
        self.edges.iter().position(inside).map(|found| (distance_m, self.triangles[found]))
    }

    /// Place in the plane along its axes.
    fn place(&self, at: DVec3) -> [f64; 2] {
        self.axes.map(|axis| axis.dot(at))
    }

    /// Where the lines from all of `here` to all of `image` meet the plane: those within the hull of the one
    /// and of the other meet it within the box of these.
    pub fn glimpse(&self, here: &[DVec3; 4], image: &[DVec3; 4]) -> Glimpse {
        let met = match self.crossed(here, image) {
            Ok(met) => met,
            Err(glimpse) => return glimpse,
        };
        if self.windows.iter().any(|window| window.holds(&met)) {
            return Glimpse::All(self.corners(met));
        }
        let apart = self.pieces.iter().all(|piece| piece.is_apart_from(&met));
        if apart { Glimpse::Nothing } else { Glimpse::Some }
    }

    /// Corners of a rectangle that holds all places of its triangles where lines from all of `here` to all of
    /// `image` meet them, m, if the plane lies between.
    pub fn shown(&self, here: &[DVec3; 4], image: &[DVec3; 4]) -> Option<[DVec3; 4]> {
        let Area { low, high } = self.crossed(here, image).ok()?;
        let Area { low: first, high: last } = self.bounds;
        let within = |x: f64, k: usize| x.clamp(first[k], last[k]);
        let part = Area {
            low: std::array::from_fn(|k| within(low[k], k)),
            high: std::array::from_fn(|k| within(high[k], k)),
        };
        Some(self.corners(part))
    }

    /// The box in which lines from all of `here` to all of `image` meet the plane, where it lies between.
    fn crossed(&self, here: &[DVec3; 4], image: &[DVec3; 4]) -> Result<Area, Glimpse> {
        let heights = |points: &[DVec3; 4]| points.map(|p| p.dot(self.normal) - self.offset_m);
        let (from, to) = (heights(here), heights(image));
        let all = |heights: &[f64; 4], sign: f64| heights.iter().all(|height| sign * height > 0.0);
        let beyond = [1.0, -1.0].map(|sign| [all(&from, sign), all(&to, sign)]);
        if beyond.contains(&[true, true]) {
            return Err(Glimpse::Nothing);
        }
        if !(beyond == [[true, false], [false, true]] || beyond == [[false, true], [true, false]]) {
            return Err(Glimpse::Some);
        }
        let [here, image] = [here, image].map(|points| points.map(|p| self.place(p)));
        let mut met = Area::NOTHING;
        for (a, from) in here.iter().zip(from) {
            for (b, to) in image.iter().zip(to) {
                let share = from / (from - to);
                met = met.with([a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share]);
            }
        }
        Ok(met)
    }

    fn corners(&self, Area { low, high }: Area) -> [DVec3; 4] {
        let [u, v] = self.axes;
        let corners = [[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]];
        corners.map(|[x, y]| u * x + v * y + self.normal * self.offset_m)
    }

    /// Works out everything that follows from the triangles.
    pub(super) fn settle(&mut self, scene: &Scene) {
        let mesh = &scene.mesh;
        let corners: Vec<[DVec3; 3]> = self.triangles.iter().map(|&t| mesh.corners(t as usize)).collect();
        let all = || corners.iter().flatten();
        self.centre = all().sum::<DVec3>() / (3.0 * corners.len() as f64);
        self.radius_m = all().map(|p| p.distance(self.centre)).fold(0.0, f64::max) * (1.0 + 1e-9);
        let bsdfs = || self.triangles.iter().map(|&t| scene.bsdf(t));
        let reflectances = bsdfs().filter_map(|bsdf| bsdf.specular(1.0));
        let reflectance = reflectances.map(|(reflected, _)| reflected).fold(0.0, f64::max);
        self.chance = (2.5 * reflectance).clamp(0.2, 1.0);
        self.is_uniform = bsdfs().all(|bsdf| bsdf == scene.bsdf(self.triangles[0]));
        self.edges = corners
            .iter()
            .map(|[a, b, c]| {
                [(a, b), (b, c), (c, a)].map(|(p, q)| {
                    let normal = self.normal.cross(*q - *p);
                    Edge { normal, offset: normal.dot(*p) }
                })
            })
            .collect();
        // Along the edge of the first triangle that is at right angles to another, if there is one.
        let [a, b, c] = corners[0];
        let slant = |[p, q, r]: [DVec3; 3]| (q - p).normalize().dot((r - p).normalize()).abs();
        let turns = [[a, b, c], [b, c, a], [c, a, b]];
        let straightest = turns.into_iter().min_by(|x, y| slant(*x).total_cmp(&slant(*y)));
        let along = straightest.map_or(b - a, |[p, q, _]| q - p).normalize();
        self.axes = [along, self.normal.cross(along)];
        let boxes: Vec<Area> = corners
            .iter()
            .map(|corners| corners.iter().fold(Area::NOTHING, |area, corner| area.with(self.place(*corner))))
            .collect();
        let slack = 1e-9 * self.radius_m;
        self.bounds = boxes.iter().fold(Area::NOTHING, |all, one| all.joined(*one)).widened(slack);
        // Two right triangles fill a rectangle if each has its box and its half of the area, and their
        // centres lie opposite to each other.
        let middles: Vec<[f64; 2]> =
            corners.iter().map(|[a, b, c]| self.place((*a + *b + *c) / 3.0)).collect();
        let area = |t: usize| mesh.normal_and_area(self.triangles[t] as usize).1;
        let fill = |i: usize, j: usize| {
            let Area { low, high } = boxes[i];
            let near = |x: f64, y: f64| (x - y).abs() <= slack;
            let whole_m2 = (high[0] - low[0]) * (high[1] - low[1]);
            (0..2).all(|k| {
                near(low[k], boxes[j].low[k])
                    && near(high[k], boxes[j].high[k])
                    && near(middles[i][k] + middles[j][k], low[k] + high[k])
            }) && (area(i) + area(j) - whole_m2).abs() <= 1e-9 * whole_m2
        };
        if boxes.len() > MOST_PIECES {
            self.pieces = vec![self.bounds];
            return;
        }
        for i in 0..boxes.len() {
            let paired = (i + 1..boxes.len()).any(|j| fill(i, j));
            self.windows.extend(paired.then(|| boxes[i].widened(-slack)));
        }
        self.pieces = boxes;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::emitters::planes;
    use crate::geometry::mesh::Mesh;
    use crate::material::{Bsdf, Material};
    use crate::rng::Rng;

    /// A mirror of two panes with a bar between them, and a triangle above, in a plane that is turned.
    fn glazed() -> (Scene, DMat3) {
        let turn = crate::sphere::frame(DVec3::new(0.3, -0.8, 0.5).normalize());
        let mut mesh = Mesh::default();
        let surface = mesh.add_surface("mirror", 0, false);
        let place = |x: f64, y: f64| turn * DVec3::new(x, y, 0.7);
        for left in [0.0, 1.1] {
            mesh.add_quad(
                [(0.0, 0.0), (1.0, 0.0), (1.0, 1.5), (0.0, 1.5)].map(|(x, y)| place(left + x, y)),
                surface,
            );
        }
        let first = mesh.positions.len() as u32;
        mesh.positions.extend([place(0.0, 1.6), place(1.0, 1.6), place(0.3, 2.0)]);
        let vertices = [first, first + 1, first + 2];
        mesh.triangles.push(crate::geometry::mesh::Triangle { vertices, surface });
        let mirror = Material { name: "mirror".into(), bsdf: Bsdf::Mirror { reflectance: 0.9 } };
        (Scene::new(mesh, vec![mirror], Vec::new()).expect("a scene"), turn)
    }

    /// Catches: a glimpse called whole or nothing that is neither, a place met beyond its rectangle, a mirror
    /// met where it has no triangle.
    #[test]
    fn glimpses_hold_for_every_line() {
        let (scene, turn) = glazed();
        let found = planes(&scene, 4, |_| true);
        assert_eq!((found.len(), found[0].windows.len(), found[0].pieces.len()), (1, 2, 5));
        let (plane, mut rng) = (&found[0], Rng::new(3, 3, 3));
        let mut kinds = [0; 3];
        let mut gaps = 0;
        for _ in 0..4000 {
            let [x, y, z, size, u, v, w, width, a, b] = rng.uniforms();
            let side = if a > 0.5 { 1.0 } else { -1.0 };
            let square = |middle: DVec3, half: f64| {
                [[1.0, 1.0], [1.0, -1.0], [-1.0, -1.0], [-1.0, 1.0]]
                    .map(|[i, j]| turn * (middle + half * DVec3::new(i, 0.6 * j, 0.8 * j)))
            };
            let here = square(DVec3::new(2.5 * x, 2.5 * y, 0.7 + side * (0.5 + z)), 0.3 * size * size);
            // Now and then on the same side.
            let other = if b > 0.1 { -side } else { side };
            let image = square(
                DVec3::new(4.0 * u - 1.0, 4.0 * v - 1.0, 0.7 + other * (0.5 + 2.0 * w)),
                0.5 * width * width,
            );
            let glimpse = plane.glimpse(&here, &image);
            let shown = plane.shown(&here, &image);
            let mut seen = [0; 2];
            for _ in 0..200 {
                let [s, t, p, q] = rng.uniforms();
                let within = |c: &[DVec3; 4], s: f64, t: f64| c[0] + (c[1] - c[0]) * s + (c[3] - c[0]) * t;
                let (from, to) = (within(&here, s, t), within(&image, p, q));
                let reach_m = from.distance(to);
                let met = plane.meet(from, (to - from) / reach_m, reach_m);
                let hit = scene.tracer.closest(from, (to - from) / reach_m, &[]);
                let hit = hit.filter(|hit| hit.distance_m < reach_m);
                assert_eq!(met.map(|(_, triangle)| triangle), hit.map(|hit| hit.triangle));
                seen[usize::from(met.is_some())] += 1;
                let whole = if let Glimpse::All(corners) = glimpse { Some(corners) } else { None };
                for corners in [whole, shown].into_iter().flatten() {
                    let Some((distance_m, _)) = met else { continue };
                    let at = plane.place(from + (to - from) * (distance_m / reach_m));
                    let [low, high] = [corners[0], corners[2]].map(|corner| plane.place(corner));
                    assert!((0..2).all(|k| (low[k] - 1e-9..high[k] + 1e-9).contains(&at[k])));
                }
            }
            match glimpse {
                Glimpse::Nothing => assert_eq!(seen[1], 0),
                Glimpse::All(_) => assert_eq!(seen[0], 0),
                Glimpse::Some => {}
            }
            kinds[match glimpse {
                Glimpse::Nothing => 0,
                Glimpse::Some => 1,
                Glimpse::All(_) => 2,
            }] += 1;
            // Broken twin: the mirror's whole box taken for a window misses the gaps.
            gaps += i32::from(seen[0] > 0 && seen[1] > 0);
        }
        assert!(kinds.iter().all(|count| *count > 200) && gaps > 200, "{kinds:?} {gaps}");
    }
}
