//! Responses of the kernels against closed forms of a point source, kept as reference data. Catches:
//! sin and cos of ε swapped, a forgotten π, semicylinders that face the wrong way.

use gershun::query::Kernel;
use glam::DVec3;
use serde_json::Value;

#[test]
fn a_point_source_gives_every_illuminance_its_closed_form() {
    let folder = std::env::var("GERSHUN_DATA")
        .unwrap_or_else(|_| format!("{}/../shared/data", env!("CARGO_MANIFEST_DIR")));
    let Ok(text) = std::fs::read_to_string(format!("{folder}/glare/photometric_cases.json")) else {
        println!("skipped: no reference data glare/photometric_cases.json");
        return;
    };
    let data: Value = serde_json::from_str(&text).expect("json");
    let vector = |value: &Value| DVec3::from_array([0, 1, 2].map(|i| value[i].as_f64().expect("a number")));
    let mut compared = 0;
    for case in data["point"].as_array().expect("cases") {
        let towards = vector(&case["source"]) - vector(&case["receiver"]);
        let normal_lx = case["I_cd"].as_f64().expect("cd") / towards.length_squared();
        let direction = towards.normalize();
        let sides = [("E", DVec3::X), ("N", DVec3::Y), ("W", DVec3::NEG_X), ("S", DVec3::NEG_Y)];
        let mut kernels = vec![
            (Kernel::Planar { normal: DVec3::Z }, &case["E_h"]),
            (Kernel::Cylindrical { axis: DVec3::Z }, &case["E_cyl"]),
            (Kernel::Hemispherical { axis: DVec3::Z }, &case["E_hemisph"]),
            (Kernel::Spherical, &case["E_scalar"]),
        ];
        for (side, normal) in sides {
            kernels.push((Kernel::Planar { normal }, &case["E_v"][side]));
            kernels
                .push((Kernel::Semicylindrical { axis: DVec3::Z, facing: normal }, &case["E_semicyl"][side]));
        }
        for (kernel, expected) in kernels {
            let expected = expected.as_f64().expect("lx");
            let found = normal_lx * kernel.response(direction);
            assert!(
                (found - expected).abs() < 1e-9 * expected.max(1.0),
                "{kernel:?}: {found} is not {expected}"
            );
            compared += 1;
        }
    }
    assert_eq!(compared, 60);
}
