//! The arguments of all commands.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum, value_parser};
use organza::record::FrameRange;
use organza::render::Size;

/// Offline simulation of adaptive cloth.
#[derive(Debug, Parser)]
#[command(
    name = "organza",
    version,
    arg_required_else_help = true,
    after_help = "\
Examples:
  organza simulate scenes/flag.json5      simulate; writes flag.mcap and flag.png
  organza info flag.mcap                  what happened, frame by frame
  organza render flag.mcap --out pictures
  organza help simulate                   all about one command

Exit codes: 0 done, 1 a run failed half-way, 2 bad input or arguments."
)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Simulate(Simulate),
    Resume(Resume),
    Info(Info),
    Check(Check),
    Export(Export),
    Render(Render),
}

/// Simulate a scene and record it
///
/// Writes a recording (MCAP, which Foxglove shows as it is) and a picture of its last frame beside
/// it. The recording carries the scene and all its files. A run that is killed loses nothing but
/// the frame being made: see `organza resume`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  organza simulate scenes/flag.json5
  organza simulate scenes/flag.json5 --frames 50 --out runs/short.mcap
  organza simulate scenes/hang.json5 --set substeps=10 --set cloths[0].fabric=denim
  organza simulate conf/flag.json --allow-unsupported      a scene of ARCSim")]
pub(crate) struct Simulate {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// Recording to write [default: the scene's name with .mcap, in the working directory]
    #[arg(long, value_name = "RUN.mcap")]
    pub(crate) out: Option<PathBuf>,
    /// Number of frames after the first [default: the scene's]
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..))]
    pub(crate) frames: Option<u32>,
    #[command(flatten)]
    pub(crate) threads: Threads,
    /// Keep a state to continue from every N frames [default: the scene's]
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..))]
    pub(crate) checkpoint_every: Option<u32>,
    /// Replace the recording and its picture if they exist
    #[arg(long)]
    pub(crate) overwrite: bool,
    /// No progress and no summary; warnings and errors still
    #[arg(long, short)]
    pub(crate) quiet: bool,
}

/// Continue a recording that was cut short
///
/// Goes on from the last checkpoint, with the same bits as a run that was never interrupted. Needs
/// no other file. With --frames a finished recording is continued beyond its end.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  organza resume flag.mcap
  organza resume flag.mcap --frames 1000     go on beyond the scene's end")]
pub(crate) struct Resume {
    /// Recording to continue
    #[arg(value_name = "RUN.mcap")]
    pub(crate) recording: PathBuf,
    /// Number of frames after the first [default: as the run was started]
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..))]
    pub(crate) frames: Option<u32>,
    #[command(flatten)]
    pub(crate) threads: Threads,
    /// No progress and no summary; warnings and errors still
    #[arg(long, short)]
    pub(crate) quiet: bool,
}

/// Tell what a recording holds
///
/// Per frame: time, vertices, faces, steps, iterations, seconds by stage. Then what was skipped and
/// why, and smallest, mean and largest values over all frames but the initial state.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  organza info flag.mcap
  organza info flag.mcap --json | jq '.totals[\"seconds.total\"].mean'

The JSON document is one object: recording, software, scene, frames_planned, status {state:
complete|cut|damaged, message}, checkpoints [frame], obstacles [name], attachments [name], frames [report of each
frame], totals {figure: {min, mean, max, sum}}, skipped [stage and why].")]
pub(crate) struct Info {
    /// Recording to read
    #[arg(value_name = "RUN.mcap")]
    pub(crate) recording: PathBuf,
    /// Print one JSON document
    #[arg(long)]
    pub(crate) json: bool,
}

/// Check a scene without running it
///
/// Reads the scene and every file it names, builds all meshes, and prints what would be simulated.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  organza check scenes/flag.json5
  organza check scenes/flag.json5 --set cloths[0].remeshing.size_m.min=0.01")]
pub(crate) struct Check {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
}

/// Write frames as mesh files
///
/// One file per frame: frame_00000.obj and so on. OBJ has a group per garment, exact positions, and
/// material coordinates in metres as texture coordinates; PLY is binary. Obstacles, where the scene
/// has any, are in a second file per frame: obstacles_00000.obj and so on, a group per obstacle.
/// Particles of a fluid are in one more: fluid_00000.ply and so on.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  organza export flag.mcap --format obj --out meshes
  organza export flag.mcap --format ply --out meshes --frames 100..200
  organza export dam-break.mcap --format bgeo --out particles")]
pub(crate) struct Export {
    /// Recording to read
    #[arg(value_name = "RUN.mcap")]
    pub(crate) recording: PathBuf,
    /// Format of the files
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub(crate) format: MeshFormat,
    #[command(flatten)]
    pub(crate) files: Files,
}

