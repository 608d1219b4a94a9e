#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _ = gershun::field::store::FieldFile::parse(bytes);
});
