#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let mut read = |_: &str| Err("no other files".to_owned());
    let _ = gershun::geometry::gltf::import(bytes, &mut read);
});
