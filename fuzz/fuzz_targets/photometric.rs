//! What a photometric file goes through in `gershun lamp`.

use gershun::lamp::convert::{Target, convert};

pub fn examine(bytes: &[u8]) {
    let Ok(lamps) = gershun::lamp::read(bytes, "fuzz") else {
        return;
    };
    for lamp in &lamps {
        let flux = lamp.photometry.distribution.flux().0;
        assert!(flux.is_finite() && flux > 0.0, "flux {flux}");
        let info = gershun::lamp::info(lamp);
        assert!(info.flux_zonal_lm.is_finite() && info.zones_lm.iter().all(|lm| lm.is_finite()));
        for target in [Target::Ies, Target::Ldt] {
            let _ = convert(&lamp.photometry, target);
        }
    }
    let batch = vec![gershun::report::lamp::Batch { file: "fuzz".into(), read: Ok(lamps) }];
    let _ = gershun::report::lamp::info_text(&batch, gershun::report::words::Lang::En);
    gershun::report::lamp::info_json(&batch).expect("figures are JSON numbers");
}
