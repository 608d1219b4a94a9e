//! What an eye sees → sources of the indices: luminaires and luminous surfaces in front of it, by a
//! declared convention. Luminances come from the photometry, never from pixels.

use std::f64::consts::PI;

use glam::DVec3;

use crate::emitters::{Emitters, Glint, GlintPiece, Seen, Shining, Sighted};
use crate::estimate::Estimate;
use crate::glare::position_index::{Position, PositionModel};
use crate::glare::propagate::SourceError;
use crate::glare::source::{Extent, GlareSource};
use crate::units::Nits;

/// How a luminaire becomes a source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SourceModel {
    /// One source: intensity over projected area and solid angle of the far field, at the centre.
    Centre,
    /// One source: mean luminance and solid angle of the visible part, P at the opening's centre.
    Visible,
    /// Pieces, each with its own luminance, solid angle and P: Σ L²ω/P² converges to the integral.
    Subdivided,
}

/// How glare is computed; every result names it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Convention {
    /// How a luminaire becomes a source.
    pub sources: SourceModel,
    /// Model of the position index.
    pub position: PositionModel,
}

impl Default for Convention {
    fn default() -> Self {
        Self { sources: SourceModel::Visible, position: PositionModel::Table }
    }
}

impl Convention {
    /// In words, as printed.
    pub fn words(self) -> String {
        let sources = match self.sources {
            SourceModel::Centre => "far field of the opening's centre",
            SourceModel::Visible => "visible part, mean luminance",
            SourceModel::Subdivided => "visible part, subdivided",
        };
        format!("{sources}; {}; L_b = E_ind/π", self.position.words())
    }
}

/// A source that the indices count.
#[derive(Clone, Debug)]
pub struct Counted {
    /// As the indices take it.
    pub source: GlareSource,
    /// Its relative errors.
    pub error: SourceError,
    /// Whose it is.
    pub label: String,
    /// Visible share.
    pub visible_fraction: f64,
    /// Unit direction from the eye to the middle of what is visible.
    pub direction: DVec3,
    /// Index into [`Emitters::sources`]; `None` for a luminous surface.
    pub emitter: Option<usize>,
    /// Index into [`Sighted::surfaces`]; `None` for all but luminous surfaces.
    pub surface: Option<usize>,
}

/// The sources of a view.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    /// Those that count.
    pub counted: Vec<Counted>,
    /// What is to be said about them.
    pub notes: Vec<String>,
    /// Illuminance of the eye from sources that the sheets count as indirect light (luminous surfaces, their
    /// images, highlights), with its standard error, lx.
    pub surfaces_lx: [f64; 2],
}

/// A highlight is a source where its luminance exceeds this many times E_v/π, the eye's mean luminance
/// weighted by the cosine: the factor that is usual for sources found in images.
pub const HIGHLIGHT: f64 = 5.0;

/// What is said of sources that UGR ignores.
const OFF_TABLE: &str = "a source, or a part of one, lies where the CIE 117 table has no position index: UGR leaves it out, other indices take P by Levin";

/// Degrees of freedom of the visibility of a luminous surface: those of one of its pieces, though several may
/// be hidden in part.
const PIECE_DEGREES: usize = 15;

