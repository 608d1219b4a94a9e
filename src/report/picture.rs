//! Luminance pictures as files: OpenEXR and Radiance HDR in absolute cd/m², false colours as SVG and
//! PNG with their scale, and views.json, which says of each how it was made and what it leaves out.

use std::path::{Path, PathBuf};

use rayon::prelude::*;
use serde::Serialize;

use super::canvas::{Anchor, Canvas, Lettering, Weight};
use super::picture_colours::{Scale, colour, colours, png, with_bar};
use super::words::{Lang, Term, phrase, word};
use super::{ReportError, folder, json, number, plan, provenance};
use crate::image::{LuminanceImage, write_exr, write_hdr};
use crate::project::InputFile;

/// A format of pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// OpenEXR, single precision, with standard errors.
    Exr,
    /// Radiance HDR.
    Hdr,
    /// False colours with scale and text.
    Svg,
    /// False colours with scale.
    Png,
}

/// How a picture was computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// The stored field.
    Stored,
    /// Direct light computed, indirect light interpolated.
    Exact,
    /// Unbiased blocks.
    Blocks(u32),
}

/// A picture and what belongs to it.
#[derive(Clone, Debug)]
pub struct Shot {
    /// Name of the camera or viewpoint.
    pub name: String,
    /// Light scene.
    pub light_scene: String,
    /// The picture; its notes are filled in here.
    pub image: LuminanceImage,
    /// How it was computed.
    pub way: Way,
    /// Σ L ω cos θ over the picture, lx; `None` without a view.
    pub illuminance_lx: Option<f64>,
    /// What it approximates or leaves out.
    pub biases: Vec<String>,
}

/// All pictures of one run.
#[derive(Clone, Debug)]
pub struct Album<'a> {
    /// Name of the project.
    pub project: &'a str,
    /// Seed of all randomness.
    pub seed: u64,
    /// Input files.
    pub inputs: &'a [InputFile],
    /// Pictures in order.
    pub shots: Vec<Shot>,
}

#[derive(Serialize)]
struct AlbumFile<'a> {
    version: u32,
    program: &'static str,
    program_version: &'static str,
    project: &'a str,
    seed: u64,
    inputs: &'a [InputFile],
    pictures: Vec<ShotRow<'a>>,
}

#[derive(Serialize)]
struct ShotRow<'a> {
    camera: &'a str,
    light_scene: &'a str,
    flux: &'static str,
    way: &'static str,
    /// Blocks behind the standard errors; `null` where there is no interval.
    blocks: Option<u32>,
    interval: &'static str,
    biases: &'a [String],
    size: [usize; 2],
    view: Option<String>,
    /// Σ L ω cos θ over the picture, lx; the whole E_v where it sees the whole half-space.
    illuminance_lx: Option<f64>,
    /// Σ L ω / Σ ω over what the projection shows.
    mean_cd_m2: f64,
    max_cd_m2: f64,
    median_relative_error: Option<f64>,
    files: Vec<String>,
}

impl Way {
    fn key(self) -> &'static str {
        match self {
            Self::Stored => "stored field",
            Self::Exact => "direct light computed, indirect light interpolated",
            Self::Blocks(_) => "unbiased blocks",
        }
    }

    fn blocks(self) -> Option<u32> {
        match self {
            Self::Stored | Self::Exact => None,
            Self::Blocks(blocks) => Some(blocks),
        }
    }
}

impl Shot {
    /// Which pixels lie in the projection.
    fn inside(&self) -> Vec<bool> {
        let [width, height] = self.image.size();
        let centre = |index: usize| [(index % width) as f64 + 0.5, (index / width) as f64 + 0.5];
        let raster = self.image.view.map(|view| view.raster([width, height]));
        let seen = |index: usize| raster.is_none_or(|raster| raster.shows(centre(index)));
        (0..width * height).into_par_iter().with_min_len(1 << 12).map(seen).collect()
    }

    /// Median of the standard errors over the luminances, where they are those of the whole.
    pub fn median_relative_error(&self) -> Option<f64> {
        self.way.blocks()?;
        let errors = self.image.standard_error_cd_m2.as_ref()?;
        let mut relative: Vec<f64> = errors
            .iter()
            .zip(&self.image.luminance_cd_m2)
            .filter(|(_, luminance)| **luminance > 0.0)
            .map(|(error, luminance)| error / luminance)
            .collect();
        relative.sort_unstable_by(f64::total_cmp);
        relative.get(relative.len() / 2).copied()
    }

