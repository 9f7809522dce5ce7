//! `organza render`.

use organza::picture::{self, Colouring, PictureOptions};

use super::args::{Color, Render, View};
use super::progress::Progress;
use super::{Failure, output};

pub(crate) fn run(args: &Render) -> Result<(), Failure> {
    let (path, files) = (&args.recording, &args.files);
    let options = PictureOptions {
        view: args.view.map(|view| match view {
            View::Camera => picture::View::Camera,
            View::Outside => picture::View::Outside,
        }),
        size: args.size,
        wireframe: args.wireframe,
        colouring: match args.color {
            Color::Plain => Colouring::Plain,
            Color::Stretch => Colouring::Stretch,
            Color::Size => Colouring::Size,
            Color::View => Colouring::View,
            Color::Visibility => Colouring::Visibility,
            Color::Speed => Colouring::Speed,
            Color::Restraint => Colouring::Restraint,
        },
        frustum: args.frustum,
    };
    let range = files.frames.unwrap_or_default();
    let mut progress = None;
    let each = |done: usize, all: usize| {
        let progress = progress.get_or_insert_with(|| Progress::new(0, all as u64, false));
        progress.done(done as u64, || "pictures".to_owned());
    };
    let written = picture::render(path, range, &options, &files.out, files.overwrite, each);
    if let Some(progress) = progress {
        progress.stop();
    }
    let written = written?;
    output::status(path, &written.status);
    output::print(&format!("{} pictures in {}\n", written.files, files.out.display()))
}