/// The sources in front of an eye that looks along `gaze`; `weights` are of the channels, `e_v_lx` is all
/// the light on the plane of the eye.
pub fn sources(
    emitters: &Emitters,
    sighted: &Sighted,
    gaze: DVec3,
    weights: &[f64],
    convention: Convention,
    e_v_lx: f64,
) -> Sources {
    let frame = Frame::new(gaze, convention.position);
    let mut found = Sources::default();
    for one in &sighted.luminaires {
        let weight = weights[emitters.sources[one.source].channel];
        if weight > 0.0 && one.direction.dot(gaze) > 0.0 && one.normal_lx.value > 0.0 {
            found.counted.extend(luminaire(emitters, one, weight, &frame, convention, &mut found.notes));
        }
    }
    let mut variance = 0.0;
    for (index, surface) in sighted.surfaces.iter().enumerate() {
        let luminance = weights[surface.channel] * surface.luminance_cd_m2;
        if !(luminance > 0.0) {
            continue;
        }
        let [eye_lx, se_lx] = on_eye(surface, luminance, gaze);
        found.surfaces_lx[0] += eye_lx;
        variance += se_lx * se_lx;
        let name = &emitters.scene.mesh.surfaces[surface.surface].name;
        let counted = luminous_surface(surface, luminance, &frame, name, eye_lx, &mut found.notes);
        found.counted.extend(counted.map(|counted| Counted { surface: Some(index), ..counted }));
    }
    for glint in sighted.glints.iter().flatten() {
        let weight = weights[emitters.sources[glint.source].channel];
        let least = HIGHLIGHT * e_v_lx / PI;
        if let Some((counted, se_lx)) = highlight(emitters, glint, weight, least, &frame, &mut found.notes) {
            found.surfaces_lx[0] += counted.source.eye_lx;
            variance += se_lx * se_lx;
            found.counted.push(counted);
        }
    }
    if !emitters.glossy.is_empty() {
        found.notes.push(if sighted.glints.is_some() {
            format!("highlights in glossy planes are sources where they exceed {HIGHLIGHT} E_v/π; others, and what is fainter, belong to the background")
        } else {
            "highlights on glossy surfaces belong to the background".to_owned()
        });
    }
    found.surfaces_lx[1] = f64::sqrt(variance);
    if sighted.surfaces.iter().any(|surface| weights[surface.channel] > 0.0) {
        found.notes.push(
            "luminous surfaces: emitted light in pieces with their own position index; what they reflect belongs \
             to the background"
                .into(),
        );
    }
    found.notes.sort();
    found.notes.dedup();
    found
}

/// The eye's axes and its model of P.
struct Frame {
    gaze: DVec3,
    up: DVec3,
    model: PositionModel,
}

impl Frame {
    fn new(gaze: DVec3, model: PositionModel) -> Self {
        Self { gaze, up: if gaze.z.abs() > 0.999 { DVec3::Y } else { DVec3::Z }, model }
    }

    /// P, and the share that UGR counts of what is there.
    fn position(&self, direction: DVec3, notes: &mut Vec<String>) -> (f64, f64) {
        let mut note = |text: &str| {
            if !notes.iter().any(|known| known == text) {
                notes.push(text.into());
            }
        };
        match self.model.position(self.gaze, self.up, direction) {
            Position::Index(index) => (index, 1.0),
            Position::BelowTable(index) => {
                note("a source lies below the line of sight: Iwata–Osterhaus position index");
                (index, 1.0)
            }
            Position::OffTable(index) => {
                note(OFF_TABLE);
                (index, 0.0)
            }
        }
    }
}

fn luminaire(
    emitters: &Emitters,
    one: &Seen,
    weight: f64,
    frame: &Frame,
    convention: Convention,
    notes: &mut Vec<String>,
) -> Option<Counted> {
    let cos = one.direction.dot(frame.gaze);
    let area_sr = one.solid_angle_sr.value;
    let is_point = !(area_sr > 0.0);
    let (luminance, solid_angle_sr, (position_index, ugr_share)) = match convention.sources {
        SourceModel::Subdivided if !is_point => {
            let pieces = one.pieces.iter().map(|piece| {
                (piece.direction, piece.visible_sr, weight * piece.normal_lx / piece.visible_sr)
            });
            merged(pieces, frame, notes)?
        }
        SourceModel::Centre if !is_point => {
            let far = weight * one.centre_lx * one.distance_m * one.distance_m / one.projected_area_m2;
            let size_sr = one.projected_area_m2 / (one.distance_m * one.distance_m) * one.visible_fraction;
            (far, size_sr, frame.position(one.direction, notes))
        }
        SourceModel::Centre | SourceModel::Visible | SourceModel::Subdivided => {
            let luminance = weight * one.luminance_cd_m2().unwrap_or(0.0);
            (luminance, area_sr, frame.position(one.direction, notes))
        }
    };
    let relative = |estimate: Estimate| if estimate.value > 0.0 { estimate.se / estimate.value } else { 0.0 };
    let product = one.normal_lx.value * area_sr;
    Some(Counted {
        source: GlareSource {
            luminance: Nits(luminance),
            solid_angle_sr,
            position_index,
            ugr_share,
            off_axis_deg: cos.clamp(-1.0, 1.0).acos().to_degrees(),
            eye_lx: weight * one.normal_lx.value * cos,
            extent: Some(Extent {
                projected_area_m2: one.projected_area_m2,
                intensity_cd: weight * one.normal_lx.value * one.distance_m * one.distance_m,
                distance_m: one.distance_m,
            }),
        },
        error: SourceError {
            light: relative(one.normal_lx),
            solid_angle: relative(one.solid_angle_sr),
            together: Some(if product > 0.0 { one.covariance_lx_sr / product } else { 0.0 }),
            degrees: one.solid_angle_sr.n.saturating_sub(1),
        },
        label: label(emitters, one.source),
        visible_fraction: one.visible_fraction,
        direction: one.light.try_normalize().unwrap_or(one.direction),
        emitter: Some(one.source),
        surface: None,
    })
}

