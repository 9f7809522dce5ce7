//! From a scene's data to meshes, fabrics and handles.

use crate::handles::Handles;
use crate::scene::format::{Diagonal as SceneDiagonal, Skirt, Tunic};
use crate::scene::{self, Loaded, MeshSource};
use cloth_dynamics::law::{
    Bending, MeasuredBending, MeasuredMembrane, Membrane, NotPositive, Quadratic,
};
use cloth_dynamics::{BendingModel, Damping, Fabric, StrainLimits};
use mesh_core::generate::{self, Border, Diagonal, GenerateError, Sheet};
use mesh_core::obj::{self, ObjError};
use mesh_core::{ClothState, Material2, Mesh, MeshError, VertexId, World3};

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
    /// A handle holds nothing or names what does not exist.
    #[error("handles[{handle}]: {message}")]
    Handle {
        /// Index of the handle.
        handle: usize,
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
    /// What the user should know.
    pub warnings: Vec<String>,
}

/// A cloth before it joins the others.
pub(crate) struct Piece {
    pub(crate) mesh: Mesh,
    pub(crate) positions: Vec<World3>,
    /// The vertex that each of a file became.
    pub(crate) vertex_of_file: Option<Vec<Option<VertexId>>>,
    /// What a generator calls the parts of the boundary; empty for files.
    pub(crate) borders: Vec<Border>,
}

/// Builds meshes, fabrics and handles of a scene.
///
/// # Errors
/// See [`BuildError`].
pub fn build(loaded: &Loaded) -> Result<Built, BuildError> {
    let scene = &loaded.scene;
    let mut joined = Joined::default();
    let (mut fabrics, mut garments, mut warnings) = (Vec::new(), Vec::new(), Vec::new());
    let mut handles = Handles::default();
    for (index, cloth) in scene.cloths.iter().enumerate() {
        let piece = piece(cloth, loaded)?;
        let fabric = fabric(cloth, &mut warnings)?;
        let n_panels = piece.mesh.panels().iter().max().map_or(1, |&p| p + 1);
        let first = fabrics.len() as u32;
        for _ in 0..n_panels {
            fabrics.push(fabric.clone());
        }
        garments.push(Garment { name: cloth.name.clone(), panels: first..first + n_panels });
        let first_vertex = joined.positions.len() as u32;
        for (number, handle) in scene.handles.iter().enumerate().filter(|(_, h)| h.cloth == index) {
            handles
                .add(number, handle, &piece, first_vertex)
                .map_err(|message| BuildError::Handle { handle: number, message })?;
        }
        joined.add(cloth, &piece, first);
    }
    let error = |source| BuildError::Mesh { cloth: garments[0].name.clone(), source };
    let Joined { triangles, material, panels, positions, velocities } = joined;
    let mesh = Mesh::new(positions.len(), triangles, material, panels).map_err(error)?;
    let density = fabrics.iter().map(|f| f.density).collect();
    let cloth = ClothState::new(mesh, positions, velocities, density).map_err(error)?;
    Ok(Built { cloth, fabrics, garments, handles, warnings })
}

fn piece(cloth: &scene::Cloth, loaded: &Loaded) -> Result<Piece, BuildError> {
    let generated = |sheet: Result<Sheet, GenerateError>| match sheet {
        Ok(Sheet { mesh, positions, borders }) => {
            Ok(Piece { mesh, positions, vertex_of_file: None, borders })
        }
        Err(source) => Err(BuildError::Generate { cloth: cloth.name.clone(), source }),
    };
    match &cloth.mesh {
        MeshSource::Obj { obj: file, material_obj } => {
            let read = |file: &String| {
                let bytes = loaded.source(file).unwrap_or_default();
                obj::read(bytes).map_err(|source| BuildError::Obj { file: file.clone(), source })
            };
            let world = read(file)?;
            let material = material_obj.as_ref().map(read).transpose()?;
            let cloth = match &material {
                Some(material) => world.to_mesh_with(material),
                None => world.to_mesh(),
            };
            let cloth = cloth.map_err(|source| BuildError::Obj { file: file.clone(), source })?;
            Ok(Piece {
                mesh: cloth.mesh,
                positions: cloth.positions,
                vertex_of_file: Some(cloth.vertex_of_file),
                borders: Vec::new(),
            })
        }
        MeshSource::Grid(grid) => {
            let diagonal = match grid.diagonal {
                SceneDiagonal::Alternating => Diagonal::Alternating,
                SceneDiagonal::One => Diagonal::One,
            };
            generated(generate::grid(grid.size_m, grid.cells.map(|n| n as usize), diagonal))
        }
        MeshSource::Disc(disc) => generated(generate::disc(disc.radius_m, disc.rings as usize)),
        MeshSource::Tube(tube) => {
            let [around, along] = tube.segments.map(|n| n as usize);
            generated(generate::tube(tube.radius_m, tube.length_m, around, along))
        }
        MeshSource::Skirt(skirt) => generated(generate::skirt(&skirt_of(skirt))),
        MeshSource::Tunic(tunic) => generated(generate::tunic(&tunic_of(tunic))),
        MeshSource::Poncho(poncho) => generated(generate::poncho(
            poncho.width_m,
            poncho.length_m,
            poncho.neck_width_m,
            poncho.cell_m,
        )),
    }
}

