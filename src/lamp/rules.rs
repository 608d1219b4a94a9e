//! Every finding that can be made about a photometric file: one row per code. A severity says what
//! the file may be used for, not how rare the fault is.

/// How grave a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Worth knowing; results are right.
    Note,
    /// A result may be wrong by a stated or bounded amount.
    Warning,
    /// The file is unusable or contradicts itself grossly: results must not be trusted.
    Error,
}

impl Severity {
    /// The word in outputs; SARIF's levels are the same.
    pub fn key(self) -> &'static str {
        match self {
            Self::Note => "note",
            Self::Warning => "warning",
            Self::Error => "error",
        }
    }
}

/// One kind of finding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rule {
    /// Stable word.
    pub code: &'static str,
    /// How grave it is.
    pub severity: Severity,
    /// What it means, one sentence.
    pub meaning: &'static str,
    /// Why it matters, how it usually arises and what to do.
    pub explanation: &'static str,
}

const fn error(code: &'static str, meaning: &'static str, explanation: &'static str) -> Rule {
    Rule { code, severity: Severity::Error, meaning, explanation }
}

const fn warning(code: &'static str, meaning: &'static str, explanation: &'static str) -> Rule {
    Rule { code, severity: Severity::Warning, meaning, explanation }
}

const fn note(code: &'static str, meaning: &'static str, explanation: &'static str) -> Rule {
    Rule { code, severity: Severity::Note, meaning, explanation }
}

/// The rule of a code.
pub fn rule(code: &str) -> Option<&'static Rule> {
    RULES.iter().find(|rule| rule.code == code)
}

/// Severity of a code; a code without a rule is taken seriously.
pub fn severity(code: &str) -> Severity {
    rule(code).map_or(Severity::Error, |rule| rule.severity)
}