/// Pieces (direction, sr, cd/m²) as one source with the same Σ L²ω/P²: luminance, solid angle, P and the share that
/// UGR counts.
///
/// 1/P² is the mean over the solid angle, L² the mean weighted by ω/P². Pieces that UGR ignores are in all of them,
/// and not in the share.
fn merged(
    pieces: impl Iterator<Item = (DVec3, f64, f64)>,
    frame: &Frame,
    notes: &mut Vec<String>,
) -> Option<(f64, f64, (f64, f64))> {
    let (mut size_sr, mut weighted_sr, mut squares, mut of_ugr) = (0.0, 0.0, 0.0, 0.0);
    for (direction, piece_sr, luminance) in pieces {
        if !(direction.dot(frame.gaze) > 0.0 && piece_sr > 0.0) {
            continue;
        }
        size_sr += piece_sr;
        let (index, ugr_share) = frame.position(direction, notes);
        let seen_sr = piece_sr / (index * index);
        weighted_sr += seen_sr;
        squares += luminance * luminance * seen_sr;
        of_ugr += ugr_share * luminance * luminance * seen_sr;
    }
    let index = f64::sqrt(size_sr / weighted_sr).max(1.0);
    (squares > 0.0).then(|| (f64::sqrt(squares / weighted_sr), size_sr, (index, of_ugr / squares)))
}

/// Illuminance on the plane of the eye straight from a luminous surface, with its standard error, lx.
fn on_eye(surface: &Shining, luminance: f64, gaze: DVec3) -> [f64; 2] {
    let (mut light, mut variance) = (0.0, 0.0);
    for piece in &surface.pieces {
        let cos = piece.direction.dot(gaze).max(0.0);
        light += luminance * piece.passed_vector.dot(gaze).max(0.0);
        variance += (luminance * piece.se_sr * cos).powi(2);
    }
    [light, f64::sqrt(variance)]
}

