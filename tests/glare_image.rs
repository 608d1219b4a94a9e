//! `gershun glare --image` as a user calls it: what it prints and how it ends. The picture is made
//! here: a fisheye of 200 pixels with one bright disc above the line of sight.

use std::path::Path;
use std::process::Command;

use gershun::image::{LuminanceImage, Projection, View, write_hdr};
use glam::DVec3;

fn gershun(arguments: &[&str]) -> (i32, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_gershun")).args(arguments).output().expect("it runs");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (output.status.code().expect("a code"), text(&output.stdout), text(&output.stderr))
}

fn picture(folder: &Path, bright: f64) -> String {
    let projection = Projection::AngularFisheye { horizontal_deg: 180.0, vertical_deg: 180.0 };
    let view = View::new(projection, DVec3::ZERO, DVec3::Y, DVec3::Z).expect("a view");
    let centre = DVec3::new(0.0, 20f64.to_radians().cos(), 20f64.to_radians().sin());
    let luminance = |index: usize| {
        let at = [(index % 200) as f64 + 0.5, (index / 200) as f64 + 0.5];
        view.direction([200, 200], at).map_or(0.0, |direction| {
            if direction.angle_between(centre).to_degrees() < 8.0 { bright } else { 100.0 }
        })
    };
    let image = LuminanceImage::new(200, 200, Some(view), (0..40_000).map(luminance).collect());
    let path = folder.join("view.hdr");
    std::fs::write(&path, write_hdr(&image)).expect("written");
    path.display().to_string()
}

#[test]
fn an_image_gives_indices_sources_and_a_check_picture() {
    let folder = tempfile::tempdir().expect("tempdir");
    let image = picture(folder.path(), 9000.0);
    let check = folder.path().join("check.svg").display().to_string();
    let (code, out, err) = gershun(&["glare", "--image", &image, "--format", "json", "--check", &check]);
    assert_eq!((code, err.as_str()), (0, ""));
    let data: serde_json::Value = serde_json::from_str(&out).expect("json");
    assert_eq!(data["sources"].as_array().expect("sources").len(), 1);
    // 100 cd/m² give 100 π less what the disc covers, the disc L π sin² 8° cos 20°.
    let disc_lx = std::f64::consts::PI * 8f64.to_radians().sin().powi(2) * 20f64.to_radians().cos();
    let e_v_lx = 100.0 * (std::f64::consts::PI - disc_lx) + 9000.0 * disc_lx;
    let found = data["indices"]["E_v"]["value"].as_f64().expect("E_v");
    assert!((found / e_v_lx - 1.0).abs() < 0.02, "{found} {e_v_lx}");
    assert!((data["sources"][0]["up_deg"].as_f64().expect("up") - 20.0).abs() < 0.5);
    assert!(data["indices"]["UGR"]["value"].as_f64().expect("UGR") > 20.0);
    assert!(data["indices"]["GGR"]["value"].is_null() && data["indices"]["GGR"]["reason"].is_string());
    assert!(data["convention"].as_str().expect("convention").contains("threshold 2000"));
    let svg = std::fs::read_to_string(&check).expect("check picture");
    assert!(roxmltree::Document::parse(&svg).is_ok() && svg.contains("data:image/png"));
}

#[test]
fn options_move_what_they_name_and_mistakes_end_with_two() {
    let folder = tempfile::tempdir().expect("tempdir");
    let image = picture(folder.path(), 9000.0);
    let index = |arguments: &[&str], key: &str| {
        let all = [&["glare", "--image", &image, "--format", "json"], arguments].concat();
        let (code, out, err) = gershun(&all);
        assert_eq!(code, 0, "{err}");
        let data: serde_json::Value = serde_json::from_str(&out).expect("json");
        data["indices"][key]["value"].as_f64()
    };
    assert_eq!(index(&["--threshold", "10000"], "UGR"), None);
    assert!(index(&["--threshold", "10000"], "DGP").is_some());
    let [ours, other] =
        ["levin", "table"].map(|model| index(&["--position-index", model], "UGR").expect("UGR"));
    assert!((ours - other).abs() > 1e-3 && (ours - other).abs() < 1.0, "{ours} {other}");
    assert!(index(&["--measured-ev", "5000"], "E_v") == Some(5000.0));
    let [evalglare, published] =
        ["evalglare", "published"].map(|form| index(&["--dgp", form], "DGP").expect("DGP"));
    assert!((evalglare - published).abs() > 1e-4);
    let (code, out, _) = gershun(&["glare", "--image", &image, "--format", "csv"]);
    assert!(code == 0 && out.starts_with("file,index,value") && out.contains(",UGR,"));
    for (arguments, hint) in [
        (vec!["glare", "--image", "none.hdr"], "none.hdr"),
        (vec!["glare", "--image", &image, "--check", "a.bmp"], ".svg"),
        (vec!["glare", "--image", &image, "--task", "1,2"], "x,y,angle"),
        (vec!["glare", "--image", &image, "--view", "-vtl"], "parallel"),
    ] {
        let (code, _, err) = gershun(&arguments);
        assert!(code == 2 && err.contains(hint), "{code} {err}");
    }
}

/// Catches: experimental figures that are shown without being asked for, or without being called so.
#[test]
fn luminance_gradients_are_experimental_and_only_where_asked_for() {
    use gershun::image::{LuminanceImage, Projection, View};
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("ramp.hdr").display().to_string();
    let fisheye = Projection::AngularFisheye { horizontal_deg: 180.0, vertical_deg: 180.0 };
    let view = View::new(fisheye, glam::DVec3::ZERO, glam::DVec3::Y, glam::DVec3::Z).expect("a view");
    let size = [400, 400];
    let luminance = |index: usize| {
        let direction = view.direction(size, [(index % 400) as f64 + 0.5, (index / 400) as f64 + 0.5]);
        direction.map_or(0.0, |d| 100.0 * 10f64.powf(0.02 * d.z.clamp(-1.0, 1.0).asin().to_degrees()))
    };
    let image = LuminanceImage::new(400, 400, Some(view), (0..160_000).map(luminance).collect());
    std::fs::write(&path, gershun::image::write_hdr(&image)).expect("written");
    let told = |more: &[&str]| {
        let arguments = [&["glare", "--image", &path][..], more].concat();
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_gershun")).args(arguments).output();
        let output = output.expect("it runs");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).expect("UTF-8")
    };
    for format in ["human", "json", "csv"] {
        let (plain, more) = (told(&["--format", format]), told(&["--format", format, "--experimental"]));
        assert!(!plain.to_lowercase().contains("experimental_l") && !plain.contains("lg L"), "{plain}");
        assert!(more.to_lowercase().contains("experimental"), "{more}");
    }
    let json: serde_json::Value =
        serde_json::from_str(&told(&["--format", "json", "--experimental"])).unwrap();
    let found = &json["experimental_luminance_gradient"];
    assert_eq!(found["standing"], "experimental");
    // The file keeps one part in 256 of each luminance, which is 0.0017 decades: noise on 0.02 a degree.
    let mean = found["mean"].as_f64().expect("a mean");
    assert!((mean / 0.02 - 1.0).abs() < 0.1, "{mean}");
    assert_eq!(found["histogram"].as_array().map(Vec::len), Some(7));
    assert!(json["indices"].get("gradient").is_none(), "no index");
}
