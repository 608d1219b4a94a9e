//! Damaged photometric files: a token or line dropped, doubled or with another digit, at many places of real
//! files and of a small one. What comes out must be an error, a new finding, or the same values; never
//! intensities that have moved to other angles without a word.

#![allow(clippy::print_stdout, reason = "measured shares are shown")]

use std::path::{Path, PathBuf};

use gershun::lamp;
use gershun::photometry::IntensityDistribution;

fn is(name: &str, extension: &str) -> bool {
    Path::new(name).extension().is_some_and(|found| found.eq_ignore_ascii_case(extension))
}

/// A sound EULUMDAT file with four different planes.
fn small() -> Vec<u8> {
    let head = "Maker;2;0;4;90;19;5;rep;Lamp;no;file;date;1300;300;80;1200;200;0;0;0;0;100;89.9;1;0;1;1;LED;4000;4000;80;40";
    let mut lines: Vec<String> = head.split(';').map(str::to_owned).collect();
    lines.extend(vec!["0".to_owned(); 10]);
    lines.extend(["0", "90", "180", "270"].map(str::to_owned));
    lines.extend((0..19).map(|k| (5 * k).to_string()));
    for plane in 0..4 {
        let turn = f64::from([0, 1, 0, -1][plane]);
        lines.extend((0..19).map(|k| {
            let gamma = (5.0 * f64::from(k)).to_radians();
            format!("{:.1}", 286.5 * gamma.cos().max(0.0) * (1.0 + 0.3 * turn * gamma.sin()))
        }));
    }
    (lines.join("\r\n") + "\r\n").into_bytes()
}

fn files() -> Vec<(String, Vec<u8>)> {
    let ies = "IESNA:LM-63-2002\r\nTILT=NONE\r\n1 -1 1 7 5 1 2 0.2 0.3 0\r\n1 1 5\r\n0 15 30 45 60 75 90\r\n0 90 180 270 360\r\n\
               400 390 350 290 200 100 0\r\n400 380 330 260 160 70 0\r\n400 391 352 291 203 101 0\r\n\
               400 399 370 320 240 130 0\r\n400 390 350 290 200 100 0\r\n";
    let mut files =
        vec![("small.ldt".to_owned(), small()), ("small.ies".to_owned(), ies.as_bytes().to_vec())];
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data");
    let data = std::env::var_os("GERSHUN_DATA").map_or_else(beside, PathBuf::from).join("photometry");
    let mut folders = vec![data.clone()];
    while let Some(folder) = folders.pop() {
        let Ok(entries) = std::fs::read_dir(&folder) else {
            println!("skipped: no {}", folder.display());
            continue;
        };
        let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
        paths.sort();
        for path in paths {
            let name = path.display().to_string();
            if path.is_dir() {
                folders.push(path);
            } else if is(&name, "ldt") || is(&name, "ies") {
                files.push((name, std::fs::read(&path).expect("readable")));
            }
        }
    }
    files
}

/// What a reader is told: the distribution, and everything found, without the lines.
fn told(bytes: &[u8]) -> Option<(IntensityDistribution, Vec<String>)> {
    let lamp = lamp::read(bytes, "x").ok()?.into_iter().next()?;
    let findings = lamp.findings.iter().map(|finding| format!("{} {}", finding.code, finding.message));
    Some((lamp.photometry.distribution, findings.collect()))
}

/// Nodes of the sound file whose intensity has changed other than in proportion, and how many γ they lie at.
fn moved(sound: &IntensityDistribution, damaged: &IntensityDistribution) -> (usize, usize, f64) {
    let (azimuths, gammas) = sound.grid().expect("a table");
    let scale = damaged.flux().0 / sound.flux().0;
    let peak = sound.max_intensity().0;
    let (mut nodes, mut rows) = (0, 0);
    for gamma in gammas {
        let at = |d: &IntensityDistribution, azimuth: f64| d.intensity_at(azimuth, *gamma);
        let off = |azimuth: &&f64| (at(damaged, **azimuth) - at(sound, **azimuth)).abs() > 1e-6 * peak;
        let scaled =
            |azimuth: &&f64| (at(damaged, **azimuth) - scale * at(sound, **azimuth)).abs() > 0.03 * peak;
        let changed = azimuths.iter().filter(off).count();
        nodes += changed;
        rows += usize::from(azimuths.iter().any(|azimuth| scaled(&azimuth)));
    }
    (nodes, rows, scale)
}

