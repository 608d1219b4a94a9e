//! The table of indices: what there is to compute of a view, with units, sources and limits. Whatever
//! lists, parses or prints indices reads it; a new index is one function and one row.

use super::luminances::Part::{Far, Surround, Task};
use super::luminances::ZoneFigure::{self, Luminance, TaskOver};
use super::source::{Given, Sight};
use super::{
    cgi, dgi, dgp, discomfort, ggr, gr, luminances, threshold_increment, ugp, ugr, ugr_exp, vcp, veiling,
};
use crate::units::Undefined;

/// A figure that can be computed of a view.
#[derive(Clone, Copy, Debug)]
pub struct Index {
    /// Key in files and on the command line.
    pub key: &'static str,
    /// Name in words.
    pub name: &'static str,
    /// Unit, `1` for none.
    pub unit: &'static str,
    /// Where the formula comes from.
    pub source: &'static str,
    /// The function.
    pub value: fn(&Sight) -> Result<f64, Undefined>,
    /// What makes it doubtful for a view, one note per reason.
    pub validity: fn(&Sight) -> Vec<String>,
    /// Whether published norms or recommendations bound it, so that a requirement may.
    pub judged: bool,
    /// Whether more of it means less glare.
    pub more_is_better: bool,
    /// What of the zones about a task it is; `None` for all else.
    pub zones: Option<ZoneFigure>,
}

fn always(_: &Sight) -> Vec<String> {
    Vec::new()
}

fn ugr_of(sight: &Sight) -> Result<f64, Undefined> {
    ugr::ugr(&sight.sources, sight.background)
}

fn ugr_validity(sight: &Sight) -> Vec<String> {
    ugr::validity(&sight.sources)
}

const fn index(
    key: &'static str,
    name: &'static str,
    unit: &'static str,
    source: &'static str,
    value: fn(&Sight) -> Result<f64, Undefined>,
    validity: fn(&Sight) -> Vec<String>,
) -> Index {
    Index { key, name, unit, source, value, validity, judged: false, more_is_better: false, zones: None }
}

const fn of_zones(figure: ZoneFigure, index: Index) -> Index {
    Index { zones: Some(figure), ..index }
}

const fn judged(index: Index) -> Index {
    Index { judged: true, ..index }
}

