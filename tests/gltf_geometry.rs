//! Geometry of hand-made glTF files against coordinates worked out by hand.

use gershun::geometry::DVec3;
use gershun::geometry::gltf::{GltfError, Imported, import};

/// Positions of a unit right triangle and a fourth corner, then bytes of indices.
struct Bytes(Vec<u8>);

impl Bytes {
    fn new() -> Self {
        let corners: [[f32; 3]; 4] = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
        Self(corners.iter().flatten().flat_map(|x| x.to_le_bytes()).collect())
    }

    fn with(mut self, more: &[u8]) -> Self {
        self.0.extend_from_slice(more);
        self
    }
}

fn document(
    bytes: &Bytes,
    nodes: &str,
    primitive: &str,
    accessors: &str,
    views: &str,
) -> Result<Imported, GltfError> {
    let length = bytes.0.len();
    let text = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{nodes}],
        "materials":[{{"name":"White"}},{{"name":"Red"}}],
        "meshes":[{{"primitives":[{primitive}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"type":"VEC3","count":4}}{accessors}],
        "bufferViews":[{{"buffer":0,"byteLength":48}}{views}],
        "buffers":[{{"byteLength":{length},"uri":"all%20of%20it.bin"}}]}}"#
    );
    import(text.as_bytes(), &mut |path| {
        assert_eq!(path, "all of it.bin");
        Ok(bytes.0.clone())
    })
}

fn normals(imported: &Imported) -> Vec<DVec3> {
    (0..imported.mesh.triangles.len()).map(|i| imported.mesh.normal_and_area(i).0).collect()
}

fn area(imported: &Imported) -> f64 {
    imported.mesh.surface_areas_m2().iter().sum()
}

