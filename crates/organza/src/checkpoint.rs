//! The exact state of a world, to and from the columns of a recording.

use crate::world::World;
use io_mcap::{Checkpoint, Column};
use mesh_core::{ClothState, Material2, Mesh, MeshError, World3};

/// Why a checkpoint does not fit the scene.
#[derive(Debug, thiserror::Error)]
pub enum RestoreError {
    /// A column is missing, of the wrong kind or of the wrong length.
    #[error("the checkpoint of frame {frame} has no usable column `{column}`")]
    Column {
        /// The frame.
        frame: u64,
        /// The column.
        column: &'static str,
    },
    /// The mesh is not valid.
    #[error("the checkpoint of frame {frame}: {source}")]
    Mesh {
        /// The frame.
        frame: u64,
        /// Why.
        source: MeshError,
    },
}

fn flat(vectors: &[World3]) -> Column {
    Column::F64(vectors.iter().flat_map(|v| [v.x, v.y, v.z]).collect())
}

/// Saves the state and makes the world forget what is not part of it, see [`World::forget`].
pub fn save(world: &mut World) -> Checkpoint {
    world.forget();
    let mesh = &world.cloth.mesh;
    let material = mesh.material().iter().flatten().flat_map(|u| [u.x, u.y]).collect();
    let mut columns = vec![
        ("triangles".into(), Column::U32(mesh.triangles().iter().flatten().copied().collect())),
        ("material".into(), Column::F64(material)),
        ("panels".into(), Column::U32(mesh.panels().to_vec())),
        ("uids".into(), Column::U64(mesh.uids().to_vec())),
        ("next_uid".into(), Column::U64(vec![mesh.next_uid()])),
        ("x".into(), flat(&world.cloth.x)),
        ("v".into(), flat(&world.cloth.v)),
    ];
    for (k, handle) in world.handles.list().iter().enumerate() {
        let names = handle.held.iter().map(|&(uid, _)| uid).collect();
        // A handle that has not taken hold yet has no place: recorded as not-a-number.
        let unset = World3::repeat(f64::NAN);
        let homes: Vec<World3> = handle.held.iter().map(|(_, x)| x.unwrap_or(unset)).collect();
        columns.push((format!("handle {k} uids"), Column::U64(names)));
        columns.push((format!("handle {k} homes"), flat(&homes)));
    }
    Checkpoint { frame: world.frame, time_s: world.time(), columns }
}

/// Puts a world of the same scene into a saved state.
///
/// # Errors
/// If the checkpoint does not fit; the world is then unchanged.
pub fn restore(world: &mut World, checkpoint: &Checkpoint) -> Result<(), RestoreError> {
    let frame = checkpoint.frame;
    let bad = |column| RestoreError::Column { frame, column };
    let f64s = |name: &str, column| match checkpoint.column(name) {
        Some(Column::F64(values)) => Ok(values.as_slice()),
        _ => Err(bad(column)),
    };
    let u32s = |name: &str, column| match checkpoint.column(name) {
        Some(Column::U32(values)) => Ok(values.as_slice()),
        _ => Err(bad(column)),
    };
    let u64s = |name: &str, column| match checkpoint.column(name) {
        Some(Column::U64(values)) => Ok(values.as_slice()),
        _ => Err(bad(column)),
    };
    let vectors = |values: &[f64]| -> Vec<World3> {
        values.chunks_exact(3).map(World3::from_column_slice).collect()
    };

    let triangles = u32s("triangles", "triangles")?;
    let triangles: Vec<[u32; 3]> = triangles.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect();
    let material = f64s("material", "material")?;
    let material: Vec<[Material2; 3]> = material
        .chunks_exact(6)
        .map(|c| [0, 2, 4].map(|k| Material2::new(c[k], c[k + 1])))
        .collect();
    let (x, v) = (vectors(f64s("x", "x")?), vectors(f64s("v", "v")?));
    let &[next_uid] = u64s("next_uid", "next_uid")? else { return Err(bad("next_uid")) };
    let mesh_error = |source| RestoreError::Mesh { frame, source };
    let mesh = Mesh::new(x.len(), triangles, material, u32s("panels", "panels")?.to_vec())
        .and_then(|m| m.with_uids(u64s("uids", "uids").unwrap_or_default().to_vec(), next_uid))
        .map_err(mesh_error)?;
    let density = world.cloth.densities().to_vec();
    let cloth = ClothState::new(mesh, x, v, density).map_err(mesh_error)?;

    let mut handles = world.handles.clone();
    for (k, handle) in handles.list_mut().iter_mut().enumerate() {
        let names = u64s(&format!("handle {k} uids"), "handle uids")?;
        let homes = vectors(f64s(&format!("handle {k} homes"), "handle homes")?);
        if names.len() != homes.len() {
            return Err(bad("handle homes"));
        }
        let place = |x: World3| (!x.x.is_nan()).then_some(x);
        handle.held = names.iter().copied().zip(homes.into_iter().map(place)).collect();
    }
    world.cloth = cloth;
    world.handles = handles;
    world.frame = frame;
    world.forget();
    Ok(())
}
