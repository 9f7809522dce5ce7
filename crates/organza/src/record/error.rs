//! What can go wrong in a recorded run, and where in the scene file it comes from.

use std::path::{Path, PathBuf};

use crate::build::BuildError;
use crate::checkpoint::RestoreError;
use crate::scene::{Cloth, IssueKind, Loaded, MeshSource, SceneErrors};
use crate::world::StepError;

/// Why a run could not begin, go on, or be continued.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The scene is wrong, with all places.
    #[error(transparent)]
    Scene(#[from] SceneErrors),
    /// More frames than can be simulated.
    #[error("{frames} frames: {why}")]
    Frames {
        /// Frames asked for.
        frames: u32,
        /// Why they are too many.
        why: String,
    },
    /// The recording cannot be read or written.
    #[error("{}{source}", prefix(path, source))]
    Recording {
        /// The recording.
        path: PathBuf,
        /// What happened.
        source: io_mcap::Error,
    },
    /// A frame could not be finished.
    #[error(transparent)]
    Step(#[from] StepError),
    /// The recording does not hold what is needed.
    #[error("{}: {what}", path.display())]
    Unusable {
        /// The recording.
        path: PathBuf,
        /// What is missing.
        what: String,
    },
    /// A checkpoint does not fit its scene.
    #[error("{}: {source}", path.display())]
    Restore {
        /// The recording.
        path: PathBuf,
        /// Why.
        source: RestoreError,
    },
}

impl RunError {
    pub(crate) fn recording(path: &Path) -> impl FnOnce(io_mcap::Error) -> Self {
        move |source| Self::Recording { path: path.to_owned(), source }
    }
}

/// The file, unless the error names it itself.
pub(crate) fn prefix(path: &Path, error: &io_mcap::Error) -> String {
    match error {
        io_mcap::Error::InFile { .. } => String::new(),
        _ => format!("{}: ", path.display()),
    }
}

/// Finds the place in the scene file to which an error in building its world belongs.
pub fn place(loaded: &Loaded, error: &BuildError) -> SceneErrors {
    let cloths = &loaded.scene.cloths;
    let named = |name: &str, key: &str| match cloths.iter().position(|c| c.name == name) {
        Some(i) => format!("cloths[{i}].{key}"),
        None => "cloths".into(),
    };
    let (path, message) = match error {
        BuildError::Obj { file, source } => {
            let key = |c: &Cloth| match &c.mesh {
                MeshSource::Obj { obj, .. } if obj == file => Some("mesh.obj"),
                MeshSource::Obj { material_obj: Some(material), .. } if material == file => {
                    Some("mesh.material_obj")
                }
                _ => None,
            };
            let found = cloths.iter().enumerate().find_map(|(i, c)| Some((i, key(c)?)));
            let path = found.map_or("cloths".into(), |(i, key)| format!("cloths[{i}].{key}"));
            (path, format!("{file}: {source}"))
        }
        BuildError::Generate { cloth, source } => (named(cloth, "mesh"), source.to_string()),
        BuildError::Garment { cloth, source } => (named(cloth, "mesh"), source.to_string()),
        BuildError::Mesh { cloth, source } => (named(cloth, "mesh"), source.to_string()),
        BuildError::Panel { cloth, message } => (named(cloth, "panel_fabrics"), message.clone()),
        BuildError::Fabric { cloth, source } => (named(cloth, "fabric"), source.to_string()),
        BuildError::Handle { handle, message } => {
            (format!("handles[{handle}].select"), message.clone())
        }
        BuildError::Obstacle { obstacle, message } => {
            (format!("obstacles[{obstacle}].mesh"), message.clone())
        }
        BuildError::Fluid { key, message } => (format!("fluids[0].{key}"), message.clone()),
        BuildError::TooLarge(_) => ("cloths".into(), error.to_string()),
    };
    loaded.places.issue(IssueKind::Value, &path, message).into()
}
