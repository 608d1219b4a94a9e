//! A small line plot as SVG for the studies: logarithmic or linear axes, markers with error bars.
#![allow(dead_code, reason = "each study uses a part")]

use std::fmt::Write as _;

/// One set of points.
pub struct Series {
    /// Name in the legend.
    pub name: String,
    /// x, y and half the height of the error bar.
    pub points: Vec<[f64; 3]>,
    /// Joined by a line; otherwise markers with bars.
    pub line: bool,
}

/// A diagram.
pub struct Figure<'a> {
    /// Title.
    pub title: &'a str,
    /// Axis labels.
    pub axes: [&'a str; 2],
    /// Logarithmic axes.
    pub log: [bool; 2],
    /// The data.
    pub series: &'a [Series],
}

const COLOURS: [&str; 8] =
    ["#0b3c5d", "#c4472b", "#2e7d32", "#8a6d00", "#6a3d9a", "#00838f", "#555555", "#ad1457"];
const SIZE: [f64; 2] = [760.0, 440.0];
const LEFT: f64 = 70.0;
const TOP: f64 = 36.0;
const PLOT: [f64; 2] = [470.0, 340.0];

impl Figure<'_> {
    /// The SVG text.
    pub fn svg(&self) -> String {
        let value = |axis: usize, v: f64| if self.log[axis] { v.max(1e-300).log10() } else { v };
        let mut range = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for point in self.series.iter().flat_map(|series| &series.points) {
            for (axis, [low, high]) in range.iter_mut().enumerate() {
                if self.log[axis] && !(point[axis] > 0.0) {
                    continue;
                }
                let bar = if axis == 1 && !self.log[1] { point[2] } else { 0.0 };
                *low = low.min(value(axis, point[axis]) - bar);
                *high = high.max(value(axis, point[axis]) + bar);
            }
        }
        for [low, high] in &mut range {
            let margin = 0.04 * (*high - *low).max(1e-9);
            (*low, *high) = (*low - margin, *high + margin);
        }
        let at = |axis: usize, v: f64| {
            let t = (value(axis, v) - range[axis][0]) / (range[axis][1] - range[axis][0]);
            if axis == 0 { LEFT + t * PLOT[0] } else { TOP + (1.0 - t) * PLOT[1] }
        };
        let [width, height] = SIZE;
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>\n<text x=\"{LEFT}\" y=\"20\" font-size=\"14\">{}</text>\n<rect x=\"{LEFT}\" y=\"{TOP}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#333\"/>\n",
            self.title, PLOT[0], PLOT[1]
        );
        for (axis, range) in range.into_iter().enumerate() {
            for tick in ticks(range, self.log[axis]) {
                let (label, place) = (label(tick), at(axis, tick));
                if axis == 0 {
                    let (end, below) = (TOP + PLOT[1], TOP + PLOT[1] + 16.0);
                    let _ = writeln!(
                        svg,
                        "<line x1=\"{place:.1}\" y1=\"{TOP}\" x2=\"{place:.1}\" y2=\"{end}\" stroke=\"#ddd\"/><text x=\"{place:.1}\" y=\"{below}\" text-anchor=\"middle\">{label}</text>"
                    );
                } else {
                    let (end, left) = (LEFT + PLOT[0], LEFT - 6.0);
                    let _ = writeln!(
                        svg,
                        "<line x1=\"{LEFT}\" y1=\"{place:.1}\" x2=\"{end}\" y2=\"{place:.1}\" stroke=\"#ddd\"/><text x=\"{left}\" y=\"{:.1}\" text-anchor=\"end\">{label}</text>",
                        place + 4.0
                    );
                }
            }
        }
        let (middle, bottom) = (LEFT + 0.5 * PLOT[0], TOP + PLOT[1] + 38.0);
        let _ = writeln!(
            svg,
            "<text x=\"{middle}\" y=\"{bottom}\" text-anchor=\"middle\">{}</text>",
            self.axes[0]
        );
        let side = TOP + 0.5 * PLOT[1];
        let _ = writeln!(
            svg,
            "<text x=\"16\" y=\"{side}\" text-anchor=\"middle\" transform=\"rotate(-90 16 {side})\">{}</text>",
            self.axes[1]
        );
        for (index, series) in self.series.iter().enumerate() {
            let colour = COLOURS[index % COLOURS.len()];
            let shown: Vec<&[f64; 3]> = series
                .points
                .iter()
                .filter(|p| (0..2).all(|axis| !self.log[axis] || p[axis] > 0.0))
                .collect();
            if series.line {
                let path: Vec<String> =
                    shown.iter().map(|p| format!("{:.1},{:.1}", at(0, p[0]), at(1, p[1]))).collect();
                let _ = writeln!(
                    svg,
                    "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.6\"/>",
                    path.join(" ")
                );
            }
            for p in shown {
                let (x, y) = (at(0, p[0]), at(1, p[1]));
                if p[2] > 0.0 && !(self.log[1] && p[1] <= p[2]) {
                    let _ = writeln!(
                        svg,
                        "<line x1=\"{x:.1}\" y1=\"{:.1}\" x2=\"{x:.1}\" y2=\"{:.1}\" stroke=\"{colour}\"/>",
                        at(1, p[1] - p[2]),
                        at(1, p[1] + p[2])
                    );
                }
                if !series.line || series.points.len() < 30 {
                    let _ =
                        writeln!(svg, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2.6\" fill=\"{colour}\"/>");
                }
            }
            let y = TOP + 12.0 + 18.0 * index as f64;
            let x = LEFT + PLOT[0] + 14.0;
            let _ = writeln!(
                svg,
                "<rect x=\"{x}\" y=\"{:.1}\" width=\"12\" height=\"4\" fill=\"{colour}\"/><text x=\"{}\" y=\"{y}\">{}</text>",
                y - 6.0,
                x + 18.0,
                series.name
            );
        }
        svg.push_str("</svg>\n");
        svg
    }
}

/// Ticks of an axis; `range` is in powers of ten on a logarithmic one.
fn ticks([low, high]: [f64; 2], log: bool) -> Vec<f64> {
    if log {
        let decades: Vec<i32> = (low.floor() as i32..=high.ceil() as i32).collect();
        let digits: &[f64] = if high - low < 2.5 { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let all = decades.iter().flat_map(|d| digits.iter().map(move |digit| digit * 10f64.powi(*d)));
        return all.filter(|v| (low..=high).contains(&v.log10())).collect();
    }
    let raw = (high - low) / 6.0;
    let power = 10f64.powf(raw.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|m| m * power).into_iter().find(|s| *s >= raw).unwrap_or(raw);
    let (first, last) = ((low / step).ceil() as i64, (high / step).floor() as i64);
    (first..=last).map(|k| k as f64 * step).collect()
}

fn label(value: f64) -> String {
    if value == 0.0 || value.abs() < 1e-12 {
        return "0".into();
    }
    if value.abs() >= 1e5 || value.abs() < 1e-3 {
        return format!("{value:.0e}");
    }
    let text = format!("{value:.3}");
    text.trim_end_matches('0').trim_end_matches('.').into()
}