/// All indices, in the order in which they are printed.
#[rustfmt::skip]
pub const INDICES: &[Index] = &[
    judged(index("UGR", "unified glare rating", "1", "CIE 117:1995, CIE 147:2002", ugr_of, ugr_validity)),
    judged(index("DGP", "daylight glare probability", "1", "Wienold, Christoffersen 2006", dgp::dgp, dgp::validity)),
    judged(index("DGPs", "simplified DGP", "1", "Wienold 2007", dgp::dgp_simplified, always)),
    index("DGI", "daylight glare index", "1", "Hopkinson 1972, Chauvel 1982", dgi::dgi, dgi::validity),
    index("DGI_mod", "modified DGI", "1", "Fisekis 2003", dgi::dgi_modified, dgi::validity),
    index("CGI", "CIE glare index", "1", "Einhorn 1979, CIE 55:1983", cgi::cgi, always),
    index("UGP", "unified glare probability", "1", "Hirning 2014", ugp::ugp, ugp::validity),
    index("UGP2", "unified glare probability 2", "1", "Hirning 2017", ugp::ugp2, always),
    index("UGR_exp", "experimental UGR", "1", "Fisekis 2003", ugr_exp::ugr_experimental, always),
    judged(index("GGR", "great-room glare rating", "1", "CIE 147:2002", ggr::ggr, always)),
    index("DGR", "discomfort glare rating", "1", "Guth 1963", vcp::dgr, vcp::validity),
    Index {
        more_is_better: true,
        ..judged(index("VCP", "visual comfort probability", "%", "IES RQQ 1966", vcp::vcp, vcp::validity))
    },
    judged(index("M", "discomfort index", "1", "UGR = 16 lg M - 4.8, Russian practice", discomfort::discomfort_m, ugr_validity)),
    judged(index("GR", "glare rating of outdoor areas", "1", "CIE 112:1994", gr::glare_rating, gr::validity)),
    judged(index("f_TI", "threshold increment", "%", "EN 13201-3:2015",
        threshold_increment::threshold_increment, threshold_increment::validity)),
    index("L_veil", "veiling luminance, general", "cd/m²", "CIE 146:2002", veiling::general, veiling::validity_general),
    index("L_veil_age", "veiling luminance, age-adjusted", "cd/m²", "CIE 146:2002",
        veiling::age_adjusted, veiling::validity_age_adjusted),
    index("L_veil_SH", "veiling luminance, Stiles–Holladay", "cd/m²", "CIE 31:1976",
        veiling::stiles_holladay, veiling::validity_stiles_holladay),
    index("E_v", "illuminance at the eye", "lx", "on the plane perpendicular to the line of sight", luminances::e_v, always),
    index("E_dir", "part of E_v from the sources", "lx", "on the same plane", luminances::e_direct, always),
    index("L_b", "background luminance", "cd/m²", "(E_v - E_dir)/π", luminances::l_b, always),
    index("L_mean", "mean luminance of the field of view", "cd/m²", "weighted by solid angle", luminances::l_mean, always),
    of_zones(Luminance(Task), index("L_task", "mean luminance of the task", "cd/m²", "in the task's cone", luminances::l_task, always)),
    of_zones(Luminance(Surround), index("L_surround", "mean luminance of the task's surround", "cd/m²",
        "up to 30° from the task", luminances::l_surround, always)),
    of_zones(Luminance(Far), index("L_far", "mean luminance of the far field", "cd/m²",
        "from 30° to 60° from the task", luminances::l_far, always)),
    of_zones(TaskOver(Surround), judged(index("L_task/L_surround", "luminance of the task to its surround", "1",
        "custom: within 3 : 1 and 1 : 3", luminances::task_to_surround, always))),
    of_zones(TaskOver(Far), judged(index("L_task/L_far", "luminance of the task to the far field", "1",
        "custom: within 10 : 1 and 1 : 10", luminances::task_to_far, always))),
];

/// The rows that concern a task and what surrounds it.
pub fn of_task() -> impl Iterator<Item = &'static Index> {
    INDICES.iter().filter(|index| index.zones.is_some())
}

/// The index of a key; `None` for anything else.
pub fn parse(key: &str) -> Option<&'static Index> {
    INDICES.iter().find(|index| index.key == key)
}

/// A computed index.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// Key of the index.
    pub key: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Its value, or why it has none.
    pub value: Result<f64, Undefined>,
    /// What makes it doubtful.
    pub notes: Vec<String>,
}

impl Index {
    /// What was assumed for it beside the view, to be printed with it.
    pub fn assumption(&self, given: &Given) -> Option<String> {
        let aged = |usual: f64| given.age_years.unwrap_or(usual);
        match self.key {
            "DGP" if given.low_light => Some(format!("{}, low-light factor", given.dgp.words())),
            "DGP" => Some(given.dgp.words().to_owned()),
            "L_veil" => {
                Some(format!("an eye of {} years, pigment {}", aged(veiling::USUAL_AGE), given.pigment))
            }
            "L_veil_age" => Some(format!("an eye of {} years", aged(veiling::USUAL_AGE))),
            "f_TI" => Some(format!("an eye of {} years", aged(threshold_increment::STANDARD_AGE))),
            _ => None,
        }
    }

    /// The index of a view with its notes; an undefined index has none.
    pub fn read(&self, sight: &Sight) -> Reading {
        let value = (self.value)(sight);
        let notes = if value.is_ok() { (self.validity)(sight) } else { Vec::new() };
        Reading { key: self.key, unit: self.unit, value, notes }
    }
}

#[cfg(test)]
mod tests;
