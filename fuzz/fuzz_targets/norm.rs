#![no_main]

libfuzzer_sys::fuzz_target!(|text: &str| {
    if let Ok(standard) = gershun::norm::Standard::parse(text, "fuzz.toml") {
        for row in &standard.rows {
            let _ = standard.requirements(row);
        }
    }
});
