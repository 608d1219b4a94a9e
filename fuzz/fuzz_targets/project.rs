#![no_main]
use std::cell::LazyCell;

use gershun::project::{LoadOptions, load};

thread_local! {
    static FOLDER: LazyCell<tempfile::TempDir> = LazyCell::new(|| tempfile::tempdir().expect("a folder"));
}

libfuzzer_sys::fuzz_target!(|text: &str| {
    FOLDER.with(|folder| {
        let file = folder.path().join("project.toml");
        std::fs::write(&file, text).expect("written");
        if let Err(diagnostics) = load(&file, &LoadOptions::default()) {
            assert!(!diagnostics.is_empty());
            for diagnostic in diagnostics {
                let _ = diagnostic.to_string();
            }
        }
    });
});
