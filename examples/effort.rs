//! Efficiency of the links method against the effort of a block: CPU seconds and the standard error
//! per point that they buy, on a furnished room. `cargo run --release --example effort`

#![allow(clippy::print_stdout, reason = "a study prints")]

#[path = "../tests/common/mod.rs"]
mod common;

use gershun::estimate::Estimate;
use gershun::query::{Demand, Kernel, Receiver};
use gershun::solve::{Effort, Method, answer, prepare};
use glam::DVec3;

fn main() {
    let scene = common::furnished();
    let mut receivers = Vec::new();
    for i in 0..12 {
        for j in 0..6 {
            let point = DVec3::new(0.25 + 0.5 * f64::from(i), 0.25 + 0.5 * f64::from(j), 0.85);
            receivers.push(Receiver {
                point,
                lift: DVec3::Z,
                kernels: vec![Kernel::Planar { normal: DVec3::Z }],
            });
        }
    }
    let demand = Demand { receivers, rays: vec![], flux: false };
    let base = Effort::default();
    let list = [
        base,
        Effort { adaptive: false, ..base },
        Effort { gather: 8, ..base },
        Effort { gather: 32, ..base },
        Effort { walks: 4, ..base },
        Effort { walks: 8, ..base },
        Effort { looks: 1, ..base },
        Effort { looks: 2, ..base },
        Effort { looks: 8, ..base },
        Effort { shadow_rays: 4.0, ..base },
        Effort { shadow_rays: 16.0, ..base },
        Effort { opening_points: 4, ..base },
        Effort { links: 128, ..base },
        Effort { patch_m2: Some(0.3), ..base },
        Effort { patch_m2: Some(0.03), ..base },
    ];
    for effort in list {
        let t0 = common::cpu_seconds();
        let mut last = None;
        for _ in 0..4 {
            last = Some(prepare(&scene, &demand, Method::Links, effort, 1));
        }
        let prepared = last.expect("four were made");
        let t1 = common::cpu_seconds();
        let sheets: Vec<_> = (0..128).map(|block| answer(&prepared, block)).collect();
        let t2 = common::cpu_seconds();
        let (mut square, mut part, n) = (0.0, 0.0, demand.rows() as f64);
        for index in 0..demand.rows() {
            let blocks = common::row(&sheets, index, scene.channels.len());
            let estimate = Estimate::from_blocks(&blocks);
            square += (estimate.se / estimate.value).powi(2) / n;
            let direct: Vec<f64> =
                sheets.iter().map(|s| s.values[index * 6] + s.values[index * 6 + 3]).collect();
            part += (Estimate::from_blocks(&direct).se / estimate.value).powi(2) / n;
        }
        let block_s = (t2 - t1) / 128.0;
        let sd = (square * 128.0).sqrt();
        println!(
            "gather {:3} walks {:3} looks {:2} shadow {:4} links {:3} patch {:?} ({} patches, adaptive {}): prepare {:.3} s, block {:.2} ms, sd/point {:.2} % (direct {:.2} %), cost to 0.5 %: {:.3} s",
            effort.gather,
            effort.walks,
            effort.looks,
            effort.shadow_rays,
            effort.links,
            effort.patch_m2,
            prepared.patches(),
            effort.adaptive,
            (t1 - t0) / 4.0,
            1e3 * block_s,
            100.0 * sd,
            100.0 * (part * 128.0).sqrt(),
            block_s * (sd / 0.005).powi(2)
        );
    }
}
