//! `[[furniture]]`: cuboids without CAD. `at` is the lower corner with the smallest coordinates;
//! `rotate` turns the piece counter-clockwise about the vertical through that corner.

use glam::{DMat3, DVec3};

use super::draft::{Draft, Located, locate};
use super::materials::Palette;
use crate::project::context::Context;
use crate::project::schema::{At, FurnitureSection};

/// Puts each piece into the world of the room it stands in.
pub fn add(
    sections: &[At<FurnitureSection>],
    drafts: &mut [Draft],
    palette: &mut Palette,
    context: &mut Context,
) {
    for (index, section) in sections.iter().enumerate() {
        let span = section.span();
        let FurnitureSection { name, at, size, material, rotate } = section.get_ref();
        let material = palette.named(material, context);
        let turn_deg = rotate.as_ref().map_or(0.0, |rotate| *rotate.get_ref());
        let mut ok = context.finite(at.get_ref(), &at.span());
        if let Some(rotate) = rotate {
            ok &= context.finite(&[turn_deg], &rotate.span());
        }
        for edge in size.get_ref() {
            ok &= context.positive(*edge, &size.span(), "an edge of the furniture");
        }
        let (Some(material), true) = (material, ok) else {
            continue;
        };
        let name =
            name.as_ref().map_or_else(|| format!("Furniture_{}", index + 1), |name| name.get_ref().clone());
        let origin = DVec3::from_array(*at.get_ref());
        let size = DVec3::from_array(*size.get_ref());
        let turn = DMat3::from_rotation_z(turn_deg.to_radians());
        let centre = origin + turn * (0.5 * size);
        let world = match locate(drafts, centre) {
            Located::In(world, _) => world,
            // CAD rooms are bounds of nodes: what stands between them still stands in the building.
            Located::Outside if drafts.len() == 1 && drafts[0].cad => 0,
            Located::Outside if drafts.is_empty() => continue,
            Located::Outside => {
                let message = format!("\"{name}\" stands outside of every room");
                context.error(&at.span(), message, "");
                continue;
            }
            Located::Ambiguous(rooms) => {
                let message = format!("\"{name}\" stands in more than one room: {rooms}");
                context.error(&span, message, "move the rooms' footprints apart");
                continue;
            }
        };
        let draft = &mut drafts[world];
        let material = draft.material(&material);
        let surface = draft.mesh.add_surface(name, material, true);
        for corners in faces() {
            let corner = |unit: DVec3| origin + turn * (unit * size);
            draft.mesh.add_quad(corners.map(corner), surface);
        }
    }
}

/// Faces of the unit cube, counter-clockwise seen from outside.
fn faces() -> [[DVec3; 4]; 6] {
    let face = |corners: [[f64; 3]; 4]| corners.map(DVec3::from_array);
    [
        face([[0., 0., 0.], [0., 1., 0.], [1., 1., 0.], [1., 0., 0.]]),
        face([[0., 0., 1.], [1., 0., 1.], [1., 1., 1.], [0., 1., 1.]]),
        face([[0., 0., 0.], [1., 0., 0.], [1., 0., 1.], [0., 0., 1.]]),
        face([[1., 1., 0.], [0., 1., 0.], [0., 1., 1.], [1., 1., 1.]]),
        face([[0., 1., 0.], [0., 0., 0.], [0., 0., 1.], [0., 1., 1.]]),
        face([[1., 0., 0.], [1., 1., 0.], [1., 1., 1.], [1., 0., 1.]]),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_face_looks_outwards() {
        for [a, b, c, d] in faces() {
            let centre = 0.25 * (a + b + c + d);
            assert!((b - a).cross(c - a).dot(centre - DVec3::splat(0.5)) > 0.0);
        }
    }
}
