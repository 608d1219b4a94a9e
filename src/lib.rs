//! gershun: lighting quality from spatial-angular luminance.
//!
//! One line of data flow: project → plan → prepare → answer → measure → judge → report.
//! `docs/architecture.md` is the map.

pub mod emitters;
pub mod estimate;
pub mod field;
pub mod geometry;
pub mod glare;
pub mod grid;
pub mod luminaire;
pub mod material;
pub mod measure;
pub mod norm;
pub mod outcome;
pub mod photometry;
pub mod plan;
pub mod project;
pub mod quantity;
pub mod query;
pub mod rng;
pub mod scene;
pub mod solve;
pub mod sphere;
pub mod units;