/// All rules, the gravest first.
pub const RULES: &[Rule] = &[
    error(
        "unreadable",
        "The file is damaged, incomplete or no photometric file.",
        "Numbers are missing or are no numbers, counts do not fit the data, or the format is not known. Nothing is \
         guessed: a shifted column of intensities would look like a valid luminaire. Get the file from its \
         manufacturer again.",
    ),
    error(
        "angle-order",
        "Angles do not rise.",
        "The values of a plane belong to its angles by position. If angles fall or repeat, either the list is \
         damaged or the counts in the head are wrong and angles are mixed with intensities; every value after the \
         fault may be shifted. The file is refused.",
    ),
    error(
        "negative-intensity",
        "An intensity is negative.",
        "There is no negative light. It arises from goniometer noise that was not clipped, or from numbers that \
         have run together. The file is refused, because a negative value may also mean that angles and \
         intensities are mixed.",
    ),
    error(
        "flux-contradiction",
        "Rated flux and intensities differ by more than 10 %.",
        "The file states one flux and its intensities add up to another. Every illuminance is proportional to the \
         intensities, so Ē differs by the same share from what the rated flux suggests. Usual causes: intensities \
         per 1000 lm taken as absolute or the reverse, LOR applied twice or not at all, several lamp sets, planes \
         declared in the wrong symmetry. gershun uses the intensities unless the project sets `flux`.",
    ),
    warning(
        "flux-mismatch",
        "Rated flux and intensities differ by 2 to 10 %.",
        "As for flux-contradiction, but small enough to come from rounding, coarse angles, or a catalogue value \
         that was updated without a new measurement. Illuminance differs by the stated share.",
    ),
    warning(
        "zero-area",
        "The file gives no luminous area.",
        "Without an area the luminaire is a point: illuminance is right beyond about five times its real size, but \
         luminance, UGR and every other glare index are undefined. Set `area` in the project.",
    ),
    warning(
        "bad-size",
        "A size of the luminous area is no number.",
        "It is taken as 0. A missing height of the luminous sides raises the luminance near the horizon, a missing \
         length or width makes the luminaire a point or a disc.",
    ),
    warning(
        "area-beyond-housing",
        "The luminous area is larger than the luminaire.",
        "Light cannot leave from outside the housing. Usually one of the two was not updated for another length of \
         the same family. Luminance is flux over area, so it and UGR are wrong: 8 lg 2 = 2.4 units of UGR for an \
         area that is wrong by a factor of 2.",
    ),
    warning(
        "swapped-dimensions",
        "The luminous area fits into the luminaire only when turned by 90°.",
        "EULUMDAT lays the length along C90–C270 and C0 *across* the luminaire; LM-63's 0° plane lies along it. \
         Converters often forget the quarter turn. Illuminance below a single luminaire hardly changes, rows and \
         UGR tables do: crosswise and endwise are exchanged.",
    ),
    warning(
        "swapped-planes",
        "Intensities near the horizon contradict the luminous sides.",
        "At 85° one sees hardly more than the sides of the opening. Where the long side shows much more area than \
         the short one but sends much less light, the planes of the measurement and the dimensions are turned by \
         90° against each other: crosswise and endwise UGR are exchanged.",
    ),
    warning(
        "asymmetry",
        "The intensities depart from the symmetry that the file declares.",
        "Programs that trust the declaration use a part of the planes and mirror it; gershun uses all that is \
         stored. The difference between two programs is then of the order of the stated asymmetry.",
    ),
    warning(
        "unequal-nadir",
        "The planes disagree about the intensity straight down.",
        "All planes meet at γ = 0, so they must agree there. A difference shows drift of lamp or photometer during \
         the measurement, or planes joined from different measurements.",
    ),
    warning(
        "missing-nadir",
        "The angles do not begin at γ = 0.",
        "What is not measured is taken as dark, so a hole opens under the luminaire. Files for upward light begin \
         at 90° rightly; any other beginning is an export fault.",
    ),
    warning(
        "missing-range",
        "The angles end where light may go on.",
        "Directions beyond the last angle are taken as dark. If the luminaire shines there, flux, wall and ceiling \
         illuminance are too low.",
    ),
    warning(
        "open-seam",
        "The planes at 0° and 360° differ, or the latter is missing.",
        "They are the same half-plane. A missing one is closed with the one at 0°; if they differ, the one at 0° \
         counts.",
    ),
    warning(
        "horizon-light",
        "A flat opening shines along its own plane.",
        "Seen edge-on a flat area vanishes, yet the file has light at γ = 90°. Luminous sides were left out of the \
         dimensions, or stray light of the measuring room was not removed. Luminance near the horizon, and with it \
         UGR, is overstated.",
    ),
    warning(
        "flat-uplight",
        "False uplight: light goes up from a flat opening that faces down.",
        "Either the opening has luminous sides or a luminous top that the file does not state, or stray light was \
         not removed. Small shares raise the ceiling's illuminance and the indirect part in the room.",
    ),
    warning(
        "down-share",
        "The stated downward share contradicts the intensities.",
        "A large difference means that the luminaire is stored upside down, or that the head belongs to another \
         measurement. The intensities are used.",
    ),
    warning(
        "spike",
        "Single intensities stand out above all their neighbours.",
        "A misplaced decimal point or a glitch of the photometer. It shows as a bright spot on walls, raises the \
         maximum and, in the direction of an observer, the glare.",
    ),
    warning(
        "drop-out",
        "Single intensities fall below all their neighbours.",
        "A missing digit or a glitch of the photometer. It shows as a dark spot and lowers E_min and U0.",
    ),
    warning(
        "coarse-angles",
        "The angles are too far apart for so narrow a beam.",
        "Between tabulated angles the intensity is interpolated linearly. For a beam that is only one or two steps \
         wide this misses its shape; flux and illuminance in the beam are uncertain. The estimate compares the \
         table with itself at twice the step.",
    ),
    warning(
        "odd-angle",
        "One angle does not keep the step of all others.",
        "Measurements are made in even steps, or in a few ranges of even steps. One angle beside its place is a \
         misprint more often than a choice; the intensities behind it then belong to another direction.",
    ),
    warning(
        "efficacy",
        "The flux does not fit the power.",
        "Luminaires give between 5 and 250 lm/W. Beyond that either is wrong: flux per 1000 lm left unscaled, power \
         of one module for a whole luminaire, or watts and lumens exchanged.",
    ),
    warning(
        "implausible-size",
        "The luminous area is larger than 10 m².",
        "LM-63 counts sizes in metres or feet, EULUMDAT in millimetres. Millimetres that are declared as metres make \
         an opening of kilometres: its light is spread so thin that almost none of it falls on the room. Set `area` \
         in the project, or correct the file.",
    ),
    warning(
        "implausible-luminance",
        "The opening would be brighter than any lamp.",
        "Usually the dimensions are in another unit (mm, m or feet) than the file declares. Illuminance is right, \
         UGR is too high by 8 lg of the area's factor.",
    ),
    warning(
        "lor-above-one",
        "The light output ratio exceeds 100 %.",
        "LOR is the luminaire's flux over its lamps'. Above 100.5 % it is no rounding: the rated flux or the lamps' \
         is wrong.",
    ),
    warning(
        "lamp-sets",
        "The file holds several lamp sets.",
        "EULUMDAT stores intensities per 1000 lm and lets the same luminaire carry different lamps. The first set \
         is used; if another is installed, every illuminance changes in proportion to its flux.",
    ),
    warning(
        "lamp-lumens",
        "The lamps' flux is neither positive nor −1.",
        "LM-63 writes −1 for absolute photometry. Anything else that is not positive is read the same way.",
    ),
    warning(
        "conversion-factor",
        "The conversion factor is no positive number.",
        "EULUMDAT multiplies every intensity by it. It is taken as 1.",
    ),
    warning(
        "reserved-field",
        "A reserved field of LM-63-2002 is not 1.",
        "Up to 1995 this field was the ballast-lamp factor, later it is reserved. It is not applied; a file that \
         means it as a factor carries the wrong edition line.",
    ),
    warning(
        "unknown-edition",
        "The edition line of LM-63 is not known.",
        "Editions differ in the meaning of negative sizes and of one factor. The file is read as LM-63-2002.",
    ),
    warning(
        "tilt",
        "The flux or the position depends on a tilt.",
        "LM-63's tilt data scale the flux of discharge lamps by their burning position; EULUMDAT's tilt is the \
         position in which a street lantern was measured. Neither is turned back.",
    ),
    warning(
        "trailing-data",
        "Something follows the last intensity.",
        "It is ignored. If it is numbers, the counts in the head are too small, and angles and intensities may be \
         mixed: compare the flux with the rated one.",
    ),
    warning(
        "opening-approximated",
        "The luminous opening is replaced by the nearest known shape.",
        "Sizes that are no shape of LM-63 (a line, a negative height) become the nearest shape; in TM-33 several \
         areas become the rectangle around them, and without any the luminaire stands for its opening. Luminance and UGR follow the shape that was taken; illuminance does not \
         depend on it beyond about ten times its size.",
    ),
    warning(
        "mixed-line-ends",
        "Lines end in different ways.",
        "Harmless to read, but a sign that the file was edited or joined by hand.",
    ),
    note(
        "resampled",
        "Type A or B photometry was converted to type C.",
        "Types A (headlamps) and B (floodlights) turn the goniometer about other axes. The intensities are \
         interpolated onto a grid of type C, fine enough for the stated error.",
    ),
    note(
        "emitters-added",
        "Several emitters were added into one distribution.",
        "TM-33 may describe every emitter of a luminaire by itself. Far away their intensities add up, which is what \
         is computed; near by, each shines from its own place.",
    ),
    note(
        "ignored-data",
        "The file holds data that are not read.",
        "TM-33 may hold spectra, radiant and photon intensities, colours by angle, measured illuminances and \
         multipliers of channels. gershun computes with luminous intensities; the rest is counted and left alone.",
    ),
    note(
        "plane-orientation",
        "How the planes lie to the luminaire is not beyond doubt.",
        "The open schema of TM-33 gives the face towards h = 0 the sizes length × height, so h = 0 lies across the \
         length; LM-63's 0° plane lies along it. A writer that carried LM-63's planes over unturned is wrong by 90°. \
         Compare the drawing of `gershun lamp polar` with the maker's.",
    ),
    note(
        "emitter",
        "The photometry is a part of a GLDF product.",
        "product.xml assigns photometries to emitters and may rate each with another flux. The intensities of the \
         photometric file are used as they are; set `flux` in the project where the product rates another.",
    ),
    note(
        "crlf",
        "Lines end in CR LF.",
        "LM-63 prescribes it and every DOS program writes it. It has no effect here; a few readers on other systems \
         keep the CR and misread the last number of a line, so differences between programs may come from it.",
    ),
    note(
        "encoding",
        "Text beyond ASCII in an undeclared encoding.",
        "Neither format declares one. UTF-8, UTF-16 with its mark, CP1251 and Latin-1 are told apart by content; \
         only names can be wrong.",
    ),
    note(
        "no-power",
        "No power is stated.",
        "Efficacy and power per area cannot be computed; light is not affected.",
    ),
];

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches: a code that `explain` does not know, a rule that nothing can raise.
    #[test]
    fn rules_and_sources_name_the_same_codes() {
        let sources = [
            include_str!("lint.rs"),
            include_str!("mod.rs"),
            include_str!("nodes.rs"),
            include_str!("../photometry/mod.rs"),
            include_str!("../photometry/findings.rs"),
            include_str!("../photometry/numbers.rs"),
            include_str!("../photometry/odd_angle.rs"),
            include_str!("../photometry/ies.rs"),
            include_str!("../photometry/ies_goniometer.rs"),
            include_str!("../photometry/ies_head.rs"),
            include_str!("../photometry/ies_opening.rs"),
            include_str!("../photometry/ldt.rs"),
            include_str!("../photometry/ldt_head.rs"),
            include_str!("../photometry/tm33.rs"),
            include_str!("../photometry/tm33_opening.rs"),
            include_str!("../photometry/tm33_table.rs"),
        ];
        for rule in RULES {
            let quoted = format!("\"{}\"", rule.code);
            assert!(sources.iter().any(|source| source.contains(&quoted)), "nothing raises {quoted}");
        }
        for source in sources {
            for call in source.split("Finding::new(").skip(1) {
                let first = call.trim_start().split(',').next().unwrap_or_default();
                if let Some(code) = first.strip_prefix('"').and_then(|code| code.strip_suffix('"')) {
                    assert!(rule(code).is_some(), "{code} has no rule");
                }
            }
        }
        let mut codes: Vec<&str> = RULES.iter().map(|rule| rule.code).collect();
        codes.sort_unstable();
        codes.dedup();
        assert_eq!(codes.len(), RULES.len());
    }
}
