//! Numbers for people: rounded by quantity, with the language's separators. Files for machines
//! never use these.

use super::words::{Lang, Term, word};
use crate::quantity::{Property, Quantity, Statistic, Unmeasured};

/// U+202F, between groups of three digits.
const NARROW_NO_BREAK_SPACE: char = '\u{202f}';

/// A number with a fixed number of decimals, grouped by thousands; "—" where it is not finite.
pub fn fixed(lang: Lang, value: f64, decimals: usize) -> String {
    if !value.is_finite() {
        return "—".into();
    }
    let plain = format!("{:.decimals$}", value.abs());
    let (whole, fraction) = plain.split_once('.').unwrap_or((&plain, ""));
    let mut text = String::new();
    if value < 0.0 && plain.bytes().any(|byte| (b'1'..=b'9').contains(&byte)) {
        text.push('−');
    }
    for (index, digit) in whole.chars().enumerate() {
        if index > 0 && (whole.len() - index).is_multiple_of(3) {
            text.push(NARROW_NO_BREAK_SPACE);
        }
        text.push(digit);
    }
    if !fraction.is_empty() {
        text.push(match lang {
            Lang::En => '.',
            Lang::Ru => ',',
        });
        text.push_str(fraction);
    }
    text
}

/// A number with `figures` significant figures, without an exponent.
pub fn figures(lang: Lang, value: f64, figures: i32) -> String {
    if !value.is_finite() || value.abs() <= 0.0 {
        return fixed(lang, value, 0);
    }
    let decimals = figures - 1 - value.abs().log10().floor() as i32;
    let step = 10_f64.powi(-decimals);
    let rounded = (value / step).round() * step;
    let decimals = figures - 1 - rounded.abs().log10().floor() as i32;
    fixed(lang, rounded, decimals.max(0) as usize)
}

/// Illuminance: integer from 10 lx, one decimal from 1 lx, two below.
pub fn illuminance(lang: Lang, lx: f64) -> String {
    fixed(lang, lx, illuminance_decimals(lx))
}

fn illuminance_decimals(lx: f64) -> usize {
    let rounds_to = |limit: f64, decimals: i32| {
        (lx.abs() * 10_f64.powi(decimals)).round() >= limit * 10_f64.powi(decimals)
    };
    if rounds_to(10.0, 1) {
        0
    } else if rounds_to(1.0, 2) {
        1
    } else {
        2
    }
}

/// A value of a quantity under a statistic, without its unit.
pub fn value(lang: Lang, quantity: Quantity, statistic: Statistic, value: f64) -> String {
    if is_luminance(quantity, statistic) {
        figures(lang, value, 3)
    } else {
        fixed(lang, value, decimals(quantity, statistic, value))
    }
}

/// A value beside a limit: more decimals where rounding would hide on which side it lies.
pub fn value_beside(lang: Lang, quantity: Quantity, statistic: Statistic, shown: f64, limit: f64) -> String {
    let mut text = value(lang, quantity, statistic, shown);
    let mut extra = decimals(quantity, statistic, shown);
    while text == value(lang, quantity, statistic, limit) && (shown - limit).abs() > 1e-6 * limit.abs() {
        extra += 1;
        let finer = fixed(lang, shown, extra);
        if finer != fixed(lang, limit, extra) {
            text = finer;
        }
    }
    text
}

/// A limit, without the zeros that rounding would add to UGR and R_a, and with all the digits that it has: a ratio
/// of 0.025 (40 : 1) or an illuminance of 100.4 lx would be said to be another limit.
pub fn limit(lang: Lang, quantity: Quantity, statistic: Statistic, limit: f64) -> String {
    let exact = |decimals: &i32| {
        let scale = 10_f64.powi(*decimals);
        ((limit * scale).round() / scale - limit).abs() < 1e-9
    };
    if statistic.is_ratio() {
        return fixed(lang, limit, (2..=4).find(exact).unwrap_or(2) as usize);
    }
    if matches!(quantity, Quantity::OfView { .. }) {
        return fixed(lang, limit, (0..=4).find(exact).unwrap_or(4) as usize);
    }
    let usual = value(lang, quantity, statistic, limit);
    let least = if quantity.is_single() || is_luminance(quantity, statistic) {
        0
    } else {
        decimals(quantity, statistic, limit)
    };
    (0..=4).skip(least).find(exact).map_or(usual, |decimals| fixed(lang, limit, decimals as usize))
}

fn is_luminance(quantity: Quantity, statistic: Statistic) -> bool {
    matches!(quantity, Quantity::Luminance { .. } | Quantity::OfView { unit: "cd/m²", .. })
        && !statistic.is_ratio()
}

fn decimals(quantity: Quantity, statistic: Statistic, value: f64) -> usize {
    if statistic.is_ratio() {
        return 2;
    }
    match quantity {
        Quantity::Horizontal
        | Quantity::Vertical { .. }
        | Quantity::Normal
        | Quantity::Cylindrical
        | Quantity::Semicylindrical { .. }
        | Quantity::Hemispherical
        | Quantity::Spherical
        | Quantity::OfView { unit: "lx", .. } => illuminance_decimals(value),
        Quantity::OfView { .. } if quantity.is_probability() => 3,
        Quantity::OfView { .. } if quantity.is_luminance_ratio() => 2,
        Quantity::Luminance { .. } | Quantity::Intensity | Quantity::ColourRendering => 0,
        Quantity::Modelling
        | Quantity::Declared(Property::PstLm | Property::Svm)
        | Quantity::NotComputed(Unmeasured::DaylightGlare) => 2,
        Quantity::Ugr
        | Quantity::DiscomfortIndex
        | Quantity::OfView { .. }
        | Quantity::Declared(Property::Pulsation)
        | Quantity::NotComputed(Unmeasured::GlareRating | Unmeasured::DaylightFactor) => 1,
    }
}