    /// The image with remarks for formats that keep them.
    fn annotated(&self) -> LuminanceImage {
        LuminanceImage { notes: self.notes(), ..self.image.clone() }
    }

    /// How it was made and what it leaves out.
    fn notes(&self) -> Vec<String> {
        let interval = match self.way {
            Way::Stored | Way::Exact => "no interval".to_owned(),
            Way::Blocks(blocks) => format!("{blocks} blocks"),
        };
        let way = self.way.key();
        let mut notes = vec![format!(
            "luminance in cd/m² at initial flux, camera {}, light scene {}; {way}; {interval}",
            self.name, self.light_scene
        )];
        if self.way.blocks().is_none() && self.image.standard_error_cd_m2.is_some() {
            notes.push("channel se: standard error of the rays in glossy lobes alone".to_owned());
        }
        notes.extend(self.biases.iter().cloned());
        notes
    }
}

/// Writes pictures into the folder `views` of `out`, all or none, and returns their paths.
///
/// # Errors
/// Where a picture cannot be encoded or the folder cannot be written.
pub fn write(album: &Album, out: &Path, formats: &[Format], lang: Lang) -> Result<Vec<PathBuf>, ReportError> {
    let folder = out.join("views");
    let written = folder::replace(&folder, &files(album, formats, lang)?)?;
    Ok(written.into_iter().map(|path| folder.join(path)).collect())
}

/// Names and bytes of all files of an album.
///
/// # Errors
/// Where a picture cannot be encoded.
pub fn files(album: &Album, formats: &[Format], lang: Lang) -> Result<Vec<(String, Vec<u8>)>, ReportError> {
    let mut files: Vec<(String, Vec<u8>)> = Vec::new();
    let mut rows = Vec::new();
    for shot in &album.shots {
        let stem = free_name(&shot.name, &files);
        let encode = |format: &Format| -> Result<(String, Vec<u8>), ReportError> {
            let (extension, bytes) = match format {
                Format::Exr => (
                    "exr",
                    write_exr(&shot.annotated()).map_err(|error| ReportError::Picture(error.to_string()))?,
                ),
                Format::Hdr => ("hdr", write_hdr(&shot.annotated())),
                Format::Svg => ("svg", svg(shot, lang)?.into_bytes()),
                Format::Png => ("png", false_colours(shot)?),
            };
            Ok((format!("{stem}.{extension}"), bytes))
        };
        let encoded: Vec<(String, Vec<u8>)> = formats.par_iter().map(encode).collect::<Result<_, _>>()?;
        let names = encoded.iter().map(|(name, _)| name.clone()).collect();
        files.extend(encoded);
        let luminances = &shot.image.luminance_cd_m2;
        rows.push(ShotRow {
            camera: &shot.name,
            light_scene: &shot.light_scene,
            flux: "initial",
            way: shot.way.key(),
            blocks: shot.way.blocks(),
            interval: if shot.way.blocks().is_some() { "standard error per pixel" } else { "no interval" },
            biases: &shot.biases,
            size: shot.image.size(),
            view: shot.image.view.map(|view| view.to_options()),
            illuminance_lx: shot.illuminance_lx,
            mean_cd_m2: shot.image.mean_cd_m2(),
            max_cd_m2: luminances.iter().copied().fold(0.0, f64::max),
            median_relative_error: shot.median_relative_error(),
            files: names,
        });
    }
    let described = AlbumFile {
        version: json::VERSION,
        program: env!("CARGO_PKG_NAME"),
        program_version: env!("CARGO_PKG_VERSION"),
        project: album.project,
        seed: album.seed,
        inputs: album.inputs,
        pictures: rows,
    };
    files.push(("views.json".to_owned(), json::bytes(&described)?));
    files.push((folder::MANIFEST.to_owned(), provenance::manifest(&files)?));
    Ok(files)
}

