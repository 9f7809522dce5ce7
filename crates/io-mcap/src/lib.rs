//! Recordings of simulations: write them, read them, recover them, continue them.
//!
//! A recording is one [MCAP](https://mcap.dev) file. Foxglove draws it as it is; any reader of
//! MCAP decodes it, as every message is described in the file. This crate is the only one that
//! knows the format: plain slices go in, plain data comes out.
//!
//! | Topic | Message | When |
//! |---|---|---|
//! | `/cloth` | `foxglove.SceneUpdate`: one indexed triangle list per garment, in doubles | every frame |
//! | `/cloth/material` | `organza.ClothMaterial`: material coordinates of every triangle corner | every frame |
//! | `/obstacles` | `foxglove.SceneUpdate`: one indexed triangle list per obstacle, in doubles | every frame, if there are any |
//! | `/fluid` | `foxglove.PointCloud`: a point per particle with velocity, speed, density, number and state | every frame, if there is a fluid |
//! | `/tf` | `foxglove.FrameTransforms`: rigid transforms into `world`, the camera's among them | if there are any |
//! | `/camera` | `foxglove.CameraCalibration` | if there is a camera |
//! | `/frame` | `organza.FrameMark`: frame index, exact time | every frame |
//! | `/report` | a JSON object of the caller's; ends the frame | every frame |
//! | `/checkpoint` | `organza.Checkpoint`: exact state, with a CRC of its own | when asked for |
//!
//! Metadata and attachments (scene, meshes, materials) come first. A frame is two chunks, the
//! meshes and the end of the frame, compressed with zstd and checked by CRC; both are handed to
//! the operating system before the next frame begins. So a run killed at any moment leaves a
//! file from which every completed frame can be read, and [`Recorder::resume`] continues it.
//! Every number read back has the bits that were written.
//!
//! # Example
//! ```
//! use io_mcap::{Frame, Garment, Header, Limits, Recorder, Recording, Status};
//! use serde_json::json;
//! use std::io::Cursor;
//!
//! # fn main() -> Result<(), io_mcap::Error> {
//! let header = Header { software: "example 1.0".into(), ..Header::default() };
//! // Recorder::create(path, header, Overwrite::No) records to a file.
//! let mut recorder = Recorder::new(Vec::new(), header)?;
//! for index in 0..2 {
//!     let time_s = 0.04 * index as f64;
//!     let fall = -0.5 * 9.81 * time_s * time_s;
//!     let garment = Garment {
//!         name: "scarf",
//!         points: &[[0.0, 0.0, fall], [1.0, 0.0, fall], [0.0, 1.0, fall]],
//!         triangles: &[[0, 1, 2]],
//!         material: &[[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]],
//!         color: [0.8, 0.1, 0.1, 1.0],
//!     };
//!     recorder.frame(&Frame {
//!         index,
//!         time_s,
//!         garments: &[garment],
//!         obstacles: &[],
//!         fluid: None,
//!         camera: None,
//!         transforms: &[],
//!         report: &json!({ "substeps": 8 }),
//!     })?;
//! }
//! let file = recorder.finish()?;
//!
//! // Recording::open(path) reads from a file.
//! let mut recording = Recording::read(Cursor::new(file), Limits::default())?;
//! assert_eq!(recording.status(), Status::Complete);
//! assert_eq!(recording.frames().len(), 2);
//! let frame = recording.frame(1)?;
//! assert_eq!(frame.garments[0].points[1], [1.0, 0.0, -0.5 * 9.81 * 0.04 * 0.04]);
//! assert_eq!(recording.report(1)?["substeps"], 8);
//! # Ok(())
//! # }
//! ```

#![warn(missing_docs)]
#![forbid(unsafe_code)]

mod checkpoint;
mod chunk;
mod decode;
mod encode;
mod error;
mod fluid;
mod frame;
mod header;
mod limits;
mod material;
mod proto;
mod recorder;
mod recording;
mod recording_file;
mod records;
mod resume;
mod scan;
mod schema;
mod source;
mod status;
mod stream;
mod topic;

pub use checkpoint::{Checkpoint, CheckpointInfo, Column};
pub use error::Error;
pub use frame::{
    Camera, Frame, FrameInfo, Garment, Obstacle, OwnedFrame, OwnedGarment, OwnedObstacle,
    OwnedTransform, Particle, Transform,
};
pub use header::{Attachment, AttachmentInfo, Header, Overwrite};
pub use limits::Limits;
pub use recorder::Recorder;
pub use recording::Recording;
pub use recording_file::RecordingFile;
pub use status::Status;
