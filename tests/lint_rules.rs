//! Every rule of `gershun lamp lint`: a file that has the fault and its sound twin, the line that is named,
//! the consequence with its figure, and all of it in Russian.

use gershun::lamp::{self, Lamp, RULES};
use gershun::photometry::Finding;
use gershun::report::lamp::{Batch, explanation, info_text, lint_human};
use gershun::report::words::Lang;

/// γ in steps of 5°, as Lambert's law: `peak` cos γ.
fn plane(peak: f64, last_deg: u32) -> Vec<String> {
    let cd = |k: u32| format!("{:.1}", peak * (5.0 * f64::from(k)).to_radians().cos().max(0.0));
    (0..=last_deg / 5).map(cd).collect()
}

/// EULUMDAT, 1200 × 200 mm of 4000 lm in a housing of 1300 × 300 mm; four planes stored, C0 from line 66 on.
fn ldt(changes: &[(usize, &str)]) -> Vec<u8> {
    let head = "Maker;2;0;4;90;19;5;rep;Lamp;no;file;date;1300;300;80;1200;200;0;0;0;0;100;89.9;1;0;1;1;LED;4000;4000;80;40";
    let mut lines: Vec<String> = head.split(';').map(str::to_owned).collect();
    lines.extend(vec!["0".to_owned(); 10]);
    lines.extend(["0", "90", "180", "270"].map(str::to_owned));
    lines.extend((0..19).map(|k| (5 * k).to_string()));
    (0..4).for_each(|_| lines.extend(plane(286.5, 90)));
    for (line, text) in changes {
        (*text).clone_into(&mut lines[line - 1]);
    }
    (lines.join("\n") + "\n").into_bytes()
}

/// LM-63-2002, a disc of 0.2 m, absolute, 1000 lm of 10 W; intensities in line 7.
fn ies(from: &str, to: &str) -> Vec<u8> {
    let angles = (0..19).map(|k| (5 * k).to_string()).collect::<Vec<_>>().join(" ");
    let text = format!(
        "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 19 1 1 2 -0.2 -0.2 0\n1 1 10\n{angles}\n0\n{}\n",
        plane(318.3, 90).join(" ")
    );
    assert!(text.contains(from), "{from} is not in {text}");
    text.replacen(from, to, 1).into_bytes()
}

/// LM-63-2002 with planes of five values, three γ below and two above the horizon.
fn planes_of_five(horizontal: &str, planes: &[&str]) -> Vec<u8> {
    format!(
        "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 5 {} 1 2 0.2 0.2 0\n1 1 5\n0 45 90 135 180\n{horizontal}\n{}\n",
        planes.len(),
        planes.join("\n")
    )
    .into_bytes()
}

/// TM-33-23 with two emitters, one spectrum, and planes that differ.
fn tm33() -> Vec<u8> {
    let values = |h: u32, peak: f64| {
        let one = |(k, cd): (usize, &String)| format!("<IntData h=\"{h}\" v=\"{}\">{cd}</IntData>\n", 5 * k);
        plane(peak, 90).iter().enumerate().map(one).collect::<Vec<_>>().concat()
    };
    let emitter = |more: &str| {
        format!(
            "<Emitter><Quantity>1</Quantity><InputWattage>10</InputWattage><LuminousData><LuminousIntensity>\n{}{}\
             </LuminousIntensity></LuminousData>{more}<EmissionAreas><BottomFace><BottomArea><Length>600</Length>\
             <Width>100</Width></BottomArea></BottomFace></EmissionAreas></Emitter>\n",
            values(0, 300.0),
            values(90, 300.0).replace("298.9", "290.0").replace("295.4", "285.0")
        )
    };
    let spectrum = "<SpectralData><EmitterSpectral/></SpectralData>";
    format!("<IESTM33-22>\n{}{}</IESTM33-22>\n", emitter(spectrum), emitter("")).into_bytes()
}

/// A type B file of Lambert's law about −z, I = 318.3 cos V cos H, measured up to ±`last_deg`.
fn type_b(last_deg: i32) -> Vec<u8> {
    let angles: Vec<f64> = (-last_deg / 5..=last_deg / 5).map(|k| 5.0 * f64::from(k)).collect();
    let cos = |deg: &f64| deg.to_radians().cos().max(0.0);
    let list = angles.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
    let plane = |h: &f64| {
        angles.iter().map(|v| format!("{:.2}", 318.3 * cos(v) * cos(h))).collect::<Vec<_>>().join(" ")
    };
    let planes = angles.iter().map(plane).collect::<Vec<_>>().join("\n");
    let count = angles.len();
    let head = format!("IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 {count} {count} 2 2 -0.2 -0.2 0\n1 1 10");
    format!("{head}\n{list}\n{list}\n{planes}\n").into_bytes()
}

