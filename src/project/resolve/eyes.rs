//! Eyes where nobody can be: inside closed furniture, behind the room's own walls, or in a surface, which then hides
//! by chance what they see. Maps leave such places out; a listed viewpoint was meant to see something, so it is a
//! mistake.

use glam::DVec3;

use crate::project::context::Context;
use crate::project::{Room, Viewpoint};
use crate::scene::{Scene, in_a_surface, inside_furniture};

/// Reports every viewpoint whose eye lies inside furniture or in a surface, or farther out than its room's
/// walls, floor and ceiling.
pub fn check(scene: &Scene, rooms: &[Room], viewpoints: &[Viewpoint], context: &mut Context) {
    for viewpoint in viewpoints {
        let Some(place) = &viewpoint.written else { continue };
        let (what, hint) = if inside_furniture(scene, viewpoint.eye, DVec3::Z, false) {
            ("inside furniture", "it would see nothing but the inner sides: move the eye, or the furniture")
        } else if !rooms[viewpoint.room].contains(viewpoint.eye) {
            (
                "in a wall, the floor or the ceiling",
                "it lies a little outside of the room: move the eye into it",
            )
        } else if in_a_surface(scene, viewpoint.eye) {
            ("in a surface", "what it sees would hang on rounding: move the eye off it")
        } else {
            continue;
        };
        let message = format!("the eye of viewpoint \"{}\" lies {what}", viewpoint.name);
        context.diagnostics.push(place.mistake(message, hint.into()));
    }
}
