//! Images made from evalglare's own cases, and its test image, against what it printed for them.

use glam::DVec3;
use serde_json::Value;

use super::*;
use crate::glare::reference_data;
use crate::image::{Projection, View};

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

/// The scene of a case at 800 × 800, 180° angular: discs by angle, rectangles by azimuth and elevation.
fn drawn(scene: &Value) -> LuminanceImage {
    let projection = Projection::AngularFisheye { horizontal_deg: 180.0, vertical_deg: 180.0 };
    let view = View::new(projection, DVec3::ZERO, DVec3::Y, DVec3::Z).unwrap();
    let mut pixels = vec![0.0; 640_000];
    for (index, pixel) in pixels.iter_mut().enumerate() {
        let at = [(index % 800) as f64 + 0.5, (index / 800) as f64 + 0.5];
        let Some(d) = view.direction([800, 800], at) else { continue };
        *pixel = number(&scene["bg_exact"]);
        let azimuth = d.x.atan2(d.y).to_degrees();
        let elevation = d.z.asin().to_degrees();
        for source in scene["srcs"].as_array().unwrap() {
            let (az, el) = (number(&source["az"]), number(&source["el"]));
            let inside = if source["shape"] == "disk" {
                let (sin, cos) = el.to_radians().sin_cos();
                let centre = DVec3::new(az.to_radians().sin() * cos, az.to_radians().cos() * cos, sin);
                crate::glare::field::angle(centre, d).to_degrees() <= number(&source["radius_deg"])
            } else {
                (azimuth - az).abs() <= 0.5 * number(&source["w_deg"])
                    && (elevation - el).abs() <= 0.5 * number(&source["h_deg"])
            };
            if inside {
                *pixel = number(&source["L_exact"]);
            }
        }
    }
    LuminanceImage::new(800, 800, Some(view), pixels)
}

fn value(glare: &ImageGlare, key: &str) -> f64 {
    let reading = glare.readings.iter().find(|reading| reading.key == key).unwrap();
    reading.value.clone().unwrap_or_else(|undefined| panic!("{key}: {undefined}"))
}

#[test]
fn drawn_cases_give_evalglares_indices() {
    let Some(text) = reference_data("glare/evalglare_cases.json") else { return };
    let data: Value = serde_json::from_str(&text).unwrap();
    let (mut worst_ugr, mut worst_dgp) = (0.0f64, 0.0f64);
    let mut image = None;
    for case in data["cases"].as_array().unwrap() {
        let variant = case["variant"].as_str().unwrap();
        // "q1" takes L_b as the mean of the background instead; its other indices are the default's.
        if variant == "q1" {
            continue;
        }
        if let Some(scene) = case.get("scene").filter(|_| variant == "default") {
            image = Some(drawn(scene));
        }
        let mut options = Options::default();
        options.given.low_light = variant == "lowlight_on";
        if variant == "b5_noT" {
            options.search.threshold = Threshold::TimesMean(5.0);
        }
        let glare = glare_of_image(image.as_ref().unwrap(), None, &options).unwrap();
        let sources = case["inputs"]["sources"].as_array().unwrap();
        assert_eq!(glare.sources.len(), sources.len(), "{}", case["case"]);
        let dgp = (value(&glare, "DGP") - number(&case["expected"]["dgp"])).abs();
        assert!(dgp < 0.005, "{} {variant}: DGP off by {dgp}", case["case"]);
        worst_dgp = worst_dgp.max(dgp);
        let e_v = value(&glare, "E_v") / number(&case["inputs"]["E_v"]);
        assert!((e_v - 1.0).abs() < 2e-3, "{} {variant}: E_v {e_v}", case["case"]);
        if !sources.is_empty() {
            let ugr = (value(&glare, "UGR") - number(&case["expected"]["ugr"])).abs();
            assert!(ugr < 0.05, "{} {variant}: UGR off by {ugr}", case["case"]);
            worst_ugr = worst_ugr.max(ugr);
        }
    }
    println!("drawn cases: UGR within {worst_ugr:.4}, DGP within {worst_dgp:.5}");
}

#[test]
fn evalglares_test_image_gives_its_values() {
    let folder = std::env::var("GERSHUN_DATA")
        .unwrap_or_else(|_| format!("{}/../shared/data", env!("CARGO_MANIFEST_DIR")));
    let Ok(bytes) = std::fs::read(format!("{folder}/hdr/evalglare/testimage.hdr")) else {
        println!("skipped: no reference data hdr/evalglare/testimage.hdr");
        return;
    };
    let image = crate::image::read(&bytes).unwrap();
    let options = Options { band_rad: Some(0.4), ..Options::default() };
    let glare = glare_of_image(&image, None, &options).unwrap();
    println!(
        "DGP {} UGR {} E_v {} L_b {} {:?}",
        value(&glare, "DGP"),
        value(&glare, "UGR"),
        value(&glare, "E_v"),
        value(&glare, "L_b"),
        glare.band
    );
    assert_eq!(glare.sources.len(), 3);
    assert!((value(&glare, "DGP") - 0.530615).abs() < 0.005);
    assert!((value(&glare, "UGR") - 26.290476).abs() < 0.1);
    assert!((value(&glare, "E_v") / 6124.936725 - 1.0).abs() < 2e-3);
    assert!((value(&glare, "L_b") / 551.287097 - 1.0).abs() < 1e-5);
    // To five digits; a band by elevation, which has 2π sin 0.4 = 2.4467 sr, is told apart.
    let band = glare.band.unwrap().unwrap();
    assert!((band.median.0 - 1339.703125).abs() < 1e-6);
    assert!((band.solid_angle_sr / 2.423399 - 1.0).abs() < 5e-6);
    assert!((band.mean.0 / 2353.496003 - 1.0).abs() < 5e-6);
    assert!((std::f64::consts::TAU * 0.4f64.sin() / 2.423399 - 1.0).abs() > 1e-3);
}
