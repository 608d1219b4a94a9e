//! The unshadowed light of tabulated luminaires is integrated numerically: this measures its error
//! against a fine midpoint rule, and that what is said of it in the list of biases is true.
#![allow(clippy::print_stdout, reason = "measured figures are shown")]

use gershun::emitters::{Emitters, TOLERANCE, unshadowed};
use gershun::project::{LoadOptions, load};
use gershun::query::Kernel;
use gershun::rng::Rng;
use glam::DVec3;

#[test]
fn the_error_of_direct_light_is_below_what_the_report_says() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/office");
    let project = load(&path, &LoadOptions::default()).expect("the example loads");
    let emitters = Emitters::new(&project.worlds[0].scene);
    let mut rng = Rng::new(1, 2, 3);
    let (mut worst, mut typical) = (0f64, 0.0);
    for index in 0..90 {
        let [x, y, z] = rng.uniforms();
        let point = DVec3::new(8.0 * x, 5.0 * y, 2.0 * z);
        let kernels = [
            Kernel::Planar { normal: DVec3::Z },
            Kernel::Cylindrical { axis: DVec3::Z },
            Kernel::Planar { normal: DVec3::X },
        ];
        let kernel = kernels[index % 3];
        let (mut total, mut exact, mut error) = (0.0, 0.0, 0.0);
        for source in &emitters.sources[..project.worlds[0].scene.luminaires.len()] {
            let found = unshadowed(&emitters, source, point, &kernel);
            let n = 240;
            let mut fine = 0.0;
            for i in 0..n {
                for j in 0..n {
                    let u = [(f64::from(i) + 0.5) / f64::from(n), (f64::from(j) + 0.5) / f64::from(n)];
                    let arrival = emitters.arrival(source, point, u);
                    fine += arrival.normal_lx * kernel.response(arrival.direction) / f64::from(n * n);
                }
            }
            total += found;
            exact += fine;
            error += (found - fine).abs();
        }
        if exact > 0.0 {
            worst = worst.max(error / exact);
            typical += (total / exact - 1.0).abs() / 90.0;
        }
    }
    println!("direct light: worst sum of errors {worst:.1e}, typical error {typical:.1e} of the illuminance");
    assert!(worst <= TOLERANCE, "{worst:e} exceeds {TOLERANCE:e}");
}
