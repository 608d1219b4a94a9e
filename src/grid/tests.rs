//! Tests of the grids: the spacing rule, borders, polygons, refusals.

use super::*;

fn floor(x: f64, y: f64, rule: GridRule, border_m: f64) -> Result<Grid, GridError> {
    rectangle(DVec3::ZERO, DVec3::X * x, DVec3::Y * y, DVec3::Z, rule, border_m, None)
}

#[test]
fn the_spacing_follows_the_rule() {
    // d = 1: 0.2; d = 10: 1; d = 100: 5; capped at 10 beyond 270 m.
    for (longer, shorter, expected) in [
        (1.0, 1.0, 0.2),
        (10.0, 8.0, 1.0),
        (100.0, 60.0, 5.0),
        (400.0, 300.0, 10.0),
        (40.0, 10.0, 1.0),
        (20.0, 10.0, 1.0),
    ] {
        assert!((spacing_m(longer, shorter) - expected).abs() < 1e-9, "{longer} × {shorter}");
        assert!((spacing_m(shorter, longer) - expected).abs() < 1e-9, "sides swapped");
    }
    // 19.9 × 10 is not yet long: d is the longer side.
    assert!(spacing_m(19.9, 10.0) > 1.5);
}

#[test]
fn from_a_shelf_to_a_hall_points_suffice_and_cells_stay_square_enough() {
    for x in [0.4, 0.7, 1.0, 1.6, 3.0, 5.5, 8.0, 19.9, 20.0, 50.0, 100.0] {
        for y in [0.4, 0.7, 1.0, 1.6, 3.0, 5.5, 8.0, 19.9, 20.0, 50.0, 100.0] {
            let grid = floor(x, y, GridRule::En, 0.0).unwrap();
            let p = spacing_m(x, y);
            assert!(grid.columns as f64 * p >= x - 1e-6 && grid.rows as f64 * p >= y - 1e-6, "{x} × {y}");
            let aspect = grid.spacing_m[0] / grid.spacing_m[1];
            assert!((0.5..=2.0).contains(&aspect), "{x} × {y}: {aspect}");
            assert_eq!(grid.points.len(), grid.columns * grid.rows);
        }
    }
    let office = floor(8.0, 5.0, GridRule::En, 0.0).unwrap();
    assert_eq!([office.columns, office.rows], [10, 6]);
}

/// Catches: an even number, the shorter side taken for d in a long area, a count next to the nearest odd one.
#[test]
fn sports_grids_are_odd_and_nearest_to_the_rule_from_a_shelf_to_a_hall() {
    let sizes = [0.4, 0.7, 1.0, 1.6, 3.0, 5.5, 8.0, 15.0, 19.9, 20.0, 28.0, 50.0, 100.0];
    for x in sizes {
        for y in sizes {
            let grid = floor(x, y, GridRule::EnSports, 0.0).unwrap();
            assert!(grid.columns % 2 == 1 && grid.rows % 2 == 1, "{x} × {y}");
            // d is the longer side, however long; no odd number lies nearer to d/p.
            let (longer, count) = if x >= y { (x, grid.columns) } else { (y, grid.rows) };
            let exact = longer / (0.2 * 5f64.powf(longer.log10())).min(10.0);
            assert!((count as f64 - exact).abs() <= 1.0 + 1e-9, "{x} × {y}: {count} for {exact}");
            // The other side has the odd number nearest to its length over that spacing.
            let (shorter, other) = if x >= y { (y, grid.rows) } else { (x, grid.columns) };
            let wanted = shorter / (longer / count as f64);
            assert!((other as f64 - wanted).abs() <= 1.0 + 1e-9, "{x} × {y}: {other} for {wanted}");
        }
    }
    // A basketball court, 28 × 15 m.
    let court = floor(28.0, 15.0, GridRule::EnSports, 0.0).unwrap();
    assert_eq!([court.columns, court.rows], [13, 7]);
}