fn tunic_of(tunic: &Tunic) -> generate::Tunic {
    generate::Tunic {
        width: tunic.width_m,
        hem_width: tunic.hem_width_m.unwrap_or(tunic.width_m),
        length: tunic.length_m,
        armhole: tunic.armhole_m,
        neck_width: tunic.neck_width_m,
        neck_depth: tunic.neck_depth_m,
        sleeve: tunic.sleeve_m,
        cell: tunic.cell_m,
    }
}

fn skirt_of(skirt: &Skirt) -> generate::Skirt {
    generate::Skirt {
        panels: skirt.panels as usize,
        waist_radius: skirt.waist_m / std::f64::consts::TAU,
        hem_radius: skirt.hem_m / std::f64::consts::TAU,
        length: skirt.length_m,
        around: skirt.cells[0] as usize,
        along: skirt.cells[1] as usize,
    }
}

fn fabric(cloth: &scene::Cloth, warnings: &mut Vec<String>) -> Result<Fabric, BuildError> {
    let scale = &cloth.multipliers;
    let bad = |source| BuildError::Fabric { cloth: cloth.name.clone(), source };
    let (density, membrane, bending) = match &cloth.fabric {
        crate::fabric::Fabric::Orthotropic(fabric) => {
            let c = fabric.stretching_n_per_m;
            let k = scale.stretching;
            let membrane =
                Quadratic::orthotropic(c.warp * k, c.coupling * k, c.weft * k, c.shear * k)
                    .map_err(bad)?;
            let b = fabric.bending_n_m;
            let [warp, bias, weft] = [b.warp, b.bias, b.weft].map(|b| b * scale.bending);
            let bending = if warp.max(bias).max(weft) > 0.0 {
                Some(Bending::Orthotropic(Quadratic::plate(warp, bias, weft).map_err(bad)?))
            } else {
                None
            };
            (fabric.density_kg_per_m2, Membrane::Orthotropic(membrane), bending)
        }
        crate::fabric::Fabric::Measured(fabric) => {
            let membrane = MeasuredMembrane::new(&fabric.stretching, scale.stretching);
            if membrane.repaired_rows() > 0 {
                warnings.push(format!(
                    "cloth `{}`: {} of 6 measured rows of stretching are not positive \
                     semi-definite and are projected",
                    cloth.name,
                    membrane.repaired_rows()
                ));
            }
            // A file's constants are those of the discrete hinge, whose rigidity is a quarter.
            let bending = MeasuredBending::new(&fabric.bending, 0.25 * scale.bending);
            (fabric.density, Membrane::Measured(membrane), Some(Bending::Measured(bending)))
        }
    };
    Ok(Fabric {
        density: density * scale.density,
        membrane,
        bending,
        bending_model: match cloth.bending {
            crate::scene::format::BendingModel::Patch => BendingModel::ShapeOperator,
            crate::scene::format::BendingModel::Hinge => BendingModel::Hinge,
        },
        strain_limits: cloth.strain_limits.map(|[min, max]| StrainLimits { min, max }),
        damping: Damping { mass: cloth.damping.mass_per_s, stiffness: cloth.damping.stiffness_s },
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
    fn add(&mut self, cloth: &scene::Cloth, piece: &Piece, first_panel: u32) {
        let first = self.positions.len() as u32;
        self.triangles.extend(piece.mesh.triangles().iter().map(|t| t.map(|i| i + first)));
        let scale = cloth.transform.scale;
        self.material.extend(piece.mesh.material().iter().map(|u| u.map(|u| u * scale)));
        self.panels.extend(piece.mesh.panels().iter().map(|p| p + first_panel));
        let place = cloth.transform.similarity();
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