/// A file name that no other picture has.
fn free_name(name: &str, files: &[(String, Vec<u8>)]) -> String {
    let stem = plan::file_name(name);
    let taken = |stem: &str| {
        files.iter().any(|(known, _)| {
            known.rsplit_once('.').is_some_and(|(known, _)| known.to_lowercase() == stem.to_lowercase())
        })
    };
    let numbered = (1..=files.len() + 1).map(|k| if k == 1 { stem.clone() } else { format!("{stem}-{k}") });
    numbered.into_iter().find(|stem| !taken(stem)).unwrap_or(stem)
}

fn scale_and_colours(shot: &Shot) -> (Scale, Vec<u8>) {
    let inside = shot.inside();
    let luminances = &shot.image.luminance_cd_m2;
    let scale =
        Scale::of(luminances.iter().zip(&inside).filter(|(_, inside)| **inside).map(|(value, _)| *value));
    (scale, colours(luminances, scale, |index| inside[index]))
}

fn remarks(shot: &Shot) -> String {
    shot.notes().join("\n")
}

fn false_colours(shot: &Shot) -> Result<Vec<u8>, ReportError> {
    let (scale, colours) = scale_and_colours(shot);
    let [width, height] = shot.image.size();
    let (whole, pixels) = with_bar(width, height, &colours, scale);
    png(whole, height, &pixels, &[("Comment", &remarks(shot))])
}

/// Width of the picture on the drawing, px.
const WIDTH: f64 = 720.0;