/// The unit of a statistic of a quantity with a space before it; empty for ratios and indices.
pub fn unit(lang: Lang, quantity: Quantity, statistic: Statistic) -> String {
    if statistic.is_ratio() {
        return String::new();
    }
    match quantity.unit() {
        "lx" => format!("\u{a0}{}", word(lang, Term::UnitLux)),
        "cd/m²" => format!("\u{a0}{}", word(lang, Term::UnitNits)),
        "cd" => format!("\u{a0}{}", word(lang, Term::UnitCandela)),
        "%" => "\u{a0}%".into(),
        _ => String::new(),
    }
}

/// A share as a percentage with one decimal.
pub fn percent(lang: Lang, share: f64) -> String {
    format!("{}\u{a0}%", fixed(lang, 100.0 * share, 1))
}

/// A length in metres with up to three decimals.
pub fn metres(lang: Lang, length_m: f64) -> String {
    let text = fixed(lang, length_m, 3);
    let trimmed = text.trim_end_matches('0').trim_end_matches(['.', ',']);
    if text.contains(['.', ',']) && !trimmed.is_empty() { trimmed.to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn illuminance_is_rounded_by_its_size() {
        for (lx, text) in [
            (1234.5, "1\u{202f}234"),
            (499.6, "500"),
            (10.4, "10"),
            (9.96, "10"),
            (9.94, "9.9"),
            (1.0, "1.0"),
            (0.996, "1.0"),
            (0.994, "0.99"),
            (0.0, "0.00"),
        ] {
            assert_eq!(illuminance(Lang::En, lx), text, "{lx}");
        }
    }

    #[test]
    fn ratios_indices_and_luminances_follow_their_rules() {
        let english = |q, s, x| value(Lang::En, q, s, x);
        let luminance = Quantity::Luminance { azimuth_deg: 0.0, tilt_deg: 0.0 };
        assert_eq!(english(Quantity::Horizontal, Statistic::U0, 0.6049), "0.60");
        assert_eq!(english(Quantity::Ugr, Statistic::Value, 18.96), "19.0");
        assert_eq!(english(luminance, Statistic::Mean, 0.123456), "0.123");
        assert_eq!(english(luminance, Statistic::Mean, 99.96), "100");
        assert_eq!(english(luminance, Statistic::Mean, 123456.0), "123\u{202f}000");
        assert_eq!(limit(Lang::En, Quantity::Ugr, Statistic::Value, 19.0), "19");
        assert_eq!(limit(Lang::En, Quantity::Ugr, Statistic::Value, 19.5), "19.5");
        assert_eq!(limit(Lang::En, Quantity::Horizontal, Statistic::Ud, 0.025), "0.025");
        assert_eq!(limit(Lang::En, Quantity::Horizontal, Statistic::U0, 0.6), "0.60");
        assert_eq!(limit(Lang::En, Quantity::Horizontal, Statistic::U0, 1.0 / 3.0), "0.33");
    }

    /// Catches: a limit of 100.4 lx printed as 100, beside a value of 100.0 that fails it.
    #[test]
    fn a_limit_keeps_its_digits() {
        let text = |limit_lx| limit(Lang::En, Quantity::Horizontal, Statistic::Mean, limit_lx);
        for (limit_lx, shown) in [
            (100.4, "100.4"),
            (99.75, "99.75"),
            (500.0, "500"),
            (5.0, "5.0"),
            (0.5, "0.50"),
            (0.125, "0.125"),
        ] {
            assert_eq!(text(limit_lx), shown);
        }
        assert_eq!(text(100.0 / 3.0), "33");
        let luminance = Quantity::Luminance { azimuth_deg: 0.0, tilt_deg: 0.0 };
        let text = |limit_nits| limit(Lang::En, luminance, Statistic::Mean, limit_nits);
        assert_eq!([1234.5, 3000.0, 0.5].map(text), ["1\u{202f}234.5", "3\u{202f}000", "0.5"]);
        let beside = |shown| value_beside(Lang::En, Quantity::Horizontal, Statistic::Mean, shown, 100.4);
        assert_eq!(beside(100.0), "100.0");
    }

    #[test]
    fn russian_numbers_have_a_comma_and_a_narrow_space() {
        assert_eq!(fixed(Lang::Ru, 1234567.891, 2), "1\u{202f}234\u{202f}567,89");
        assert_eq!(fixed(Lang::Ru, -0.25, 1), "−0,2");
        assert_eq!(fixed(Lang::Ru, -0.001, 1), "0,0");
        assert_eq!(fixed(Lang::Ru, f64::NAN, 1), "—");
    }

    #[test]
    fn a_value_just_below_its_limit_does_not_print_as_the_limit() {
        let text = |x| value_beside(Lang::En, Quantity::Horizontal, Statistic::Mean, x, 500.0);
        assert_eq!(text(499.7), "499.7");
        assert_eq!(text(500.0), "500");
        assert_eq!(text(512.2), "512");
    }

    #[test]
    fn lengths_lose_trailing_zeros_only() {
        assert_eq!(metres(Lang::Ru, 0.8), "0,8");
        assert_eq!(metres(Lang::En, 10.0), "10");
        assert_eq!(metres(Lang::En, 0.0), "0");
    }
}
