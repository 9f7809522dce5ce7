//! Any frames and checkpoints come back with the same bits.

mod common;

use std::collections::BTreeMap;

use common::{checkpoint_bits, frame_bits, lend, open};
use io_mcap::{
    Attachment, Camera, Checkpoint, Column, Header, OwnedFrame, OwnedGarment, OwnedObstacle,
    OwnedTransform, Particle, Recorder, Status,
};
use proptest::collection::{btree_map, vec};
use proptest::prelude::*;

/// Any bits at all, with the special ones often. Not signalling NaN: only of a column are all
/// bits promised on every machine.
fn number() -> impl Strategy<Value = f64> {
    let any_bits = any::<u64>().prop_map(|bits| {
        let x = f64::from_bits(bits);
        if x.is_nan() { f64::from_bits(bits | 1 << 51) } else { x }
    });
    prop_oneof![4 => any_bits, 1 => Just(-0.0), 1 => Just(0.0), 1 => Just(5e-324)]
}

fn triple() -> impl Strategy<Value = [f64; 3]> {
    [number(), number(), number()]
}

fn quadruple() -> impl Strategy<Value = [f64; 4]> {
    [number(), number(), number(), number()]
}

fn garment() -> impl Strategy<Value = OwnedGarment> {
    (1usize..20)
        .prop_flat_map(|n| {
            // Few distinct coordinates, so that some corners share theirs and some do not.
            let uv = prop_oneof![number(), Just(0.5), Just(1.5)];
            let corner = (0..n as u32, [uv.clone(), uv]);
            let triangle = [corner.clone(), corner.clone(), corner];
            (vec(triple(), n), vec(triangle, 0..30), any::<[f32; 4]>())
        })
        .prop_map(|(points, corners, color)| OwnedGarment {
            name: String::new(),
            points,
            triangles: corners.iter().map(|t| t.map(|(p, _)| p)).collect(),
            material: corners.iter().map(|t| t.map(|(_, uv)| uv)).collect(),
            color,
        })
}

/// The mesh of a garment as an obstacle.
fn obstacle() -> impl Strategy<Value = OwnedObstacle> {
    garment().prop_map(|OwnedGarment { name, points, triangles, color, .. }| OwnedObstacle {
        name,
        points,
        triangles,
        color,
    })
}

fn camera() -> impl Strategy<Value = Camera> {
    (any::<[u32; 2]>(), quadruple(), triple(), quadruple()).prop_map(
        |([width_px, height_px], [fx, fy, cx, cy], position, rotation)| Camera {
            width_px,
            height_px,
            focal_px: [fx, fy],
            center_px: [cx, cy],
            position,
            rotation,
        },
    )
}

fn frame() -> impl Strategy<Value = OwnedFrame> {
    let garments = btree_map("[a-zé /]{1,8}", garment(), 0..3);
    let obstacles = btree_map("[a-zé /]{1,8}", obstacle(), 0..3);
    let transforms = btree_map("t.{0,5}", (triple(), quadruple()), 0..3);
    let report = btree_map(".{0,6}", prop_oneof![number(), Just(0.1)], 0..5);
    let meshes = (garments, obstacles);
    (meshes, transforms, proptest::option::of(camera()), report, 0.0..1.0f64, 1u64..50).prop_map(
        |((garments, obstacles), transforms, camera, report, time_s, index)| OwnedFrame {
            // Steps for now; summed up when the frames are in a row.
            index,
            time_s,
            garments: garments.into_iter().map(|(name, g)| OwnedGarment { name, ..g }).collect(),
            obstacles: obstacles.into_iter().map(|(name, o)| OwnedObstacle { name, ..o }).collect(),
            fluid: (index % 2 == 0).then(|| vec![Particle { speed: 0.5, ..Particle::default() }]),
            camera,
            transforms: transforms
                .into_iter()
                .map(|(name, (translation, rotation))| OwnedTransform {
                    name,
                    translation,
                    rotation,
                })
                .collect(),
            report: serde_json::json!(report),
        },
    )
}

fn frames() -> impl Strategy<Value = Vec<OwnedFrame>> {
    vec(frame(), 0..5).prop_map(|mut frames| {
        for k in 1..frames.len() {
            frames[k].index += frames[k - 1].index;
            frames[k].time_s += frames[k - 1].time_s;
        }
        frames
    })
}

fn columns() -> impl Strategy<Value = Vec<(String, Column)>> {
    let column = prop_oneof![
        vec(any::<u64>().prop_map(f64::from_bits), 0..40).prop_map(Column::F64),
        vec(any::<u32>(), 0..40).prop_map(Column::U32),
        vec(any::<u64>(), 0..40).prop_map(Column::U64),
        ".{0,20}".prop_map(Column::Text),
    ];
    vec((".{0,8}", column), 0..5)
}

fn header() -> impl Strategy<Value = Header> {
    let metadata = btree_map("[a-z.]{0,4}", ".{0,8}", 0..3);
    let attachments = btree_map(".{1,8}", vec(any::<u8>(), 0..100), 0..3);
    (".{0,10}", metadata, attachments).prop_map(|(software, metadata, attachments)| Header {
        software,
        metadata,
        attachments: BTreeMap::into_iter(attachments)
            .map(|(name, data)| Attachment { name, media_type: "a/b".into(), data })
            .collect(),
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, failure_persistence: None, ..Default::default() })]

    #[test]
    fn round_trip(
        header in header(),
        frames in frames(),
        columns in columns(),
        every in 1usize..4,
        cut in 0.0..1.0f64,
    ) {
        let checkpoint = |frame: &OwnedFrame| Checkpoint {
            frame: frame.index,
            time_s: frame.time_s,
            columns: columns.clone(),
        };
        let mut recorder = Recorder::new(Vec::new(), header.clone()).unwrap();
        for (k, frame) in frames.iter().enumerate() {
            lend(frame, |f| recorder.frame(f)).unwrap();
            if k % every == 0 {
                recorder.checkpoint(&checkpoint(frame)).unwrap();
            }
        }
        let bytes = recorder.finish().unwrap();
        let mut recording = open(&bytes).unwrap();
        prop_assert_eq!(recording.verify().unwrap(), Status::Complete);
        prop_assert_eq!(recording.header().unwrap(), header);
        prop_assert_eq!(recording.frames().len(), frames.len());
        for (k, frame) in frames.iter().enumerate() {
            let read = recording.frame(frame.index).unwrap();
            prop_assert_eq!(frame_bits(&read), frame_bits(frame));
            prop_assert_eq!(&recording.report(frame.index).unwrap(), &frame.report);
            if k % every == 0 {
                let read = recording.checkpoint(frame.index).unwrap();
                prop_assert_eq!(checkpoint_bits(&read), checkpoint_bits(&checkpoint(frame)));
            }
        }

        // Cut anywhere, what can be read is right.
        let cut = (cut * bytes.len() as f64) as usize;
        if let Ok(mut recording) = open(&bytes[..cut]) {
            let n = recording.frames().len();
            for frame in &frames[..n] {
                let read = recording.frame(frame.index).unwrap();
                prop_assert_eq!(frame_bits(&read), frame_bits(frame));
            }
        }
    }
}
