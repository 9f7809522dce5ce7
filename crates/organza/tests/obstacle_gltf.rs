//! Characters from glTF files: what moves how, and what is refused.

use base64::Engine;
use mesh_core::World3;
use organza::build::{Built, build};
use organza::record::place;
use organza::scene::{LoadOptions, Source, from_sources, parse};
use serde_json::{Value, json};

/// A file while it is put together.
struct File {
    json: Value,
    bytes: Vec<u8>,
}

impl File {
    /// Adds numbers as an accessor, and returns its number.
    fn floats(&mut self, kind: &str, count: usize, numbers: &[f32]) -> usize {
        let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
        self.accessor(kind, 5126, count, &bytes)
    }

    fn accessor(&mut self, kind: &str, component: u32, count: usize, bytes: &[u8]) -> usize {
        let list = |value: &mut Value, element: Value| {
            let list = value.as_array_mut().unwrap();
            list.push(element);
            list.len() - 1
        };
        let start = self.bytes.len();
        self.bytes.extend(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let view = json!({"buffer": 0, "byteOffset": start, "byteLength": bytes.len()});
        let view = list(&mut self.json["bufferViews"], view);
        let accessor =
            json!({"bufferView": view, "componentType": component, "count": count, "type": kind});
        list(&mut self.json["accessors"], accessor)
    }

    fn glb(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"] = json!([{"byteLength": self.bytes.len()}]);
        let mut text = json.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut out = b"glTF".to_vec();
        let number = |n: usize| (n as u32).to_le_bytes();
        out.extend(number(2));
        out.extend(number(28 + text.len() + self.bytes.len()));
        out.extend(number(text.len()));
        out.extend(b"JSON");
        out.extend(text);
        out.extend(number(self.bytes.len()));
        out.extend(b"BIN\0");
        out.extend(&self.bytes);
        out
    }

    fn text(&self, uri: &str) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"] = json!([{"byteLength": self.bytes.len(), "uri": uri}]);
        json.to_string().into_bytes()
    }
}

/// An arm along x with a joint at x = 0 and an elbow at x = 1, whose skin is a strip of triangles up
/// to x = 2, and a ball-less stick that no skin moves at its end. The animation `bend` turns the
/// elbow by a quarter about z within a second, `jump` lifts the root.
fn arm() -> File {
    let mut file = File {
        json: json!({
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [3, 0]}],
            "nodes": [
                {"name": "shoulder", "children": [1], "translation": [0, 0, 1]},
                {"name": "elbow", "children": [2], "translation": [1, 0, 0]},
                {"name": "hand", "mesh": 1, "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 1,0,0,1]},
                {"name": "body", "mesh": 0, "skin": 0, "translation": [50, 0, 0]},
            ],
            "skins": [{"joints": [0, 1]}],
            "accessors": [], "bufferViews": [],
        }),
        bytes: Vec::new(),
    };
    // Two vertices at each of x = 0, 1, 2; those in the middle hang half on each joint.
    let skin: Vec<f32> =
        (0..6).flat_map(|k| [(k / 2) as f32, if k % 2 == 0 { 0.0 } else { 0.1 }, 1.0]).collect();
    let positions = file.floats("VEC3", 6, &skin);
    let joints: Vec<u8> = (0..6).flat_map(|k| [u8::from(k > 3), 1, 0, 0]).collect();
    let joints = file.accessor("VEC4", 5121, 6, &joints);
    // Fractions as bytes, of which 255 is one.
    let weights: Vec<u8> =
        (0..6).flat_map(|k| if k / 2 == 1 { [100, 100, 0, 0] } else { [255, 0, 0, 0] }).collect();
    let weights = file.accessor("VEC4", 5121, 6, &weights);
    file.json["accessors"][weights]["normalized"] = json!(true);
    let indices: Vec<u8> = [0u16, 1, 2, 3, 4, 5].iter().flat_map(|i| i.to_le_bytes()).collect();
    let indices = file.accessor("SCALAR", 5123, 6, &indices);
    // The two triangles of a square without indices: its diagonal is two vertices, not four.
    let corners = [[0, 0], [1, 0], [1, 1], [0, 0], [1, 1], [0, 1]];
    let corners: Vec<f32> = corners.iter().flat_map(|[x, y]| [*x as f32, *y as f32, 0.0]).collect();
    let stick = file.floats("VEC3", 6, &corners);
    file.json["meshes"] = json!([
        {"primitives": [{"mode": 5, "indices": indices,
            "attributes": {"POSITION": positions, "JOINTS_0": joints, "WEIGHTS_0": weights}}]},
        {"primitives": [{"attributes": {"POSITION": stick}}, {"mode": 1, "attributes": {"POSITION": stick}}]},
    ]);
    let back = |x: f32| [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., -x, 0., -1., 1.];
    let binds = file.floats("MAT4", 2, &[back(0.0), back(1.0)].concat());
    file.json["skins"][0]["inverseBindMatrices"] = json!(binds);
    let second = file.floats("SCALAR", 2, &[0.0, 1.0]);
    let (s, c) = std::f32::consts::FRAC_PI_4.sin_cos();
    let turn = file.floats("VEC4", 2, &[0., 0., 0., 1., 0., 0., -s, -c]);
    let places = file.floats("VEC3", 2, &[0., 0., 1., 0., 4., 1.]);
    // Tangent in, value, tangent out.
    let spline = file.floats(
        "VEC3",
        6,
        &[[0.; 3], [0., 0., 1.], [0., 4., 0.], [0., 0., 0.], [0., 4., 1.], [0.; 3]].concat(),
    );
    let channel =
        |node: u32, path: &str| json!([{"sampler": 0, "target": {"node": node, "path": path}}]);
    let animation = |name: &str, output: usize, way: &str, channels: Value| {
        json!({"name": name, "channels": channels,
            "samplers": [{"input": second, "output": output, "interpolation": way}]})
    };
    file.json["animations"] = json!([
        animation("bend", turn, "LINEAR", channel(1, "rotation")),
        animation("jump", places, "STEP", channel(0, "translation")),
        animation("swing", spline, "CUBICSPLINE", channel(0, "translation")),
    ]);
    file
}

