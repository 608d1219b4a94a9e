//! Background luminance of the rooms of CIE 190: a box between eye level and luminaire plane, with
//! the luminaires' flux split by zones. Only the light that the walls receive *from each other, the
//! floor and the ceiling* counts; what comes straight from the luminaires does not.

use crate::units::{Nits, Undefined};

/// Share of the zonal fluxes Φ_zL1 … Φ_zL4 that falls on the reference plane, by room index k: the
/// multipliers F_GL of CIE 190. Their sum with the zones' weights is the direct floor flux.
const GEOMETRIC_MULTIPLIERS: [(f64, [f64; 4]); 13] = [
    (1.00, [0.690, 0.109, 0.085, -0.016]),
    (1.20, [0.578, 0.200, 0.127, -0.018]),
    (1.33, [0.528, 0.218, 0.170, -0.017]),
    (1.50, [0.485, 0.215, 0.222, -0.012]),
    (1.60, [0.466, 0.207, 0.249, -0.006]),
    (1.71, [0.448, 0.198, 0.272, 0.005]),
    (2.00, [0.338, 0.257, 0.351, -0.018]),
    (2.40, [0.296, 0.203, 0.449, -0.006]),
    (2.67, [0.280, 0.165, 0.499, 0.006]),
    (3.00, [0.264, 0.125, 0.541, 0.027]),
    (3.43, [0.248, 0.058, 0.628, 0.032]),
    (4.00, [0.239, -0.012, 0.690, 0.058]),
    (4.80, [0.232, -0.084, 0.740, 0.098]),
];

/// Fractions of the flux that first lands on floor, walls and ceiling which the walls receive
/// *indirectly*: F_FW, F_WW, F_CW.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransferFactors {
    /// From the floor.
    pub floor: f64,
    /// From the walls themselves.
    pub walls: f64,
    /// From the ceiling.
    pub ceiling: f64,
}

/// Direct flux of one luminaire on the three surfaces, lm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectFlux {
    /// On the plane at eye level.
    pub floor_lm: f64,
    /// On the walls between eye level and luminaires.
    pub walls_lm: f64,
    /// Above the luminaire plane.
    pub ceiling_lm: f64,
}

/// View factor between two equal, opposite rectangles `x` × `y` at the distance 1.
pub fn opposite_rectangles(x: f64, y: f64) -> f64 {
    let (x2, y2) = (1.0 + x * x, 1.0 + y * y);
    let corners = 0.5 * (x2 * y2 / (1.0 + x * x + y * y)).ln();
    let sides = x * y2.sqrt() * (x / y2.sqrt()).atan() + y * x2.sqrt() * (y / x2.sqrt()).atan();
    2.0 / (std::f64::consts::PI * x * y) * (corners + sides - x * x.atan() - y * y.atan())
}

/// Transfer factors of a box X·H × Y·H × H with diffuse surfaces. Flux balance of three surfaces,
/// Φ_i = Φ0_i + Σ_j ρ_j Φ_j F_ji, solved for a unit Φ0 on each surface in turn, less the direct part.
pub fn transfer_factors(x_over_h: f64, y_over_h: f64, [ceiling, walls, floor]: [f64; 3]) -> TransferFactors {
    let across = opposite_rectangles(x_over_h, y_over_h);
    let to_walls = 1.0 - across;
    // Reciprocity with the walls' area 2(X + Y) gives the walls' view of either horizontal surface.
    let from_walls = to_walls * x_over_h * y_over_h / (2.0 * (x_over_h + y_over_h));
    let wall_to_wall = 1.0 - 2.0 * from_walls;
    // Floor and ceiling as a pair see only each other and the walls: eliminate them, then the walls.
    let pair = 1.0 - ceiling * floor * across * across;
    let floor_to_walls = floor * (1.0 + ceiling * across) / pair * to_walls;
    let ceiling_to_walls = ceiling * (1.0 + floor * across) / pair * to_walls;
    let round = walls * (wall_to_wall + from_walls * (floor_to_walls + ceiling_to_walls));
    TransferFactors {
        floor: floor_to_walls / (1.0 - round),
        walls: round / (1.0 - round),
        ceiling: ceiling_to_walls / (1.0 - round),
    }
}

