//! The scenes that are put under stress, small enough for many runs, and meshes that begin wrong.

use serde_json::{Value, json};
use std::fmt::Write;
use std::io;
use std::path::Path;

/// A scene.
pub(super) struct Scene {
    pub(super) name: &'static str,
    pub(super) text: fn() -> Value,
}

pub(super) const ALL: &[Scene] = &[
    Scene { name: "hang", text: hang },
    Scene { name: "adaptive", text: adaptive },
    Scene { name: "drape", text: drape },
    Scene { name: "flag", text: flag },
];

/// Cells along each side of the square sheets (1), and the sides (m).
const CELLS: usize = 16;
const SIDE: f64 = 0.8;

fn grid() -> Value {
    json!({ "grid": { "size_m": [SIDE, SIDE], "cells": [CELLS, CELLS] } })
}

/// A sheet that falls and swings on two corners.
fn hang() -> Value {
    json!({
        "cloths": [{ "mesh": grid(), "fabric": "woven-light" }],
        "handles": [{ "select": { "corners": ["upper-left", "upper-right"] } }],
        "camera": { "position": [2.6, -2.2, 0.6], "target": [0.4, 0.6, -0.3] },
    })
}

/// The same sheet, adaptive.
fn adaptive() -> Value {
    let mut scene = hang();
    scene["cloths"][0]["remeshing"] = json!({
        "size_m": { "min": 0.03, "max": 0.2 }, "refine_angle": 0.3, "refine_velocity": 0.5,
        "refine_compression": 0.01,
    });
    scene
}

/// A sheet that falls on a ball, on a table and on itself.
fn drape() -> Value {
    json!({
        "cloths": [{ "mesh": grid(), "fabric": "woven-light",
            "transform": { "translate": [-0.4, -0.37, 0.21] } }],
        "obstacles": [
            { "name": "ball", "mesh": { "sphere": { "radius_m": 0.2, "detail": 3 } } },
            { "name": "table", "mesh": { "plane": { "size_m": [3, 3] } },
              "transform": { "translate": [0, 0, -0.22] } },
        ],
        "contact": {},
        "camera": { "position": [1.3, -1.5, 0.7], "target": [0, 0, 0] },
    })
}

/// A sheet in the wind.
fn flag() -> Value {
    json!({
        "wind": { "velocity": [6, 1, 0] },
        "cloths": [{ "mesh": grid(), "fabric": "woven-light",
            "transform": { "rotate": { "axis": [1, 0, 0], "degrees": 90 } } }],
        "handles": [{ "select": { "sides": ["left"] } }],
        "camera": { "position": [0.5, -2.5, 0.4], "target": [0.4, 0, 0.4] },
    })
}

/// Writes `stretched.obj`, `inverted.obj` and `crumpled.obj`: the square sheet twice as large as its
/// pattern, with every fourth vertex thrown across its neighbours, and gathered at random in a ball.
pub(super) fn write_meshes(folder: &Path) -> io::Result<()> {
    let stretched = |u: [f64; 2]| [2.0 * u[0], 2.0 * u[1], 0.0];
    std::fs::write(folder.join("stretched.obj"), sheet(stretched))?;
    let cell = SIDE / CELLS as f64;
    let inverted = |u: [f64; 2]| {
        let [i, j] = u.map(|c| (c / cell).round() as usize);
        let thrown = if i % 2 == 1 && j % 2 == 1 { 1.6 * cell } else { 0.0 };
        [u[0] + thrown, u[1] + thrown, 0.0]
    };
    std::fs::write(folder.join("inverted.obj"), sheet(inverted))?;
    // Lehmer's generator: enough for places without order.
    const MODULUS: u64 = (1 << 31) - 1;
    let mut seed = 7;
    let mut random = || {
        seed = 48_271 * seed % MODULUS;
        2.0 * seed as f64 / MODULUS as f64 - 1.0
    };
    let crumpled = |_| std::array::from_fn(|_| 0.1 * random());
    std::fs::write(folder.join("crumpled.obj"), sheet(crumpled))
}

/// The square sheet as an OBJ file, its vertices at the places of their material points (m).
fn sheet(mut at: impl FnMut([f64; 2]) -> [f64; 3]) -> String {
    let mut text = String::new();
    let n = CELLS + 1;
    for k in 0..n * n {
        let u = [k % n, k / n].map(|c| c as f64 * SIDE / CELLS as f64);
        let [x, y, z] = at(u);
        // Writing to a String cannot fail.
        let _ = writeln!(text, "v {x} {y} {z}\nvt {} {}", u[0], u[1]);
    }
    for k in (0..CELLS * n).filter(|k| k % n < CELLS) {
        let (a, b, c, d) = (k + 1, k + 2, k + n + 2, k + n + 1);
        let _ = writeln!(text, "f {a}/{a} {b}/{b} {c}/{c}\nf {a}/{a} {c}/{c} {d}/{d}");
    }
    text
}