/// Catches: a border that is left out of the points and not of the sides by which they are counted, one on
/// two sides only, a long area counted by its longer side.
#[test]
fn borders_are_left_out_of_every_rule_and_long_areas_count_by_their_shorter_side() {
    for rule in [GridRule::En, GridRule::EnSports, GridRule::Step(0.7), GridRule::Count([5, 3])] {
        for (x, y) in [(2.0, 1.6), (8.0, 5.0), (40.0, 6.0), (100.0, 60.0), (100.0, 1.5)] {
            for border_m in [0.0, 0.1, 0.5] {
                let grid = floor(x, y, rule, border_m).unwrap();
                let inner = floor(x - 2.0 * border_m, y - 2.0 * border_m, rule, 0.0).unwrap();
                assert_eq!([grid.columns, grid.rows], [inner.columns, inner.rows], "{rule:?} {x} × {y}");
                for point in &grid.points {
                    let [dx, dy] = grid.spacing_m.map(|spacing| 0.5 * spacing + border_m - 1e-9);
                    let p = point.position;
                    assert!(
                        p.x >= dx && p.x <= x - dx && p.y >= dy && p.y <= y - dy,
                        "{rule:?} {x} × {y}: {p}"
                    );
                }
                let sum: DVec3 = grid.points.iter().map(|point| point.position).sum();
                let centre = sum / grid.points.len() as f64;
                assert!((centre - DVec3::new(0.5 * x, 0.5 * y, 0.0)).length() < 1e-9, "not in the middle");
            }
        }
    }
    // 40 × 6 m is long: p by 6 m, 0.70 m; by 40 m it would be 2.63 m.
    let corridor = floor(40.0, 6.0, GridRule::En, 0.0).unwrap();
    assert!(corridor.spacing_m[1] < 0.71 && corridor.rows == 9, "{:?}", corridor.spacing_m);
    // The longer side may be coarser, up to cells of 2:1, never finer than the rule asks.
    assert!(corridor.spacing_m[0] <= 0.71, "{:?}", corridor.spacing_m);
}

#[test]
fn points_are_cell_centres_in_order_of_rows_inside_the_border() {
    let grid = floor(5.0, 3.0, GridRule::Count([4, 2]), 0.5).unwrap();
    assert!((grid.points[0].position - DVec3::new(1.0, 1.0, 0.0)).length() < 1e-12);
    assert!((grid.points[5].position - DVec3::new(2.0, 2.0, 0.0)).length() < 1e-12);
    assert_eq!((grid.points[5].row, grid.points[5].column), (1, 1));
    let step = floor(5.0, 3.0, GridRule::Step(0.5), 0.0).unwrap();
    assert_eq!([step.columns, step.rows], [10, 6]);
}

#[test]
fn what_gives_no_grid_says_why() {
    assert_eq!(
        floor(5.0, 1.0, GridRule::En, 0.5).unwrap_err(),
        GridError::Border { border_m: 0.5, side_m: 1.0 }
    );
    assert!(matches!(floor(5.0, 3.0, GridRule::En, f64::NAN), Err(GridError::Border { .. })));
    assert!(matches!(floor(0.0, 3.0, GridRule::En, 0.0), Err(GridError::NoExtent { .. })));
    for rule in [GridRule::Step(0.0), GridRule::Step(f64::NAN), GridRule::Count([0, 3])] {
        assert_eq!(floor(5.0, 3.0, rule, 0.0).unwrap_err(), GridError::Rule);
    }
    for rule in [GridRule::Step(1e-4), GridRule::Step(1e-300), GridRule::Count([usize::MAX, 2])] {
        assert!(matches!(floor(5.0, 3.0, rule, 0.0), Err(GridError::TooMany { .. })));
    }
    let skewed =
        rectangle(DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Z, GridRule::En, 0.0, None);
    assert!(skewed.unwrap_err().to_string().contains("45.0°"));
}

#[test]
fn a_grid_in_step_with_the_luminaires_gets_one_more_point() {
    let along = |avoid| {
        let grid = rectangle(DVec3::ZERO, DVec3::X * 8.0, DVec3::Y * 5.0, DVec3::Z, GridRule::En, 0.0, avoid)
            .unwrap();
        [grid.columns, grid.rows]
    };
    assert_eq!(along(Some([0.8, 2.0])), [11, 6]);
    assert_eq!(along(Some([0.79, 0.84])), [11, 7]);
    assert_eq!(along(Some([1.6, 2.4])), [10, 6]);
    assert_eq!(along(None), [10, 6]);
}

#[test]
fn a_rectangular_polygon_is_the_rectangle_and_an_l_loses_its_notch() {
    let at = |x: f64, y: f64| DVec3::new(x, y, 0.8);
    let square = [at(0.0, 0.0), at(8.0, 0.0), at(8.0, 5.0), at(0.0, 5.0)];
    let grid = polygon(&square, DVec3::Z, GridRule::En, 0.5, &[]).unwrap();
    let twin =
        rectangle(square[0], DVec3::X * 8.0, DVec3::Y * 5.0, DVec3::Z, GridRule::En, 0.5, None).unwrap();
    assert!(grid.points.iter().all(|point| point.excluded.is_none()));
    for (a, b) in grid.points.iter().zip(&twin.points) {
        assert!((a.position - b.position).length() < 1e-12);
    }
    let l = [at(0.0, 0.0), at(8.0, 0.0), at(8.0, 2.0), at(4.0, 2.0), at(4.0, 5.0), at(0.0, 5.0)];
    for (outline, normal) in
        [(l.to_vec(), DVec3::Z), (l.iter().rev().copied().collect(), DVec3::Z), (l.to_vec(), DVec3::NEG_Z)]
    {
        let grid = polygon(&outline, normal, GridRule::Step(0.5), 0.3, &[]).unwrap();
        for point in &grid.points {
            let (x, y) = (point.position.x, point.position.y);
            // Nearer than 0.3 to the notch, whose inner corner (4, 2) is rounded.
            let gap = DVec2::new((4.0 - x).max(0.0), (2.0 - y).max(0.0)).length();
            assert_eq!(point.excluded.is_some(), gap < 0.3, "{x} {y}");
            assert!((point.position.z - 0.8).abs() < 1e-12 && point.normal == normal);
        }
    }
}