/// Draw frames as pictures
///
/// One PNG per frame: frame_00000.png and so on.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  organza render flag.mcap --out pictures
  organza render flag.mcap --out pictures --view outside --wireframe --size 1920x1080
  organza render flag.mcap --out pictures --frames 100 --color stretch")]
pub(crate) struct Render {
    /// Recording to read
    #[arg(value_name = "RUN.mcap")]
    pub(crate) recording: PathBuf,
    #[command(flatten)]
    pub(crate) files: Files,
    /// Through the scene's camera, or from outside so that the whole run is seen [default: camera
    /// if the scene has one]
    #[arg(long, value_enum, value_name = "VIEW")]
    pub(crate) view: Option<View>,
    /// Size of the pictures in pixels [default: that of the scene's camera, or 1280x720]
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub(crate) size: Option<Size>,
    /// Draw the edges of the mesh
    #[arg(long)]
    pub(crate) wireframe: bool,
    /// Draw the frustum of the scene's camera; best with --view outside
    #[arg(long)]
    pub(crate) frustum: bool,
    /// What the colours show
    #[arg(long, value_enum, value_name = "COLOR", default_value_t = Color::Plain)]
    pub(crate) color: Color,
}

/// A scene and how to read it.
#[derive(Debug, Args)]
pub(crate) struct SceneArgs {
    /// Scene file: JSON5 of Organza, or JSON of ARCSim
    #[arg(value_name = "SCENE")]
    pub(crate) scene: PathBuf,
    /// Replace a value of the scene; may be given several times
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub(crate) sets: Vec<String>,
    /// Leave out what is not supported yet, with a warning
    #[arg(long)]
    pub(crate) allow_unsupported: bool,
}

#[derive(Debug, Args)]
pub(crate) struct Threads {
    /// Number of threads [default: one per core]. The result has the same bits with any number
    #[arg(long, value_name = "N", value_parser = value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
}

/// Numbered files to write.
#[derive(Debug, Args)]
pub(crate) struct Files {
    /// Folder for the files; made if it is not there
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Frames A to B-1; also A.. and ..B and A alone [default: all]
    #[arg(long, value_name = "A..B")]
    pub(crate) frames: Option<FrameRange>,
    /// Replace files that exist
    #[arg(long)]
    pub(crate) overwrite: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum MeshFormat {
    /// Wavefront OBJ
    Obj,
    /// Binary PLY
    Ply,
    /// Particles alone, as Partio and SPlisHSPlasH read them
    Bgeo,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum View {
    /// Through the scene's camera
    Camera,
    /// From outside, so that the whole run is seen
    Outside,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Color {
    /// Each garment in its colour; particles blue that move freely, green in transition, red at rest
    Plain,
    /// Larger principal stretch: violet 0.95, green 1, yellow 1.05
    Stretch,
    /// Size of triangles: violet 5 mm, yellow 200 mm
    Size,
    /// View factor of the scene's cameras: violet 0, yellow 1
    View,
    /// What the scene's camera sees: green its front, orange its back, grey what is outside
    Visibility,
    /// Speed of particles, from violet at rest to yellow at the greatest of the recording
    Speed,
    /// Who rests: blue moves freely, green in transition, red stands still
    Restraint,
}

fn size(text: &str) -> Result<Size, String> {
    let [width, height] = text
        .split_once(['x', 'X'])
        .and_then(|(w, h)| Some([w.trim().parse().ok()?, h.trim().parse().ok()?]))
        .ok_or("expected WIDTHxHEIGHT in pixels, such as 1280x720")?;
    let most = organza::scene::limits::MAX_PICTURE_PX;
    if [width, height].iter().any(|side| !(1..=most).contains(side)) {
        return Err(format!("each side must be from 1 to {most} pixels"));
    }
    Ok(Size::new(width, height))
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn arguments_are_consistent_and_every_command_has_examples() {
        let command = Cli::command();
        command.clone().debug_assert();
        for sub in command.get_subcommands() {
            let help = sub.get_after_help().map(ToString::to_string).unwrap_or_default();
            let example = format!("  organza {} ", sub.get_name());
            assert!(help.contains(&example), "{}: {help}", sub.get_name());
        }
    }

    #[test]
    fn sizes() {
        assert_eq!(size("1920x1080"), Ok(Size::new(1920, 1080)));
        for bad in ["", "x", "12", "12x", "0x5", "5x16385", "-1x5", "1e3x4", "1x2x3"] {
            assert!(size(bad).is_err(), "{bad}");
        }
    }
}