fn gldf(photometry: &[u8]) -> Vec<u8> {
    use std::io::Write;
    let product = "<Root><File id='f' contentType='ldc/eulumdat'>a.ldt</File>\
        <Photometry id='p'><PhotometryFileReference fileId='f'/></Photometry>\
        <Emitter id='left'><PhotometryReference photometryId='p'/></Emitter></Root>";
    let mut writer = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    for (name, bytes) in [("product.xml", product.as_bytes()), ("ldc/a.ldt", photometry)] {
        writer.start_file(name, zip::write::SimpleFileOptions::default()).expect("entry");
        writer.write_all(bytes).expect("written");
    }
    writer.finish().expect("archive").into_inner()
}

/// A faulty file: all codes it has, and the line of the first.
struct Case {
    codes: &'static [&'static str],
    line: Option<usize>,
    bytes: Vec<u8>,
}

fn case(codes: &'static [&'static str], line: impl Into<Option<usize>>, bytes: Vec<u8>) -> Case {
    Case { codes, line: line.into(), bytes }
}

fn cases() -> Vec<Case> {
    // Luminous long sides of 80 mm; light near the horizon along the length only, 20 cd at 80° and 85°.
    let mut swapped = vec![(18, "80"), (20, "80"), (19, "1"), (21, "1")];
    for start in [66, 104] {
        swapped.extend([(start + 16, "1"), (start + 17, "1"), (start + 18, "0")]);
    }
    for start in [85, 123] {
        swapped.extend([(start + 16, "60"), (start + 17, "60"), (start + 18, "0")]);
    }
    let even = ["100 70 0 0 0"; 5];
    let mut cp1251 = ies("TILT", "[MANUFAC] ?\nTILT");
    let name = cp1251.iter().position(|byte| *byte == b'?').expect("the name");
    cp1251[name] = 0xCC;
    let crlf = |bytes: Vec<u8>, most: usize| {
        String::from_utf8(bytes).expect("text").replacen('\n', "\r\n", most).into_bytes()
    };
    let mut sets = String::from_utf8(ldt(&[(26, "2")])).expect("text");
    sets = sets.replacen("40\n0\n", "40\n1\nHIT\n6000\n3000\n80\n100\n0\n", 1);
    vec![
        case(&["unreadable"], 3, ies("1 -1 1 19", "1 -1 x 19")),
        case(&["angle-order"], 51, ldt(&[(51, "15")])),
        case(&["negative-intensity"], 70, ldt(&[(70, "-3")])),
        case(&["flux-contradiction"], 29, ldt(&[(23, "70")])),
        case(&["flux-mismatch"], 29, ldt(&[(23, "94.3")])),
        case(&["flux-contradiction"], 3, ies("1 -1 1", "1 800 1")),
        case(&["zero-area"], 16, ldt(&[(16, "0")])),
        case(&["zero-area"], 3, ies("-0.2 -0.2", "0 0")),
        case(&["bad-size"], 18, ldt(&[(18, "n/a")])),
        case(&["area-beyond-housing"], 16, ldt(&[(13, "1000")])),
        case(&["swapped-dimensions"], 16, ldt(&[(16, "200"), (17, "1200")])),
        case(&["swapped-planes"], 16, ldt(&swapped)),
        case(&["asymmetry"], 66, ldt(&[(3, "2"), (95, "200"), (96, "180")])),
        case(&["asymmetry"], 2, ldt(&[(2, "1"), (95, "200"), (96, "180")])),
        case(&["unequal-nadir"], 85, ldt(&[(85, "260")])),
        case(&["missing-nadir"], 47, ldt(&[(47, "1")])),
        case(&["missing-range"], 65, ldt(&[(65, "87")])),
        case(
            &["open-seam"],
            6,
            planes_of_five("0 90 180 270 360", &[even[0], even[0], even[0], even[0], "100 60 0 0 0"]),
        ),
        case(&["open-seam"], 6, planes_of_five("0 90 180 270", &even[..4])),
        case(&["horizon-light"], 84, ldt(&[(84, "9")])),
        case(&["flat-uplight"], 8, planes_of_five("0 90", &[even[0], "100 70 0 3 0"])),
        case(&["down-share"], 22, ldt(&[(22, "80")])),
        case(&["spike"], 101, ldt(&[(101, "230"), (23, "92.2")])),
        case(&["drop-out"], 92, ldt(&[(92, "24")])),
        case(
            &["coarse-angles"],
            5,
            ies(&plane(318.3, 90).join(" "), &format!("9000 100{}", " 0".repeat(17))),
        ),
        case(&["odd-angle"], 53, ldt(&[(53, "31")])),
        case(&["efficacy"], 4, ies("1 1 10", "1 1 1")),
        case(&["efficacy"], 32, ldt(&[(32, "4000")])),
        case(&["implausible-size"], 3, ies("-0.2 -0.2", "300 1200")),
        case(&["implausible-luminance"], 3, ies("-0.2 -0.2", "-0.0002 -0.0002")),
        case(&["lor-above-one"], 23, ldt(&[(23, "101"), (29, "3560"), (24, "1.1236")])),
        case(&["lamp-sets"], 27, sets.into_bytes()),
        case(&["lamp-lumens"], 3, ies("1 -1 1", "1 0 1")),
        case(&["conversion-factor"], 24, ldt(&[(24, "-")])),
        case(&["reserved-field"], 4, ies("1 1 10", "1 0.9 10")),
        case(&["unknown-edition"], 1, ies("LM-63-2002", "LM-63-2031")),
        case(&["tilt"], 2, ies("TILT=NONE", "TILT=INCLUDE\n1\n3\n0 45 90\n1 0.9 0.8")),
        case(&["tilt"], 25, ldt(&[(25, "15")])),
        case(&["trailing-data"], 8, [ies("IESNA", "IESNA"), b"17 21".to_vec()].concat()),
        case(&["opening-approximated", "zero-area"], 3, ies("-0.2 -0.2 0", "0 1.2 0")),
        case(&["mixed-line-ends"], 4, crlf(ies("IESNA", "IESNA"), 3)),
        case(&["resampled"], 6, type_b(90)),
        case(&["missing-range", "resampled"], 6, type_b(45)),
        case(&["unreadable"], 29, ldt(&[(29, "4 000")])),
        case(&["unreadable"], 16, ldt(&[(16, "1 200")])),
        case(&["emitter"], None, gldf(&ldt(&[]))),
        case(&["ignored-data", "plane-orientation", "emitters-added"], 41, tm33()),
        case(&["plane-orientation", "ignored-data", "emitters-added"], 1, tm33()),
        case(&["emitters-added", "plane-orientation", "ignored-data"], 42, tm33()),
        case(&["crlf"], 1, crlf(ies("IESNA", "IESNA"), usize::MAX)),
        case(&["encoding"], 2, cp1251),
        case(&["no-power"], 32, ldt(&[(32, "")])),
    ]
}

