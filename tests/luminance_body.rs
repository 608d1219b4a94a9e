//! The luminance body of a point: against closed forms and against receivers.

mod common;

use std::fs;
use std::path::Path;
use std::process::Command;

use common::{planar, sheets};
use gershun::estimate::Estimate;
use gershun::measure::weights;
use gershun::observe::body::{AskedBody, LuminanceBody, luminance_body};
use gershun::project::{LoadOptions, Project, load};
use gershun::query::Demand;
use gershun::solve::{Effort, Method};
use glam::DVec3;

fn project(name: &str) -> Project {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name);
    load(&folder, &LoadOptions::default()).expect("an example that loads")
}

fn body(project: &Project, point: DVec3, step_deg: f64) -> LuminanceBody {
    let name = "here".to_owned();
    let asked = AskedBody { name, place: [0, 0], point, light_scene: 0, step_deg, blocks: 128 };
    luminance_body(project, &asked, &|_| {})
}

/// Catches: cells that do not fill the sphere, azimuth or elevation turned, luminance of the wrong
/// direction, a vector that points the wrong way. The body's own sums are compared with receivers of
/// another method: E(n) − E(−n) of planes is the vector's component.
#[test]
fn the_light_vector_is_the_difference_of_two_planes() {
    let project = project("office");
    let point = DVec3::new(2.39, 1.6, 1.2);
    let found = body(&project, point, 10.0);
    let filled: f64 = (0..found.cells.len()).map(|index| found.cell(index).1).sum();
    assert!((filled - 4.0 * std::f64::consts::PI).abs() < 1e-9, "{filled} sr");
    let world = &project.worlds[0];
    let light = weights(world, &project.light_scenes[0], &world.rooms[0], false);
    let normals = [DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y, DVec3::Z, -DVec3::Z];
    let mut receivers: Vec<_> = normals.iter().map(|&normal| planar(point, normal)).collect();
    for receiver in &mut receivers {
        receiver.lift = DVec3::ZERO;
    }
    let demand = Demand { receivers, ..Demand::default() };
    let effort = Effort { paths: 64, ..Effort::default() };
    let sheets = sheets(&world.scene, &demand, Method::Path, effort, 3, 128);
    let channels = world.scene.channels.len();
    let lx = |index: usize| -> Vec<f64> {
        let of_channel = |channel: usize| -> Vec<f64> {
            let parts = gershun::solve::PARTS;
            let start = (index * channels + channel) * parts;
            sheets.iter().map(|sheet| sheet.values[start..start + parts].iter().sum()).collect()
        };
        let mut sum = vec![0.0; sheets.len()];
        for (channel, weight) in light.iter().enumerate() {
            for (sum, value) in sum.iter_mut().zip(of_channel(channel)) {
                *sum += weight * value;
            }
        }
        sum
    };
    for axis in 0..3 {
        let (front, back) = (lx(2 * axis), lx(2 * axis + 1));
        let difference: Vec<f64> = front.iter().zip(&back).map(|(front, back)| front - back).collect();
        let expected = Estimate::from_blocks(&difference);
        let own = found.vector_lx[axis];
        let se = own.se.hypot(expected.se);
        println!(
            "axis {axis}: {:.2} ± {:.2} lx, planes {:.2} ± {:.2} lx",
            own.value, own.se, expected.value, expected.se
        );
        assert!((own.value - expected.value).abs() < 5.0 * se, "axis {axis}");
        // From the cells' means, read at their centres: only as exact as the cells are small.
        let from_cells: f64 = (0..found.cells.len())
            .map(|index| {
                let ([azimuth, elevation], sr) = found.cell(index);
                let (sin, cos) = azimuth.to_radians().sin_cos();
                let level = elevation.to_radians().cos();
                let along = [level * cos, level * sin, elevation.to_radians().sin()][axis];
                along * sr * found.cells[index].value
            })
            .sum();
        let length = found.vector_lx.iter().map(|v| v.value.powi(2)).sum::<f64>().sqrt();
        assert!((from_cells - own.value).abs() < 0.02 * length, "axis {axis}: {from_cells}");
    }
    // Broken twin: the vector points up to the panels, so the opposite one is far off.
    let up = found.vector_lx[2];
    assert!(up.value > 20.0 * up.se, "{up:?}");
}

/// Catches: a luminance that depends on where the cell lies. In a closed room whose walls shine alike
/// and reflect alike every direction has L = M / (π (1 − ρ)).
#[test]
fn in_a_furnace_the_body_is_a_sphere() {
    let folder = tempfile::tempdir().expect("tempdir");
    let text = "[scene]\nbox = { size = [3, 4, 2.5], floor = \"Hot\", walls = \"Hot\", ceiling = \"Hot\" }\n\
                [materials]\nHot = { emit = 100, reflectance = 0.8 }\n[[room]]\nname = \"Furnace\"\n";
    fs::write(folder.path().join("project.toml"), text).expect("written");
    let project = load(folder.path(), &LoadOptions::default()).expect("it loads");
    let found = body(&project, DVec3::new(1.0, 1.0, 1.0), 30.0);
    let expected = 100.0 / (1.0 - 0.8);
    for (index, cell) in found.cells.iter().enumerate() {
        assert!((cell.value - expected).abs() < 5.0 * cell.se, "{:?}: {cell:?}", found.cell(index));
        assert!((cell.value - 1.1 * expected).abs() > 5.0 * cell.se, "10 % more are not told apart");
    }
    let spherical = found.spherical_lx;
    let sphere = expected * std::f64::consts::PI;
    assert!((spherical.value - sphere).abs() < 5.0 * spherical.se, "{spherical:?}, expected {sphere}");
    assert!(5.0 * spherical.se < 0.02 * sphere, "{spherical:?} resolves nothing");
}

/// Catches: files with other numbers than the body's, a language that is not the one asked for.
#[test]
fn the_command_writes_a_table_and_a_drawing() {
    let folder = tempfile::tempdir().expect("tempdir");
    let office = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/office");
    let run = |more: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_gershun"));
        command
            .args(["body", "--blocks", "4", "--step", "30", "--out"])
            .arg(folder.path())
            .args(more)
            .arg(&office);
        command.output().expect("it runs")
    };
    let output = run(&["--viewpoint", "Seat 1", "--lang", "ru"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(String::from_utf8_lossy(&output.stdout).contains("световой вектор"));
    let table = fs::read_to_string(folder.path().join("bodies/Seat 1.csv")).expect("a table");
    assert_eq!(table.lines().count(), 1 + 12 * 6);
    assert!(table.starts_with("azimuth_deg,elevation_deg,solid_angle_sr,luminance_cd_m2,se_cd_m2\n"));
    let drawing = fs::read_to_string(folder.path().join("bodies/Seat 1.svg")).expect("a drawing");
    assert!(drawing.contains("Тело яркости") && drawing.contains("кд/м²"));
    for (wrong, hint) in [(["--viewpoint", "Seat 7"], "Seat"), (["--at", "99,0,1"], "no room")] {
        let output = run(&wrong);
        assert_eq!(output.status.code(), Some(2));
        assert!(String::from_utf8_lossy(&output.stderr).contains(hint), "{output:?}");
    }
}
