//! What one eye sees, as the indices take it: sources, illuminances at the eye, background. E_v and
//! its parts are on the plane *perpendicular to the line of sight*, never horizontal.

use super::luminances::Zones;
use crate::units::{Nits, Undefined};

/// The reason why there is no index where nothing shines: no glare, unlike every other reason.
pub const NO_SOURCE: &str = "no light source is visible";

/// The same where UGR ignores all that shines.
pub const ALL_OFF_TABLE: &str =
    "all visible sources lie where the CIE 117 table has no position index, so UGR counts none";

/// Whether an index has no value only because nothing glares.
pub fn nothing_glares(undefined: &Undefined) -> bool {
    [NO_SOURCE, ALL_OFF_TABLE].contains(&undefined.reason.as_str())
}

/// A source as one eye sees it; what is hidden from the eye is not part of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlareSource {
    /// Mean luminance toward the eye, weighted by solid angle; 0 for a point.
    pub luminance: Nits,
    /// Solid angle of the visible part, sr; 0 for a point.
    pub solid_angle_sr: f64,
    /// Position index P, 1 on the line of sight.
    pub position_index: f64,
    /// Share of its L²ω/P² that UGR and its kin count: 0 where the table of CIE 117 has no P, less than 1 where a part
    /// of it lies there. Other indices were made with a formula for P and count all of it.
    pub ugr_share: f64,
    /// Angle between the line of sight and the source, θ, degrees.
    pub off_axis_deg: f64,
    /// Illuminance that it gives on the plane of the eye, L ω cos θ, lx.
    pub eye_lx: f64,
    /// What is known of its size beside the solid angle; `None` in an image, which tells no distances.
    pub extent: Option<Extent>,
}

/// A source's size in metres, which decides between the forms of UGR.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// Luminous area projected toward the eye, m².
    pub projected_area_m2: f64,
    /// Intensity toward the eye, cd.
    pub intensity_cd: f64,
    /// Distance from the eye, m.
    pub distance_m: f64,
}

/// A part of a source at its own angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrayPart {
    /// Which source, in the order of the view.
    pub source: usize,
    /// Angle from the line of sight, degrees.
    pub off_axis_deg: f64,
    /// Its share of the illuminance that the source gives on the plane of the eye.
    pub share: f64,
}

/// Light that comes to an eye at an angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AtAngle {
    /// Angle from the line of sight, degrees.
    pub off_axis_deg: f64,
    /// Illuminance on the plane of the eye, lx.
    pub eye_lx: f64,
    /// Whether it is one of several parts of a source.
    pub is_part: bool,
}

/// One view of one eye: everything that an index may ask for.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sight {
    /// The sources.
    pub sources: Vec<GlareSource>,
    /// Where the light of sources with a size comes from, for veiling luminance; a source without parts lies at its
    /// own angle.
    pub parts: Vec<StrayPart>,
    /// Illuminance on the plane of the eye, sources included, E_v, lx.
    pub e_v_lx: f64,
    /// The part of E_v that comes from the sources, E_dir, lx.
    pub e_direct_lx: f64,
    /// Background luminance L_b, cd/m²: (E_v − E_dir)/π unless the convention says otherwise.
    pub background: Nits,
    /// Mean luminance of the field of view weighted by solid angle, cd/m²; VCP asks for it.
    pub mean: Option<Nits>,
    /// Luminances of a task and of what surrounds it; `None` where no task is given.
    pub zones: Option<Result<Zones, Undefined>>,
    /// What only some indices ask for.
    pub given: Given,
}

impl GlareSource {
    /// Whether UGR and its kin leave it out altogether.
    pub fn is_off_table(&self) -> bool {
        !(self.ugr_share > 0.0)
    }
}

/// Assumptions about observer and surroundings that no view can tell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Given {
    /// Age of the observer, years; `None`: 25 for veiling luminance, and 23 for f_TI, as EN 13201-3 has it.
    pub age_years: Option<f64>,
    /// Eye pigmentation p of CIE 146: 0 black, 0.5 brown, 1.0 light, 1.2 very light.
    pub pigment: f64,
    /// Coefficients of DGP.
    pub dgp: DgpForm,
    /// Whether DGP is lowered in dim scenes.
    pub low_light: bool,
    /// Share of the ceiling that shines, 0.15 to 1; GGR asks for it.
    pub ceiling_coverage: Option<f64>,
    /// Illuminated ground; GR asks for it.
    pub ground: Option<Ground>,
    /// Mean luminance of the road L_av, cd/m²; f_TI asks for it.
    pub road: Option<Nits>,
}

