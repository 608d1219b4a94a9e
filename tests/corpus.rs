//! Inputs that are, or once were, interesting to a parser. No panic, no figure that is no number;
//! what each file must give is in its name where it matters.

use std::fs;
use std::path::{Path, PathBuf};

use gershun::lamp::convert::{Target, convert};
use gershun::norm::Standard;
use gershun::project::{LoadOptions, load};

fn corpus(kind: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus").join(kind);
    let mut files: Vec<PathBuf> =
        fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()).collect();
    files.sort();
    assert!(!files.is_empty());
    files
}

fn stem(path: &Path) -> String {
    path.file_name().expect("a name").to_string_lossy().into_owned()
}

/// Every file whole, then cut and with a flipped bit at every `step`th byte.
fn damaged(bytes: &[u8], step: usize, mut feed: impl FnMut(&[u8])) {
    feed(bytes);
    for cut in (0..bytes.len().min(600)).step_by(step) {
        feed(&bytes[..cut]);
        let mut flipped = bytes.to_vec();
        flipped[cut] ^= 1 << (cut % 8);
        feed(&flipped);
    }
}

/// Catches: a panic in parsers, figures, writers or printers; figures that JSON cannot hold.
#[test]
fn photometric_files() {
    let refused = [
        "angles_out_of_order.ies",
        "counts_beyond_the_file.ies",
        "entities.gldf",
        "huge.ies",
        "subnormal.ies",
        "tm33_hole.xml",
        "truncated.gldf",
    ];
    for path in corpus("photometry") {
        let (name, bytes) = (stem(&path), fs::read(&path).expect("readable"));
        let whole = gershun::lamp::read(&bytes, &name);
        assert_eq!(whole.is_err(), refused.contains(&name.as_str()), "{name}: {whole:?}");
        // Resampling types A and B takes its time.
        damaged(&bytes, 17, |bytes| {
            let Ok(lamps) = gershun::lamp::read(bytes, "damaged") else { return };
            for lamp in &lamps {
                let info = gershun::lamp::info(lamp);
                assert!(info.flux_integrated_lm > 0.0 && info.flux_zonal_lm.is_finite(), "{name}: {info:?}");
                let _ = (convert(&lamp.photometry, Target::Ies), convert(&lamp.photometry, Target::Ldt));
            }
            let batch = [gershun::report::lamp::Batch { file: name.clone(), read: Ok(lamps) }];
            let _ = gershun::report::lamp::info_text(&batch, gershun::report::words::Lang::En);
            gershun::report::lamp::info_json(&batch).expect("figures are numbers");
        });
    }
}

/// Catches: a panic, an endless node chain, an allocation as large as a file claims.
#[test]
fn gltf_files() {
    for path in corpus("gltf") {
        let bytes = fs::read(&path).expect("readable");
        damaged(&bytes, 1, |bytes| {
            let _ = gershun::geometry::gltf::import(bytes, &mut |_| Err("no other files".to_owned()));
        });
    }
}

/// Catches: a panic, or memory and time without bound, on a project that is absurd.
#[test]
fn project_files() {
    let folder = tempfile::tempdir().expect("tempdir");
    for path in corpus("project") {
        let file = folder.path().join("project.toml");
        fs::copy(&path, &file).expect("copied");
        let loaded = load(&file, &LoadOptions::default());
        let planned = loaded.as_ref().is_ok_and(|project| {
            project.worlds.iter().all(|world| gershun::plan::plan(project, world).is_ok())
        });
        assert_eq!(planned, stem(&path) == "box.toml", "{}: {:?}", path.display(), loaded.err());
    }
}

/// Catches: a panic, or a standard accepted from nothing.
#[test]
fn norm_files() {
    for path in corpus("norm") {
        let text = fs::read_to_string(&path).expect("readable");
        assert!(Standard::parse(&text, "corpus").is_err(), "{}", path.display());
    }
}

/// Catches: a panic, an allocation as large as a file claims, luminances that are no numbers.
#[test]
fn images() {
    let refused =
        ["absurd_size.exr", "absurd_size.hdr", "endless_header.hdr", "no_luminance.exr", "subsampled.exr"];
    for path in corpus("image") {
        let (name, bytes) = (stem(&path), fs::read(&path).expect("readable"));
        let whole = gershun::image::read(&bytes);
        assert_eq!(whole.is_err(), refused.contains(&name.as_str()), "{name}: {whole:?}");
        damaged(&bytes, 1, |bytes| {
            let Ok(image) = gershun::image::read(bytes) else { return };
            assert!(image.luminance_cd_m2.iter().all(|value| value.is_finite()), "{name}");
            assert_eq!(image.luminance_cd_m2.len(), image.width * image.height);
            let _ = image.illuminance_lx();
            let again = gershun::image::read(&gershun::image::write_hdr(&image)).expect("own bytes");
            assert_eq!(again.size(), image.size());
        });
    }
}
