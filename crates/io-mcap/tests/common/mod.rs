//! Frames to record, and comparison of what comes back, bit by bit.

#![allow(dead_code, reason = "every test takes what it needs")]

use std::collections::BTreeMap;
use std::io::{self, Cursor, Write};
use std::path::PathBuf;
use std::sync::{Arc, Mutex};

use io_mcap::{
    Attachment, Camera, Checkpoint, Column, Frame, Header, Limits, OwnedFrame, OwnedGarment,
    OwnedObstacle, OwnedTransform, Particle, Recorder, Recording,
};

/// SplitMix64.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub(crate) fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    pub(crate) fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// A square of `n` × `n` points with random heights; its material coordinates jump at the middle
/// if it has a `seam`.
pub(crate) fn sheet(name: &str, n: usize, seam: bool, random: &mut Random) -> OwnedGarment {
    let at = |i: usize, j: usize| (i * n + j) as u32;
    let mut triangles = Vec::new();
    let mut material = Vec::new();
    for i in 0..n - 1 {
        for j in 0..n - 1 {
            let shift = if seam && i >= n / 2 { 10.0 } else { 0.0 };
            let uv =
                |di: usize, dj: usize| [shift + (i + di) as f64 / 3.0, (j + dj) as f64 / 7.0 - 0.0];
            triangles.push([at(i, j), at(i + 1, j), at(i, j + 1)]);
            material.push([uv(0, 0), uv(1, 0), uv(0, 1)]);
            triangles.push([at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)]);
            material.push([uv(0, 1), uv(1, 0), uv(1, 1)]);
        }
    }
    let points = (0..n * n).map(|k| [(k / n) as f64, (k % n) as f64, random.unit() - 0.5]);
    OwnedGarment {
        name: name.into(),
        points: points.collect(),
        triangles,
        material,
        color: [0.1, 0.2, 0.3, 1.0],
    }
}

/// An obstacle that is elsewhere in every frame. Its name may be that of a garment.
pub(crate) fn tetrahedron(name: &str, index: u64) -> OwnedObstacle {
    let z = -0.1 * index as f64;
    OwnedObstacle {
        name: name.into(),
        points: vec![[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z], [0.0, -0.0, z + 1.0]],
        triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
        color: [0.5, 0.5, 0.5, 1.0],
    }
}

/// A particle, the first with numbers that are none.
fn particle(id: u32) -> Particle {
    Particle {
        id,
        position: [0.1 * f64::from(id), -0.0, f64::from_bits(0x7ff8_0000_0000_0005)],
        velocity: [-0.0, f32::from_bits(0x7fc0_0001), f32::MIN_POSITIVE],
        speed: 0.5,
        density: 1000.0 + id as f32,
        state: (id % 3) as u8,
    }
}

pub(crate) fn frame(index: u64) -> OwnedFrame {
    let mut random = Random(index);
    let mut garments = vec![
        sheet("flag", 6 + index as usize % 3, false, &mut random),
        sheet("tube", 7, true, &mut random),
    ];
    garments[0].points[1] = [-0.0, f64::MIN_POSITIVE / 8.0, f64::INFINITY];
    garments[1].points[2][0] = f64::from_bits(0x7ff8_0000_dead_beef);
    garments[1].material[3][1][0] = -0.0;
    OwnedFrame {
        index,
        time_s: 0.1 * index as f64,
        garments,
        obstacles: (0..index.min(2)).map(|k| tetrahedron(&format!("rock-{k}"), index)).collect(),
        fluid: (index % 3 != 1).then(|| (0..index as u32).map(particle).collect()),
        camera: (index % 4 != 3).then(|| Camera {
            width_px: 1920,
            height_px: 1080,
            focal_px: [1500.0 + random.unit(), 1499.0],
            center_px: [960.0, 540.0],
            position: [random.unit(), -0.0, 2.0],
            rotation: [0.5, 0.5, -0.5, 0.5],
        }),
        transforms: (0..index % 3)
            .map(|k| OwnedTransform {
                name: format!("sphere-{k}"),
                translation: [random.unit(), 0.0, -0.0],
                rotation: [0.0, 0.0, 0.0, 1.0],
            })
            .collect(),
        report: serde_json::json!({
            "frame": index,
            "seconds": random.unit() * 1e-3,
            "stages": { "solve": [0.1 + 0.2, 1e300, 5e-324], "skipped": "self-contact" },
        }),
    }
}

pub(crate) fn checkpoint(index: u64) -> Checkpoint {
    let mut random = Random(!index);
    let mut x: Vec<f64> = (0..200).map(|_| f64::from_bits(random.next())).collect();
    x.extend([-0.0, f64::from_bits(1), f64::from_bits(0x7ff0_0000_0000_0001)]);
    Checkpoint {
        frame: index,
        time_s: 0.1 * index as f64,
        columns: vec![
            ("cloth.x".into(), Column::F64(x)),
            ("cloth.triangles".into(), Column::U32((0..99).collect())),
            ("cloth.uid".into(), Column::U64(vec![u64::MAX, 0, random.next()])),
            ("scene".into(), Column::Text("{\"wind\": \"↗\"}".into())),
            ("none".into(), Column::F64(Vec::new())),
        ],
    }
}

