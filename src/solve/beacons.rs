//! Beacons: the few bright patches from which much of the light comes, where rays that follow a response
//! or a cosine find them by chance – the spot under a lamp that almost touches a wall, one lit corner of a
//! dark hall – and luminous surfaces always: no luminaire's direct light is there to find them. Points drawn on
//! them are *added* to the rays, and every ray is weighted by the sum of all densities, so a wrong choice costs
//! noise and nothing else.
//!
//! A ray drawn to a beacon counts if it arrives there straight, through panes at most; what it sees otherwise is
//! left to the other rays, which then have the weight of their own density alone.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::covered::place;
use super::look::{Landing, Sight, Way, look};
use crate::emitters::Emitters;
use crate::field::{LuminanceField, Patches};
use crate::query::Kernel;
use crate::rng::Rng;
use crate::scene::Scene;
use crate::sphere;

/// The field is uneven enough if the mean square of its luminance is this many times its squared mean.
const UNEVEN: f64 = 8.0;
/// A bright patch is this many times brighter than the mean.
const BRIGHT: f64 = 4.0;
/// Bright patches are taken together until there are this many beacons.
const MOST: usize = 32;
/// A place aims at beacons if they make the square of what its own rays find this many times as large as the
/// squared mean: of all light that comes to it or, where they shine of themselves, of theirs alone, since a light
/// scene may have nothing else.
const RARE: f64 = 2.0;
/// Rays by which a luminous side looks for what lies before it.
const BEFORE: u32 = 8;
/// Places of a beacon by which a receiver finds out how much of it is seen …
const PLACES: u32 = 32;
/// … and the share that is believed to be seen where none of them is.
const UNSEEN: f64 = 0.1;
/// First item of the random numbers of these looks, in the field's stream.
pub(super) const ITEM: u64 = 1 << 42;
/// Looks by which a receiver finds out how much other light there is.
const LOOKS: u32 = 64;
/// Not a beacon.
const NONE: u32 = u32::MAX;

/// The beacons of a field.
#[derive(Debug, Default)]
pub(super) struct Beacons {
    list: Vec<Beacon>,
    /// Bright patches, those of a beacon together.
    bright: Vec<Bright>,
    /// Per patch side: its place in `bright`, or `NONE`; empty without beacons.
    place: Vec<u32>,
    /// Mean luminance of all patch sides, channels summed …
    mean: f64,
    /// … and without what beacons add to it.
    others: f64,
}

/// Bright patches that lie together and face one way.
#[derive(Clone, Copy, Debug)]
struct Beacon {
    first: usize,
    last: usize,
    /// Its middle and the corners of the box round it, each with its share: near its own plane, or where a
    /// response ends, the middle alone says nothing.
    places: [(DVec3, f64); 5],
    normal: DVec3,
    area_m2: f64,
    luminance: f64,
    /// The part of the luminance that it emits.
    emitted: f64,
}

#[derive(Clone, Copy, Debug)]
struct Bright {
    side: usize,
    middle: DVec3,
    /// The box round it.
    box_m: [DVec3; 2],
    normal: DVec3,
    area_m2: f64,
    /// Channels summed.
    luminance: f64,
    /// The part of it that is emitted.
    emitted: f64,
    beacon: usize,
    /// Luminance times area up to here, of its beacon.
    up_to: f64,
}

/// A walk's branch to a bright patch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Branch {
    /// Share of what the walk finds there that counts.
    pub part: f64,
    /// How often the aimed branch is followed.
    pub chance: f64,
}

/// What a receiver sees of beacons and of all else.
#[derive(Debug)]
pub(super) struct Seen {
    /// Share of each beacon.
    shares: Vec<f64>,
    /// Light of all else, the receiver's responses summed.
    others: f64,
}

/// The chance of each beacon to be aimed at from one place.
#[derive(Clone, Debug, Default)]
pub(super) struct Chances {
    /// Probability summed up to each beacon; empty where nothing is aimed at.
    up_to: Vec<f64>,
}

