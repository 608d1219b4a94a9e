//! Which cells of a nodal field are split: those on an edge of which the middle, solved, is not what its ends
//! predict, by more than is tolerated and more than their noise explains.

use super::Splitting;
use crate::field::angular::Form;
use crate::field::nodal::{NodalField, Stored};

/// Differences below this many standard errors are noise.
const NOISE: f64 = 2.0;

/// Splits cells, generation by generation; `solve_new` solves the nodes that were added.
pub(super) fn refine(
    splitting: &Splitting,
    field: &mut NodalField,
    mut solve_new: impl FnMut(&mut NodalField),
) {
    let mut fresh = field.nodes.whole_cells();
    for _ in 0..splitting.deepest.min(crate::field::nodes::DEEPEST) {
        let middles: Vec<_> = fresh.iter().map(|&cell| field.nodes.middles(cell)).collect();
        solve_new(field);
        let mut children = Vec::new();
        for (cell, middles) in fresh.into_iter().zip(middles) {
            if middles.iter().any(|&(ends, middle)| misses(splitting, field, ends, middle)) {
                children.extend(field.nodes.split(cell));
            }
        }
        fresh = children;
    }
    let kept = field.nodes.drop_unused();
    let mut sides = std::mem::take(&mut field.sides);
    field.sides = kept.into_iter().map(|former| std::mem::take(&mut sides[former])).collect();
}

/// Whether a node is not what the mean of two others says.
fn misses(splitting: &Splitting, field: &NodalField, ends: [usize; 2], middle: usize) -> bool {
    (0..2).any(|side| {
        let of = |node: usize| field.sides[node][side].as_ref();
        match (of(ends[0]), of(ends[1]), of(middle)) {
            (Some(one), Some(other), Some(middle)) => (0..field.channels).any(|channel| {
                let found = misfits(field.form, field.channels, channel, [one, other], middle);
                found.into_iter().any(|(misfit, se)| misfit > splitting.tolerance_cd_m2.max(NOISE * se))
            }),
            _ => false,
        }
    })
}

/// Misfit and its standard error of the diffuse luminance and, root mean square over directions, of the table.
fn misfits(
    form: Form,
    channels: usize,
    channel: usize,
    [one, other]: [&Stored; 2],
    middle: &Stored,
) -> [(f64, f64); 2] {
    let count = middle.numbers.len() / channels;
    let at = |number: usize| number * channels + channel;
    let difference = |number: usize| {
        let k = at(number);
        middle.numbers[k] - 0.5 * (one.numbers[k] + other.numbers[k])
    };
    let error = |number: usize| {
        let k = at(number);
        (middle.errors[k].powi(2) + 0.25 * (one.errors[k].powi(2) + other.errors[k].powi(2))).sqrt()
    };
    let table = |of: &dyn Fn(usize) -> f64| form.mean_square((1..count).map(of)).sqrt();
    [(difference(0).abs(), error(0)), (table(&difference), table(&error))]
}