#[test]
fn strips_fans_and_lists_of_every_index_type_fill_the_square_facing_the_same_way() {
    let list: [u32; 6] = [0, 1, 2, 0, 2, 3];
    let strip: [u32; 4] = [0, 1, 3, 2];
    let fan: [u32; 4] = [0, 1, 2, 3];
    for (mode, indices) in [(4, &list[..]), (5, &strip), (6, &fan)] {
        for (kind, width) in [(5121, 1), (5123, 2), (5125, 4)] {
            let raw: Vec<u8> = indices.iter().flat_map(|i| i.to_le_bytes()[..width].to_vec()).collect();
            let imported = document(
                &Bytes::new().with(&raw),
                r#"{"mesh":0,"name":"N"}"#,
                &format!(r#"{{"attributes":{{"POSITION":0}},"indices":1,"mode":{mode}}}"#),
                &format!(
                    r#",{{"bufferView":1,"componentType":{kind},"type":"SCALAR","count":{}}}"#,
                    indices.len()
                ),
                &format!(r#",{{"buffer":0,"byteOffset":48,"byteLength":{}}}"#, raw.len()),
            )
            .unwrap();
            assert!((area(&imported) - 1.0).abs() < 1e-12, "mode {mode}, type {kind}");
            // The file's +z is the project's −y.
            assert!(normals(&imported).iter().all(|n| (*n - DVec3::NEG_Y).length() < 1e-12));
        }
    }
}

#[test]
fn instances_are_baked_where_their_nodes_stand_and_mirrors_keep_their_front() {
    let nodes = r#"{"name":"Root","children":[1,2,3]},
        {"mesh":0,"name":"Moved","translation":[10,0,0],"rotation":[0,0.70710678,0,0.70710678],"scale":[2,3,1]},
        {"mesh":0,"name":"Mirrored","scale":[-1,1,1]},
        {"mesh":0,"name":"Matrix","matrix":[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,5,1]}"#;
    let primitives = r#"{"attributes":{"POSITION":0},"mode":6,"material":0}"#;
    let imported = document(&Bytes::new(), nodes, primitives, "", "").unwrap();
    let names: Vec<&str> = imported.mesh.surfaces.iter().map(|s| s.name.as_str()).collect();
    assert_eq!(names, ["Moved", "Mirrored", "Matrix"]);
    assert_eq!(imported.nodes[0].surfaces, [0, 1, 2]);
    assert_eq!(imported.nodes[1].path, "Root/Moved");
    let areas = imported.mesh.surface_areas_m2();
    for (found, expected) in areas.iter().zip([6.0, 1.0, 1.0]) {
        assert!((found - expected).abs() < 1e-6);
    }
    // Turned by 90° about the file's y, the front +z looks along +x.
    let normals = normals(&imported);
    assert!((normals[0] - DVec3::X).length() < 1e-6);
    // A mirror in x leaves the front of a face in the xy-plane where it was.
    assert!((normals[2] - DVec3::NEG_Y).length() < 1e-12);
    assert!((imported.mesh.corners(4)[0] - DVec3::new(0.0, -5.0, 0.0)).length() < 1e-12);
}

#[test]
fn a_node_of_two_materials_has_two_surfaces() {
    let primitives = r#"{"attributes":{"POSITION":0},"mode":6,"material":0},{"attributes":{"POSITION":0},"mode":6,"material":1},{"attributes":{"POSITION":0},"mode":6,"material":0}"#;
    let imported = document(&Bytes::new(), r#"{"mesh":0,"name":"N"}"#, primitives, "", "").unwrap();
    let names: Vec<&str> = imported.mesh.surfaces.iter().map(|s| s.name.as_str()).collect();
    assert_eq!(names, ["N.White", "N.Red"]);
    assert_eq!(imported.materials[0].reflectance, None, "a default white is no datum");
}

/// Catches: a lobe from glTF's defaults, from a textured roughness, or from a factor beyond 1.
#[test]
fn only_a_written_roughness_makes_a_material_glossy() {
    let gloss = |pbr: &str| {
        let text = format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0,"name":"N"}}],
            "materials":[{{"name":"M","pbrMetallicRoughness":{{"baseColorFactor":[0.5,0.5,0.5,1]{pbr}}}}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"mode":6,"material":0}}]}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"type":"VEC3","count":4}}],
            "bufferViews":[{{"buffer":0,"byteLength":48}}],"buffers":[{{"byteLength":48,"uri":"a.bin"}}],
            "textures":[{{}}]}}"#
        );
        let imported = import(text.as_bytes(), &mut |_| Ok(Bytes::new().0))?;
        Ok::<_, GltfError>((imported.materials[0].gloss, imported.biases))
    };
    assert_eq!(gloss("").unwrap().0, None);
    assert_eq!(gloss(r#","metallicFactor":0"#).unwrap().0, None);
    assert_eq!(gloss(r#","metallicFactor":0.2,"roughnessFactor":0.3"#).unwrap().0, Some([0.2, 0.3]));
    let (bare, biases) = gloss(r#","roughnessFactor":0.3"#).unwrap();
    assert_eq!(bare, Some([1.0, 0.3]), "glTF's default metallic factor is 1");
    assert!(biases.iter().any(|bias| bias.contains("metallic-roughness")), "{biases:?}");
    let textured = r#","roughnessFactor":0.3,"metallicRoughnessTexture":{"index":0}"#;
    assert_eq!(gloss(textured).unwrap().0, None);
    assert!(matches!(gloss(r#","roughnessFactor":1.5"#), Err(GltfError::Gloss { .. })));
}

#[test]
fn sparse_values_replace_those_of_the_base() {
    // Index 2 (16 bit, padded) becomes (2, 2, 0): a kite of area 2 instead of the square.
    let mut raw = vec![2u8, 0, 0, 0];
    raw.extend([2f32, 2., 0.].into_iter().flat_map(f32::to_le_bytes));
    let sparse = |count: u32, kind: u32| {
        let accessor = format!(
            r#",{{"bufferView":0,"componentType":5126,"type":"VEC3","count":4,"sparse":{{"count":{count},"indices":{{"bufferView":1,"componentType":{kind}}},"values":{{"bufferView":2}}}}}}"#
        );
        document(
            &Bytes::new().with(&raw),
            r#"{"mesh":0,"name":"N"}"#,
            r#"{"attributes":{"POSITION":1},"mode":6}"#,
            &accessor,
            r#",{"buffer":0,"byteOffset":48,"byteLength":4},{"buffer":0,"byteOffset":52,"byteLength":12}"#,
        )
    };
    assert!((area(&sparse(1, 5123).unwrap()) - 2.0).abs() < 1e-12);
    assert!(matches!(sparse(2, 5123), Err(GltfError::Accessor { .. })));
    assert!(matches!(sparse(9, 5121), Err(GltfError::Accessor { .. })));
}

#[test]
fn what_cannot_be_read_is_refused_by_name() {
    let node = r#"{"mesh":0,"name":"N"}"#;
    let plain = r#"{"attributes":{"POSITION":0},"mode":6}"#;
    let message = |nodes: &str, primitive: &str, accessors: &str, views: &str| {
        document(&Bytes::new(), nodes, primitive, accessors, views).unwrap_err().to_string()
    };
    let cases = [
        (message(r#"{"mesh":3,"name":"N"}"#, plain, "", ""), "mesh 3"),
        (message(node, r#"{"attributes":{"POSITION":7}}"#, "", ""), "accessor 7"),
        (message(node, r#"{"attributes":{"NORMAL":0}}"#, "", ""), "POSITION"),
        (message(node, r#"{"attributes":{"POSITION":0},"mode":9}"#, "", ""), "mode"),
        (message(node, r#"{"attributes":{"POSITION":0},"material":5}"#, "", ""), "material 5"),
        (
            message(r#"{"mesh":0,"name":"N","matrix":[1,0,0,1,0,1,0,0,0,0,1,0,0,0,0,1]}"#, plain, "", ""),
            "affine",
        ),
        (message(r#"{"mesh":0,"name":"N","rotation":[0,0,0,0]}"#, plain, "", ""), "not finite"),
        (
            message(
                node,
                r#"{"attributes":{"POSITION":1}}"#,
                r#",{"bufferView":1,"componentType":5126,"type":"VEC3","count":2}"#,
                r#",{"buffer":0,"byteLength":48,"byteStride":4}"#,
            ),
            "stride",
        ),
        (
            message(
                node,
                r#"{"attributes":{"POSITION":1}}"#,
                r#",{"bufferView":1,"componentType":5126,"type":"VEC3","count":2}"#,
                r#",{"buffer":0,"byteLength":96}"#,
            ),
            "past buffer 0",
        ),
        (
            message(
                node,
                r#"{"attributes":{"POSITION":1}}"#,
                r#",{"componentType":5126,"type":"VEC3","count":18446744073709551615}"#,
                "",
            ),
            "without a buffer view",
        ),
        (
            message(
                node,
                r#"{"attributes":{"POSITION":1}}"#,
                r#",{"bufferView":0,"byteOffset":18446744073709551615,"componentType":5126,"type":"VEC3","count":2}"#,
                "",
            ),
            "run past",
        ),
        (
            message(
                node,
                r#"{"attributes":{"POSITION":1}}"#,
                r#",{"bufferView":0,"componentType":5123,"type":"VEC3","count":2}"#,
                "",
            ),
            "32-bit floats",
        ),
    ];
    for (message, fragment) in cases {
        assert!(message.contains(fragment), "{message}: {fragment}");
    }
}

#[test]
fn a_chain_of_nodes_ends_before_its_paths_fill_the_memory() {
    let chain: Vec<String> = (1..100_000).map(|i| format!(r#"{{"children":[{i}]}}"#)).collect();
    let nodes = format!("{},{{}}", chain.join(","));
    let primitive = r#"{"attributes":{"POSITION":0}}"#;
    let error = document(&Bytes::new(), &nodes, primitive, "", "").unwrap_err();
    assert!(matches!(error, GltfError::TooDeep(_)), "{error}");
}
