//! Pictures of the frames of a recording: a sequence, or the poster beside a recording.

mod beads;
mod error;
mod paint;
mod sight;
mod view;

pub use beads::Beads;
pub use error::PictureError;
pub use paint::{Colouring, SIZE_RANGE_M, STRETCH_RANGE};
pub use sight::Sight;
pub use view::{View, viewpoint};

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

use io_mcap::{OwnedFrame, Recording};

use crate::export::{NumberedFiles, Written, selected};
use crate::record::{FrameRange, RunError, up};
use crate::render::{
    Bounds, Image, Layer, Lines, Paint, RenderError, Size, Style, Surface, Viewpoint, draw_with,
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
    /// Whether the frustum of the scene's camera is drawn.
    pub frustum: bool,
}

impl PictureOptions {
    /// Whether pictures depend on what the cameras of the scene see.
    fn looks(&self) -> bool {
        self.frustum || matches!(self.colouring, Colouring::View | Colouring::Visibility)
    }
}

/// Draws the garments of a frame, its obstacles in grey, and its particles as `beads`. What depends on cameras needs `sight`, and
/// is left out without.
///
/// # Errors
/// See [`crate::render::draw`].
pub fn draw_frame(
    frame: &OwnedFrame,
    viewpoint: &Viewpoint,
    size: Size,
    options: &PictureOptions,
    beads: &Beads,
    style: &Style,
    sight: Option<&Sight>,
) -> Result<Image, RenderError> {
    let fluid = frame.fluid.as_ref().map(|particles| beads.draw(particles, options.colouring));
    let states = |k: usize| frame.report.get("restraint")?.get("states")?.get(k)?.as_str();
    let garments = frame.garments.iter().enumerate();
    let paint = |(k, garment)| options.colouring.of(garment, states(k), frame.index, sight);
    let paints: Vec<_> = garments.map(paint).collect();
    let edges = sight.filter(|_| options.frustum).map(|sight| sight.frustum(frame));
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
    let surfaces = garments.chain(obstacles).chain(fluid.iter().map(|f| f.surface()));
    let mut layers: Vec<Layer<'_>> = surfaces.map(Layer::Surface).collect();
    layers.extend(edges.iter().map(|edges| Layer::Lines(Lines::new(edges))));
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
    let sight = options.looks().then(|| Sight::of(&mut recording, path)).transpose()?;
    let (bounds, beads) = whole(&mut recording, path, sight.as_ref().filter(|_| options.frustum))?;
    let style = Style { floor: bounds.lowest(up), ..Style::default() };
    let mut files = None;
    for (k, &index) in frames.iter().enumerate() {
        let frame = recording.frame(index).map_err(RunError::recording(path))?;
        let (viewpoint, size) = viewpoint(&frame, bounds.corners(), up, options)
            .ok_or_else(|| PictureError::NoCamera { path: path.to_owned(), frame: index })?;
        let png = draw_frame(&frame, &viewpoint, size, options, &beads, &style, sight.as_ref())?;
        let png = png.encode_png()?;
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
    let mut beads = Beads::of(&recording)?;
    beads.note(frame.fluid.as_deref().unwrap_or_default());
    let image = draw_frame(&frame, &viewpoint, size, &options, &beads, &style, None)?;
    Ok(image.write_png(poster)?)
}

/// The box around everything in a recording, with the frustums where `sight` shows them, and what its
/// particles look like.
fn whole(
    recording: &mut Recording<File>,
    path: &Path,
    sight: Option<&Sight>,
) -> Result<(Bounds, Beads), RunError> {
    let (mut bounds, mut beads) = (Bounds::EMPTY, Beads::of(recording)?);
    let indices: Vec<u64> = recording.frames().map(|frame| frame.index).collect();
    for index in indices {
        let frame = recording.frame(index).map_err(RunError::recording(path))?;
        bounds.extend(points(&frame));
        bounds.extend(sight.iter().flat_map(|sight| sight.frustum(&frame)).flatten());
        beads.note(frame.fluid.as_deref().unwrap_or_default());
    }
    Ok((bounds, beads))
}

/// All points that a picture of a frame shows.
fn points(frame: &OwnedFrame) -> impl Iterator<Item = [f64; 3]> + Clone + '_ {
    let garments = frame.garments.iter().map(|garment| &garment.points);
    let obstacles = frame.obstacles.iter().map(|obstacle| &obstacle.points);
    let fluid = frame.fluid.iter().flatten().map(|particle| particle.position);
    garments.chain(obstacles).flatten().copied().chain(fluid)
}