/// Nothing is aimed at.
pub(super) static NOWHERE: Chances = Chances { up_to: Vec::new() };

impl Beacons {
    /// Chooses the beacons of a field: what shines, and what is bright where it is uneven. `stored` is the
    /// luminance of a patch side without what it emits itself, channels summed.
    pub(super) fn new(scene: &Scene, patches: &Patches, stored: impl Fn(usize) -> f64) -> Self {
        let emitted = shining(scene, patches);
        let all: Vec<f64> = (0..patches.sides()).map(|side| stored(side) + emitted[side]).collect();
        let Evenness { mean, is_uneven } = Evenness::of(patches, |side| all[side]);
        let mut bright: Vec<Bright> = (0..all.len())
            .filter(|&side| emitted[side] > 0.0 || (is_uneven && all[side] > BRIGHT * mean))
            .filter(|&side| patches.area_m2(side) > 0.0)
            .map(|side| {
                let (middle, front) = patches.centre(side);
                let normal = if side.is_multiple_of(2) { front } else { -front };
                let (luminance, area_m2, emitted) = (all[side], patches.area_m2(side), emitted[side]);
                let box_m = patches
                    .outlines(side / 2)
                    .flatten()
                    .fold([middle; 2], |[low, high], corner| [low.min(corner), high.max(corner)]);
                Bright { side, middle, box_m, normal, area_m2, luminance, emitted, beacon: 0, up_to: 0.0 }
            })
            .collect();
        let whole_m2: f64 = (0..patches.sides()).map(|side| patches.area_m2(side)).sum();
        let of_bright: f64 = bright.iter().map(|bright| bright.luminance * bright.area_m2).sum();
        let others = (mean - of_bright / whole_m2).max(0.0);
        let list = gather(&mut bright);
        let mut place = vec![NONE; patches.sides()];
        for (beacon, entry) in list.iter().enumerate() {
            let mut up_to = 0.0;
            for at in entry.first..entry.last {
                up_to += bright[at].luminance * bright[at].area_m2;
                (bright[at].up_to, bright[at].beacon) = (up_to, beacon);
                place[bright[at].side] = at as u32;
            }
        }
        Self { list, bright, place, mean, others }
    }

    /// Fills `chances` with the chances of beacons as seen from `origin`; with none where rays that follow
    /// `response` find their light well enough. The response is the sum of `kernels`, each of integral π;
    /// `known` is ∫ response · L dω of all light, where the field knows it; `seen` what is seen from
    /// there ([`Beacons::seen`]), where that is known.
    pub(super) fn about(
        &self,
        origin: DVec3,
        response: impl Fn(DVec3) -> f64,
        kernels: usize,
        known: Option<f64>,
        seen: Option<&Seen>,
        chances: &mut Chances,
    ) {
        chances.clear();
        if self.list.is_empty() {
            return;
        }
        let (mut total, mut squares, mut chance) = (0.0, 0.0, 0.0);
        let (mut emitted, mut emitted_squares) = (0.0, 0.0);
        for (number, beacon) in self.list.iter().enumerate() {
            let share = seen.map_or(1.0, |seen| seen.shares[number]);
            let mut light = 0.0;
            for (place, part) in beacon.places {
                let away = place - origin;
                let squared = away.length_squared();
                let towards = away / squared.sqrt();
                let facing = -beacon.normal.dot(towards);
                if facing > 0.0 {
                    // Near a beacon a place says little: its solid angle is at most about 2π.
                    let solid_angle = facing * beacon.area_m2 / (squared + beacon.area_m2 / TAU);
                    light += part * response(towards).max(0.0) * solid_angle * beacon.luminance;
                }
            }
            if light > 0.0 && light.is_finite() {
                chance += light * share.max(UNSEEN);
                let light = share * light;
                total += light;
                squares += light * beacon.luminance;
                let own = light * beacon.emitted / beacon.luminance;
                emitted += own;
                emitted_squares += own * beacon.emitted;
            }
            chances.up_to.push(chance);
        }
        // Rays by a response of integral nπ have density R/nπ: their mean square is ∫ nπ R L².
        let whole = PI * kernels as f64;
        // Hidden beacons add nothing to what is known, which may therefore be less than they seem to give.
        let guess = total + seen.map_or(whole * self.others, |seen| seen.others);
        let mean = known.map_or(guess, |known| known.min(guess));
        let is_rare = |squares: f64, mean: f64| squares > 0.0 && whole * squares > RARE * mean * mean;
        if !(is_rare(squares, mean) || is_rare(emitted_squares, emitted)) {
            chances.clear();
            return;
        }
        for up_to in &mut chances.up_to {
            *up_to /= chance;
        }
    }

