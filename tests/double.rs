//! Double local estimation: luminance along lines of sight and illuminance, against the links method;
//! and its two forms, which weight the same paths differently, against each other.
#![allow(clippy::print_stdout, reason = "measured figures are shown")]

mod common;
mod differences;

use common::{furnished, glossy_room};
use differences::{agree, brighter, demand};
use gershun::query::Demand;
use gershun::solve::{LocalEffort, LocalKernel, Method, SeenForm};
use glam::DVec3;

fn sights() -> Demand {
    let targets = [
        DVec3::new(0.01, 1.7, 1.2), // the mirror
        DVec3::new(0.01, 1.0, 1.6), // the mirror
        DVec3::new(5.9, 1.0, 1.0),  // through the pane
        DVec3::new(5.99, 0.01, 1.0),
        DVec3::new(2.7, 2.2, 1.0), // the opal
        DVec3::new(3.1, 2.2, 0.5), // the opal
        DVec3::new(2.8, 1.4, 0.74),
        DVec3::new(0.01, 0.01, 0.0),
        DVec3::new(3.0, 3.9, 2.8),
        DVec3::new(5.0, 3.99, 2.0),
    ];
    let whole = demand(DVec3::new(6.0, 4.0, 2.8), DVec3::new(3.2, 0.6, 1.2), &targets);
    Demand { receivers: whole.receivers.into_iter().take(3).collect(), ..whole }
}

fn effort(form: SeenForm) -> LocalEffort {
    LocalEffort {
        chains: 64,
        connections: 64.0,
        returns: 8,
        kernel: LocalKernel::Bounded { bound_m2: None },
        form,
    }
}

#[test]
fn double_agrees_with_links_in_a_room_with_mirror_pane_and_opal() {
    let (scene, form) = (furnished(), effort(SeenForm::Auto));
    agree("furnished, double", &scene, &brighter(&scene), &sights(), Method::Double, form);
}

#[test]
fn double_by_gathering_alone_agrees_too() {
    let (scene, form) = (furnished(), effort(SeenForm::Gather));
    agree("furnished, form B", &scene, &brighter(&scene), &sights(), Method::Double, form);
}

fn glossy_sights() -> Demand {
    let targets = [
        DVec3::new(0.01, 1.7, 1.2),  // the mirror, if there is one
        DVec3::new(2.8, 1.4, 0.74),  // the sharp desk
        DVec3::new(2.5, 1.2, 0.74),  // the sharp desk
        DVec3::new(3.05, 1.6, 0.0),  // the floor where it reflects a downlight
        DVec3::new(3.3, 2.4, 0.0),   // the floor
        DVec3::new(3.05, 4.0, 1.75), // the wall of the paper's lobe
        DVec3::new(5.0, 4.0, 1.0),
    ];
    let whole = demand(DVec3::new(6.0, 4.0, 2.8), DVec3::new(3.2, 0.6, 1.2), &targets);
    Demand { receivers: whole.receivers.into_iter().take(4).collect(), ..whole }
}

#[test]
fn double_agrees_with_links_on_glossy_surfaces_under_downlights() {
    let (scene, twin) = (glossy_room([1.0, 1.0], true), glossy_room([1.02, 1.0], true));
    agree("downlights, double", &scene, &twin, &glossy_sights(), Method::Double, effort(SeenForm::Auto));
}

#[test]
fn local_agrees_with_links_on_glossy_surfaces_beside_a_mirror() {
    let (scene, twin) = (glossy_room([1.0, 1.0], false), glossy_room([1.02, 1.0], false));
    agree("glossy, local", &scene, &twin, &glossy_sights(), Method::Local, effort(SeenForm::Auto));
}

#[test]
fn double_agrees_with_links_in_the_hall_with_a_polished_floor() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/hall");
    let project = gershun::project::load(&path, &gershun::project::LoadOptions::default()).expect("it loads");
    let scene = &project.worlds[0].scene;
    let targets = [8.0, 10.0, 12.5, 15.0, 20.0].map(|x| DVec3::new(x, 2.8, 0.0));
    let whole = demand(DVec3::new(30.0, 6.0, 4.0), DVec3::new(5.0, 3.0, 1.6), &targets);
    let demand = Demand { receivers: whole.receivers.into_iter().take(4).collect(), ..whole };
    agree("hall", scene, &brighter(scene), &demand, Method::Double, effort(SeenForm::Auto));
}
