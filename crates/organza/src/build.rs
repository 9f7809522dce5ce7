//! From a scene's data to meshes, fabrics, handles and obstacles.

mod fabric;
mod obstacle;
mod piece;

pub(crate) use piece::Piece;

use crate::contact::ContactSettings;
use crate::fluid::{self, Water};
use crate::handles::Handles;
use crate::obstacle::Obstacle;
use crate::scene::{self, Loaded, MeshSource, Scene, limits};
use cloth_dynamics::Fabric;
use cloth_dynamics::law::NotPositive;
use mannequin::MannequinError;
use mesh_core::generate::GenerateError;
use mesh_core::obj::ObjError;
use mesh_core::{ClothState, Material2, Mesh, MeshError, World3};
use nalgebra::Similarity3;

/// Why a scene that reads well cannot be built.
#[derive(Debug, thiserror::Error)]
pub enum BuildError {
    /// A mesh file is not usable.
    #[error("{file}: {source}")]
    Obj {
        /// Name of the file.
        file: String,
        /// What is wrong, with its line.
        source: ObjError,
    },
    /// A generator refused its sizes.
    #[error("cloth `{cloth}`: {source}")]
    Generate {
        /// Name of the cloth.
        cloth: String,
        /// What is wrong.
        source: GenerateError,
    },
    /// There is no such garment.
    #[error("cloth `{cloth}`: {source}")]
    Garment {
        /// Name of the cloth.
        cloth: String,
        /// What is wrong.
        source: MannequinError,
    },
    /// The mesh is not usable.
    #[error("cloth `{cloth}`: {source}")]
    Mesh {
        /// Name of the cloth.
        cloth: String,
        /// What is wrong.
        source: MeshError,
    },
    /// Constants that are not positive definite.
    #[error("cloth `{cloth}`: {source}")]
    Fabric {
        /// Name of the cloth.
        cloth: String,
        /// What is wrong.
        source: NotPositive,
    },
    /// A fabric of its own is given to a panel that the cloth does not have.
    #[error("cloth `{cloth}`: {message}")]
    Panel {
        /// Name of the cloth.
        cloth: String,
        /// What is wrong.
        message: String,
    },
    /// A handle holds nothing or names what does not exist.
    #[error("handles[{handle}]: {message}")]
    Handle {
        /// Index of the handle.
        handle: usize,
        /// What is wrong.
        message: String,
    },
    /// An obstacle has no usable surface.
    #[error("obstacles[{obstacle}]: {message}")]
    Obstacle {
        /// Index of the obstacle.
        obstacle: usize,
        /// What is wrong.
        message: String,
    },
    /// A fluid cannot be as described.
    #[error("fluids[0].{key}: {message}")]
    Fluid {
        /// The key of the fluid, such as `blocks`.
        key: String,
        /// What is wrong.
        message: String,
    },
    /// The system would be too large.
    #[error("the scene is too large: {0}")]
    TooLarge(String),
}

/// One cloth of the scene inside the common mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Garment {
    /// Its name.
    pub name: String,
    /// Its panels: a range of the mesh's panel numbers.
    pub panels: std::ops::Range<u32>,
    /// Thickness in contact (m); absent for that of the scene.
    pub thickness: Option<f64>,
}

/// All that the scene describes, as one mesh.
#[derive(Debug)]
pub struct Built {
    /// Meshes of all cloths side by side, with their state.
    pub cloth: ClothState,
    /// Fabric of every panel.
    pub fabrics: Vec<Fabric>,
    /// The cloths.
    pub garments: Vec<Garment>,
    /// What holds vertices.
    pub handles: Handles,
    /// Bodies that cloth cannot pass.
    pub obstacles: Vec<Obstacle>,
    /// The fluid, if the scene has one.
    pub fluid: Option<Water>,
    /// How things touch; absent where nothing does.
    pub contact: Option<ContactSettings>,
    /// What the user should know.
    pub warnings: Vec<String>,
}

