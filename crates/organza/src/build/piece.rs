//! The mesh of one cloth: read from files or generated.

use super::BuildError;
use crate::scene::format::{Diagonal as SceneDiagonal, GarmentKind, Skirt, Tunic};
use crate::scene::{self, Dialect, Loaded, MeshSource, suggestion};
use mannequin::{Garment, MannequinError};
use mesh_core::generate::{self, Border, Diagonal, GenerateError, Sheet};
use mesh_core::obj;
use mesh_core::{Mesh, VertexId, World3};

/// A cloth before it joins the others.
pub(crate) struct Piece {
    pub(crate) mesh: Mesh,
    pub(crate) positions: Vec<World3>,
    /// The vertex that each of a file became.
    pub(crate) vertex_of_file: Option<Vec<Option<VertexId>>>,
    /// What a generator calls the parts of the boundary; empty for files.
    pub(crate) borders: Vec<Border>,
    /// Names of the panels.
    pub(crate) panels: Vec<String>,
}

impl Piece {
    /// The panel of this name.
    ///
    /// # Errors
    /// If there is none.
    pub(crate) fn panel(&self, name: &str) -> Result<u32, String> {
        let found = self.panels.iter().position(|panel| panel == name);
        let missing = || format!("there is no panel `{name}`{}", suggestion(name, &self.panels));
        found.map(|panel| panel as u32).ok_or_else(missing)
    }
}

/// Garments that have been made already, with the length of their edges (m): those of a crowd are made
/// once.
#[derive(Default)]
pub(super) struct Wardrobe(Vec<(Garment, f64, Sheet)>);

impl Wardrobe {
    fn get(&mut self, garment: Garment, cell: f64) -> Result<Sheet, MannequinError> {
        if let Some((.., sheet)) = self.0.iter().find(|(g, c, _)| (*g, *c) == (garment, cell)) {
            return Ok(sheet.clone());
        }
        let sheet = garment.sheet(cell)?;
        self.0.push((garment, cell, sheet.clone()));
        Ok(sheet)
    }
}

/// Panels of tunics, and the first two of ponchos.
const GARMENT: [&str; 4] = ["front", "back", "right-sleeve", "left-sleeve"];

/// Reads or makes the mesh of a cloth.
pub(super) fn piece(
    cloth: &scene::Cloth,
    loaded: &Loaded,
    wardrobe: &mut Wardrobe,
) -> Result<Piece, BuildError> {
    let generated = |sheet: Result<Sheet, GenerateError>| match sheet {
        Ok(Sheet { mesh, positions, borders }) => {
            let n_panels = mesh.panels().iter().max().map_or(1, |&p| p as usize + 1);
            let named = matches!(cloth.mesh, MeshSource::Tunic(_) | MeshSource::Poncho(_));
            let name = |p: usize| if named { GARMENT[p].to_owned() } else { p.to_string() };
            let panels = (0..n_panels).map(name).collect();
            Ok(Piece { mesh, positions, vertex_of_file: None, borders, panels })
        }
        Err(source) => Err(BuildError::Generate { cloth: cloth.name.clone(), source }),
    };
    match &cloth.mesh {
        MeshSource::Garment(worn) => {
            let garment = match worn.kind {
                GarmentKind::Dress => Garment::Dress,
                GarmentKind::Skirt => Garment::Skirt,
                GarmentKind::Trousers => Garment::Trousers,
                GarmentKind::Jacket => Garment::Jacket,
                GarmentKind::Belt => Garment::Belt,
            };
            let sheet = wardrobe.get(garment, worn.cell_m);
            let Sheet { mesh, positions, borders } = sheet
                .map_err(|source| BuildError::Garment { cloth: cloth.name.clone(), source })?;
            let panels = garment.panels().iter().map(|&name| name.to_owned()).collect();
            Ok(Piece { mesh, positions, vertex_of_file: None, borders, panels })
        }
        MeshSource::Obj { obj: file, material_obj } => {
            let read = |file: &String| {
                let bytes = loaded.source(file).unwrap_or_default();
                obj::read(bytes).map_err(|source| BuildError::Obj { file: file.clone(), source })
            };
            let mut world = read(file)?;
            if loaded.dialect == Dialect::Arcsim {
                // Groups mean nothing there.
                world.ungroup();
            }
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
                panels: world.groups,
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
