//! Contours of grid values. Values are refined to half the spacing first: grid points keep their
//! values, cell borders and corners get the mean of the points around them, so that contours
//! reach the edge of the outermost cells; between these nodes values are linear.

use std::collections::{BTreeMap, BTreeSet};

/// Values on a grid of rows × columns, `None` where a point is excluded.
#[derive(Clone, Copy, Debug)]
pub struct Values<'a> {
    /// Points per row.
    pub columns: usize,
    /// Rows.
    pub rows: usize,
    /// Row by row.
    pub by_point: &'a [Option<f64>],
}

/// A place in units of cells: a point (column c, row r) lies at (c + ½, r + ½).
pub type Place = [f64; 2];

/// What one level separates.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Contours {
    /// Closed borders of the region where the value is at least the level; use the even-odd rule.
    pub regions: Vec<Vec<Place>>,
    /// Lines along which the value equals the level.
    pub lines: Vec<Vec<Place>>,
}

/// A node or a crossing of the refined grid: column, row, and 0 = node, 1 = crossing on the edge to
/// the next column, 2 = on the edge to the next row.
type Vertex = (usize, usize, u8);

/// Contours at a level. `f64::NEG_INFINITY` gives the outline of all cells that have a value.
pub fn contours(values: &Values<'_>, level: f64) -> Contours {
    let nodes = Nodes::refine(values);
    let mut borders: BTreeSet<(Vertex, Vertex)> = BTreeSet::new();
    for row in 0..2 * values.rows {
        for column in 0..2 * values.columns {
            if nodes.owner(column, row).is_some() {
                for polygon in nodes.at_least(column, row, level) {
                    add_borders(&mut borders, &polygon);
                }
            }
        }
    }
    let is_crossing = |vertex: &Vertex| vertex.2 != 0;
    let place = |vertex: &Vertex| nodes.place(*vertex, level);
    let lines: BTreeSet<_> =
        borders.iter().copied().filter(|(a, b)| is_crossing(a) && is_crossing(b)).collect();
    Contours {
        regions: chains(borders)
            .into_iter()
            .map(|chain| straightened(chain.iter().map(place).collect()))
            .collect(),
        lines: chains(lines).into_iter().map(|chain| chain.iter().map(place).collect()).collect(),
    }
}

/// Borders shared by two polygons run both ways and cancel.
fn add_borders(borders: &mut BTreeSet<(Vertex, Vertex)>, polygon: &[Vertex]) {
    for (index, from) in polygon.iter().enumerate() {
        let to = polygon[(index + 1) % polygon.len()];
        if !borders.remove(&(to, *from)) {
            borders.insert((*from, to));
        }
    }
}

/// Joins directed edges into chains; open ends first, then rings (first place repeated).
fn chains(edges: BTreeSet<(Vertex, Vertex)>) -> Vec<Vec<Vertex>> {
    let mut next: BTreeMap<Vertex, Vec<Vertex>> = BTreeMap::new();
    let ends: BTreeSet<Vertex> = edges.iter().map(|(_, to)| *to).collect();
    for (from, to) in edges {
        next.entry(from).or_default().push(to);
    }
    let mut starts: Vec<Vertex> = next.keys().copied().filter(|from| !ends.contains(from)).collect();
    starts.extend(next.keys().copied());
    let mut chains = Vec::new();
    for start in starts {
        let mut chain = vec![start];
        let mut at = start;
        while let Some(to) = next.get_mut(&at).and_then(Vec::pop) {
            chain.push(to);
            at = to;
        }
        if chain.len() > 1 {
            chains.push(chain);
        }
    }
    chains
}

/// A ring without repeated places and those that lie on a straight line between their neighbours.
fn straightened(mut ring: Vec<Place>) -> Vec<Place> {
    let alike = |a: Place, b: Place| (a[0] - b[0]).abs().max((a[1] - b[1]).abs()) < 1e-9;
    ring.dedup_by(|a, b| alike(*a, *b));
    while ring.len() > 1 && alike(ring[0], ring[ring.len() - 1]) {
        ring.pop();
    }
    let count = ring.len();
    let bends = |index: &usize| {
        let (a, b, c) = (ring[(index + count - 1) % count], ring[*index], ring[(index + 1) % count]);
        ((b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0])).abs() > 1e-9
    };
    (0..count).filter(bends).map(|index| ring[index]).collect()
}

