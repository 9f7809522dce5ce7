//! Cloths and cameras that several test files share.
#![allow(dead_code, unreachable_pub)]

use mesh_core::generate::{self, Diagonal};
use mesh_core::{ClothState, Mesh, World3};
use nalgebra::{Quaternion, UnitQuaternion};
use proptest::prelude::*;
use sizing_view::{Camera, Sample, ViewFactors, ViewSettings};
use std::path::PathBuf;

/// A sheet in the plane z = 0 with its middle in the origin; its normals point along +z.
pub fn sheet(size: f64, cells: usize) -> ClothState {
    let sheet = generate::grid([size, size], [cells, cells], Diagonal::Alternating).unwrap();
    let x = sheet.positions.iter().map(|p| p - World3::new(0.5, 0.5, 0.0) * size).collect();
    ClothState::at_rest(sheet.mesh, x, vec![0.2]).unwrap()
}

/// A sheet with waves.
pub fn wavy(size: f64, cells: usize) -> ClothState {
    let mut cloth = sheet(size, cells);
    for x in &mut cloth.x {
        x.z = 0.1 * size * (7.0 * x.x / size).sin() * (5.0 * x.y / size).cos();
    }
    cloth
}

/// Wavy sheets in a row along x, `gap` from middle to middle, each a panel.
pub fn crowd(n: usize, cells: usize, gap: f64) -> ClothState {
    let one = wavy(1.0, cells);
    let (mut triangles, mut material, mut panels, mut x) = (vec![], vec![], vec![], vec![]);
    for k in 0..n {
        let first = x.len() as u32;
        triangles.extend(one.mesh.triangles().iter().map(|t| t.map(|i| i + first)));
        material.extend_from_slice(one.mesh.material());
        panels.extend(vec![k as u32; one.mesh.n_triangles()]);
        x.extend(one.x.iter().map(|p| p + World3::x() * (gap * k as f64)));
    }
    let mesh = Mesh::new(x.len(), triangles, material, panels).unwrap();
    ClothState::at_rest(mesh, x, vec![0.2; n]).unwrap()
}

/// A single triangle with material coordinates as it lies.
pub fn triangle(corners: [World3; 3]) -> ClothState {
    let [a, b, c] = corners;
    let (p, q) = (b - a, c - a);
    let along = p.norm();
    let foot = q.dot(&p) / along;
    let u = [[0.0, 0.0], [along, 0.0], [foot, (q - p * (foot / along)).norm()]].map(Into::into);
    let mesh = Mesh::new(3, vec![[0, 1, 2]], vec![u], vec![0]).unwrap();
    ClothState::at_rest(mesh, corners.to_vec(), vec![0.2]).unwrap()
}

pub fn look(position: [f64; 3], target: [f64; 3], fov: f64) -> Camera {
    Camera::looking_at(position.into(), target.into(), World3::z(), fov, [1280, 720]).unwrap()
}

/// View factors for one camera, without time.
pub fn still(cloth: &ClothState, camera: Camera, settings: &ViewSettings) -> Vec<f64> {
    ViewFactors::evaluate(cloth, &[Sample::new(camera)], settings).unwrap().values().to_vec()
}

/// Settings whose view factors are not changed by the silhouette rule.
pub fn raw() -> ViewSettings {
    ViewSettings { silhouette: 1.0, ..ViewSettings::default() }
}

pub fn point(reach: f64) -> impl Strategy<Value = World3> {
    prop::array::uniform3(-reach..reach).prop_map(World3::from)
}

pub fn rotation() -> impl Strategy<Value = UnitQuaternion<f64>> {
    prop::array::uniform4(-1.0..1.0f64)
        .prop_filter("no direction", |q| q.iter().map(|x| x * x).sum::<f64>() > 1e-2)
        .prop_map(|[x, y, z, w]| UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z)))
}

/// Cameras near the origin, with wide and narrow pictures.
pub fn camera() -> impl Strategy<Value = Camera> {
    let size = || prop_oneof![Just(1u32), Just(17), Just(720), Just(1280)];
    (point(3.0), rotation(), -1.0..3.0f64, size(), size(), -3.0..0.0f64).prop_map(
        |(position, rotation, focal, width, height, near)| {
            let focal_px = f64::from(height) * 10f64.powf(focal);
            let camera = Camera::new(position, rotation, focal_px, [width, height]).unwrap();
            camera.with_near(10f64.powf(near)).unwrap()
        },
    )
}

/// A table of the shared reference data as rows of numbers; none if it is not here.
pub fn reference(name: &str) -> Option<Vec<Vec<f64>>> {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let path = root.join("../../../shared/reference").join(name);
    let Ok(text) = std::fs::read_to_string(&path) else {
        eprintln!("skipped: there is no reference table {name}");
        return None;
    };
    let numbers = |line: &str| line.split(',').map(|x| x.parse().unwrap()).collect();
    Some(text.lines().skip(1).map(numbers).collect())
}