    /// What is seen from `origin`: of each beacon by a few of its places, and by a few looks the light of all else,
    /// ∫ R L dω with R the sum of the responses of `kernels`.
    pub(super) fn seen(
        &self,
        emitters: &Emitters,
        field: &LuminanceField,
        origin: DVec3,
        kernels: &[Kernel],
        rng: &mut Rng,
    ) -> Seen {
        let (scene, patches) = (emitters.scene, field.patches());
        let mut sight = Sight::new(scene.channels.len());
        let mut others = 0.0;
        for number in 0..LOOKS {
            let direction = kernels[number as usize % kernels.len()].sample(rng.uniforms());
            let density =
                kernels.iter().map(|kernel| kernel.pdf(direction)).sum::<f64>() / kernels.len() as f64;
            let response: f64 = kernels.iter().map(|kernel| kernel.response(direction)).sum();
            if !(density > 0.0) {
                continue;
            }
            look(emitters, origin, direction, 1.0, rng, &mut sight);
            for landing in &sight.landings {
                let side = patches.side_at(landing.triangle, landing.barycentric, landing.front);
                if self.place[side] == NONE {
                    let stored: f64 = field.at(side).iter().sum();
                    others += response / density * landing.weight * stored / f64::from(LOOKS);
                }
            }
        }
        let is_seen = |beacon: &Beacon, number: u32| {
            let members = &self.bright[beacon.first..beacon.last];
            let part = (f64::from(number) + 0.5) / f64::from(PLACES);
            let wanted = part * members[members.len() - 1].up_to;
            let member = members.partition_point(|bright| bright.up_to <= wanted).min(members.len() - 1);
            let u = [0.819_172_5, 0.671_043_6, 0.549_700_5].map(|step| f64::from(number) * step % 1.0);
            let at = place(patches, members[member].side, u);
            let towards = at.origin(scene, true) - origin;
            let distance_m = towards.length();
            let direction = towards / distance_m;
            at.normal.dot(direction) < 0.0
                && scene.tracer.transmittance(origin, direction, distance_m - scene.tracer.offset_m(), &[])
                    > 0.0
        };
        let share = |beacon: &Beacon| {
            let count = (0..PLACES).filter(|&number| is_seen(beacon, number)).count();
            count as f64 / f64::from(PLACES)
        };
        Seen { shares: self.list.iter().map(share).collect(), others }
    }

    /// Whether there is none.
    pub(super) fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Draws a beacon and a point on it; the direction to it, and the patch side.
    pub(super) fn draw(
        &self,
        patches: &Patches,
        origin: DVec3,
        chances: &Chances,
        [choice, u, v, w]: [f64; 4],
    ) -> (DVec3, usize) {
        let chosen = chances.up_to.partition_point(|up_to| *up_to <= choice).min(self.list.len() - 1);
        let before = if chosen == 0 { 0.0 } else { chances.up_to[chosen - 1] };
        let Beacon { first, last, .. } = self.list[chosen];
        let members = &self.bright[first..last];
        // What is left of the choice chooses the patch.
        let rest = (choice - before) / (chances.up_to[chosen] - before) * members[members.len() - 1].up_to;
        let member = members.partition_point(|bright| bright.up_to <= rest).min(members.len() - 1);
        let side = members[member].side;
        let point = place(patches, side, [u, v, w]).point;
        ((point - origin).normalize(), side)
    }

