//! `organza export`.

use organza::export::{Format, export};

use super::args::{Export, MeshFormat};
use super::progress::Progress;
use super::{Failure, output};

pub(crate) fn run(args: &Export) -> Result<(), Failure> {
    let (path, files) = (&args.recording, &args.files);
    let format = match args.format {
        MeshFormat::Obj => Format::Obj,
        MeshFormat::Ply => Format::Ply,
        MeshFormat::Bgeo => Format::Bgeo,
    };
    let range = files.frames.unwrap_or_default();
    let mut progress = None;
    let each = |done: usize, all: usize| {
        let progress = progress.get_or_insert_with(|| Progress::new(0, all as u64, false));
        progress.done(done as u64, || format.extension().to_owned());
    };
    let written = export(path, format, range, &files.out, files.overwrite, each);
    if let Some(progress) = progress {
        progress.stop();
    }
    let written = written?;
    output::status(path, &written.status);
    let (n, extension) = (written.files, format.extension());
    output::print(&format!("{n} {extension} files in {}\n", files.out.display()))
}