struct Nodes<'a> {
    source: Values<'a>,
    /// Values at half-cell steps, (2·columns + 1) per row.
    values: Vec<Option<f64>>,
}

impl<'a> Nodes<'a> {
    fn refine(source: &Values<'a>) -> Self {
        let mut values = Vec::with_capacity((2 * source.columns + 1) * (2 * source.rows + 1));
        for row in 0..=2 * source.rows {
            for column in 0..=2 * source.columns {
                let mut sum = 0.0;
                let mut count = 0;
                for r in around(row, source.rows) {
                    for c in around(column, source.columns) {
                        if let Some(value) = source.by_point[r * source.columns + c] {
                            sum += value;
                            count += 1;
                        }
                    }
                }
                values.push((count > 0).then(|| sum / f64::from(count)));
            }
        }
        Self { source: *source, values }
    }

    /// The grid point in whose cell a refined square lies.
    fn owner(&self, column: usize, row: usize) -> Option<f64> {
        self.source.by_point[(row / 2) * self.source.columns + column / 2]
    }

    fn value(&self, column: usize, row: usize) -> f64 {
        self.values[row * (2 * self.source.columns + 1) + column]
            .expect("a corner of a cell with a value has one")
    }

    /// The parts of a refined square where the value is at least `level`, counter-clockwise.
    fn at_least(&self, column: usize, row: usize, level: f64) -> Vec<Vec<Vertex>> {
        let corners = [(column, row), (column + 1, row), (column + 1, row + 1), (column, row + 1)];
        let sides = [(column, row, 1), (column + 1, row, 2), (column, row + 1, 1), (column, row, 2)];
        let high = corners.map(|(c, r)| self.value(c, r) >= level);
        let node = |corner: usize| (corners[corner].0, corners[corner].1, 0);
        let mean = corners.iter().map(|(c, r)| self.value(*c, *r)).sum::<f64>() / 4.0;
        let saddle = high[0] == high[2] && high[1] == high[3] && high[0] != high[1];
        if saddle && mean < level {
            let first = usize::from(!high[0]);
            return [first, first + 2]
                .map(|corner| vec![sides[(corner + 3) % 4], node(corner), sides[corner]])
                .to_vec();
        }
        let mut polygon = Vec::new();
        for corner in 0..4 {
            if high[corner] {
                polygon.push(node(corner));
            }
            if high[corner] != high[(corner + 1) % 4] {
                polygon.push(sides[corner]);
            }
        }
        if polygon.is_empty() { Vec::new() } else { vec![polygon] }
    }

    fn place(&self, (column, row, kind): Vertex, level: f64) -> Place {
        let (x, y) = (column as f64 / 2.0, row as f64 / 2.0);
        let (next_column, next_row) = match kind {
            0 => return [x, y],
            1 => (column + 1, row),
            _ => (column, row + 1),
        };
        let (from, to) = (self.value(column, row), self.value(next_column, next_row));
        let share = ((level - from) / (to - from)).clamp(0.0, 1.0) / 2.0;
        if kind == 1 { [x + share, y] } else { [x, y + share] }
    }
}

/// Grid points beside a node: the one it lies on, or the two it lies between, inside the grid.
fn around(node: usize, count: usize) -> std::ops::Range<usize> {
    let low = if node % 2 == 1 { node / 2 } else { (node / 2).saturating_sub(1) };
    low..(node / 2 + 1).min(count)
}

/// Steps of the scale on which illuminances are specified, per decade.
const SERIES: [f64; 6] = [1.0, 1.5, 2.0, 3.0, 5.0, 7.5];

/// Levels at nice numbers strictly between `min` and `max`: the series of illuminances where they
/// span more than a factor of five, else equal steps; at most about ten.
pub fn levels(min: f64, max: f64) -> Vec<f64> {
    if !min.is_finite() || !max.is_finite() || max - min <= 1e-9 * max.abs() {
        return Vec::new();
    }
    if min > 0.0 && max > 5.0 * min {
        let decades = min.log10().floor() as i32..=max.log10().ceil() as i32;
        let mut levels: Vec<f64> = decades
            .flat_map(|decade| SERIES.map(|step| rounded(step * 10_f64.powi(decade))))
            .filter(|level| *level > min && *level < max)
            .collect();
        if levels.len() > 12 {
            levels = levels.into_iter().step_by(3).collect();
        }
        return levels;
    }
    let raw = (max - min) / 8.0;
    let decade = 10_f64.powf(raw.log10().floor());
    let step = [1.0, 2.0, 2.5, 5.0, 10.0]
        .map(|nice| nice * decade)
        .into_iter()
        .find(|step| *step >= raw)
        .unwrap_or(10.0 * decade);
    let first = (min / step).floor() as i64 + 1;
    (first..)
        .map(|index| rounded(index as f64 * step))
        .skip_while(|level| *level <= min)
        .take_while(|level| *level < max)
        .collect()
}

