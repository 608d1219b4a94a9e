//! Tests of TM-33 on a small file of the newer edition.

use super::super::{Opening, PhotometryError, parse};
use super::*;

pub(in super::super) const SAMPLE: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<IESTM33-22>
  <Version>1.1</Version>
  <Header><Manufacturer>Maker</Manufacturer><CatalogNumber>T-1</CatalogNumber></Header>
  <Luminaire><Dimensions><Length>1200</Length><Width>300</Width><Height>80</Height></Dimensions></Luminaire>
  <Emitter>
    <Quantity>1</Quantity><RatedLumens>390</RatedLumens><InputWattage>4</InputWattage>
    <ColorRendering><CIE_CRI><Ra>82</Ra></CIE_CRI></ColorRendering>
    <LuminousData>
      <LuminousIntensity>
        <AbsolutePhotometry>true</AbsolutePhotometry><Symm>Symm_Quad</Symm>
        <Multiplier>2</Multiplier>
        <NumberMeasured>6</NumberMeasured><NumberHorz>2</NumberHorz><NumberVert>3</NumberVert>
        <IntData h="0" v="0">50</IntData><IntData h="0" v="45">50</IntData><IntData h="0" v="90">0</IntData>
        <IntData h="90" v="0">50</IntData><IntData h="90" v="45">20</IntData><IntData h="90" v="90">0</IntData>
      </LuminousIntensity>
    </LuminousData>
    <EmissionAreas><BottomFace><NumberBottom>1</NumberBottom><BottomArea><Length>1100</Length><Width>200</Width>
      <LengthOffset>0</LengthOffset><WidthOffset>0</WidthOffset></BottomArea></BottomFace></EmissionAreas>
  </Emitter>
</IESTM33-22>
"#;

fn edited(changes: &[(&str, &str)]) -> Result<Photometry, PhotometryError> {
    let mut text = SAMPLE.to_owned();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    parse(text.as_bytes(), "x.xml")
}

fn codes(photometry: &Photometry) -> Vec<&'static str> {
    photometry.findings.iter().map(|finding| finding.code).collect()
}

/// Catches: a multiplier forgotten, planes not mirrored, h = 0 laid along, millimetres as metres, a finding
/// without its line.
#[test]
fn factors_frame_and_sizes() {
    let lamp = edited(&[]).expect("sound");
    let at = |azimuth: f64| lamp.distribution.intensity_at(azimuth, 45.0);
    // Azimuth 0 lies along the length, which is h = 90°.
    for (azimuth, cd) in [(0.0, 40.0), (180.0, 40.0), (90.0, 100.0), (270.0, 100.0), (225.0, 70.0)] {
        assert!((at(azimuth) - cd).abs() < 1e-9, "{azimuth}: {}", at(azimuth));
    }
    assert_eq!(lamp.opening, Opening::rect(1.1, 0.2));
    assert_eq!((lamp.format, lamp.description.as_str()), (Format::Tm33, "Maker T-1"));
    assert_eq!(
        (lamp.power_w, lamp.colour_rendering, lamp.rated_flux_lm),
        (Some(4.0), Some(82.0), Some(390.0))
    );
    assert_eq!((lamp.places.flux, lamp.places.intensity(0.0, 1)), (Some(7), Some(15)));
    assert!(codes(&lamp).contains(&"plane-orientation") && !codes(&lamp).contains(&"opening-approximated"));
}

