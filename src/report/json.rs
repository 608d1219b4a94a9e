//! result.json. A value that does not exist is `null` beside its reason;
//! serde_json writes any number that is not finite as `null`, so NaN cannot reach a file.

use glam::DVec2;
use serde::Serialize;

use super::ReportError;
use super::sentence::{bound, verdict_key};
use crate::outcome::{
    AreaOutcome, Bias, Dimming, FluxBalance, GlareSourceOutcome, Interval, Modified, NormOutcome, Outcome,
    Power, Requirement, RoomOutcome, Solver, TypeOutcome, UgrTableOutcome, Value, ViewpointOutcome,
};
use crate::project::{AreaKind, Info, InputFile};
use crate::quantity::{Quantity, Statistic};
use crate::units::Undefined;

/// Version of the layout of result.json and provenance.json.
pub const VERSION: u32 = 1;

#[derive(Serialize)]
struct ResultFile<'a> {
    version: u32,
    project: &'a Info,
    norm: Option<&'a NormOutcome>,
    verdict: Option<&'static str>,
    requirements: Vec<RequirementRow<'a>>,
    values: Vec<ValueRow<'a>>,
    rooms: Vec<RoomRow<'a>>,
    plan: &'a [String],
    solver: &'a Solver,
    biases: &'a [Bias],
    inputs: &'a [InputFile],
}

#[derive(Serialize)]
struct RequirementRow<'a> {
    standard: &'a str,
    clause: &'a str,
    room: &'a str,
    subject: &'a str,
    light_scene: &'a str,
    quantity: String,
    statistic: &'static str,
    bound: &'static str,
    limit: f64,
    unit: &'static str,
    value: Option<f64>,
    undefined: Option<&'a str>,
    lo_joint: Option<f64>,
    hi_joint: Option<f64>,
    margin: Option<f64>,
    outcome: &'static str,
    at_the_limit: bool,
    other_comparison: Option<&'static str>,
    blocks_needed: Option<usize>,
    modified: Option<&'a Modified>,
    verified: &'a str,
    note: &'a str,
    at_risk: &'a [String],
}

#[derive(Serialize)]
struct ValueRow<'a> {
    room: &'a str,
    subject: &'a str,
    light_scene: &'a str,
    quantity: &'a str,
    statistic: &'a str,
    location: Option<[f64; 3]>,
    unit: &'a str,
    value: Option<f64>,
    undefined: Option<&'a str>,
    se: Option<f64>,
    lo: Option<f64>,
    hi: Option<f64>,
    n: usize,
}

#[derive(Serialize)]
struct RoomRow<'a> {
    name: &'a str,
    number: &'a str,
    row: Option<&'a str>,
    footprint_m: Vec<[f64; 2]>,
    floor_m: f64,
    height_m: f64,
    reflectances: Reflectances,
    luminaire_types: &'a [TypeOutcome],
    luminaires: usize,
    areas: Vec<AreaRow<'a>>,
    viewpoints: Vec<ViewpointRow<'a>>,
    ugr_table: Vec<UgrTableRow<'a>>,
    power: Option<&'a Power>,
    dimming: Option<&'a Dimming>,
    flux: &'a [FluxBalance],
}

#[derive(Serialize)]
struct Reflectances {
    ceiling: f64,
    walls: f64,
    floor: f64,
}

#[derive(Serialize)]
struct AreaRow<'a> {
    name: &'a str,
    kind: AreaKind,
    of: Option<&'a str>,
    row: Option<&'a str>,
    origin_m: [f64; 3],
    edge_u_m: [f64; 3],
    edge_v_m: [f64; 3],
    normal: [f64; 3],
    columns: usize,
    rows: usize,
    spacing_m: [f64; 2],
    border_m: f64,
    points: usize,
    excluded: usize,
}

#[derive(Serialize)]
pub(super) struct IndexRow<'a> {
    pub index: &'a str,
    pub unit: &'a str,
    pub estimate: Option<Interval>,
    pub undefined: Option<&'a str>,
    pub notes: &'a [String],
}

impl<'a> IndexRow<'a> {
    /// A figure of a view, or why there is none.
    pub fn new(
        index: &'a str,
        unit: &'a str,
        estimate: &'a Result<Interval, Undefined>,
        notes: &'a [String],
    ) -> Self {
        let undefined = estimate.as_ref().err().map(|undefined| undefined.reason.as_str());
        Self { index, unit, estimate: estimate.as_ref().ok().copied(), undefined, notes }
    }
}

