//! Found by an independent review of the light transport and its intervals.

mod common;

use common::{lambert, panel, room};
use gershun::emitters::Emitters;
use gershun::material::{Bsdf, Material};
use gershun::rng::Rng;
use gershun::scene::Scene;
use glam::DVec3;

fn mirror(name: &str) -> Material {
    Material { name: name.into(), bsdf: Bsdf::Mirror { reflectance: 0.9 } }
}

/// Catches: the cheap visibility test of images erring towards no where an opening is not parallel to
/// its mirror (a panel under the ceiling beside a mirror on the wall, a receiver near that wall).
#[test]
fn the_cheap_test_of_images_never_hides_light() {
    let mut mesh = room(DVec3::new(8.0, 6.0, 3.0));
    let surface = mesh.add_surface("mirror", 3, true);
    let p = |y: f64, z: f64| DVec3::new(0.01, y, z);
    mesh.add_quad([p(2.0, 1.5), p(2.4, 1.5), p(2.4, 1.9), p(2.0, 1.9)], surface);
    let materials = vec![lambert("f", 0.2), lambert("w", 0.5), lambert("c", 0.7), mirror("m")];
    let lamp = panel(4000.0, 0.6, DVec3::new(0.46, 3.0, 2.9));
    let scene = Scene::new(mesh, materials, vec![lamp]).unwrap();
    let emitters = Emitters::new(&scene);
    assert_eq!(emitters.sources.len(), 2);
    let image = &emitters.sources[1];
    let mut rng = Rng::new(1, 0, 0);
    let (mut lit, mut hidden) = (0, 0);
    for _ in 0..400_000 {
        let u = rng.uniforms::<3>();
        let point = DVec3::new(0.02 + u[0], 6.0 * u[1], 2.9 * u[2]);
        if let Some(arrival) = emitters.arrival_if(image, point, rng.uniforms(), |_| true)
            && emitters.passed(image, point, &arrival) > 0.0
        {
            lit += 1;
            hidden += u32::from(!emitters.may_show(image, point));
        }
    }
    assert!(lit > 100, "{lit}");
    assert_eq!(hidden, 0, "of {lit}");
}
