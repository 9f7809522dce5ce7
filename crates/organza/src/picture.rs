//! Pictures of the frames of a recording: a sequence, or the poster beside a recording.

mod error;
mod paint;
mod view;

pub use error::PictureError;
pub use paint::{Colouring, STRETCH_RANGE};
pub use view::{View, viewpoint};

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

use io_mcap::{OwnedFrame, Recording};

use crate::export::{NumberedFiles, Written, selected};
use crate::record::{FrameRange, RunError, up};
use crate::render::{
    Bounds, Image, Layer, Paint, RenderError, Size, Style, Surface, Viewpoint, draw_with,
};

/// Size of pictures where nothing else is said.
pub const DEFAULT_SIZE: Size = Size::new(1280, 720);

/// What pictures of a sequence look like.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PictureOptions {
    /// Where they are taken from; absent for the camera of the scene, or from outside if it has none.
    pub view: Option<View>,
    /// Their size; absent for that of the scene's camera, or [`DEFAULT_SIZE`].
    pub size: Option<Size>,
    /// Whether the edges of the mesh are drawn.
    pub wireframe: bool,
    /// What the colours show.
    pub colouring: Colouring,
}

/// Draws the garments of a frame, and its obstacles in grey.
///
/// # Errors
/// See [`crate::render::draw`].
pub fn draw_frame(
    frame: &OwnedFrame,
    viewpoint: &Viewpoint,
    size: Size,
    options: &PictureOptions,
    style: &Style,
) -> Result<Image, RenderError> {
    let states = |k: usize| frame.report.get("restraint")?.get("states")?.get(k)?.as_str();
    let garments = frame.garments.iter().enumerate();
    let paints: Vec<_> = garments.map(|(k, g)| options.colouring.of(g, states(k))).collect();
    let garments = frame.garments.iter().zip(&paints).map(|(garment, paint)| Surface {
        points: &garment.points,
        triangles: &garment.triangles,
        paint: paint.borrowed(),
        wireframe: options.wireframe,
    });
    let obstacles = frame.obstacles.iter().map(|obstacle| Surface {
        paint: Paint::OBSTACLE,
        ..Surface::new(&obstacle.points, &obstacle.triangles)
    });
    let layers: Vec<Layer<'_>> = garments.chain(obstacles).map(Layer::Surface).collect();
    draw_with(&layers, viewpoint, size, style)
}

/// Draws the frames `range` of the recording at `path` to files `frame_00000.png` and so on in
/// `folder`, which is made if it is not there; `each` is called after every file with the number of
/// files written and to be written. The view from outside shows everything that happens in the whole recording, so that
/// pictures of several ranges fit together.
///
/// # Errors
/// The recording cannot be read, has none of the frames or no camera to look through, a file exists
/// (unless `overwrite`), or cannot be written. No file is written if one exists.
pub fn render(
    path: &Path,
    range: FrameRange,
    options: &PictureOptions,
    folder: &Path,
    overwrite: bool,
    mut each: impl FnMut(usize, usize),
) -> Result<Written, PictureError> {
    let mut recording = Recording::open(path).map_err(RunError::recording(path))?;
    let frames = selected(&recording, path, range)?;
    let up = up(&recording);
    let bounds = bounds(&mut recording, path)?;
    let style = Style { floor: bounds.lowest(up), ..Style::default() };
    let mut files = None;
    for (k, &index) in frames.iter().enumerate() {
        let frame = recording.frame(index).map_err(RunError::recording(path))?;
        let (viewpoint, size) = viewpoint(&frame, bounds.corners(), up, options)
            .ok_or_else(|| PictureError::NoCamera { path: path.to_owned(), frame: index })?;
        let png = draw_frame(&frame, &viewpoint, size, options, &style)?.encode_png()?;
        // Only now: what cannot be drawn leaves no folder behind.
        let files = match &files {
            Some(files) => files,
            None => {
                files.insert(NumberedFiles::prepare(folder, &["frame"], "png", &frames, overwrite)?)
            }
        };
        files.write("frame", index, |out| out.write_all(&png))?;
        each(k + 1, frames.len());
    }
    Ok(Written { files: frames.len(), status: recording.status() })
}

/// Where the poster of a recording belongs: beside it, by the same name.
pub fn poster_path(recording: &Path) -> PathBuf {
    recording.with_extension("png")
}

/// Draws the last frame of the recording at `path` and writes it to `poster`, through the scene's
/// camera if there is one.
///
/// # Errors
/// The recording cannot be read or has no frame, or the picture cannot be written.
pub fn write_poster(path: &Path, poster: &Path) -> Result<(), PictureError> {
    let mut recording = Recording::open(path).map_err(RunError::recording(path))?;
    let frames = selected(&recording, path, FrameRange::default())?;
    let up = up(&recording);
    let last = frames.last().copied().unwrap_or_default();
    let frame = recording.frame(last).map_err(RunError::recording(path))?;
    let options = PictureOptions::default();
    let points = || points(&frame);
    let style = Style { floor: Bounds::of(points()).lowest(up), ..Style::default() };
    let (viewpoint, size) = viewpoint(&frame, points(), up, &options)
        .ok_or_else(|| PictureError::NoCamera { path: path.to_owned(), frame: last })?;
    Ok(draw_frame(&frame, &viewpoint, size, &options, &style)?.write_png(poster)?)
}

/// The box around everything in a recording.
fn bounds(recording: &mut Recording<File>, path: &Path) -> Result<Bounds, RunError> {
    let mut bounds = Bounds::EMPTY;
    let indices: Vec<u64> = recording.frames().map(|frame| frame.index).collect();
    for index in indices {
        let frame = recording.frame(index).map_err(RunError::recording(path))?;
        bounds.extend(points(&frame));
    }
    Ok(bounds)
}

/// All points that a picture of a frame shows.
fn points(frame: &OwnedFrame) -> impl Iterator<Item = [f64; 3]> + Clone + '_ {
    let garments = frame.garments.iter().map(|garment| &garment.points);
    let obstacles = frame.obstacles.iter().map(|obstacle| &obstacle.points);
    garments.chain(obstacles).flatten().copied()
}