/// Builds meshes, fabrics, handles and obstacles of a scene.
///
/// # Errors
/// See [`BuildError`].
pub fn build(loaded: &Loaded) -> Result<Built, BuildError> {
    let scene = &loaded.scene;
    let mut joined = Joined::default();
    let mut wardrobe = piece::Wardrobe::default();
    let (mut fabrics, mut garments, mut warnings) = (Vec::new(), Vec::new(), Vec::new());
    let (mut handles, mut first_vertices) = (Handles::default(), Vec::new());
    for (index, cloth) in scene.cloths.iter().enumerate() {
        let piece = piece::piece(cloth, loaded, &mut wardrobe)?;
        let first = fabrics.len() as u32;
        fabrics.extend(fabrics_of_panels(cloth, &piece, &mut warnings)?);
        let (panels, thickness) = (first..fabrics.len() as u32, cloth.thickness_m);
        garments.push(Garment { name: cloth.name.clone(), panels, thickness });
        let n_triangles = joined.triangles.len() + piece.mesh.n_triangles();
        if n_triangles > limits::MAX_SCENE_TRIANGLES {
            let limit = limits::MAX_SCENE_TRIANGLES;
            return Err(BuildError::TooLarge(format!("more than {limit} triangles in all cloths")));
        }
        let first_vertex = joined.positions.len() as u32;
        first_vertices.push(first_vertex as usize);
        for (number, handle) in scene.handles.iter().enumerate().filter(|(_, h)| h.cloth == index) {
            handles
                .add(number, handle, &piece, first_vertex)
                .map_err(|message| BuildError::Handle { handle: number, message })?;
        }
        joined.add(cloth, &place(cloth, scene), &piece, first);
    }
    let Joined { triangles, material, panels, positions, velocities } = joined;
    let panel_of = panels.clone();
    let error = |source| {
        // What was good by itself can still fail where it is put: say which cloth it was.
        let cloth = match &source {
            MeshError::MaterialArea { triangle, .. } => {
                cloth_of_panel(&garments, panel_of[*triangle])
            }
            MeshError::Density { panel, .. } => cloth_of_panel(&garments, *panel as u32),
            MeshError::NotFinite { what, index } if what.ends_with("of vertex") => {
                first_vertices.partition_point(|first| first <= index) - 1
            }
            _ => 0,
        };
        BuildError::Mesh { cloth: garments[cloth].name.clone(), source }
    };
    let mesh = match triangles.len() {
        0 => Mesh::empty(),
        _ => Mesh::new(positions.len(), triangles, material, panels).map_err(error)?,
    };
    let density = fabrics.iter().map(|f| f.density).collect();
    let cloth = ClothState::new(mesh, positions, velocities, density).map_err(error)?;
    let obstacles = obstacle::obstacles(loaded)?;
    let fluid = scene.fluid.as_ref();
    let fluid = fluid.map(|fluid| fluid::water(fluid, (&cloth, &garments), &obstacles)).transpose();
    let fluid = fluid.map_err(|(key, message)| BuildError::Fluid { key, message })?;
    let contact = scene.contact;
    Ok(Built { cloth, fabrics, garments, handles, obstacles, fluid, contact, warnings })
}

/// The cloth that a panel belongs to.
fn cloth_of_panel(garments: &[Garment], panel: u32) -> usize {
    garments.partition_point(|garment| garment.panels.end <= panel)
}

/// The fabric of every panel of a cloth.
fn fabrics_of_panels(
    cloth: &scene::Cloth,
    piece: &Piece,
    warnings: &mut Vec<String>,
) -> Result<Vec<Fabric>, BuildError> {
    let common = fabric::fabric(cloth, &cloth.fabric, warnings)?;
    let mut fabrics = vec![common; piece.panels.len()];
    for (name, material) in &cloth.panel_fabrics {
        let panel = piece.panel(name);
        let panel =
            panel.map_err(|message| BuildError::Panel { cloth: cloth.name.clone(), message })?;
        fabrics[panel as usize] = fabric::fabric(cloth, material, warnings)?;
    }
    Ok(fabrics)
}

/// Where a cloth starts: a garment on its character.
fn place(cloth: &scene::Cloth, scene: &Scene) -> Similarity3<f64> {
    let own = cloth.transform.similarity();
    let MeshSource::Garment(garment) = &cloth.mesh else { return own };
    let wearer = scene.obstacles.iter().find(|obstacle| obstacle.name == garment.on);
    wearer.map_or(own, |body| {
        let moved = body.motion.as_ref().map_or_else(Similarity3::identity, |m| m.at(0.0));
        moved * body.transform.similarity() * own
    })
}

/// The common mesh while it is put together.
#[derive(Default)]
struct Joined {
    triangles: Vec<[u32; 3]>,
    material: Vec<[Material2; 3]>,
    panels: Vec<u32>,
    positions: Vec<World3>,
    velocities: Vec<World3>,
}

impl Joined {
    fn add(
        &mut self,
        cloth: &scene::Cloth,
        place: &Similarity3<f64>,
        piece: &Piece,
        first_panel: u32,
    ) {
        let first = self.positions.len() as u32;
        self.triangles.extend(piece.mesh.triangles().iter().map(|t| t.map(|i| i + first)));
        let scale = place.scaling();
        self.material.extend(piece.mesh.material().iter().map(|u| u.map(|u| u * scale)));
        self.panels.extend(piece.mesh.panels().iter().map(|p| p + first_panel));
        let velocity = World3::from(cloth.initial_velocity);
        for x in &piece.positions {
            let x = place.transform_point(&(*x).into()).coords;
            let spin = cloth.initial_spin.map_or_else(World3::zeros, |spin| {
                World3::from(spin.angular_velocity).cross(&(x - World3::from(spin.center)))
            });
            self.positions.push(x);
            self.velocities.push(velocity + spin);
        }
    }
}
