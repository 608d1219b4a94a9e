//! gershun: lighting quality from spatial-angular luminance.
//!
//! One line of data flow: project → plan → prepare → answer → measure → judge → report.
//! `docs/architecture.md` is the map.

pub mod geometry;
pub mod grid;
pub mod luminaire;
pub mod material;
pub mod norm;
pub mod outcome;
pub mod photometry;
pub mod project;
pub mod quantity;
pub mod report;
pub mod scene;
pub mod units;