#[derive(Serialize)]
struct ViewpointRow<'a> {
    name: &'a str,
    light_scene: &'a str,
    eye_m: [f64; 3],
    direction: [f64; 3],
    azimuth_deg: f64,
    tilt_deg: f64,
    ugr: Option<Interval>,
    undefined: Option<&'a str>,
    indices: Vec<IndexRow<'a>>,
    convention: &'a str,
    background_cd_m2: f64,
    e_v_lx: f64,
    sources: &'a [GlareSourceOutcome],
    notes: &'a [String],
}

#[derive(Serialize)]
struct UgrTableRow<'a> {
    luminaire: &'a str,
    shr: f64,
    crosswise: Option<f64>,
    crosswise_undefined: Option<&'a str>,
    endwise: Option<f64>,
    endwise_undefined: Option<&'a str>,
    notes: &'a [String],
}

/// The bytes of result.json; its layout is [`super::schema`].
pub fn result(outcome: &Outcome) -> Result<Vec<u8>, ReportError> {
    bytes(&ResultFile {
        version: VERSION,
        project: &outcome.info,
        norm: outcome.norm.as_ref(),
        verdict: outcome.verdict().map(verdict_key),
        requirements: outcome.requirements.iter().map(requirement).collect(),
        values: outcome.values.iter().map(value).collect(),
        rooms: outcome.rooms.iter().map(room).collect(),
        plan: &outcome.plan,
        solver: &outcome.solver,
        biases: &outcome.biases,
        inputs: &outcome.inputs,
    })
}

/// Unit of a statistic of a quantity; `1` for ratios.
pub fn unit(quantity: Quantity, statistic: Statistic) -> &'static str {
    if statistic.is_ratio() { "1" } else { quantity.unit() }
}

/// Pretty-printed JSON with a final line feed.
pub fn bytes(file: &impl Serialize) -> Result<Vec<u8>, ReportError> {
    let mut bytes = serde_json::to_vec_pretty(file)?;
    bytes.push(b'\n');
    Ok(bytes)
}

fn reason<T>(value: &Result<T, Undefined>) -> Option<&str> {
    value.as_ref().err().map(|undefined| undefined.reason.as_str())
}

fn finite(number: f64) -> Option<f64> {
    number.is_finite().then_some(number)
}

fn requirement(r: &Requirement) -> RequirementRow<'_> {
    let (limit, is_minimum) = bound(r.bound);
    let known = r.value.is_ok();
    RequirementRow {
        standard: &r.standard,
        clause: &r.clause,
        room: &r.room,
        subject: &r.subject,
        light_scene: &r.light_scene,
        quantity: r.quantity.key(),
        statistic: r.statistic.key(),
        bound: if is_minimum { "min" } else { "max" },
        limit,
        unit: unit(r.quantity, r.statistic),
        value: r.value.as_ref().ok().copied().and_then(finite),
        undefined: reason(&r.value),
        lo_joint: finite(r.lo_joint).filter(|_| known),
        hi_joint: finite(r.hi_joint).filter(|_| known),
        margin: r.margin.and_then(finite),
        outcome: verdict_key(r.verdict),
        at_the_limit: r.at_the_limit,
        other_comparison: r.other_comparison.map(verdict_key),
        blocks_needed: r.blocks_needed,
        modified: r.modified.as_ref(),
        verified: &r.verified,
        note: &r.note,
        at_risk: &r.at_risk,
    }
}

fn value(v: &Value) -> ValueRow<'_> {
    let estimate = v.estimate.as_ref().ok();
    let number = |pick: fn(&Interval) -> f64| estimate.map(pick).and_then(finite);
    ValueRow {
        room: &v.room,
        subject: &v.subject,
        light_scene: &v.light_scene,
        quantity: &v.quantity,
        statistic: &v.statistic,
        location: v.location.map(|place| place.to_array()),
        unit: &v.unit,
        value: number(|e| e.value),
        undefined: reason(&v.estimate),
        se: number(|e| e.se),
        lo: number(|e| e.lo),
        hi: number(|e| e.hi),
        n: v.n,
    }
}