fn build_scene(gltf: &str, sources: &[(&str, Vec<u8>)]) -> Result<Built, String> {
    let text = format!(
        "{{frames: 1, cloths: [{{mesh: {{grid: {{size_m: [1, 1], cells: [1, 1]}}}}, fabric: 'swim'}}],\n\
         obstacles: [{{mesh: {{gltf: {{{gltf}}}}}}}]}}"
    );
    let sources: Vec<Source> = sources
        .iter()
        .map(|(name, bytes)| Source { name: (*name).to_owned(), bytes: bytes.clone() })
        .collect();
    let options = LoadOptions::default();
    let loaded =
        parse(text, "s.json5", &options, &from_sources(&sources)).map_err(|e| e.to_string())?;
    build(&loaded).map_err(|error| place(&loaded, &error).to_string())
}

fn positions(gltf: &str, file: &File, time: f64) -> Vec<World3> {
    let built = build_scene(gltf, &[("arm.glb", file.glb())]).unwrap_or_else(|e| panic!("{e}"));
    built.obstacles[0].positions(time)
}

#[track_caller]
fn near(got: World3, expected: [f64; 3]) {
    // The file's numbers have 24 bits.
    assert!((got - World3::from(expected)).norm() < 1e-6, "{got} {expected:?}");
}

#[test]
fn joints_move_the_skin() {
    let file = arm();
    let built = build_scene("file: 'arm.glb'", &[("arm.glb", file.glb())]).unwrap();
    let arm = &built.obstacles[0];
    assert!(arm.is_moving());
    // The strip first: the skinned node comes first in the scene. Four of the six corners of the
    // square are apart, and lines are no surface.
    assert_eq!(arm.n_vertices(), 6 + 4);
    assert_eq!(arm.triangles, [[0, 1, 2], [2, 1, 3], [2, 3, 4], [4, 3, 5], [6, 7, 8], [6, 8, 9]]);
    let x = arm.positions(0.0);
    // A skin's own node places nothing.
    near(x[5], [2.0, 0.1, 1.0]);
    near(x[7], [3.0, 0.0, 1.0]);
    // Half a quarter is an eighth, on the shorter way although the second quaternion is negated.
    let (s, c) = std::f64::consts::FRAC_PI_4.sin_cos();
    let x = arm.positions(0.5);
    near(x[0], [0.0, 0.0, 1.0]);
    near(x[4], [1.0 + c, s, 1.0]);
    for time in [1.0, 7.0] {
        let x = arm.positions(time);
        near(x[4], [1.0, 1.0, 1.0]);
        // Half at (1, 0.1), half at (0.9, 0).
        near(x[3], [0.95, 0.05, 1.0]);
        // The stick hangs on the elbow: its corner (1, 1) goes to 2 − … along both axes.
        near(x[8], [0.0, 2.0, 1.0]);
    }
}