/// Removes the last bits that products of decimals leave.
fn rounded(value: f64) -> f64 {
    if value.abs() > 0.0 {
        let scale = 10_f64.powi(9 - value.abs().log10().floor() as i32);
        (value * scale).round() / scale
    } else {
        value
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(rings: &[Vec<Place>]) -> f64 {
        let ring_area = |ring: &Vec<Place>| {
            (0..ring.len())
                .map(|i| (ring[i], ring[(i + 1) % ring.len()]))
                .map(|(a, b)| a[0] * b[1] - b[0] * a[1])
                .sum::<f64>()
                / 2.0
        };
        rings.iter().map(ring_area).sum()
    }

    #[test]
    fn a_slope_is_cut_where_it_has_the_level() {
        let values: Vec<_> = (0..3).flat_map(|_| (0..5).map(|c| Some(10.0 * f64::from(c)))).collect();
        let found = contours(&Values { columns: 5, rows: 3, by_point: &values }, 23.0);
        assert_eq!(found.lines.len(), 1);
        assert!(found.lines[0].iter().all(|place| (place[0] - 2.8).abs() < 1e-12));
        assert!((area(&found.regions) - 3.0 * 2.2).abs() < 1e-12);
    }

    #[test]
    fn a_hill_has_a_closed_line_and_a_pit_is_a_hole() {
        let hill = |sign: f64| {
            let at = |i: i32| Some(100.0 - sign * f64::from((i % 7 - 3).pow(2) + (i / 7 - 3).pow(2)));
            (0..49).map(at).collect::<Vec<_>>()
        };
        let found = contours(&Values { columns: 7, rows: 7, by_point: &hill(1.0) }, 96.0);
        assert_eq!((found.lines.len(), found.regions.len()), (1, 1));
        assert_eq!(found.lines[0].first(), found.lines[0].last());
        assert!((area(&found.regions) - std::f64::consts::PI * 4.0).abs() < 1.5);
        let pit = contours(&Values { columns: 7, rows: 7, by_point: &hill(-1.0) }, 104.0);
        assert_eq!(pit.regions.len(), 2);
        assert!((area(&pit.regions) + area(&found.regions) - 49.0).abs() < 1e-9);
    }

    #[test]
    fn excluded_points_cut_the_region_and_carry_no_line() {
        let values = [Some(1.0), Some(1.0), Some(1.0), None];
        let all = contours(&Values { columns: 2, rows: 2, by_point: &values }, f64::NEG_INFINITY);
        assert!(all.lines.is_empty());
        assert!((area(&all.regions) - 3.0).abs() < 1e-12);
        assert_eq!(all.regions[0].len(), 6, "an L has six corners");
    }

    #[test]
    fn both_ways_through_a_saddle_are_consistent() {
        for corner in [9.0, 1.0] {
            let values = [Some(10.0), Some(0.0), Some(0.0), Some(corner)];
            let grid = Values { columns: 2, rows: 2, by_point: &values };
            let (high, all) = (contours(&grid, 5.0), contours(&grid, f64::NEG_INFINITY));
            assert!(area(&high.regions) > 0.0 && area(&high.regions) < area(&all.regions));
        }
    }

    #[test]
    fn levels_are_nice_numbers_inside_the_range() {
        assert_eq!(levels(320.0, 680.0), [350.0, 400.0, 450.0, 500.0, 550.0, 600.0, 650.0]);
        assert_eq!(levels(40.0, 900.0), [50.0, 75.0, 100.0, 150.0, 200.0, 300.0, 500.0, 750.0]);
        assert_eq!(levels(0.3, 0.6), [0.35, 0.4, 0.45, 0.5, 0.55]);
        assert!(levels(5.0, 5.0).is_empty() && levels(f64::NAN, 1.0).is_empty());
    }
}