    /// Density of [`Beacons::draw`] of what a look from `origin` met, 1/sr: q L/Σ(L A) · d²/cos θ with q the
    /// chance of the beacon; 0 if the look did not come to one straight.
    pub(super) fn density(&self, patches: &Patches, origin: DVec3, chances: &Chances, sight: &Sight) -> f64 {
        let Some(met) = self.met(patches, sight).filter(|_| !chances.is_empty()) else { return 0.0 };
        let (landing, beacon) = (&sight.landings[0], met.beacon);
        let chance = chances.up_to[beacon] - if beacon == 0 { 0.0 } else { chances.up_to[beacon - 1] };
        let squared = (landing.point - origin).length_squared();
        let facing = landing.normal.dot(landing.to_eye);
        let whole = self.bright[self.list[beacon].last - 1].up_to;
        let density = chance * met.luminance / whole * squared / facing;
        if density.is_finite() { density } else { 0.0 }
    }

    /// Whether walks branch to what a look has met; `part` is the share of a ray that follows the cosine in
    /// the mixture with the one that is aimed, the same for both. `None`: the walk goes there by the cosine
    /// alone. A branch is followed as often as it is bright in proportion to the mean, but walks must not
    /// multiply, and their weight must not grow: no more than (1 + `albedo`)/2 of those that came go on, and
    /// where a branch would have to be followed less often than it counts, there is none.
    pub(super) fn branch(&self, patches: &Patches, sight: &Sight, part: f64, albedo: f64) -> Option<Branch> {
        let most = (0.5 * (1.0 - albedo) / albedo).min(1.0);
        if !(part < most) {
            return None;
        }
        let bright = self.met(patches, sight)?.luminance / self.mean;
        Some(Branch { part, chance: (part * bright).min(most) })
    }

    /// The bright patch to which a look came straight.
    fn met(&self, patches: &Patches, sight: &Sight) -> Option<&Bright> {
        let landing =
            sight.landings.first().filter(|landing| landing.way != Way::Turned && !self.list.is_empty())?;
        let side = patches.side_at(landing.triangle, landing.barycentric, landing.front);
        self.bright.get(self.place[side] as usize)
    }

    /// Whether a look came straight to this patch side.
    pub(super) fn came_to(patches: &Patches, sight: &Sight, side: usize) -> bool {
        let there = |landing: &Landing| {
            landing.way != Way::Turned
                && patches.side_at(landing.triangle, landing.barycentric, landing.front) == side
        };
        sight.landings.first().is_some_and(there)
    }
}

/// Luminance that each patch side emits, cd/m²: 0 where nothing lies before it, as outside of a room's walls.
pub(super) fn shining(scene: &Scene, patches: &Patches) -> Vec<f64> {
    let seen = |side: usize| {
        let (middle, front) = patches.centre(side);
        let normal = if side.is_multiple_of(2) { front } else { -front };
        let frame = sphere::frame(normal);
        let origin = middle + normal * scene.tracer.offset_m();
        (0..BEFORE).any(|number| {
            let u = [(f64::from(number) + 0.5) / f64::from(BEFORE), f64::from(number) * 0.618_034 % 1.0];
            scene.tracer.closest(origin, frame * sphere::cosine_hemisphere(u), &[]).is_some()
        })
    };
    let emitted = |side: usize| {
        let emitted = scene.bsdf(patches.triangle(side)).emitted();
        if emitted > 0.0 && seen(side) { emitted } else { 0.0 }
    };
    (0..patches.sides()).map(emitted).collect()
}

/// How even luminances of patch sides are.
pub(super) struct Evenness {
    /// Their mean.
    mean: f64,
    /// Few patches make most of the light.
    pub is_uneven: bool,
}