/// The ground of an outdoor area, CIE 112.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ground {
    /// Mean horizontal illuminance, lx.
    pub mean_lx: f64,
    /// Diffuse reflectance.
    pub reflectance: f64,
}

/// Which of the two published sets of coefficients of DGP.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DgpForm {
    /// 0.092 and 0.159, as evalglare 3.06 computes.
    #[default]
    Evalglare,
    /// 0.0918 and 0.16, as Wienold and Christoffersen published.
    Published,
}

impl DgpForm {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Evalglare => "DGP with evalglare's coefficients (0.092, 0.159)",
            Self::Published => "DGP with the published coefficients (0.0918, 0.16)",
        }
    }
}

impl Default for Given {
    /// A reader with brown eyes, of the age for which a form was made; nothing assumed about the surroundings.
    fn default() -> Self {
        Self {
            age_years: None,
            pigment: 0.5,
            dgp: DgpForm::Evalglare,
            low_light: false,
            ceiling_coverage: None,
            ground: None,
            road: None,
        }
    }
}

impl Sight {
    /// The light of the sources by its angle: part by part where parts are known.
    pub fn by_angle(&self) -> Vec<AtAngle> {
        let mut all = Vec::with_capacity(self.sources.len() + self.parts.len());
        let mut of: Vec<Vec<&StrayPart>> = vec![Vec::new(); self.sources.len()];
        for part in &self.parts {
            of[part.source].push(part);
        }
        for (source, parts) in self.sources.iter().zip(of) {
            all.extend(parts.iter().map(|part| AtAngle {
                off_axis_deg: part.off_axis_deg,
                eye_lx: part.share * source.eye_lx,
                is_part: true,
            }));
            if parts.is_empty() {
                let GlareSource { off_axis_deg, eye_lx, .. } = *source;
                all.push(AtAngle { off_axis_deg, eye_lx, is_part: false });
            }
        }
        all
    }

    /// The part of E_v that does not come from the sources, lx.
    pub fn e_indirect_lx(&self) -> f64 {
        self.e_v_lx - self.e_direct_lx
    }
}

/// Σ term/P^`power` over the sources; never 0.
///
/// # Errors
/// No source shines, or one of them is no physical one.
pub fn positioned_sum(
    sources: &[GlareSource],
    power: i32,
    term: impl Fn(&GlareSource) -> Result<f64, Undefined>,
) -> Result<f64, Undefined> {
    let mut sum = 0.0;
    for source in sources {
        if !(source.position_index >= 1.0 - 1e-9) {
            return Err(Undefined::because("a source has no valid position index"));
        }
        let glare = term(source)?;
        if !(glare.is_finite() && glare >= 0.0) {
            return Err(Undefined::because("a source has no finite luminance"));
        }
        sum += glare / source.position_index.powi(power);
    }
    if sum > 0.0 { Ok(sum) } else { Err(Undefined::because(NO_SOURCE)) }
}

/// The source's luminance, cd/m².
///
/// # Errors
/// It is a point: without an area there is no luminance.
pub fn luminance(source: &GlareSource) -> Result<f64, Undefined> {
    if source.solid_angle_sr > 0.0 || !(source.eye_lx > 0.0) {
        Ok(source.luminance.0)
    } else {
        Err(Undefined::because("a point source has no luminance, for which this index asks"))
    }
}

/// L²ω of a source, cd²·sr/m⁴.
///
/// # Errors
/// As for [`luminance`].
pub fn square(source: &GlareSource) -> Result<f64, Undefined> {
    let luminance = luminance(source)?;
    Ok(luminance * luminance * source.solid_angle_sr)
}

/// S2 = Σ L²ω/P², the sum of CGI, UGP and DGP; never 0.
///
/// # Errors
/// As for [`positioned_sum`] and [`luminance`].
pub fn square_sum(sight: &Sight) -> Result<f64, Undefined> {
    positioned_sum(&sight.sources, 2, square)
}

/// A positive figure, or why an index has none.
///
/// # Errors
/// `reason` if it is not positive (or no number).
pub fn positive(value: f64, reason: &str) -> Result<f64, Undefined> {
    if value > 0.0 && value.is_finite() { Ok(value) } else { Err(Undefined::because(reason)) }
}

/// L_b, if there is one.
///
/// # Errors
/// It is not positive.
pub fn background(sight: &Sight) -> Result<f64, Undefined> {
    positive(sight.background.0, "the background luminance is not positive")
}

/// E_v, if there is one.
///
/// # Errors
/// It is not positive.
pub fn eye_illuminance(sight: &Sight) -> Result<f64, Undefined> {
    positive(sight.e_v_lx, "the illuminance at the eye is not positive")
}
