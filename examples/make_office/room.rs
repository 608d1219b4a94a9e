//! The room's shell with its door and glazed partition, the corridor behind it, and where the
//! furniture stands. Frames straddle the edges of the openings, so that no light leaks past them.

use glam::DVec3;

use super::furniture;
use super::glb::{Model, Part};
use super::solid::Shape;

/// Inner size of the room, m.
pub const ROOM_M: DVec3 = DVec3::new(8.0, 5.0, 2.8);
/// Depth of the corridor strip behind the partition, m.
pub const CORRIDOR_M: f64 = 1.5;

/// The whole office.
pub fn office() -> Model {
    let mut model = Model::default();
    shell(&mut model);
    door(&mut model);
    partition(&mut model);
    corridor(&mut model);
    furnish(&mut model);
    model
}

fn shell(model: &mut Model) {
    let room = Some(model.group("Room"));
    let DVec3 { x, y, z } = ROOM_M;
    let (ex, ey, ez) = (DVec3::X, DVec3::Y, DVec3::Z);
    let (east, north) = (ex * x, ey * y);
    let (along_x, along_y, up) = ([0.0, x], [0.0, y], [0.0, z]);
    let sheet = Shape::sheet;
    let floor = sheet(DVec3::ZERO, ex, ey, &along_x, &along_y, None);
    model.fixed(room, "Floor", "Floor", floor);
    let ceiling = sheet(ez * z, ey, ex, &along_y, &along_x, None);
    model.fixed(room, "Ceiling", "Ceiling", ceiling);
    let south = sheet(DVec3::ZERO, ez, ex, &up, &along_x, None);
    model.fixed(room, "Wall_S", "Wall", south);
    let wall_n = sheet(north, ex, ez, &along_x, &up, None);
    model.fixed(room, "Wall_N", "Wall", wall_n);
    let wall_w = sheet(DVec3::ZERO, ey, ez, &[0.0, 0.4, 1.4, y], &[0.0, 2.1, z], Some([1, 0]));
    model.fixed(room, "Wall_W", "Wall", wall_w);
    let wall_e = sheet(east, ez, ey, &[0.0, 0.1, 2.4, z], &[0.0, 1.2, 4.4, y], Some([1, 1]));
    model.fixed(room, "Wall_E", "Wall", wall_e);
}

fn door(model: &mut Model) {
    let frame = frame([-0.08, 0.012], [0.37, 1.43, -0.02, 2.13], [0.45, 1.35, 0.01, 2.05]);
    model.fixed(None, "Door_Frame", "Metal", frame);
    let leaf = Shape::cuboid([-0.06, -0.02], [0.44, 1.36], [0.005, 2.06]);
    model.fixed(None, "Door_Leaf", "Door", leaf);
    let spindle = Shape::cuboid([-0.03, 0.03], [1.262, 1.278], [1.042, 1.058]);
    let lever = Shape::cuboid([0.02, 0.036], [1.15, 1.285], [1.038, 1.062]);
    let handle = [spindle, lever].map(|shape| Part { material: "Metal", shape });
    let mesh = model.mesh("Door_Handle", handle.into());
    model.place("Door_Handle", mesh, DVec3::ZERO, 0.0);
}

fn partition(model: &mut Model) {
    let ring = frame([7.97, 8.03], [1.17, 4.43, 0.07, 2.43], [1.25, 4.35, 0.15, 2.35]);
    let mullion = |y: f64| Shape::cuboid([7.975, 8.025], [y - 0.02, y + 0.02], [0.14, 2.36]);
    let parts = [ring, mullion(2.28), mullion(3.32)].map(|shape| Part { material: "Metal", shape });
    let mesh = model.mesh("Partition_Frame", parts.into());
    model.place("Partition_Frame", mesh, DVec3::ZERO, 0.0);
    let east = DVec3::X * ROOM_M.x;
    let pane = Shape::sheet(east, DVec3::Z, DVec3::Y, &[0.13, 2.37], &[1.23, 4.37], None);
    model.fixed(None, "Partition_Glass", "Glass", pane);
}