impl Evenness {
    /// Of all sides.
    pub(super) fn of(patches: &Patches, luminance: impl Fn(usize) -> f64) -> Self {
        let (mut area, mut sum, mut squares) = (0.0, 0.0, 0.0);
        for side in 0..patches.sides() {
            let (area_m2, luminance) = (patches.area_m2(side), luminance(side));
            area += area_m2;
            sum += area_m2 * luminance;
            squares += area_m2 * luminance * luminance;
        }
        Self { mean: sum / area, is_uneven: squares * area > UNEVEN * sum * sum }
    }
}

/// Sorts bright patches into groups of one facing that lie together: the group with the most light spread
/// over the largest space is halved by light until there are enough.
fn gather(bright: &mut [Bright]) -> Vec<Beacon> {
    let facing = |bright: &Bright| {
        let normal = bright.normal.to_array();
        let axis = (0..3).max_by(|&a, &b| normal[a].abs().total_cmp(&normal[b].abs())).unwrap_or(0);
        2 * axis + usize::from(normal[axis] < 0.0)
    };
    bright.sort_by_key(|bright| (facing(bright), bright.side));
    let (mut groups, mut first) = (Vec::new(), 0);
    for one in bright.chunk_by(|a, b| facing(a) == facing(b)) {
        groups.push(Beacon::of(one, first));
        first += one.len();
    }
    while groups.len() < MOST {
        let spread = |group: &Beacon| {
            let (_, extent_m) = extent(&bright[group.first..group.last]);
            group.luminance * group.area_m2 * extent_m * extent_m
        };
        let widest = (0..groups.len()).max_by(|&a, &b| spread(&groups[a]).total_cmp(&spread(&groups[b])));
        let Some(widest) = widest.filter(|&widest| spread(&groups[widest]) > 0.0) else { break };
        let Beacon { first, last, luminance, area_m2, .. } = groups[widest];
        let members = &mut bright[first..last];
        let (axis, _) = extent(members);
        members.sort_by(|a, b| a.middle[axis].total_cmp(&b.middle[axis]).then(a.side.cmp(&b.side)));
        let (mut light, mut half) = (0.0, 0);
        while half + 1 < members.len() && (half == 0 || light < 0.5 * luminance * area_m2) {
            light += members[half].luminance * members[half].area_m2;
            half += 1;
        }
        groups[widest] = Beacon::of(&bright[first..first + half], first);
        groups.push(Beacon::of(&bright[first + half..last], first + half));
    }
    groups
}

/// Axis along which the middles extend furthest, and how far, m.
fn extent(bright: &[Bright]) -> (usize, f64) {
    let (low, high) = bright.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), b| {
        (low.min(b.middle), high.max(b.middle))
    });
    let extent = (high - low).to_array();
    let axis = (0..3).max_by(|&a, &b| extent[a].total_cmp(&extent[b])).unwrap_or(0);
    (axis, extent[axis])
}

impl Beacon {
    /// Patches from place `first` on, taken together by their light.
    fn of(bright: &[Bright], first: usize) -> Self {
        let light = |bright: &Bright| bright.luminance * bright.area_m2;
        let whole: f64 = bright.iter().map(light).sum();
        let area_m2 = bright.iter().map(|bright| bright.area_m2).sum();
        let middle = bright.iter().map(|bright| bright.middle * light(bright)).sum::<DVec3>() / whole;
        let [low, high] = bright
            .iter()
            .fold([middle; 2], |[low, high], bright| [low.min(bright.box_m[0]), high.max(bright.box_m[1])]);
        // A beacon is about flat: its corners lie across the two longest edges of its box.
        let size = (high - low).to_array();
        let thin = (0..3).min_by(|&a, &b| size[a].total_cmp(&size[b])).unwrap_or(0);
        let corner = |number: usize| {
            let mut place = middle;
            for (bit, axis) in [(thin + 1) % 3, (thin + 2) % 3].into_iter().enumerate() {
                place[axis] = if (number >> bit) & 1 == 0 { low[axis] } else { high[axis] };
            }
            (place, 0.125)
        };
        Self {
            first,
            last: first + bright.len(),
            places: [(middle, 0.5), corner(0), corner(1), corner(2), corner(3)],
            normal: bright.iter().map(|bright| bright.normal * light(bright)).sum::<DVec3>() / whole,
            area_m2,
            luminance: whole / area_m2,
            emitted: bright.iter().map(|bright| bright.emitted * bright.area_m2).sum::<f64>() / area_m2,
        }
    }
}

