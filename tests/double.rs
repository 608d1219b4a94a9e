//! Double local estimation: luminance along lines of sight and illuminance, against the links method;
//! and its two forms, which weight the same paths differently, against each other.
#![allow(clippy::print_stdout, reason = "measured figures are shown")]

mod common;
mod differences;

use common::furnished;
use differences::{agree, demand};
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
    agree("furnished, double", &furnished(), &sights(), Method::Double, effort(SeenForm::Auto));
}

#[test]
fn double_by_gathering_alone_agrees_too() {
    agree("furnished, form B", &furnished(), &sights(), Method::Double, effort(SeenForm::Gather));
}