fn corridor(model: &mut Model) {
    let corridor = Some(model.group("Corridor"));
    let DVec3 { x, y, z } = ROOM_M;
    let (ex, ey, ez) = (DVec3::X, DVec3::Y, DVec3::Z);
    let (along_x, along_y, up) = ([x, x + CORRIDOR_M], [0.0, y], [0.0, z]);
    let sheet = Shape::sheet;
    let floor = sheet(DVec3::ZERO, ex, ey, &along_x, &along_y, None);
    model.fixed(corridor, "Corridor_Floor", "Corridor", floor);
    let ceiling = sheet(ez * z, ey, ex, &along_y, &along_x, None);
    model.fixed(corridor, "Corridor_Ceiling", "Corridor", ceiling);
    let south = sheet(DVec3::ZERO, ez, ex, &up, &along_x, None);
    model.fixed(corridor, "Corridor_S", "Corridor", south);
    let north = sheet(ey * y, ex, ez, &along_x, &up, None);
    model.fixed(corridor, "Corridor_N", "Corridor", north);
    let east = sheet(ex * (x + CORRIDOR_M), ez, ey, &up, &along_y, None);
    model.fixed(corridor, "Corridor_E", "Corridor", east);
}

/// A rectangular frame in a wall x = const: `outer` and `inner` are [y0, y1, z0, z1].
fn frame(x: [f64; 2], outer: [f64; 4], inner: [f64; 4]) -> Shape {
    let corners = [[0, 2], [1, 2], [1, 3], [0, 3]];
    let rings = corners.map(|[y, z]| {
        let [out, within] = [outer, inner].map(|rect| (rect[y], rect[z]));
        [(x[0], within), (x[1], within), (x[1], out), (x[0], out)]
            .map(|(x, (y, z))| DVec3::new(x, y, z))
            .to_vec()
    });
    Shape::hoop(&rings)
}

/// Centres of the desks along x, m, and of the two rows along y with their turn.
const DESKS_X_M: [f64; 3] = [2.39, 4.0, 5.61];
const DESK_ROWS: [(f64, f64); 2] = [(2.09, 0.0), (2.91, 180.0)];

fn furnish(model: &mut Model) {
    let desk = model.mesh("Desk", furniture::desk());
    let monitor = model.mesh("Monitor", furniture::monitor());
    let keyboard = model.mesh("Keyboard", furniture::keyboard());
    let papers = model.mesh("Papers", furniture::papers());
    let chair = model.mesh("Chair", furniture::chair());
    // Nobody leaves a chair straight.
    let chair_turns_deg = [8.0, -14.0, 5.0, -6.0, 17.0, -10.0];
    let mut number = 0;
    for (y, turn_deg) in DESK_ROWS {
        for x in DESKS_X_M {
            let at = DVec3::new(x, y, 0.0);
            let towards_user = if turn_deg == 0.0 { -1.0 } else { 1.0 };
            let seat = at + DVec3::Y * (0.66 * towards_user);
            let chair_turn_deg = turn_deg + chair_turns_deg[number];
            number += 1;
            model.place(format!("Desk_{number}"), desk, at, turn_deg);
            model.place(format!("Monitor_{number}"), monitor, at, turn_deg);
            model.place(format!("Keyboard_{number}"), keyboard, at, turn_deg);
            model.place(format!("Papers_{number}"), papers, at, turn_deg);
            model.place(format!("Chair_{number}"), chair, seat, chair_turn_deg);
        }
    }
    let north = |x: f64, z: f64| DVec3::new(x, ROOM_M.y, z);
    let cabinet = model.mesh("Cabinet", furniture::cabinet());
    model.place("Cabinet_1", cabinet, north(0.8, 0.0), 0.0);
    model.place("Cabinet_2", cabinet, north(1.602, 0.0), 0.0);
    let shelf = model.mesh("Shelf", furniture::shelf());
    model.place("Shelf", shelf, north(5.8, 0.0), 0.0);
    let books = model.mesh("Books", furniture::books());
    for (index, z) in furniture::BOOK_BOARDS_M.into_iter().enumerate() {
        let x = 5.8 + [0.0, 0.31, 0.12, 0.55][index];
        model.place(format!("Books_{}", index + 1), books, north(x, z), 0.0);
    }
    let bin = model.mesh("Bin", furniture::bin());
    model.place("Bin", bin, DVec3::new(1.25, 2.5, 0.0), 0.0);
    let plant = model.mesh("Plant", furniture::plant());
    model.place("Plant", plant, DVec3::new(7.55, 0.45, 0.0), 0.0);
    let y = [ROOM_M.y - 0.005, ROOM_M.y + furniture::SUNK_M];
    let mirror = Shape::cuboid([2.6, 3.2], y, [0.7, 1.9]);
    model.fixed(None, "Mirror", "Mirror", mirror);
}
