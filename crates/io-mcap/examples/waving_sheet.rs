//! Records two seconds of a waving sheet, a rolling ball's place and a camera, to look at in a
//! viewer: `cargo run --release -p io-mcap --example waving_sheet -- sheet.mcap`.

use io_mcap::{
    Camera, Checkpoint, Column, Error, Frame, Garment, Header, Overwrite, Recorder, Transform,
};

/// Points along each side.
const N: usize = 40;
/// Distance of two points (m).
const STEP: f64 = 0.05;

fn main() -> Result<(), Error> {
    let path = std::env::args().nth(1).unwrap_or_else(|| "sheet.mcap".into());
    let header = Header { software: "waving_sheet 1".into(), ..Header::default() };
    let mut recorder = Recorder::create(path, header, Overwrite::Yes)?;
    let uv = |i: usize, j: usize| [i as f64 * STEP, j as f64 * STEP];
    let mut triangles = Vec::new();
    let mut material = Vec::new();
    for (i, j) in (0..N - 1).flat_map(|i| (0..N - 1).map(move |j| (i, j))) {
        for corners in [[(i, j), (i + 1, j), (i, j + 1)], [(i, j + 1), (i + 1, j), (i + 1, j + 1)]]
        {
            triangles.push(corners.map(|(i, j)| (i * N + j) as u32));
            material.push(corners.map(|(i, j)| uv(i, j)));
        }
    }
    for index in 0..50 {
        let time_s = 0.04 * index as f64;
        let points: Vec<[f64; 3]> = (0..N * N)
            .map(|k| {
                let [x, z] = uv(k / N, k % N);
                [x, 0.2 * x * (4.0 * x - 6.0 * time_s).sin(), z]
            })
            .collect();
        let report = serde_json::json!({ "vertices": points.len(), "faces": triangles.len() });
        recorder.frame(&Frame {
            index,
            time_s,
            garments: &[Garment {
                name: "sheet",
                points: &points,
                triangles: &triangles,
                material: &material,
                color: [0.8, 0.3, 0.1, 1.0],
            }],
            obstacles: &[],
            fluid: None,
            // From the side, with z up: x of the picture is x, y of the picture is -z.
            camera: Some(Camera {
                width_px: 640,
                height_px: 480,
                focal_px: [600.0; 2],
                center_px: [320.0, 240.0],
                position: [1.0, -4.0, 1.0],
                rotation: [-0.5f64.sqrt(), 0.0, 0.0, 0.5f64.sqrt()],
            }),
            transforms: &[Transform {
                name: "ball",
                translation: [time_s, 1.0, 0.0],
                rotation: [0.0, 0.0, 0.0, 1.0],
            }],
            report: &report,
        })?;
        if index % 25 == 0 {
            let x = Column::F64(points.into_flattened());
            let columns = vec![("x".to_owned(), x)];
            recorder.checkpoint(&Checkpoint { frame: index, time_s, columns })?;
        }
    }
    recorder.finish()?;
    Ok(())
}
