//! The unshadowed light of tabulated luminaires is integrated numerically: this measures its error
//! against a fine midpoint rule, and that what is said of it in the list of biases is true.
#![allow(clippy::print_stdout, reason = "measured figures are shown")]

mod common;

use gershun::emitters::{Emitters, TOLERANCE, contour, unshadowed};
use gershun::photometry::{IntensityDistribution, Opening};
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

/// A panel of 1.2 × 0.3 m of even luminance, told as a table of 0.5° steps, from 0.5 mm to 0.5 m away: below
/// its middle, its edge and its corner, on level and upright planes. Truth is Lambert's contour formula; the
/// table itself departs from cos γ by 1e-5. Catches: a quadrature that gives up close to an opening.
#[test]
fn the_error_stays_that_small_right_at_an_opening() {
    let gammas: Vec<f64> = (0..=180).map(|k| 0.5 * f64::from(k)).collect();
    let plane: Vec<f64> = gammas.iter().map(|gamma| 1000.0 * gamma.to_radians().cos()).collect();
    let table = IntensityDistribution::from_grid(vec![0.0, 360.0], gammas, vec![plane; 2]).expect("sound");
    let opening = Opening::rect(1.2, 0.3);
    let hung = DVec3::new(2.0, 2.0, 2.5);
    let materials = ["floor", "walls", "ceiling"].map(|name| common::lambert(name, 0.3)).to_vec();
    let lamps = vec![common::lamp(table, opening, hung)];
    let scene = gershun::scene::Scene::new(common::room(DVec3::new(4.0, 4.0, 3.0)), materials, lamps);
    let scene = scene.expect("a sound scene");
    let emitters = Emitters::new(&scene);
    let nits = 1000.0 / 0.36;
    let mut worst = (0f64, String::new());
    for down in [0.0005, 0.002, 0.01, 0.05, 0.2, 0.5] {
        for (x, y) in
            [(0.0, 0.0), (0.3, 0.1), (0.599, 0.0), (0.6, 0.15), (0.62, 0.0), (0.1, 0.16), (1.0, 0.4)]
        {
            let point = hung + DVec3::new(x, y, -down);
            for normal in [DVec3::Z, DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::new(0.6, 0.0, 0.8)] {
                let corners: Vec<DVec3> = opening.outline().into_iter().map(|at| hung + at - point).collect();
                let truth = nits * contour(&corners, normal);
                let found = unshadowed(&emitters, &emitters.sources[0], point, &Kernel::Planar { normal });
                // What the panel gives to a plane that faces it: a share of that is what a reader sees.
                let facing = nits * contour(&corners, DVec3::Z);
                let error = (found - truth).abs() / truth.max(0.01 * facing);
                if error > worst.0 {
                    worst = (error, format!("{down} m below ({x}, {y}), {normal}: {found} lx, not {truth}"));
                }
            }
        }
    }
    println!("right at an opening: worst error {:.1e}, {}", worst.0, worst.1);
    assert!(worst.0 <= TOLERANCE, "{:e} exceeds {TOLERANCE:e}: {}", worst.0, worst.1);
}

/// 600 panels of 1.2 × 0.3 m with a table of 5° steps, 9 m above a floor of 100 × 60 m: most pairs of
/// point and luminaire are far apart, and yet the point law is exact to 1e-4 for few of them: why there is no
/// switch to it. Catches: that reason going away, and a point law that errs near by.
#[test]
fn few_panels_could_be_points_even_in_a_hall() {
    let gammas: Vec<f64> = (0..=18).map(|k| 5.0 * f64::from(k)).collect();
    let beam = |gamma: &f64| 3000.0 * gamma.to_radians().cos().powi(3);
    let plane: Vec<f64> = gammas.iter().map(beam).collect();
    let table = IntensityDistribution::from_grid(vec![0.0, 360.0], gammas, vec![plane; 2]).expect("sound");
    let place = |k: i32| DVec3::new(1.7 + 3.3 * f64::from(k % 30), 1.5 + 3.0 * f64::from(k / 30), 9.0);
    let panels = (0..600).map(|k| common::lamp(table.clone(), Opening::rect(1.2, 0.3), place(k))).collect();
    let materials = ["floor", "walls", "ceiling"].map(|name| common::lambert(name, 0.3)).to_vec();
    let scene = gershun::scene::Scene::new(common::room(DVec3::new(100.0, 60.0, 10.0)), materials, panels);
    let scene = scene.expect("a sound scene");
    let emitters = Emitters::new(&scene);
    let sources = &emitters.sources[..600];
    let kernel = Kernel::Planar { normal: DVec3::Z };
    let points: Vec<DVec3> = (0..100)
        .map(|k| DVec3::new(9.7 * f64::from(k % 10) + 3.1, 5.9 * f64::from(k / 10) + 2.3, 0.0))
        .collect();
    let (mut taken, mut near) = (0, 0f64);
    for point in &points {
        for source in sources {
            let whole = unshadowed(&emitters, source, *point, &kernel);
            let centre = emitters.arrival(source, *point, [0.5, 0.5]);
            let change = (centre.normal_lx * kernel.response(centre.direction) / whole - 1.0).abs();
            taken += usize::from(change <= 1e-4);
            near = near.max(change);
        }
    }
    let share = taken as f64 / (600.0 * points.len() as f64);
    println!(
        "hall: the point law is within 1e-4 for {:.1} % of pairs, at worst it errs by {near:.1e}",
        100.0 * share
    );
    assert!(share < 0.25, "a switch to points may pay now: {share}");
    assert!(near > TOLERANCE, "the point law errs by {near:e} at most, so this test measures nothing");
}
