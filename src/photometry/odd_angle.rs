//! One angle beside the step that all others of its list keep. A misprint looks like this; a choice of
//! uneven steps does not.

use super::Finding;
use super::numbers::Number;

/// Angles this close keep their step, degrees.
const SAME_DEG: f64 = 1e-3;

/// The odd angle of a list of γ or of planes that is even but for it; `closes` where the list should begin at
/// 0 and end at a quarter, a half or the whole of the circle.
pub(super) fn odd_angle(name: &str, angles: &[Number], closes: bool) -> Option<Finding> {
    let steps: Vec<f64> = angles.windows(2).map(|pair| pair[1].value - pair[0].value).collect();
    if steps.len() < 5 {
        return None;
    }
    let mut sorted = steps.clone();
    sorted.sort_by(f64::total_cmp);
    let usual = sorted[sorted.len() / 2];
    let odd: Vec<usize> = (0..steps.len()).filter(|k| (steps[*k] - usual).abs() > SAME_DEG).collect();
    let whole = |deg: f64| [0.0, 90.0, 180.0, 270.0, 360.0].iter().any(|end| (deg - end).abs() < SAME_DEG);
    let last = steps.len();
    let (at, due) = match odd[..] {
        [k, next] if next == k + 1 && (steps[k] + steps[next] - 2.0 * usual).abs() < SAME_DEG => {
            (next, angles[k].value + usual)
        }
        [0] if closes && whole(angles[1].value - usual) => (0, angles[1].value - usual),
        [k] if closes && k + 1 == last => {
            let due = angles[k].value + usual;
            (whole(due) || whole(due + usual)).then_some((last, due))?
        }
        _ => return None,
    };
    let Number { value, line } = angles[at];
    let apart = (value - due).abs();
    let message =
        format!("{name} {value}° stands where the step of {usual}° that all others keep asks for {due}°");
    let consequence = format!(
        "if it is a misprint, what was measured {apart}° away is used there, and its neighbours are interpolated towards it"
    );
    Some(Finding::new("odd-angle", line, message, consequence))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches: uneven steps on purpose reported, an odd first or last plane overlooked, the wrong line.
    #[test]
    fn only_a_lone_angle_is_odd() {
        let list = |values: &[f64]| -> Vec<Number> {
            values.iter().enumerate().map(|(k, value)| Number { value: *value, line: 10 + k }).collect()
        };
        let line =
            |values: &[f64], closes: bool| odd_angle("C", &list(values), closes).map(|finding| finding.line);
        assert_eq!(line(&[0., 15., 30., 45., 60., 75., 90.], true), None);
        assert_eq!(line(&[0., 2.5, 5., 10., 15., 20., 25.], true), None);
        assert_eq!(line(&[0., 15., 30., 47., 60., 75., 90.], true), Some(Some(13)));
        assert_eq!(line(&[3., 15., 30., 45., 60., 75., 90.], true), Some(Some(10)));
        assert_eq!(line(&[3., 15., 30., 45., 60., 75., 90.], false), None);
        assert_eq!(line(&[0., 15., 30., 45., 60., 75., 93.], true), Some(Some(16)));
        assert_eq!(line(&[0., 60., 120., 180., 240., 301.], true), Some(Some(15)));
        assert_eq!(line(&[0., 10., 25.], true), None);
    }
}
