//! Detection on images made here, where every answer is known.

use super::*;
use crate::image::{LuminanceImage, Projection, View};

/// A 180° fisheye with luminances by direction (right, up, ahead).
fn image(size: usize, luminance: impl Fn(DVec3) -> f64) -> LuminanceImage {
    let projection = Projection::AngularFisheye { horizontal_deg: 180.0, vertical_deg: 180.0 };
    let view = View::new(projection, DVec3::ZERO, DVec3::Y, DVec3::Z).unwrap();
    let mut pixels = vec![0.0; size * size];
    for (index, pixel) in pixels.iter_mut().enumerate() {
        let at = [(index % size) as f64 + 0.5, (index / size) as f64 + 0.5];
        if let Some(direction) = view.direction([size, size], at) {
            // The eye looks along +y with x to its right.
            *pixel = luminance(DVec3::new(direction.x, direction.z, direction.y));
        }
    }
    LuminanceImage::new(size, size, Some(view), pixels)
}

/// Direction at an azimuth to the right and an elevation, degrees.
fn towards(azimuth_deg: f64, elevation_deg: f64) -> DVec3 {
    let (azimuth, elevation) = (azimuth_deg.to_radians(), elevation_deg.to_radians());
    DVec3::new(azimuth.sin() * elevation.cos(), elevation.sin(), azimuth.cos() * elevation.cos())
}

fn disc(centre: DVec3, radius_deg: f64, direction: DVec3) -> bool {
    super::super::field::angle(centre, direction).to_degrees() <= radius_deg
}

fn found(image: &LuminanceImage, search: &Search) -> Found {
    detect(&Field::of(image, None).unwrap(), search).unwrap()
}

#[test]
fn a_disc_has_its_luminance_solid_angle_and_place() {
    // Catches a wrong Jacobian, cos θ forgotten, axes swapped or mirrored.
    for (azimuth, elevation) in [(0.0, 0.0), (20.0, 15.0), (-45.0, 30.0), (60.0, -20.0)] {
        let centre = towards(azimuth, elevation);
        let image = image(800, |d| if disc(centre, 8.0, d) { 9000.0 } else { 50.0 });
        let found = found(&image, &Search::default());
        assert_eq!(found.sources.len(), 1);
        let source = found.sources[0];
        let size_sr = 2.0 * std::f64::consts::PI * (1.0 - 8f64.to_radians().cos());
        assert!((source.luminance.0 - 9000.0).abs() < 1e-9);
        assert!((source.solid_angle_sr / size_sr - 1.0).abs() < 0.01, "{}", source.solid_angle_sr);
        // The centre in the plane of angles lies up to 0.2° farther out for a disc of this size.
        assert!((source.direction - centre).length() < 5e-3);
        // A disc gives L π sin² r cos θ on a plane that it lies wholly before.
        let eye_lx = 9000.0 * std::f64::consts::PI * 8f64.to_radians().sin().powi(2) * centre.z;
        assert!((source.eye_lx / eye_lx - 1.0).abs() < 0.01, "{} {eye_lx}", source.eye_lx);
    }
}

#[test]
fn sources_join_within_half_the_search_angle_and_not_beyond() {
    // Two small discs with a gap of 4.5° or 7.5°: half of 0.2 rad is 5.7°. Catches the full angle.
    for (gap_deg, count) in [(4.5, 1), (7.5, 2)] {
        let centres = [towards(-1.0 - 0.5 * gap_deg, 0.0), towards(1.0 + 0.5 * gap_deg, 0.0)];
        let lit = |d| centres.iter().any(|centre| disc(*centre, 1.0, d));
        let image = image(800, |d| if lit(d) { 9000.0 } else { 50.0 });
        assert_eq!(found(&image, &Search::default()).sources.len(), count, "{gap_deg}°");
    }
}

#[test]
fn joining_is_transitive_and_takes_no_order() {
    // A chain of discs 5° apart is one source; the mirror image and the image turned over have the
    // same sources. Catches a join by scan order, which splits a U that is open upwards.
    let chain: Vec<DVec3> = (0..9).map(|k| towards(-40.0 + 5.0 * f64::from(k), 10.0)).collect();
    let arms = [towards(-40.0, 15.0), towards(0.0, 15.0), towards(30.0, -30.0)];
    let lit = |d: DVec3| chain.iter().chain(&arms).any(|centre| disc(*centre, 1.2, d));
    let luminance = |d: DVec3| if lit(d) { 9000.0 } else { 50.0 };
    let plain = found(&image(600, luminance), &Search::default());
    assert_eq!(plain.sources.len(), 2);
    let sorted = |found: &Found| {
        let mut sizes: Vec<f64> = found.sources.iter().map(|source| source.solid_angle_sr).collect();
        sizes.sort_by(f64::total_cmp);
        sizes
    };
    let flips = [DVec3::new(-1.0, 1.0, 1.0), DVec3::new(1.0, -1.0, 1.0), DVec3::new(-1.0, -1.0, 1.0)];
    for flip in flips {
        let turned = found(&image(600, |d| luminance(d * flip)), &Search::default());
        for (a, b) in sorted(&plain).into_iter().zip(sorted(&turned)) {
            assert!((a - b).abs() < 1e-9);
        }
        assert_eq!(turned.sources.len(), 2);
    }
}