fn room(room: &RoomOutcome) -> RoomRow<'_> {
    let [ceiling, walls, floor] = room.reflectances;
    RoomRow {
        name: &room.name,
        number: &room.number,
        row: room.row.as_deref(),
        footprint_m: room.footprint.iter().map(DVec2::to_array).collect(),
        floor_m: room.floor_m,
        height_m: room.height_m,
        reflectances: Reflectances { ceiling, walls, floor },
        luminaire_types: &room.types,
        luminaires: room.luminaires.len(),
        areas: room.areas.iter().map(area).collect(),
        viewpoints: room.viewpoints.iter().map(viewpoint).collect(),
        ugr_table: room.ugr_table.iter().map(ugr_table).collect(),
        power: room.power.as_ref(),
        dimming: room.dimming.as_ref(),
        flux: &room.flux,
    }
}

fn area(area: &AreaOutcome) -> AreaRow<'_> {
    let grid = &area.grid;
    AreaRow {
        name: &area.name,
        kind: area.kind,
        of: area.of.as_deref(),
        row: area.row.as_deref(),
        origin_m: grid.origin.to_array(),
        edge_u_m: grid.edge_u.to_array(),
        edge_v_m: grid.edge_v.to_array(),
        normal: grid.normal.to_array(),
        columns: grid.columns,
        rows: grid.rows,
        spacing_m: grid.spacing_m,
        border_m: grid.border_m,
        points: grid.points.len(),
        excluded: grid.points.iter().filter(|point| point.excluded.is_some()).count(),
    }
}

fn viewpoint(view: &ViewpointOutcome) -> ViewpointRow<'_> {
    ViewpointRow {
        name: &view.name,
        light_scene: &view.light_scene,
        eye_m: view.eye.to_array(),
        direction: view.direction.to_array(),
        azimuth_deg: view.azimuth_deg,
        tilt_deg: view.tilt_deg,
        ugr: view.ugr.as_ref().ok().copied(),
        undefined: reason(&view.ugr),
        indices: view
            .indices
            .iter()
            .map(|index| IndexRow::new(&index.key, &index.unit, &index.estimate, &index.notes))
            .collect(),
        convention: &view.convention,
        background_cd_m2: view.background_cd_m2,
        e_v_lx: view.e_v_lx,
        sources: &view.sources,
        notes: &view.notes,
    }
}

fn ugr_table(table: &UgrTableOutcome) -> UgrTableRow<'_> {
    UgrTableRow {
        luminaire: &table.kind,
        shr: table.shr,
        crosswise: table.crosswise.as_ref().ok().copied(),
        crosswise_undefined: reason(&table.crosswise),
        endwise: table.endwise.as_ref().ok().copied(),
        endwise_undefined: reason(&table.endwise),
        notes: &table.notes,
    }
}

#[cfg(test)]
#[path = "../../tests/common/schema.rs"]
mod against_schema;

#[cfg(test)]
mod tests {
    use serde_json::Value as Json;

    use super::against_schema::violations;
    use super::*;
    use crate::report::{sample, schema};

    fn check(file: &Json) -> Vec<String> {
        violations(&serde_json::from_str(schema()).expect("schema is JSON"), file, "result")
    }

    #[test]
    fn the_sample_follows_the_schema_and_a_broken_twin_does_not() {
        let mut file: Json =
            serde_json::from_slice(&result(&sample::outcome()).expect("bytes")).expect("JSON");
        assert_eq!(check(&file), Vec::<String>::new());
        file["requirements"][0]["outcome"] = "perhaps".into();
        file["values"][0].as_object_mut().expect("object").remove("se");
        file["invented"] = 1.into();
        assert_eq!(check(&file).len(), 3);
    }

    #[test]
    fn an_undefined_value_is_null_with_its_reason_and_no_nan_is_written() {
        let text = String::from_utf8(result(&sample::outcome()).expect("bytes")).expect("UTF-8");
        assert!(!text.contains("NaN") && !text.contains("Infinity"));
        let file: Json = serde_json::from_str(&text).expect("JSON");
        let undefined = file["values"].as_array().expect("values").iter().find(|v| v["value"].is_null());
        assert!(undefined.expect("one is undefined")["undefined"].is_string());
    }

    #[test]
    fn numbers_read_back_to_the_same_bits() {
        let outcome = sample::outcome();
        let file: Json = serde_json::from_slice(&result(&outcome).expect("bytes")).expect("JSON");
        for (row, value) in file["values"].as_array().expect("values").iter().zip(&outcome.values) {
            if let Ok(estimate) = &value.estimate {
                assert_eq!(row["value"].as_f64().map(f64::to_bits), Some(estimate.value.to_bits()));
            }
        }
    }
}
