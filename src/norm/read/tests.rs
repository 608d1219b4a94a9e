//! Tests of the loader: every mistake with its line and a hint.

use super::*;

fn mistakes(text: &str) -> Vec<Mistake> {
    Standard::parse(text, "house.toml").unwrap_err().mistakes
}

#[test]
fn a_wrong_key_or_type_is_named_with_its_line() {
    // Catches silently ignored misspellings, the worst a norm file can have.
    let found = mistakes("id = \"house\"\n[[row]]\nref = \"1\"\nemm = 300\n");
    assert_eq!(found[0].line, 4, "{found:?}");
    assert!(found[0].what.contains("emm") && found[0].hint.contains("em_walls"), "{found:?}");
    let shown = found[0].to_string();
    let expected = "error: unknown key \"emm\"\n --> house.toml:4:1\n  |\n4 | emm = 300\n  | ^^^\n  = hint: ";
    assert!(shown.starts_with(expected), "{shown}");
    let found = mistakes("id = \"house\"\n[[row]]\nref = \"1\"\nem = \"300 lx\"\n");
    assert_eq!(found[0].line, 4, "{found:?}");
    let found = mistakes("id = \"house\"\n[application]\nugr_shr = 0.25\n[[row]]\nref = \"1\"\nem = 300\n");
    assert_eq!(found[0].line, 3, "{found:?}");
    let found = mistakes(
        "id = \"house\"\n[application]\nugr_method = { value = \"guess\" }\n[[row]]\nref = \"1\"\nem = 3\n",
    );
    assert_eq!(found[0].line, 3, "{found:?}");
}

#[test]
fn all_wrong_values_come_at_once() {
    let text = "id = \"house\"\n[[row]]\nref = \"1\"\nem = -300\nu0 = 1.4\n[[row]]\nref = \"1\"\nugr = nan\n\
                one_source = [\"em\"]\n[[row]]\nref = \"3\"\n";
    let found = mistakes(text);
    let lines: Vec<usize> = found.iter().map(|mistake| mistake.line).collect();
    assert_eq!(lines, [4, 5, 7, 8, 9, 11], "{found:#?}");
    let error = Standard::parse(text, "house.toml").unwrap_err().to_string();
    let expected = "error: em = -300 is out of range\n --> house.toml:4:6\n  |\n4 | em = -300\n  |      ^^^^\n  = hint: an illuminance";
    assert!(error.starts_with(expected), "{error}");
    assert!(mistakes("id = \"\"\n").len() == 2);
}

#[test]
fn a_limit_may_be_a_maximum_or_on_another_statistic() {
    // A screen's 200 lx is a maximum; some norms limit the minimum, not the mean.
    let text = "id = \"house\"\n[[row]]\nref = \"17\"\n\
                [[row.limit]]\nzone = \"task\"\nquantity = \"E_v@0\"\nstatistic = \"max\"\nmax = 200\n\
                [[row.limit]]\nzone = \"task\"\nquantity = \"E_h\"\nstatistic = \"min\"\nmin = 300\nverified = \"one-source\"\n";
    let limits = Standard::parse(text, "house.toml").unwrap().rows[0].limits.clone();
    assert_eq!(limits[0].bound, Bound::Max(200.0));
    assert_eq!(limits[0].quantity, Quantity::Vertical { azimuth_deg: 0.0 });
    assert_eq!((limits[1].statistic, limits[1].verified), (Statistic::Min, Verified::OneSource));
    let both = text.replace("max = 200", "max = 200\nmin = 100").replace("\"min\"", "\"least\"");
    assert_eq!(mistakes(&both).iter().map(|mistake| mistake.line).collect::<Vec<_>>(), [6, 13]);
}