fn read(bytes: &[u8]) -> Result<Vec<Lamp>, Finding> {
    lamp::read(bytes, "a").map_err(|error| lamp::unreadable(&error))
}

fn findings(bytes: &[u8]) -> Vec<Finding> {
    match read(bytes) {
        Ok(lamps) => lamps.into_iter().flat_map(|lamp| lamp.findings).collect(),
        Err(finding) => vec![finding],
    }
}

/// Catches: a rule that never fires, that fires on a sound file or for another fault, that names no line
/// or another one; a rule that was added without its pair of files.
#[test]
fn every_rule_has_a_faulty_file_and_a_sound_twin() {
    for sound in [ldt(&[]), ies("IESNA", "IESNA"), planes_of_five("0 90", &["100 70 0 0 0"; 2])] {
        let found = findings(&sound);
        assert!(found.iter().all(|finding| finding.code == "coarse-angles"), "{found:?}");
    }
    assert!(findings(&ldt(&[])).is_empty() && findings(&ies("IESNA", "IESNA")).is_empty());
    let cases = cases();
    let mut wrong = Vec::new();
    for case in &cases {
        let found = findings(&case.bytes);
        // Five γ are coarse, whatever else is wrong with them.
        let few = case.bytes.windows(15).any(|part| part == b"0 45 90 135 180");
        let mut codes: Vec<&str> = found
            .iter()
            .map(|finding| finding.code)
            .filter(|code| !few || *code != "coarse-angles")
            .collect();
        let first = found.iter().find(|finding| finding.code == case.codes[0]);
        codes.sort_unstable();
        let mut expected = case.codes.to_vec();
        expected.sort_unstable();
        if codes != expected || first.is_none_or(|first| first.line != case.line) {
            wrong.push(format!("{:?} at {:?}: {found:#?}", case.codes, case.line));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    for rule in RULES {
        assert!(cases.iter().any(|case| case.codes.contains(&rule.code)), "{} has no file", rule.code);
    }
}

/// Whose consequence cannot be a figure: what is unknown or has no effect on light.
const WITHOUT_FIGURE: &[&str] = &[
    "unreadable",
    "angle-order",
    "negative-intensity",
    "zero-area",
    "bad-size",
    "swapped-dimensions",
    "asymmetry",
    "open-seam",
    "down-share",
    "lamp-lumens",
    "conversion-factor",
    "unknown-edition",
    "tilt",
    "trailing-data",
    "opening-approximated",
    "mixed-line-ends",
    "emitter",
    "emitters-added",
    "ignored-data",
    "crlf",
    "encoding",
    "no-power",
];

/// Catches: a consequence without the figure by which the result is wrong, where one can be given.
#[test]
fn consequences_are_estimated() {
    let found = || cases().into_iter().flat_map(|case| findings(&case.bytes));
    let bare: Vec<Finding> = found()
        .filter(|finding| {
            let figure = finding.consequence.chars().any(|c| c.is_ascii_digit());
            !(figure || WITHOUT_FIGURE.contains(&finding.code)) || finding.consequence.len() < 20
        })
        .collect();
    assert!(bare.is_empty(), "{bare:#?}");
    let told = |bytes: Vec<u8>| findings(&bytes)[0].to_string();
    // The issue's own example: LOR 0.943 of 4000 lm is rated above the 3598 lm of the intensities.
    let flux = told(ldt(&[(23, "94.3")]));
    assert!(flux.contains("rated 3772 lm, integrates to 3598 lm") && flux.contains("4.6 % lower"), "{flux}");
    assert!(told(ldt(&[(85, "260")])).contains("9.2 %"), "{}", told(ldt(&[(85, "260")])));
    assert!(told(ies("1 1 10", "1 1 1")).contains("999 lm from 1 W"), "{}", told(ies("1 1 10", "1 1 1")));
    assert!(told(ldt(&[(16, "0")])).contains("undefined"));
}

/// Words of Latin letters that are not names, symbols or what a file says.
fn english(text: &str) -> Vec<&str> {
    const KNOWN: &[&str] = &["cos", "lg", "xml", "ldc", "eulumdat", "ies", "ldt", "product", "max"];
    let mut bare = Vec::new();
    for (k, part) in text.split('`').enumerate() {
        // Between backquotes stands what a user types; in «…» and […] what the file says, and codes.
        if k % 2 == 0 {
            bare.extend(part.split(['«', '[']).enumerate().filter_map(|(k, part)| {
                if k == 0 { Some(part) } else { part.split_once(['»', ']']).map(|(_, after)| after) }
            }));
        }
    }
    let word = |word: &&str| word.len() > 2 && word.bytes().all(|byte| byte.is_ascii_lowercase());
    let words = bare.into_iter().flat_map(|part| part.split(|c: char| !c.is_alphanumeric()));
    words.filter(word).filter(|word| !KNOWN.contains(word)).collect()
}

/// Catches: a finding, a consequence, an explanation or a line of `info` that stays English.
#[test]
fn all_of_it_is_told_in_russian() {
    assert_eq!(english("сила `area` «made by» [spike] E_min the light"), ["min", "the", "light"]);
    let mut wrong = Vec::new();
    for case in cases() {
        let batch = [Batch { file: "a".to_owned(), read: read(&case.bytes) }];
        let lint = lint_human(&batch, Lang::Ru);
        wrong.extend(english(&lint).into_iter().map(|word| format!("{word} in {lint}")));
        let info = info_text(&batch, Lang::Ru);
        // The name of the luminaire is the file's own.
        let info: String = info
            .lines()
            .filter(|line| !line.trim_start().starts_with("светильник "))
            .collect::<Vec<_>>()
            .join("\n");
        wrong.extend(english(&info).into_iter().map(|word| format!("{word} in {info}")));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    for rule in RULES {
        let text = explanation(rule.code, Lang::Ru).expect("a rule");
        let (_, told) = text.split_once('\n').expect("two lines");
        let left: Vec<&str> = english(told)
            .into_iter()
            .filter(|word| !RULES.iter().any(|rule| rule.code.split('-').any(|part| part == *word)))
            .filter(|word| !["gershun", "min"].contains(word))
            .collect();
        assert!(left.is_empty(), "{}: {left:?}", rule.code);
    }
}