impl Chances {
    /// Chances at nothing.
    pub(super) fn clear(&mut self) {
        self.up_to.clear();
    }

    /// Whether nothing is aimed at.
    pub(super) fn is_empty(&self) -> bool {
        self.up_to.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::mesh::Mesh;
    use crate::material::{Bsdf, Material};

    /// A dark floor, and over it two tiles that shine down, one brighter.
    fn tiles() -> Scene {
        let mut mesh = Mesh::default();
        let quad = |[x, y]: [f64; 2], half: f64, z: f64| {
            [[-half, -half], [-half, half], [half, half], [half, -half]]
                .map(|[u, v]| DVec3::new(x + u, y + v, z))
        };
        for (name, material, middle, half, z) in [
            ("floor", 0, [0.0, 0.0], 20.0, 0.0),
            ("near", 1, [1.0, 0.5], 0.1, 2.0),
            ("far", 2, [-4.0, 2.0], 0.3, 3.0),
        ] {
            let surface = mesh.add_surface(name, material, true);
            mesh.add_quad(quad(middle, half, z), surface);
        }
        let shining = |luminance_cd_m2| Bsdf::Emitter { luminance_cd_m2, reflectance: 0.2 };
        let material = |name: &str, bsdf| Material { name: name.into(), bsdf };
        let materials = vec![
            material("floor", Bsdf::Lambert { reflectance: 0.1 }),
            material("near", shining(3000.0)),
            material("far", shining(1000.0)),
        ];
        Scene::new(mesh, materials, Vec::new()).expect("the scene is valid")
    }

    /// Catches: a density that is not that of the draws, or does not integrate to 1 where all is seen.
    #[test]
    fn draws_follow_their_density() {
        let scene = tiles();
        let emitters = Emitters::new(&scene);
        let patches = Patches::of_scene(&scene, 1e-3);
        let beacons = Beacons::new(&scene, &patches, |_| 0.0);
        let origin = DVec3::new(0.2, 0.1, 0.3);
        let mut chances = Chances::default();
        beacons.about(origin, |direction| direction.z.max(0.0), 1, None, None, &mut chances);
        assert!(!chances.is_empty() && beacons.list.len() > 1);
        let (mut rng, mut sight) = (Rng::new(1, 2, 3), Sight::new(scene.channels.len()));
        let weight = |direction: DVec3| direction * direction.x.max(0.0);
        // Moments by draws, and by their density along uniform directions about the tiles.
        let n = 400_000;
        let (mut whole, mut by_density, mut by_draws) = (0.0, DVec3::ZERO, DVec3::ZERO);
        for _ in 0..n {
            let direction = sphere::uniform_sphere(rng.uniforms());
            look(&emitters, origin, direction, 1.0, &mut rng, &mut sight);
            let density = beacons.density(&patches, origin, &chances, &sight) * 4.0 * PI / f64::from(n);
            whole += density;
            by_density += weight(direction) * density;
            let (direction, side) = beacons.draw(&patches, origin, &chances, rng.uniforms());
            look(&emitters, origin, direction, 1.0, &mut rng, &mut sight);
            assert!(Beacons::came_to(&patches, &sight, side), "all is in sight");
            by_draws += weight(direction) / f64::from(n);
        }
        // Some 1 400 of the uniform directions meet a tile: a standard error of 3 %.
        assert!((whole - 1.0).abs() < 0.15, "{whole}");
        assert!((by_density - by_draws).length() < 0.1, "{by_density} is not {by_draws}");
    }
}
