//! Luminance images of other programs: what they hold, and damaged ones.

mod common;

use std::fs;
use std::path::PathBuf;

use gershun::image::{LuminanceImage, Projection, read};

fn file(path: &str) -> Option<Vec<u8>> {
    let path: PathBuf = common::data()?.join(path);
    Some(fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display())))
}

fn image(path: &str) -> Option<LuminanceImage> {
    file(path).map(|bytes| read(&bytes).unwrap_or_else(|error| panic!("{path}: {error}")))
}

/// Catches: a wrong Jacobian or cosine, pixels read half a step off, an exposure or a factor lost.
/// evalglare 3.06 gives E_v = 6124.936725 lx for its test image.
#[test]
fn the_illuminance_of_a_photographed_window_is_evalglares() {
    let Some(image) = image("hdr/evalglare/testimage.hdr") else {
        println!("skipped: no reference data");
        return;
    };
    let view = image.view.expect("its view");
    assert_eq!(view.projection, Projection::AngularFisheye { horizontal_deg: 182.0, vertical_deg: 182.0 });
    assert_eq!(image.size(), [786, 786]);
    let found = image.illuminance_lx().expect("a view");
    let expected = 6124.936725;
    assert!((found / expected - 1.0).abs() < 2e-3, "{found} is not {expected}");
    // Broken twin: 180° instead of 182° is told apart.
    let mut narrow = image.clone();
    let projection = Projection::AngularFisheye { horizontal_deg: 180.0, vertical_deg: 180.0 };
    narrow.view.as_mut().expect("a view").projection = projection;
    let wrong = narrow.illuminance_lx().expect("a view");
    assert!((wrong / expected - 1.0).abs() > 4e-3, "{wrong} would pass");
}

/// Catches: EXPOSURE multiplied instead of divided, rows and columns swapped, a missing view taken
/// for a default one. `6 x / 128 + 0.1` is what the header's pcomb line says of the radiances.
#[test]
fn gradients_have_the_slope_of_their_formula() {
    for (name, horizontal) in [("h_gradient", true), ("v_gradient", false)] {
        let Some(image) = image(&format!("hdr/gradients/{name}.hdr")) else {
            println!("skipped: no reference data");
            return;
        };
        assert_eq!(image.size(), [128, 128]);
        assert_eq!(image.view, None);
        for k in [10usize, 64, 120] {
            // pcomb counts rows from below.
            let at = if horizontal { 64 * 128 + k } else { (127 - k) * 128 + 64 };
            let expected = 179.0 * (6.0 * k as f64 / 128.0 + 0.1);
            let found = image.luminance_cd_m2[at];
            assert!((found / expected - 1.0).abs() < 0.05, "{name} {k}: {found} is not {expected}");
        }
    }
}

/// Catches: a view other than the file's; rows upside down would swap floor and sky.
#[test]
fn another_programs_fisheye_has_its_view() {
    let Some(image) = image("hdr/raytraverse/check.hdr") else {
        println!("skipped: no reference data");
        return;
    };
    let view = image.view.expect("its view");
    assert_eq!(view.forward(), glam::DVec3::NEG_Y);
    assert_eq!(view.eye, glam::DVec3::new(3.0, 3.0, 1.0));
    assert!(image.luminance_cd_m2.iter().all(|value| value.is_finite()));
}

/// Catches: a compression that is decoded wrongly. One set of files holds the same picture.
#[test]
fn every_compression_is_decoded() {
    let Some(plain) = image("hdr/exr/uncompressed.exr") else {
        println!("skipped: no reference data");
        return;
    };
    assert_eq!(plain.size(), [109, 65]);
    // What the compressions may lose: nothing, 24-bit numbers, perceptually invisible differences.
    for (name, loss) in
        [("rle", 0.0), ("zip", 0.0), ("piz", 0.0), ("pxr24", 1e-4), ("b44", 0.02), ("dwaa", 0.2)]
    {
        let image = image(&format!("hdr/exr/{name}.exr")).expect("in the same folder");
        assert_eq!(image.size(), plain.size(), "{name}");
        for (found, expected) in image.luminance_cd_m2.iter().zip(&plain.luminance_cd_m2) {
            assert!(
                (found - expected).abs() <= loss * (1.0 + expected.abs()),
                "{name}: {found} is not {expected}"
            );
        }
    }
}

/// Catches: windows ignored, NaN let through, a single colour or XYZ taken for grey.
#[test]
fn oddities_of_exr_files_are_said() {
    if common::data().is_none() {
        println!("skipped: no reference data");
        return;
    }
    let exr = |name: &str| file(&format!("hdr/exr/{name}.exr")).map(|bytes| read(&bytes)).expect("data");
    let notes = |name: &str| exr(name).expect("an image").notes.join(" ");
    assert!(notes("BrightRingsNanInf").contains("no finite number"));
    assert!(notes("t07").contains("display window"));
    assert_eq!(exr("t07").expect("an image").size(), [481, 371]);
    assert!(!notes("XYZ").contains("impossible"), "{}", notes("XYZ"));
    let error = exr("WideFloatRange").expect_err("it has a channel G only").to_string();
    assert!(error.contains("channels G;"), "{error}");
}

/// Catches: a panic or an unbounded allocation on damaged OpenEXR files.
#[test]
fn hostile_exr_files_end_in_an_image_or_an_error() {
    let Some(folder) = common::data() else {
        println!("skipped: no reference data");
        return;
    };
    let mut files: Vec<PathBuf> = fs::read_dir(folder.join("hostile/exr"))
        .expect("a folder")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|kind| kind == "exr"))
        .collect();
    files.sort();
    assert!(files.len() >= 6);
    for path in files {
        let bytes = fs::read(&path).expect("readable");
        println!("{}: {:?}", path.display(), read(&bytes).map(|image| (image.size(), image.notes)));
    }
}