fn svg(shot: &Shot, lang: Lang) -> Result<String, ReportError> {
    const INK: [u8; 3] = [30, 30, 30];
    const STEPS: u32 = 120;
    let (scale, colours) = scale_and_colours(shot);
    let [width, height] = shot.image.size();
    let shown = [WIDTH, WIDTH * height as f64 / width as f64];
    let length = shown[1].max(160.0);
    let mut canvas = Canvas::new(shown[0] + 150.0, length + 76.0);
    let lettering = |size, weight| Lettering { size, anchor: Anchor::Start, weight, colour: INK };
    canvas.text([16.0, 18.0], &shot.name, lettering(15.0, Weight::Bold));
    let facts = format!(
        "{}: {} · {}",
        word(lang, Term::LightScene),
        shot.light_scene,
        word(lang, Term::InitialValues)
    );
    canvas.text([16.0, 38.0], &facts, lettering(11.0, Weight::Normal));
    let way = match shot.way {
        Way::Stored => word(lang, Term::StoredPicture).to_owned(),
        Way::Exact => word(lang, Term::ExactPicture).to_owned(),
        Way::Blocks(blocks) => {
            let error = shot.median_relative_error().unwrap_or(0.0);
            phrase(
                lang,
                Term::BlocksPicture,
                &[&blocks.to_string(), &number::figures(lang, 100.0 * error, 2)],
            )
        }
    };
    canvas.text([16.0, 54.0], &way, lettering(11.0, Weight::Normal));
    let top = 66.0;
    let raster = png(width, height, &colours, &[])?;
    canvas.picture([16.0, top], [16.0 + shown[0], top + shown[1]], &raster);
    let left = 16.0 + shown[0] + 16.0;
    canvas.text([left, 54.0], word(lang, Term::LuminanceScale), lettering(11.0, Weight::Normal));
    for step in 0..STEPS {
        let at = |step: u32| top + length * f64::from(step) / f64::from(STEPS);
        let position = 1.0 - (f64::from(step) + 0.5) / f64::from(STEPS);
        canvas.rectangle([left, at(step)], [left + 20.0, at(step + 1)], colour(position), 1.0);
    }
    for mark in scale.marks() {
        let y = top + length * (1.0 - scale.position(mark));
        canvas.line(&[[left + 20.0, y], [left + 26.0, y]], INK, 1.0);
        canvas.text([left + 30.0, y], &number::figures(lang, mark, 1), lettering(11.0, Weight::Normal));
    }
    Ok(canvas.finish(&format!("{}: {}", shot.name, word(lang, Term::LuminanceScale))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::{Projection, View, read};
    use glam::DVec3;

    fn album(blocks: bool) -> Album<'static> {
        let projection = Projection::AngularFisheye { horizontal_deg: 180.0, vertical_deg: 180.0 };
        let view = View::new(projection, DVec3::new(1.0, 2.0, 1.2), DVec3::X, DVec3::Z).expect("a view");
        let luminance = (0..40 * 40).map(|k| 10.0 + f64::from(k)).collect();
        let mut image = LuminanceImage::new(40, 40, Some(view), luminance);
        image.standard_error_cd_m2 = blocks.then(|| vec![1.0; 1600]);
        let shot = Shot {
            illuminance_lx: image.illuminance_lx(),
            name: "Место <1>".into(),
            light_scene: "work".into(),
            image,
            way: if blocks { Way::Blocks(64) } else { Way::Exact },
            biases: vec!["something is left out".into()],
        };
        Album { project: "p", seed: 1, inputs: &[], shots: vec![shot.clone(), shot] }
    }

    fn is(name: &str, kind: &str) -> bool {
        Path::new(name).extension().is_some_and(|extension| extension == kind)
    }

    const ALL: [Format; 4] = [Format::Exr, Format::Hdr, Format::Svg, Format::Png];

    /// Catches: a picture without its "no interval", names that overwrite each other, bytes that
    /// differ, drawings that are no XML.
    #[test]
    fn every_file_says_how_it_was_made() {
        for lang in [Lang::En, Lang::Ru] {
            let made = files(&album(false), &ALL, lang).expect("encoded");
            assert_eq!(made, files(&album(false), &ALL, lang).expect("encoded"));
            assert_eq!(made.len(), 2 * ALL.len() + 2);
            for (name, bytes) in &made {
                if is(name, "exr") || is(name, "hdr") {
                    let text = String::from_utf8_lossy(bytes);
                    assert!(text.contains("no interval") && text.contains("left out"), "{name}");
                    assert_eq!(read(bytes).expect("an image").view, album(false).shots[0].image.view);
                } else if is(name, "svg") {
                    let text = String::from_utf8(bytes.clone()).expect("UTF-8");
                    roxmltree::Document::parse(&text).expect("XML");
                    assert!(text.contains(word(lang, Term::NoInterval)), "{name}");
                } else if name == "views.json" {
                    let json: serde_json::Value = serde_json::from_slice(bytes).expect("JSON");
                    assert_eq!(json["pictures"][0]["interval"], "no interval");
                    assert_eq!(json["pictures"][0]["biases"][0], "something is left out");
                    assert_ne!(json["pictures"][0]["files"], json["pictures"][1]["files"]);
                }
            }
        }
    }

    /// Catches: blocks whose errors are lost, or that are called "no interval".
    #[test]
    fn blocks_keep_their_standard_errors() {
        let made = files(&album(true), &ALL, Lang::En).expect("encoded");
        let exr = made.iter().find(|(name, _)| is(name, "exr")).expect("an EXR");
        let image = read(&exr.1).expect("an image");
        assert!(image.standard_error_cd_m2.expect("se").iter().all(|se| (se - 1.0).abs() < 1e-6));
        let json = &made.iter().find(|(name, _)| name == "views.json").expect("views.json").1;
        let json: serde_json::Value = serde_json::from_slice(json).expect("JSON");
        assert_eq!(json["pictures"][0]["blocks"], 64);
        assert_ne!(json["pictures"][0]["interval"], "no interval");
    }

    /// Catches: a mean that counts the black corners of a fisheye, or its pixels alike.
    #[test]
    fn the_mean_is_that_of_what_the_picture_shows() {
        let mut all = album(false);
        let image = &mut all.shots[0].image;
        let view = image.view.expect("a view");
        let size = image.size();
        for index in 0..image.luminance_cd_m2.len() {
            let at = [(index % 40) as f64 + 0.5, (index / 40) as f64 + 0.5];
            image.luminance_cd_m2[index] =
                view.direction(size, at).map_or(0.0, |d| 100.0 + 50.0 * d.dot(view.forward()));
        }
        // Over a hemisphere the mean of cos θ is ½.
        let made = files(&all, &[], Lang::En).expect("encoded");
        let json = &made.iter().find(|(name, _)| name == "views.json").expect("views.json").1;
        let json: serde_json::Value = serde_json::from_slice(json).expect("JSON");
        let mean = json["pictures"][0]["mean_cd_m2"].as_f64().expect("a mean");
        assert!((mean - 125.0).abs() < 0.5, "{mean}");
    }
}
