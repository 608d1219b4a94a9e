#![no_main]
mod photometric;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    // The other formats have their own targets.
    if !bytes.starts_with(b"<") { return; }
    photometric::examine(bytes);
});