#[test]
fn animations_are_chosen_and_begin_when_they_should() {
    let file = arm();
    for (gltf, time, y) in [
        ("file: 'arm.glb', animation: 'jump'", 0.9, 0.0),
        ("file: 'arm.glb', animation: 'jump'", 1.0, 4.0),
        ("file: 'arm.glb', animation: 1, start_s: 2", 2.9, 0.0),
        ("file: 'arm.glb', animation: 1, start_s: 2", 3.1, 4.0),
        // The cubic with these tangents: 4 (s³ − 2s² + s) + 4 (3s² − 2s³).
        ("file: 'arm.glb', animation: 'swing'", 0.25, 4.0 * (0.140625 + 0.15625)),
        ("file: 'arm.glb', animation: 'swing'", 0.5, 4.0 * (0.125 + 0.5)),
        ("file: 'arm.glb', animation: 'swing'", -1.0, 0.0),
    ] {
        near(positions(gltf, &file, time)[0], [0.0, y, 1.0]);
    }
    let mut still = arm();
    still.json.as_object_mut().unwrap().remove("animations");
    let built = build_scene("file: 'arm.glb'", &[("arm.glb", still.glb())]).unwrap();
    assert!(!built.obstacles[0].is_moving());
}

#[test]
fn buffers_may_be_elsewhere() {
    let file = arm();
    let data = base64::engine::general_purpose::STANDARD.encode(&file.bytes);
    let inside = file.text(&format!("data:application/octet-stream;base64,{data}"));
    let expected = positions("file: 'arm.glb'", &file, 0.3);
    for sources in [
        vec![("x/arm.gltf", file.text("my%20data.bin")), ("x/my data.bin", file.bytes.clone())],
        vec![("x/arm.gltf", inside)],
    ] {
        let built = build_scene("file: 'x/arm.gltf'", &sources).unwrap();
        assert_eq!(built.obstacles[0].positions(0.3), expected);
    }
    let error = build_scene("file: 'x/arm.gltf'", &[("x/arm.gltf", file.text("a.bin"))]);
    let expected = "s.json5:2:34: obstacles[0].mesh.gltf.file: there is no file `x/a.bin` among those attached";
    assert_eq!(error.unwrap_err(), expected);
    let sources = [("x/arm.gltf", file.text("a.bin")), ("x/a.bin", vec![0; 9])];
    let error = build_scene("file: 'x/arm.gltf'", &sources).unwrap_err();
    assert!(error.contains("x/arm.gltf: buffers[0]: has 9 bytes instead of "), "{error}");
}

