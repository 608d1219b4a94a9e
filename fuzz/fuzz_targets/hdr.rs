#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Ok(image) = gershun::image::read_hdr(bytes) {
        assert!(image.luminance_cd_m2.iter().all(|value| value.is_finite()));
        gershun::image::read_hdr(&gershun::image::write_hdr(&image)).expect("own bytes");
    }
});