/// Starts and ends of the tokens of a file: its lines in EULUMDAT, its words in LM-63 behind TILT.
fn tokens(name: &str, bytes: &[u8]) -> Vec<(usize, usize)> {
    let by_lines = is(name, "ldt");
    let from = bytes.windows(5).position(|part| part == b"TILT=").unwrap_or(0);
    let splits = |byte: u8| byte == b'\n' || (!by_lines && (byte.is_ascii_whitespace() || byte == b','));
    let mut found = Vec::new();
    let mut start = from;
    for at in from..=bytes.len() {
        if at == bytes.len() || splits(bytes[at]) {
            if at > start || by_lines {
                found.push((start, at));
            }
            start = at + 1;
        }
    }
    found
}

#[derive(Default)]
struct Tally {
    refused: usize,
    found: usize,
    same: usize,
    changed: usize,
    shifted: Vec<String>,
}

/// Catches: a count that is not checked, a list that is read past its end or not to it, angles and
/// intensities mixed up, and all of that in silence.
#[test]
fn damage_never_moves_values_in_silence() {
    let kinds = ["dropped", "doubled", "digit", "cut"];
    let mut tallies: [Tally; 4] = Default::default();
    let files = files();
    // So many must be refused, or the damage does no harm: of the two small files alone, and of many.
    let least = if files.len() > 2 { 50 } else { 10 };
    for (name, whole) in files {
        let Some((sound, known)) = told(&whole) else { continue };
        let all = tokens(&name, &whole);
        let step = (all.len() / 150).max(1);
        for (k, &(start, end)) in all.iter().enumerate().filter(|(k, _)| k % step == 0 || *k < 60) {
            let token = &whole[start..end];
            let (before, after) = (&whole[..start], &whole[end..]);
            let next = after.get(1..).unwrap_or_default();
            let flipped: Vec<u8> = {
                let digits: Vec<usize> = (0..token.len()).filter(|at| token[*at].is_ascii_digit()).collect();
                let mut token = token.to_vec();
                if let Some(at) = digits.get(k % digits.len().max(1)) {
                    token[*at] = b'0' + (token[*at] - b'0' + 1 + (k % 8) as u8) % 10;
                }
                token
            };
            let damaged = [
                [before, next].concat(),
                [before, token, &after[..after.len().min(1)], token, after].concat(),
                [before, &flipped, after].concat(),
                whole[..start + token.len() / 2].to_vec(),
            ];
            for ((bytes, kind), tally) in damaged.into_iter().zip(kinds).zip(&mut tallies) {
                let Some((distribution, findings)) = told(&bytes) else {
                    tally.refused += 1;
                    continue;
                };
                let news = findings.iter().any(|finding| !known.contains(finding));
                let (nodes, rows, scale) = moved(&sound, &distribution);
                if news {
                    tally.found += 1;
                } else if nodes == 0 {
                    tally.same += 1;
                } else {
                    tally.changed += 1;
                    // A digit changes one value, one angle or one factor: a row at most.
                    if rows > 1 {
                        let token = String::from_utf8_lossy(token).into_owned();
                        tally.shifted.push(format!(
                            "{name}: {kind} '{}' (token {k}), {rows} γ, × {scale:.3}",
                            token.trim()
                        ));
                    }
                }
            }
        }
    }
    for (kind, tally) in kinds.iter().zip(&tallies) {
        let all = tally.refused + tally.found + tally.same + tally.changed;
        let share = |n: usize| 100.0 * n as f64 / all as f64;
        println!(
            "{kind}: {all} files, refused {:.2} %, told {:.2} %, same {:.2} %, changed in silence {:.2} %, shifted {}",
            share(tally.refused),
            share(tally.found),
            share(tally.same),
            share(tally.changed),
            tally.shifted.len()
        );
        for line in tally.shifted.iter().take(40) {
            println!("  {line}");
        }
    }
    for (kind, tally) in kinds.iter().zip(&tallies) {
        assert!(tally.shifted.is_empty(), "{kind}: {} moved in silence", tally.shifted.len());
        assert!(tally.refused > least, "{kind}: {}", tally.refused);
    }
}