#[test]
fn polygons_that_are_none_are_refused() {
    let at = |x: f64, y: f64| DVec3::new(x, y, 0.0);
    let bow = [at(0.0, 0.0), at(4.0, 3.0), at(4.0, 0.0), at(0.0, 4.0)];
    assert_eq!(
        polygon(&bow, DVec3::Z, GridRule::En, 0.0, &[]).unwrap_err(),
        GridError::SelfIntersecting { first: 1, second: 3 }
    );
    let bent = [at(0.0, 0.0), at(4.0, 0.0), DVec3::new(4.0, 3.0, 0.2), at(0.0, 3.0)];
    assert!(matches!(polygon(&bent, DVec3::Z, GridRule::En, 0.0, &[]), Err(GridError::NotPlanar { .. })));
    assert_eq!(
        polygon(&bow[..2], DVec3::Z, GridRule::En, 0.0, &[]).unwrap_err(),
        GridError::Corners { corners: 2 }
    );
    let line = [at(0.0, 0.0), at(1.0, 0.0), at(2.0, 0.0)];
    assert!(matches!(polygon(&line, DVec3::Z, GridRule::En, 0.0, &[]), Err(GridError::NoExtent { .. })));
    // The largest circle inside has a radius of 1.17.
    let sliver = [at(0.0, 0.0), at(4.0, 0.0), at(0.0, 4.0)];
    assert_eq!(
        polygon(&sliver, DVec3::Z, GridRule::Step(0.1), 1.2, &[]).unwrap_err(),
        GridError::Empty { border_m: 1.2 }
    );
}

#[test]
fn a_list_keeps_order_and_normals() {
    let grid =
        list(&[(DVec3::X, None), (DVec3::Y, Some(DVec3::Y * 2.0)), (DVec3::Z, Some(DVec3::ZERO))], DVec3::Z);
    assert_eq!([grid.columns, grid.rows], [0, 0]);
    let normals: Vec<DVec3> = grid.points.iter().map(|point| point.normal).collect();
    assert_eq!(normals, [DVec3::Z, DVec3::Y, DVec3::Z]);
    assert_eq!(grid.points[1].column, 1);
}

/// Catches: luminaires in rows that are taken for irregular, or scattered ones for regular.
/// Catches: a spacing that stays within 2 % of the luminaires' after its one point more.
#[test]
fn one_more_point_of_many_is_not_always_enough() {
    // p = 0.2 · 5^lg 8 = 0.855 m: 71 columns of 0.845 m, and 72 of 0.833 m are 1.4 % away.
    let laid = |avoid| {
        let grid =
            rectangle(DVec3::ZERO, DVec3::X * 60.0, DVec3::Y * 8.0, DVec3::Z, GridRule::En, 0.0, avoid);
        grid.unwrap().columns
    };
    assert_eq!((laid(None), laid(Some([60.0 / 71.0, 0.0]))), (71, 73));
    let narrow = |avoid| {
        let grid =
            rectangle(DVec3::ZERO, DVec3::X * 10.0, DVec3::Y * 0.9, DVec3::Z, GridRule::En, 0.0, avoid);
        let grid = grid.unwrap();
        [grid.columns, grid.rows]
    };
    let [columns, rows] = narrow(None);
    let found = narrow(Some([10.0 / columns as f64, 0.9 / rows as f64]));
    assert!(found[0] > columns && found[1] > rows, "{found:?} of {columns} and {rows}");
}

