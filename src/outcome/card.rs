//! A card of a view: what the eye sees, where the sources are in it, and what would help.

use crate::image::LuminanceImage;

/// A card. Its picture shows where things are; no number is to be read off it.
#[derive(Clone, Debug)]
pub struct Card {
    /// Angular fisheye of 180°, cd/m² at initial flux.
    pub picture: LuminanceImage,
    /// Where the sources are in the picture, in the order of the view's list.
    pub sources: Vec<PlacedSource>,
    /// The luminaire that lowers UGR most if its light is halved; the background is left as it is.
    pub dimmed: Option<Remedy>,
    /// The luminaire that lowers UGR most if it is shifted level by 1 m: within its room, past nothing that stands in
    /// its way, as if nothing hid it there; background and images are left as they are.
    pub moved: Option<Remedy>,
}

/// Where a source is, in shares of the picture's width and height from the upper left.
#[derive(Clone, Debug, Default)]
pub struct PlacedSource {
    /// Middle of what is visible.
    pub centre: [f64; 2],
    /// A closed line around the source, hidden parts included; cut at the picture's rim.
    pub outline: Vec<[f64; 2]>,
}

/// A luminaire, what is done to it, and what it does to UGR.
#[derive(Clone, Debug, PartialEq)]
pub struct Remedy {
    /// Label of the source.
    pub luminaire: String,
    /// UGR then.
    pub ugr: f64,
    /// Direction of the shift from the eye's point of view.
    pub shift: Option<Shift>,
    /// The surface in which it is seen, where only its images glare and not the luminaire itself: turning or
    /// covering that helps as well.
    pub mirror: Option<String>,
}

/// Directions on the level, as the eye sees them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shift {
    /// Along the line of sight.
    Away,
    /// Against it.
    Nearer,
    /// To the right.
    Right,
    /// To the left.
    Left,
}
