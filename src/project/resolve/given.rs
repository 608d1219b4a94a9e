//! What no view tells and some indices ask for → an observer's assumptions, and the area that GR is rated against.

use super::draft::Draft;
use crate::glare::ggr::VALID_COVERAGE;
use crate::glare::source::{Given, Ground};
use crate::project::context::Context;
use crate::project::diagnostics::suggestion;
use crate::project::schema::{GroundSection, ViewpointSection};
use crate::units::Nits;

/// Ages of observers, years.
const AGES: [f64; 2] = [1.0, 120.0];

/// The age of the observer, the share of the ceiling that shines, the road; mistakes are reported.
pub(super) fn given(section: &ViewpointSection, context: &mut Context) -> Option<Given> {
    let mut given = Given::default();
    let mut ok = true;
    if let Some(age) = &section.age {
        ok &= context.in_range(age, AGES[0], AGES[1], "age");
        given.age_years = Some(*age.get_ref());
    }
    if let Some(coverage) = &section.ceiling_coverage {
        let [least, most] = VALID_COVERAGE;
        ok &= context.in_range(coverage, least, most, "ceiling_coverage");
        given.ceiling_coverage = Some(*coverage.get_ref());
    }
    if let Some(road) = &section.road {
        ok &= context.in_range(road, 0.0, f64::INFINITY, "road");
        given.road = Some(Nits(*road.get_ref()));
    }
    ok.then_some(given)
}

/// What GR is rated against.
#[derive(Default)]
pub(super) struct Chosen {
    /// An illuminance as the user gives it, of no area.
    pub given: Option<Ground>,
    /// Index of an area within its world.
    pub area: Option<usize>,
    /// Reflectance of what lies under that area.
    pub reflectance: Option<f64>,
}

/// The ground of a section: an area of the project or an illuminance; mistakes are reported.
pub(super) fn ground(section: &ViewpointSection, drafts: &[Draft], context: &mut Context) -> Option<Chosen> {
    let Some(ground) = &section.ground else { return Some(Chosen::default()) };
    let GroundSection { area, lx, reflectance } = ground.get_ref();
    let mut ok = true;
    if let Some(reflectance) = reflectance {
        ok &= context.in_range(reflectance, 0.0, 1.0, "reflectance of the ground");
    }
    if let Some(lx) = lx {
        ok &= context.in_range(lx, 0.0, f64::INFINITY, "lx of the ground");
    }
    let reflectance = reflectance.as_ref().map(|rho| *rho.get_ref());
    let chosen = match (area, lx, reflectance) {
        (None, Some(lx), Some(reflectance)) => {
            Chosen { given: Some(Ground { mean_lx: *lx.get_ref(), reflectance }), ..Chosen::default() }
        }
        (None, Some(_) | None, None) => {
            let hint =
                "ground = { lx = 300, reflectance = 0.2 }, or { area = \"Court\" } and its own reflectance";
            context.error(&ground.span(), "the ground is not known", hint);
            return None;
        }
        (Some(_), Some(lx), _) => {
            let hint = "the area has an illuminance of its own; an illuminance that is given needs no area";
            context.error(&lx.span(), "give either `area` or `lx` of the ground", hint);
            return None;
        }
        (Some(name), None, reflectance) => {
            let Some((_, index)) = area_named(drafts, name.get_ref()) else {
                let known = drafts.iter().flat_map(|draft| &draft.areas);
                let hint = suggestion(name.get_ref(), known.map(|area| area.name.as_str()));
                context.error(&name.span(), format!("no area \"{}\"", name.get_ref()), &hint);
                return None;
            };
            Chosen { area: Some(index), reflectance, given: None }
        }
        (None, None, Some(_)) => Chosen { reflectance, ..Chosen::default() },
    };
    ok.then_some(chosen)
}

/// World and index of an area by its name.
pub(super) fn area_named(drafts: &[Draft], name: &str) -> Option<(usize, usize)> {
    drafts
        .iter()
        .enumerate()
        .find_map(|(world, draft)| Some((world, draft.areas.iter().position(|area| area.name == name)?)))
}