#[test]
fn luminaires_in_rows_have_a_spacing_and_scattered_ones_none() {
    let field: Vec<DVec3> = (0..12)
        .map(|k| DVec3::new(1.0 + 1.6 * f64::from(k % 4), 0.8 + 2.4 * f64::from(k / 4), 2.8))
        .collect();
    assert!((regular_spacing_m(&field, DVec3::X) - 1.6).abs() < 1e-9);
    assert!((regular_spacing_m(&field, DVec3::NEG_Y) - 2.4).abs() < 1e-9);
    assert!(regular_spacing_m(&field, DVec3::Z).abs() < 1e-12);
    let scattered = [DVec3::ZERO, DVec3::X, DVec3::X * 2.4];
    assert!(regular_spacing_m(&scattered, DVec3::X).abs() < 1e-12);
    assert!(regular_spacing_m(&[], DVec3::X).abs() < 1e-12);
    // Through the polygon, whose axes only it knows: 8 m in 10 columns is 0.8 m.
    let at = |x: f64, y: f64| DVec3::new(x, y, 0.0);
    let square = [at(0.0, 0.0), at(8.0, 0.0), at(8.0, 5.0), at(0.0, 5.0)];
    let rows: Vec<DVec3> = (0..10).map(|k| at(0.4 + 0.8 * f64::from(k), 2.0)).collect();
    let grid = polygon(&square, DVec3::Z, GridRule::En, 0.0, &rows).unwrap();
    assert_eq!([grid.columns, grid.rows], [11, 6]);
}

/// Playing areas of EN 12193 as its tables print them: length, width, points along both.
#[test]
fn sports_grids_have_the_odd_numbers_of_points_of_the_tables() {
    for (length, width, expected) in [
        (28.0, 15.0, [13, 7]),   // basketball
        (36.0, 18.0, [15, 7]),   // tennis
        (105.0, 68.0, [21, 13]), // football
    ] {
        let grid = floor(length, width, GridRule::EnSports, 0.0).unwrap();
        assert_eq!([grid.columns, grid.rows], expected, "{length} × {width}");
        let turned = floor(width, length, GridRule::EnSports, 0.0).unwrap();
        assert_eq!([turned.rows, turned.columns], expected, "turned");
    }
    for side in [0.4, 1.0, 5.0, 20.0, 55.0, 100.0] {
        for other in [0.4, 1.0, 5.0, 20.0, 55.0, 100.0] {
            let grid = floor(side, other, GridRule::EnSports, 0.0).unwrap();
            assert!(grid.columns % 2 == 1 && grid.rows % 2 == 1, "{side} × {other}");
        }
    }
    // A row of luminaires in step with the points: the count stays odd.
    let avoid = Some([28.0 / 13.0, 0.0]);
    let grid =
        rectangle(DVec3::ZERO, DVec3::X * 28.0, DVec3::Y * 15.0, DVec3::Z, GridRule::EnSports, 0.0, avoid);
    assert_eq!(grid.unwrap().columns, 15);
}

/// Least numbers of points as EN 12464-1's table has them in a luminaire maker's guide (their spacings
/// are the rule's, rounded to one figure): the rule gives as many or up to two more.
#[test]
fn the_least_number_of_points_is_that_of_published_tables() {
    for (side, least) in
        [(0.4, 3), (0.6, 3), (1.0, 5), (2.0, 6), (5.0, 8), (10.0, 10), (25.0, 12), (50.0, 17), (100.0, 20)]
    {
        let grid = floor(side, side, GridRule::En, 0.0).unwrap();
        assert!((least..=least + 2).contains(&grid.columns), "{side} m: {} and {least}", grid.columns);
    }
}

/// Catches: an L-shaped corridor taken for the hall round it, a strip for the task inside, a rectangle that is
/// turned.
#[test]
fn the_width_of_an_area_is_that_of_the_largest_circle_in_it() {
    let of = |corners: &[(f64, f64)], holes: &[Vec<DVec2>]| {
        width(&corners.iter().copied().map(DVec2::from).collect::<Vec<_>>(), holes)
    };
    assert!((of(&[(0.0, 0.0), (8.0, 0.0), (8.0, 5.0), (0.0, 5.0)], &[]) - 5.0).abs() < 1e-12);
    assert!((of(&[(0.0, 0.0), (6.0, 8.0), (2.0, 11.0), (-4.0, 3.0)], &[]) - 5.0).abs() < 1e-9);
    let l = [(0.0, 0.0), (20.0, 0.0), (20.0, 1.8), (1.8, 1.8), (1.8, 20.0), (0.0, 20.0)];
    // In the corner a circle may be larger: it touches two walls and the inner corner.
    let corner = 2.0 * 1.8 * 2f64.sqrt() / (1.0 + 2f64.sqrt());
    let found = of(&l, &[]);
    assert!(found <= corner && found > 0.97 * corner, "{found}, not {corner}");
    let task = [(0.5, 0.5), (10.5, 0.5), (10.5, 10.5), (0.5, 10.5)].map(DVec2::from).to_vec();
    let strip = of(&[(0.0, 0.0), (11.0, 0.0), (11.0, 11.0), (0.0, 11.0)], &[task]);
    assert!((0.49..0.6).contains(&strip), "{strip}");
    assert!(of(&l, &[l.map(DVec2::from).to_vec()]) < 1e-9, "nothing is left");
}