#[test]
fn bad_files_are_refused_by_name() {
    let refused = |change: &dyn Fn(&mut File), expected: &str| {
        let mut file = arm();
        change(&mut file);
        let error = build_scene("file: 'arm.glb'", &[("arm.glb", file.glb())]).map(|_| ());
        let error = error.unwrap_err();
        assert!(error.starts_with("s.json5:2:"), "{error}");
        assert!(error.ends_with(expected), "{error}\n{expected}");
    };
    let set = |path: &'static str, value: Value| {
        move |file: &mut File| {
            let (parent, key) = path.rsplit_once('/').unwrap();
            file.json.pointer_mut(parent).unwrap()[key] = value.clone();
        }
    };
    refused(&set("/asset/version", json!("1.0")), "is glTF 1.0, and 2.0 alone is read");
    refused(
        &set("/extensionsRequired", json!(["KHR_draco_mesh_compression"])),
        "needs the extension `KHR_draco_mesh_compression`, which is not supported",
    );
    refused(&set("/scene", json!(4)), "scene: there is no scene 4");
    refused(&set("/scenes/0/nodes", json!([9])), "scenes[0]: there is no node 9");
    refused(&set("/nodes/0/children", json!([7])), "nodes[0]: there is no node 7");
    refused(&set("/nodes/3/skin", json!(1)), "skins[1]: is not there");
    refused(&set("/nodes/3/mesh", json!(2)), "nodes[3]: has no mesh");
    refused(&set("/meshes/0/primitives/0/indices", json!(99)), "accessors[99]: it is not there");
    refused(&set("/nodes/2/children", json!([0])), "nodes: some are their own ancestors");
    refused(&set("/nodes/3/children", json!([1])), "nodes[1]: has two parents");
    refused(&set("/nodes/0/rotation", json!([0, 0, 0, 0])), "nodes[0]: its rotation is zero");
    refused(&set("/scenes/0/nodes", json!([])), "has no triangles in its scene");
    refused(
        &set("/meshes/0/primitives/0/targets", json!([{"POSITION": 0}])),
        "meshes[0].primitives[0]: morph targets are not supported",
    );
    refused(
        &|file| {
            let joints = json!([0]);
            file.json["skins"][0]["joints"] = joints;
        },
        "meshes[0].primitives[0]: vertex 2: there is no joint 1, the skin has 1",
    );
    refused(
        &set("/animations/0/channels/0/target/path", json!("weights")),
        "animations[0].channels[0]: morph targets are not supported",
    );
    refused(
        &set("/animations/0/channels/0/target/node", json!(2)),
        "animations[0].channels[0]: node 2 has a matrix, which cannot be animated",
    );
    refused(
        &set("/animations/0/samplers/0/interpolation", json!("CUBICSPLINE")),
        "animations[0].channels[0]: has 2 values instead of 6",
    );
    refused(&set("/accessors/0/count", json!(7)), "accessors[0]: reaches beyond its buffer");
    refused(
        &set("/accessors/0/type", json!("VEC2")),
        "accessors[0]: has 2 numbers an element instead of 3",
    );
    refused(
        &|file| file.bytes[0..4].copy_from_slice(&f32::NAN.to_le_bytes()),
        "accessors[0]: element 0 is not finite",
    );
    refused(&set("/nodes/0/scale", json!([1e9, 1, 1])), "nodes[0]: is too far or too large at 0 s");

    let unknown = build_scene("file: 'arm.glb', animation: 'bent'", &[("arm.glb", arm().glb())]);
    let unknown = unknown.map(|_| ()).unwrap_err();
    assert!(unknown.ends_with("there is no animation `bent`, did you mean `bend`?"), "{unknown}");
    let unknown = build_scene("file: 'arm.glb', animation: 3", &[("arm.glb", arm().glb())]);
    let unknown = unknown.map(|_| ()).unwrap_err();
    assert!(unknown.ends_with("there is no animation 3, it has 3"), "{unknown}");
    for bytes in [b"".to_vec(), b"glTF".to_vec(), b"glTF\x02\0\0\0\x01\0\0\0".to_vec()] {
        let error = build_scene("file: 'arm.glb'", &[("arm.glb", bytes)]).map(|_| ());
        assert!(error.as_ref().is_err_and(|e| e.contains("`arm.glb` is not glTF")), "{error:?}");
    }
}

/// Whatever is broken in a file, it is read or refused; nothing panics.
#[test]
fn damaged_files_do_no_harm() {
    let glb = arm().glb();
    for k in 0..glb.len() {
        for value in [0, 0xff, glb[k] ^ 1, glb[k].wrapping_add(7)] {
            let mut damaged = glb.clone();
            damaged[k] = value;
            if let Ok(built) = build_scene("file: 'arm.glb'", &[("arm.glb", damaged)]) {
                built.obstacles[0].positions(0.5);
            }
        }
        let cut = glb[..k].to_vec();
        assert!(build_scene("file: 'arm.glb'", &[("arm.glb", cut)]).is_err(), "cut at {k}");
    }
}