/// Catches: the older edition's names and root unknown, values at the pole demanded once per plane.
#[test]
fn the_older_editions_read_alike() {
    let older = SAMPLE
        .replace("IESTM33-22>", "LuminaireOpticalData>")
        .replace("LuminousIntensity>", "IntensityDistribution>")
        .replace("IntData", "IntensityData")
        .replace(" h=", " horz=")
        .replace(" v=", " vertical=")
        .replace("<NumberMeasured>6</NumberMeasured>", "")
        .replace(r#"<IntensityData horz="90" vertical="0">50</IntensityData>"#, "");
    let first = SAMPLE.replace("IESTM33-22>", "IESTM33>");
    let flux = |text: &str| parse(text.as_bytes(), "x.xml").expect("sound").distribution.flux().0;
    let lm = flux(SAMPLE);
    assert!((flux(&older) - lm).abs() < 1e-9 && (flux(&first) - lm).abs() < 1e-9);
}

/// Catches: emission areas that are not found, faces exchanged, a round area as a square one, several areas
/// as their sum in one place.
#[test]
fn emission_areas_are_the_opening() {
    let sides = "</BottomFace><C0Face><NumberC0>1</NumberC0><C0Area><Length>1100</Length><Height>40</Height></C0Area></C0Face>\
        <C90Face><C90Area><Width>200</Width><Height>30</Height></C90Area></C90Face>";
    let lamp = edited(&[("</BottomFace>", sides)]).expect("sound");
    let seen = |x: f64, y: f64| lamp.opening.projected_area_m2(glam::DVec3::new(x, y, 0.0));
    assert!((seen(0.0, -1.0) - 1.1 * 0.04).abs() < 1e-9 && (seen(1.0, 0.0) - 0.2 * 0.03).abs() < 1e-9);
    let round = edited(&[("<Length>1100", "<Circular>true</Circular><Length>200")]).expect("sound");
    assert_eq!(round.opening, Opening::Disc { diameter_m: 0.2, height_m: 0.0 });
    let second = "</BottomArea><BottomArea><Length>100</Length><Width>200</Width><LengthOffset>1000</LengthOffset></BottomArea>";
    let two = edited(&[("</BottomArea>", second)]).expect("sound");
    assert_eq!(two.opening, Opening::rect(1.6, 0.2));
    let told = two.findings.iter().find(|finding| finding.code == "opening-approximated").expect("told");
    // 0.24 of 0.32 m²: 8 lg(4/3) = 1.0.
    assert!(told.consequence.contains("0.75 times") && told.consequence.contains("lower by 1.0"), "{told:?}");
    let none = edited(&[("<EmissionAreas>", "<Other>"), ("</EmissionAreas>", "</Other>")]).expect("sound");
    assert_eq!(none.opening, Opening::rect(1.2, 0.3));
    assert!(codes(&none).contains(&"opening-approximated"));
}

/// Catches: type B read as C, the equipment's type overlooked, angles below 0 refused for types A and B.
#[test]
fn types_a_and_b_become_type_c() {
    let values = |kind: &str| {
        let angles: Vec<f64> = (-9..=9).map(|k| 10.0 * f64::from(k)).collect();
        let mut text = String::new();
        for h in &angles {
            for v in &angles {
                let cd = 500.0 * v.to_radians().cos() * h.to_radians().cos();
                text.push_str(&format!("<IntData h=\"{h}\" v=\"{v}\">{cd:.3}</IntData>\n"));
            }
        }
        let file = format!(
            "<IESTM33><Equipment><Gonioradiometer><Type>{kind}</Type></Gonioradiometer></Equipment>\
             <Emitter><LuminousData><LuminousIntensity>{text}</LuminousIntensity></LuminousData></Emitter></IESTM33>"
        );
        parse(file.as_bytes(), "x.xml").expect("sound")
    };
    // Lambert's law about −z for B, about +x for A.
    let b = values("CIE_B").distribution;
    assert!(
        (b.intensity_along(glam::DVec3::NEG_Z) - 500.0).abs() < 5.0,
        "{}",
        b.intensity_along(glam::DVec3::NEG_Z)
    );
    assert!((b.intensity_along(glam::DVec3::new(0.6, 0.0, -0.8)) - 400.0).abs() < 10.0);
    let a = values("IES _ A").distribution;
    assert!((a.intensity_along(glam::DVec3::X) - 500.0).abs() < 5.0, "{}", a.intensity_along(glam::DVec3::X));
    assert!(codes(&values("CIE_B")).contains(&"resampled"));
}

/// Catches: a second emitter forgotten, its power or flux not added, other angles added as if they were the
/// same; spectra dropped without a word.
#[test]
fn emitters_are_added_and_spectra_are_told() {
    let start = SAMPLE.find("  <Emitter>").expect("one");
    let end = SAMPLE.find("</IESTM33-22>").expect("the end");
    let other = SAMPLE[start..end].replace("v=\"45\"", "v=\"30\"").replace("h=\"90\"", "h=\"180\"");
    let spectra = "<SpectralData><EmitterSpectral/><EmitterSpectral/></SpectralData>";
    let two = format!("{}{other}{}", &SAMPLE[..end], &SAMPLE[end..]);
    let two = two.replacen("<EmissionAreas>", &format!("{spectra}<EmissionAreas>"), 1);
    let lamp = parse(two.as_bytes(), "x.xml").expect("sound");
    let one = edited(&[]).expect("sound").distribution;
    let alone =
        parse(format!("{}{other}{}", &SAMPLE[..start], &SAMPLE[end..]).as_bytes(), "x.xml").expect("sound");
    for (azimuth, gamma) in [(10.0, 20.0), (100.0, 37.0), (200.0, 60.0)] {
        let truth = one.intensity_at(azimuth, gamma) + alone.distribution.intensity_at(azimuth, gamma);
        let found = lamp.distribution.intensity_at(azimuth, gamma);
        assert!((found - truth).abs() < 1e-9, "{azimuth} {gamma}: {found} {truth}");
    }
    assert_eq!((lamp.power_w, lamp.rated_flux_lm), (Some(8.0), Some(780.0)));
    assert!(codes(&lamp).contains(&"emitters-added"), "{:?}", codes(&lamp));
    let told = lamp.findings.iter().find(|finding| finding.code == "ignored-data").expect("told");
    assert_eq!(told.message, "not read: emitter spectra: 2");
    let shorter = two.replace("v=\"30\"", "v=\"80\"").replace("h=\"180\" v=\"90\"", "h=\"180\" v=\"85\"");
    let shorter = shorter.replacen("v=\"90\"", "v=\"85\"", 1);
    assert!(parse(shorter.as_bytes(), "x.xml").is_err());
}

/// Catches: radiant intensities as candelas, a hole in the table, a count that is wrong, a panic on damage.
#[test]
fn what_cannot_be_read_is_refused_with_its_line() {
    for (from, to, what) in [
        ("<Symm>", "<PhotometryType>CUSTOM</PhotometryType><Symm>", "type"),
        ("<Symm>", "<Metric>Radiant</Metric><Symm>", "luminous"),
        (
            "<NumberMeasured>6</NumberMeasured>",
            "<NumberMeasured>7</NumberMeasured>",
            "NumberMeasured is 7, but 6",
        ),
        (r#"<IntData h="90" v="45">20</IntData>"#, "", "NumberMeasured is 6, but 5"),
        (r#"v="45">20"#, r#"v="45">-20"#, "negative"),
        (r#"v="45">20"#, r#"v="45">x"#, "no number"),
        (r#"h="90" v="45""#, r#"h="-90" v="45""#, "h -90"),
        ("</IESTM33-22>", "", "XML"),
        ("<Multiplier>2", "<Multiplier>0", "not positive"),
        ("LuminousIntensity>", "RadiantIntensity>", "XML"),
    ] {
        let error = edited(&[(from, to)]).expect_err(what);
        assert!(error.to_string().contains(what) && error.line > 0, "{what}: {error}");
    }
    let none = SAMPLE.replace("LuminousIntensity>", "RadiantIntensity>");
    assert!(parse(none.as_bytes(), "x.xml").expect_err("none").to_string().contains("no emitter"));
}