#[test]
fn groups_are_those_of_all_pairs() {
    // The cells' short cut against comparing every pair, on scattered bright pixels.
    let mut rng = crate::rng::Rng::new(7, 0, 0);
    for density in [0.002, 0.01, 0.05] {
        let scattered: Vec<f64> = (0..120 * 120).map(|_| rng.uniform()).collect();
        let mut image = image(120, |_| 50.0);
        for (pixel, chance) in image.luminance_cd_m2.iter_mut().zip(&scattered) {
            if *pixel > 0.0 && *chance < density {
                *pixel = 9000.0;
            }
        }
        let field = Field::of(&image, None).unwrap();
        let members: Vec<u32> =
            (0..field.pixels.len() as u32).filter(|&i| field.pixels[i as usize].luminance > 100.0).collect();
        let reach = 0.06;
        let mut groups = Groups::new(members.len());
        for a in 0..members.len() {
            for b in 0..a {
                let place = |i: usize| field.pixels[members[i] as usize].direction;
                if super::super::field::angle(place(a), place(b)) <= reach {
                    groups.join(a, b);
                }
            }
        }
        let every: Vec<u32> = (0..members.len()).map(|i| members[groups.root(i)]).collect();
        assert_eq!(joined(&field, &members, reach), every);
    }
}

#[test]
fn peaks_are_split_off_and_their_surround_stays_one() {
    let (window, sun) = (towards(0.0, 10.0), towards(3.0, 12.0));
    let image = image(800, |d| match d {
        d if disc(sun, 1.0, d) => 400_000.0,
        d if disc(window, 12.0, d) => 6000.0,
        _ => 300.0,
    });
    let split = found(&image, &Search::default());
    assert_eq!(split.sources.iter().map(|source| source.is_peak).collect::<Vec<_>>(), [false, true]);
    assert!((split.sources[0].luminance.0 - 6000.0).abs() < 1e-6);
    let whole = found(&image, &Search { peak: None, ..Search::default() });
    assert_eq!(whole.sources.len(), 1);
    let together: f64 = split.sources.iter().map(|source| source.eye_lx).sum();
    assert!((whole.sources[0].eye_lx - together).abs() < 1e-9);
}

#[test]
fn thresholds_follow_the_image_or_the_task() {
    let bright = towards(20.0, 20.0);
    let task = Cone { direction: towards(0.0, -40.0), opening_rad: 0.5 };
    let image = image(400, |d| match d {
        d if disc(bright, 5.0, d) => 1500.0,
        d if task.contains(d) => 200.0,
        _ => 50.0,
    });
    let count = |threshold| {
        let found = found(&image, &Search { threshold, ..Search::default() });
        (found.sources.len(), found.threshold.0)
    };
    assert_eq!(count(Threshold::Absolute(Nits(2000.0))).0, 0);
    assert_eq!(count(Threshold::Absolute(Nits(1000.0))).0, 1);
    let (sources, level) = count(Threshold::TimesTask(5.0, task));
    assert!(sources == 1 && (level - 1000.0).abs() < 1e-9, "{level}");
    let mean = Field::of(&image, None).unwrap().mean(|_| true).unwrap().0;
    let (sources, level) = count(Threshold::TimesMean(5.0));
    assert!(sources == 1 && (level - 5.0 * mean).abs() < 1e-9 && mean > 50.0 && mean < 80.0);
    let nowhere = Cone { direction: DVec3::NEG_Z, opening_rad: 0.1 };
    let search = Search { threshold: Threshold::TimesTask(5.0, nowhere), ..Search::default() };
    assert!(detect(&Field::of(&image, None).unwrap(), &search).is_err());
}

#[test]
fn bad_and_masked_pixels_are_counted_and_give_nothing() {
    let mut image = image(200, |_| 100.0);
    let middle = 100 * 200 + 100;
    for (offset, value) in [(0, f64::NAN), (1, f64::NAN), (2, -5.0)] {
        image.luminance_cd_m2[middle + offset] = value;
    }
    let mut mask = LuminanceImage::new(200, 200, None, vec![1.0; 200 * 200]);
    mask.luminance_cd_m2[..100 * 200].fill(0.0);
    let field = Field::of(&image, Some(&mask)).unwrap();
    assert_eq!(field.bad_pixels, 3);
    assert!(field.masked_pixels > 15_000 && field.illuminance_lx().is_finite());
    assert!((field.illuminance_lx() / (100.0 * 0.5 * std::f64::consts::PI) - 1.0).abs() < 0.01);
    // A sun too bright for the file is no dark pixel: without it every figure would be too low.
    image.luminance_cd_m2[middle + 1] = f64::INFINITY;
    let refused = Field::of(&image, Some(&mask)).unwrap_err();
    assert!(refused.reason.starts_with("1 pixel(s) before the eye are infinite"), "{refused}");
    mask.luminance_cd_m2[middle + 1] = 0.0;
    assert!(Field::of(&image, Some(&mask)).is_ok(), "what is hidden does not count");
    let small = LuminanceImage::new(2, 2, None, vec![1.0; 4]);
    assert!(Field::of(&image, Some(&small)).is_err());
    assert!(Field::of(&small, None).is_err());
}