/// Direct flux of a luminaire in a room X·H × Y·H: the zones' fluxes (γ from, to in degrees) with
/// the weights of CIE 190 on the floor, the rest of the downward flux on the walls, the upward flux
/// on the ceiling.
///
/// # Errors
/// The room index is none of the table's.
pub fn direct_flux(
    zonal_flux_lm: &dyn Fn(f64, f64) -> f64,
    x_over_h: f64,
    y_over_h: f64,
) -> Result<DirectFlux, Undefined> {
    let room_index = x_over_h * y_over_h / (x_over_h + y_over_h);
    let (_, multipliers) =
        GEOMETRIC_MULTIPLIERS.iter().find(|(k, _)| (k - room_index).abs() < 0.006).ok_or_else(|| {
            Undefined::because(format!("CIE 190 has no multipliers for the room index {room_index:.2}"))
        })?;
    let down_lm = zonal_flux_lm(0.0, 90.0);
    let zones = [
        zonal_flux_lm(0.0, 40.0) + 0.130 * zonal_flux_lm(40.0, 50.0),
        zonal_flux_lm(0.0, 60.0),
        zonal_flux_lm(0.0, 70.0) + 0.547 * zonal_flux_lm(70.0, 80.0),
        down_lm,
    ];
    let floor_lm: f64 = multipliers.iter().zip(zones).map(|(multiplier, zone_lm)| multiplier * zone_lm).sum();
    Ok(DirectFlux { floor_lm, walls_lm: down_lm - floor_lm, ceiling_lm: zonal_flux_lm(90.0, 180.0) })
}

/// L_b = N/(π A_w) · (Φ_F F_FW + Φ_W F_WW + Φ_C F_CW) of `luminaires` in a room X·H × Y·H of height
/// H; A_w = 2 H² (X + Y).
pub fn wall_luminance(
    direct: DirectFlux,
    transfer: TransferFactors,
    luminaires: usize,
    wall_area_m2: f64,
) -> Nits {
    let indirect_lm = direct.floor_lm * transfer.floor
        + direct.walls_lm * transfer.walls
        + direct.ceiling_lm * transfer.ceiling;
    Nits(luminaires as f64 * indirect_lm / (std::f64::consts::PI * wall_area_m2))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::glare::reference_data;
    use crate::glare::ugr_table::{REFLECTANCES, ROOMS};

    #[test]
    fn the_view_factor_meets_its_limits() {
        // A cube's opposite faces: 0.199825; wide plates see only each other.
        assert!((opposite_rectangles(1.0, 1.0) - 0.199_824_9).abs() < 1e-6);
        assert!(opposite_rectangles(1e4, 1e4) > 0.999);
    }

    #[test]
    fn the_box_loses_no_flux() {
        // With white surfaces nothing is absorbed, so the walls receive without end; with black
        // floor and ceiling and walls of 0.5 in a cube the chain is a geometric series.
        let cube = transfer_factors(1.0, 1.0, [0.0, 0.5, 0.0]);
        let wall_to_wall = 1.0 - 2.0 * (1.0 - 0.199_824_9) / 4.0;
        let series = 0.5 * wall_to_wall / (1.0 - 0.5 * wall_to_wall);
        assert!((cube.walls - series).abs() < 1e-6);
        assert!(cube.floor.abs() < 1e-12 && cube.ceiling.abs() < 1e-12);
        assert!(transfer_factors(2.0, 2.0, [0.9999; 3]).walls > 1000.0);
    }

    #[test]
    fn the_box_reproduces_the_printed_transfer_factors() {
        // Catches a wrong reciprocity, floor and ceiling swapped, the direct part left in.
        let Some(text) = reference_data("ugr_tables/cie190_tables_and_worked_example.json") else {
            return;
        };
        let data: serde_json::Value = serde_json::from_str(&text).unwrap();
        let (mut within, mut worst) = (0, 0.0f64);
        for (set, name) in
            ["70/50/20", "70/30/20", "50/50/20", "50/30/20", "30/30/20"].into_iter().enumerate()
        {
            for (room, (x, y)) in ROOMS.into_iter().enumerate() {
                let factors = transfer_factors(x, y, REFLECTANCES[set]);
                for (column, value) in [factors.floor, factors.walls, factors.ceiling].into_iter().enumerate()
                {
                    let error = (value - data["F_T"][name][room][column].as_f64().unwrap()).abs();
                    within += u32::from(error < 0.0011);
                    worst = worst.max(error);
                }
            }
        }
        println!("transfer factors: {within} of 285 within 0.0011, worst {worst:.4}");
        assert!(within >= 284 && worst < 0.005);
    }
}
