//! Names that the program gives: areas made from a room's outline, zones without an area, images of luminaires.
//! They are English inside the program and in files for machines.

use std::borrow::Cow;

use super::{Lang, Term, phrase, said, word};

/// Name of an area or zone; what a user named stays as it is.
pub fn place_name(lang: Lang, name: &str) -> Cow<'_, str> {
    let (head, tail) = name.rsplit_once(" · ").map_or(("", name), |(head, tail)| (head, tail));
    match made_by_us(lang, tail) {
        Some(tail) if head.is_empty() => Cow::Owned(tail),
        Some(tail) => Cow::Owned(format!("{head} · {tail}")),
        None => Cow::Borrowed(name),
    }
}

/// `None` for English, and where the name is none of ours.
fn made_by_us(lang: Lang, name: &str) -> Option<String> {
    const ZONES: [&str; 6] =
        ["task area", "surrounding area", "background area", "wall", "ceiling", "volume"];
    if lang == Lang::En {
        return None;
    }
    if name == word(Lang::En, Term::WorkingPlane) {
        return Some(word(lang, Term::WorkingPlane).to_owned());
    }
    if ZONES.contains(&name) {
        return Some(said(lang, name).into_owned());
    }
    let number = |before: &str, after: &str| {
        let number = name.strip_prefix(before)?.strip_suffix(after)?;
        number.parse::<f64>().is_ok().then_some(number)
    };
    let comma = |number: &str| number.replace('.', ",");
    number("wall ", "")
        .map(|number| phrase(lang, Term::WallNumber, &[number]))
        .or_else(|| number("volume ", " m").map(|number| phrase(lang, Term::VolumeAt, &[&comma(number)])))
}

/// What a luminaire type without a photometric file is; what a file says of itself stays as it is.
pub fn description<'a>(lang: Lang, description: &'a str, file: &str) -> Cow<'a, str> {
    if file.is_empty() { said(lang, description) } else { Cow::Borrowed(description) }
}

/// Label of a glare source, `A #3 (row-1, mirrored)`.
pub fn source_label(lang: Lang, label: &str) -> Cow<'_, str> {
    let end = format!(", {})", word(Lang::En, Term::InMirror));
    match label.strip_suffix(&end) {
        Some(start) if lang != Lang::En => Cow::Owned(format!("{start}, {})", word(lang, Term::InMirror))),
        Some(_) | None => Cow::Borrowed(label),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches: names of the program's own that a Russian report prints in English, and a user's that it changes.
    #[test]
    fn names_that_the_program_gives_are_translated() {
        for (english, russian) in [
            ("Office · working plane", "Office · рабочая плоскость"),
            ("Office · volume 1.2 m", "Office · объём на высоте 1,2 м"),
            ("Office · volume", "Office · объём"),
            ("Office · ceiling", "Office · потолок"),
            ("wall", "стена"),
            ("Office · wall 3", "Office · стена 3"),
            ("surrounding area", "зона непосредственного окружения"),
            ("Desk · background area", "Desk · зона периферии"),
            ("Wall_N", "Wall_N"),
            ("wall of fame", "wall of fame"),
            ("Desk", "Desk"),
        ] {
            assert_eq!(place_name(Lang::En, english), english);
            assert_eq!(place_name(Lang::Ru, english), russian);
        }
        assert_eq!(description(Lang::Ru, "Isotropic point source", ""), "изотропный точечный источник");
        assert_eq!(description(Lang::Ru, "Isotropic point source", "a.ldt"), "Isotropic point source");
        assert_eq!(source_label(Lang::Ru, "A #3 (row-1, mirrored)"), "A #3 (row-1, в зеркале)");
        assert_eq!(source_label(Lang::En, "A #3 (row-1, mirrored)"), "A #3 (row-1, mirrored)");
    }
}