pub(crate) fn header() -> Header {
    let attachment = |name: &str, n: usize| Attachment {
        name: name.into(),
        media_type: "text/plain".into(),
        data: (0..n).map(|k| (k * k % 251) as u8).collect(),
    };
    Header {
        software: "organza 0.1.0".into(),
        metadata: BTreeMap::from([("threads".into(), "2".into()), ("seed".into(), "17".into())]),
        attachments: vec![attachment("flag.json5", 700), attachment("flag.obj", 20_000)],
    }
}

/// Lends `frame` to `use_it` as the recorder takes it.
pub(crate) fn lend<T>(frame: &OwnedFrame, use_it: impl FnOnce(&Frame<'_>) -> T) -> T {
    let garments: Vec<_> = frame.garments.iter().map(|g| g.borrowed()).collect();
    let obstacles: Vec<_> = frame.obstacles.iter().map(|o| o.borrowed()).collect();
    let transforms: Vec<_> = frame.transforms.iter().map(|t| t.borrowed()).collect();
    use_it(&Frame {
        index: frame.index,
        time_s: frame.time_s,
        garments: &garments,
        obstacles: &obstacles,
        fluid: frame.fluid.as_deref(),
        camera: frame.camera,
        transforms: &transforms,
        report: &frame.report,
    })
}

/// Records `frame(index)`, and a checkpoint at every third.
pub(crate) fn record<W: Write>(recorder: &mut Recorder<W>, index: u64) {
    lend(&frame(index), |f| recorder.frame(f)).unwrap();
    if index.is_multiple_of(3) {
        recorder.checkpoint(&checkpoint(index)).unwrap();
    }
}

/// Bytes that can be looked at while they are being written.
#[derive(Clone, Default)]
pub(crate) struct Shared(pub(crate) Arc<Mutex<Vec<u8>>>);

impl Shared {
    pub(crate) fn bytes(&self) -> Vec<u8> {
        self.0.lock().unwrap().clone()
    }
}

impl Write for Shared {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.lock().unwrap().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// A whole recording of `n` frames, and its length after each frame and checkpoint.
pub(crate) fn recording_of(n: u64) -> (Vec<u8>, Vec<usize>) {
    let shared = Shared::default();
    let mut recorder = Recorder::new(shared.clone(), header()).unwrap();
    let mut lengths = Vec::new();
    for index in 0..n {
        record(&mut recorder, index);
        lengths.push(shared.bytes().len());
    }
    recorder.finish().unwrap();
    (shared.bytes(), lengths)
}

pub(crate) fn open(bytes: &[u8]) -> Result<Recording<Cursor<&[u8]>>, io_mcap::Error> {
    Recording::read(Cursor::new(bytes), Limits::default())
}

/// Everything in a frame as bits, so that NaN equals itself and -0.0 is not 0.0.
pub(crate) fn frame_bits(frame: &OwnedFrame) -> String {
    let f64s = |values: &[f64]| values.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    let garments: Vec<_> = frame
        .garments
        .iter()
        .map(|g| {
            (
                &g.name,
                f64s(g.points.as_flattened()),
                &g.triangles,
                f64s(g.material.as_flattened().as_flattened()),
                g.color.map(f32::to_bits),
            )
        })
        .collect();
    let obstacles: Vec<_> = frame
        .obstacles
        .iter()
        .map(|o| (&o.name, f64s(o.points.as_flattened()), &o.triangles, o.color.map(f32::to_bits)))
        .collect();
    let fluid = frame.fluid.as_ref().map(|particles| {
        let bits = |p: &Particle| {
            let singles = [&p.velocity[..], &[p.speed, p.density]].concat();
            let singles: Vec<u32> = singles.into_iter().map(f32::to_bits).collect();
            (p.id, f64s(&p.position), singles, p.state)
        };
        particles.iter().map(bits).collect::<Vec<_>>()
    });
    let camera = frame.camera.map(|c| {
        let numbers = [&c.focal_px[..], &c.center_px, &c.position, &c.rotation].concat();
        (c.width_px, c.height_px, f64s(&numbers))
    });
    let transforms: Vec<_> = frame
        .transforms
        .iter()
        .map(|t| (&t.name, f64s(&[&t.translation[..], &t.rotation].concat())))
        .collect();
    let (index, time_s, report) = (frame.index, frame.time_s.to_bits(), &frame.report);
    format!(
        "{index} {time_s} {garments:?} {obstacles:?} {fluid:?} {camera:?} {transforms:?} {report}"
    )
}

/// Everything in a checkpoint as bits.
pub(crate) fn checkpoint_bits(checkpoint: &Checkpoint) -> String {
    let columns: Vec<_> = checkpoint
        .columns
        .iter()
        .map(|(name, column)| match column {
            Column::F64(values) => {
                format!("{name} {:?}", values.iter().map(|x| x.to_bits()).collect::<Vec<_>>())
            }
            other => format!("{name} {other:?}"),
        })
        .collect();
    format!("{} {} {columns:?}", checkpoint.frame, checkpoint.time_s.to_bits())
}

/// A path for a file that no other test uses; no file is there.
pub(crate) fn path(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("io-mcap");
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join(name);
    let _ = std::fs::remove_file(&path);
    path
}
