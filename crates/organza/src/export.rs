//! Frames of a recording as mesh files for other programs, one file per frame.

mod bgeo;
mod error;
mod files;
mod obj;
mod ply;

pub use bgeo::write_fluid_bgeo;
pub use error::ExportError;
pub use files::{FilesError, NumberedFiles};
pub use obj::{write_fluid_obj, write_obj, write_obstacles_obj};
pub use ply::{write_fluid_ply, write_obstacles_ply, write_ply};

use std::fs::File;
use std::io::{self, Write};
use std::path::Path;

use io_mcap::{OwnedGarment, OwnedObstacle, Particle, Recording, Status};

use crate::record::{FLUID, FrameRange, OBSTACLES, RunError};

/// A format of mesh files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Wavefront OBJ, see [`write_obj`].
    Obj,
    /// Binary PLY, see [`write_ply`].
    Ply,
    /// Particles alone, as Partio and SPlisHSPlasH read them, see [`write_fluid_bgeo`].
    Bgeo,
}

impl Format {
    /// How names of its files end.
    pub fn extension(self) -> &'static str {
        match self {
            Format::Obj => "obj",
            Format::Ply => "ply",
            Format::Bgeo => "bgeo",
        }
    }

    /// Writes the garments of one frame.
    ///
    /// # Errors
    /// Those of `out`, and `InvalidInput` for a coordinate that is not finite or a format without
    /// meshes.
    pub fn write(self, out: &mut impl Write, garments: &[OwnedGarment]) -> io::Result<()> {
        match self {
            Format::Obj => write_obj(out, garments),
            Format::Ply => write_ply(out, garments),
            Format::Bgeo => Err(no_meshes()),
        }
    }

    /// Writes the particles of one frame.
    ///
    /// # Errors
    /// Those of `out`, and `InvalidInput` for a coordinate that is not finite.
    pub fn write_fluid(self, out: &mut impl Write, particles: &[Particle]) -> io::Result<()> {
        match self {
            Format::Obj => write_fluid_obj(out, particles),
            Format::Ply => write_fluid_ply(out, particles),
            Format::Bgeo => write_fluid_bgeo(out, particles),
        }
    }

    /// Writes the obstacles of one frame.
    ///
    /// # Errors
    /// As for [`Format::write`].
    pub fn write_obstacles(
        self,
        out: &mut impl Write,
        obstacles: &[OwnedObstacle],
    ) -> io::Result<()> {
        match self {
            Format::Obj => write_obstacles_obj(out, obstacles),
            Format::Ply => write_obstacles_ply(out, obstacles),
            Format::Bgeo => Err(no_meshes()),
        }
    }
}

/// What was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// Number of files.
    pub files: usize,
    /// Whether the recording is whole: frames may be missing from one that is not.
    pub status: Status,
}

/// Writes the frames `range` of the recording at `path` to files `frame_00000.obj` and so on in
/// `folder`, which is made if it is not there. Obstacles, where there are any, go to files of their
/// own beside them, `obstacles_00000.obj` and so on; so do the particles of a fluid,
/// `fluid_00000.obj`. `each` is called after every frame with the
/// number of frames written and to be written.
///
/// # Errors
/// The recording cannot be read, has none of the frames, a file exists (unless `overwrite`), or
/// cannot be written. No file is written if one exists.
pub fn export(
    path: &Path,
    format: Format,
    range: FrameRange,
    folder: &Path,
    overwrite: bool,
    mut each: impl FnMut(usize, usize),
) -> Result<Written, ExportError> {
    let mut recording = Recording::open(path).map_err(RunError::recording(path))?;
    let frames = selected(&recording, path, range)?;
    // Obstacles come and go; the recording names all of them.
    let with_meshes = format != Format::Bgeo;
    let with_obstacles = with_meshes && recording.metadata().contains_key(OBSTACLES);
    let with_fluid = recording.metadata().contains_key(FLUID);
    if !with_meshes && !with_fluid {
        return Err(ExportError::NoFluid { path: path.to_owned() });
    }
    let first = recording.frame(frames[0]).map_err(RunError::recording(path))?;
    let with_garments = with_meshes && !(with_fluid && first.garments.is_empty());
    let parts = [(with_garments, "frame"), (with_obstacles, "obstacles"), (with_fluid, "fluid")];
    let names: Vec<&str> = parts.iter().filter(|(with, _)| *with).map(|(_, n)| *n).collect();
    let files = NumberedFiles::prepare(folder, &names, format.extension(), &frames, overwrite)?;
    for (k, &index) in frames.iter().enumerate() {
        let frame = recording.frame(index).map_err(RunError::recording(path))?;
        for &name in &names {
            files.write(name, index, |out| match name {
                "frame" => format.write(out, &frame.garments),
                "obstacles" => format.write_obstacles(out, &frame.obstacles),
                _ => format.write_fluid(out, frame.fluid.as_deref().unwrap_or_default()),
            })?;
        }
        each(k + 1, frames.len());
    }
    Ok(Written { files: names.len() * frames.len(), status: recording.status() })
}

/// The frames of `range` that a recording has.
pub(crate) fn selected(
    recording: &Recording<File>,
    path: &Path,
    range: FrameRange,
) -> Result<Vec<u64>, ExportError> {
    let all: Vec<u64> = recording.frames().map(|frame| frame.index).collect();
    let frames: Vec<u64> = all.iter().copied().filter(|&k| range.contains(k)).collect();
    if frames.is_empty() {
        let held = match (all.first(), all.last()) {
            (Some(a), Some(b)) => format!("it holds frames {a} to {b}"),
            _ => format!("it holds no frame: {}", recording.status()),
        };
        return Err(ExportError::NoFrames { path: path.to_owned(), range, held });
    }
    Ok(frames)
}

fn no_meshes() -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, "the format has no meshes")
}

/// Refuses numbers that other programs cannot read.
fn check_finite(garments: &[OwnedGarment]) -> io::Result<()> {
    for OwnedGarment { name, points, material, .. } in garments {
        check_points("garment", name, points)?;
        let broken = |u: &[[f64; 2]; 3]| !u.as_flattened().iter().all(|c| c.is_finite());
        if let Some(k) = material.iter().position(broken) {
            let what = format!("garment {name:?}: a material coordinate of triangle {k}");
            return Err(not_finite(&what));
        }
    }
    Ok(())
}

fn check_points(kind: &str, name: &str, points: &[[f64; 3]]) -> io::Result<()> {
    match points.iter().position(|x| !x.iter().all(|c| c.is_finite())) {
        Some(k) => Err(not_finite(&format!("{kind} {name:?}: the position of point {k}"))),
        None => Ok(()),
    }
}

fn check_particles(particles: &[Particle]) -> io::Result<()> {
    match particles.iter().find(|p| !p.position.iter().all(|c| c.is_finite())) {
        Some(p) => Err(not_finite(&format!("the position of particle {}", p.id))),
        None => Ok(()),
    }
}

fn not_finite(what: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, format!("{what} is not finite"))
}