fn luminous_surface(
    surface: &Shining,
    luminance: f64,
    frame: &Frame,
    name: &str,
    eye_lx: f64,
    notes: &mut Vec<String>,
) -> Option<Counted> {
    let ahead = || surface.pieces.iter().filter(|piece| piece.direction.dot(frame.gaze) > 0.0);
    let pieces = ahead()
        .map(|piece| (piece.direction, piece.visible_sr, luminance * piece.passed_sr / piece.visible_sr));
    let (mean, solid_angle_sr, (position_index, ugr_share)) = merged(pieces, frame, notes)?;
    let passed_sr: f64 = ahead().map(|piece| piece.passed_sr).sum();
    // Relative error of Σ ω/P², by which the pieces count for UGR, or for the others where it ignores them all.
    let (mut weighted_sr, mut variance) = (0.0, 0.0);
    for piece in ahead() {
        let (index, counts) = frame.position(piece.direction, notes);
        if counts > 0.0 || !(ugr_share > 0.0) {
            weighted_sr += piece.passed_sr / (index * index);
            variance += (piece.se_sr / (index * index)).powi(2);
        }
    }
    let relative = f64::sqrt(variance) / weighted_sr;
    let visible_sr: f64 = surface.pieces.iter().map(|piece| piece.visible_sr).sum();
    let cos = eye_lx / (luminance * passed_sr);
    let distance_m = f64::sqrt(surface.projected_area_m2 / surface.whole_sr);
    Some(Counted {
        source: GlareSource {
            luminance: Nits(mean),
            solid_angle_sr,
            position_index,
            ugr_share,
            off_axis_deg: cos.clamp(-1.0, 1.0).acos().to_degrees(),
            eye_lx,
            extent: Some(Extent {
                projected_area_m2: surface.projected_area_m2,
                intensity_cd: mean * surface.projected_area_m2,
                distance_m,
            }),
        },
        // Visibility moves light and solid angle together.
        error: SourceError {
            light: relative,
            solid_angle: relative,
            together: Some(relative * relative),
            degrees: PIECE_DEGREES,
        },
        label: format!(
            "{name} (luminous surface{})",
            if surface.mirror.is_some() { ", mirrored" } else { "" }
        ),
        visible_fraction: visible_sr / surface.whole_sr,
        direction: ahead().map(|piece| piece.passed_vector).sum::<DVec3>().normalize_or_zero(),
        emitter: None,
        surface: None,
    })
}

/// The part of a highlight that is brighter than `least`, cd/m², and the standard error of its light on
/// the plane of the eye, lx. Σ L²ω/P² is made of products of independent estimates of L.
fn highlight(
    emitters: &Emitters,
    glint: &Glint,
    weight: f64,
    least: f64,
    frame: &Frame,
    notes: &mut Vec<String>,
) -> Option<(Counted, f64)> {
    let count = glint.pieces.len().max(1) as f64;
    let counts =
        |piece: &&GlintPiece| weight * piece.luminance_cd_m2 > least && piece.direction.dot(frame.gaze) > 0.0;
    let bright = || glint.pieces.iter().map(|pieces| pieces.iter().filter(counts));
    let pieces = bright().flatten();
    let pieces = pieces
        .map(|piece| (piece.direction, piece.solid_angle_sr / count, weight * piece.square.max(0.0).sqrt()));
    let (luminance, solid_angle_sr, (position_index, ugr_share)) = merged(pieces, frame, notes)?;
    let light = |piece: &GlintPiece| weight * piece.luminance_cd_m2 * piece.solid_angle_sr;
    let sums = |of: &dyn Fn(&GlintPiece) -> f64| -> Estimate {
        Estimate::from_blocks(&bright().map(|pieces| pieces.map(of).sum()).collect::<Vec<f64>>())
    };
    let on_eye = sums(&|piece| light(piece) * piece.direction.dot(frame.gaze));
    let (whole, size) = (sums(&light), sums(&|piece| piece.solid_angle_sr));
    let direction = bright().flatten().map(|piece| light(piece) * piece.direction).sum::<DVec3>();
    let direction = direction.try_normalize()?;
    let name = &emitters.scene.mesh.surfaces[glint.surface as usize].name;
    let luminaire = label(emitters, glint.source);
    let counted = Counted {
        source: GlareSource {
            luminance: Nits(luminance),
            solid_angle_sr,
            position_index,
            ugr_share,
            off_axis_deg: direction.dot(frame.gaze).clamp(-1.0, 1.0).acos().to_degrees(),
            eye_lx: on_eye.value,
            extent: None,
        },
        error: SourceError {
            light: whole.se / whole.value,
            solid_angle: size.se / size.value,
            together: None,
            degrees: glint.pieces.len().saturating_sub(1),
        },
        label: format!("{luminaire}, highlight on {name}"),
        visible_fraction: 1.0,
        direction,
        emitter: None,
        surface: None,
    };
    Some((counted, on_eye.se))
}

/// What a source is called.
pub fn label(emitters: &Emitters, index: usize) -> String {
    let source = &emitters.sources[index];
    let luminaire = emitters.luminaire(source);
    let image = if source.mirror.is_some() { ", mirrored" } else { "" };
    format!("{} #{} ({}{image})", luminaire.kind.name, source.luminaire + 1, luminaire.group)
}
