//! The exact state of a world, to and from the columns of a recording.

use crate::fluid;
use crate::handles::Handles;
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
    /// The state is none of this fluid.
    #[error("the checkpoint of frame {frame}: {source}")]
    Fluid {
        /// The frame.
        frame: u64,
        /// Why.
        source: sph::FluidError,
    },
}

fn flat(vectors: &[World3]) -> Column {
    Column::F64(vectors.iter().flat_map(|v| [v.x, v.y, v.z]).collect())
}

/// Saves the state and makes the world forget what is not part of it, see [`World::forget`].
pub fn save(world: &mut World) -> Checkpoint {
    world.forget();
    let mut columns = if world.has_cloth() { cloth_columns(world) } else { Vec::new() };
    columns.extend(world.fluid.iter().flat_map(fluid::columns));
    Checkpoint { frame: world.frame, time_s: world.time(), columns }
}

/// The state of the cloth and of what holds it.
fn cloth_columns(world: &World) -> Vec<(String, Column)> {
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
    columns
}

/// Puts a world of the same scene into a saved state.
///
/// # Errors
/// If the checkpoint does not fit; the world is then unchanged.
pub fn restore(world: &mut World, checkpoint: &Checkpoint) -> Result<(), RestoreError> {
    let cloth = match world.has_cloth() {
        true => Some(restored_cloth(world, checkpoint)?),
        false => None,
    };
    if let Some(water) = &mut world.fluid {
        fluid::restore(water, checkpoint)?;
    }
    if let Some((cloth, handles)) = cloth {
        (world.cloth, world.handles) = (cloth, handles);
    }
    world.frame = checkpoint.frame;
    world.forget();
    world.look_who_may_rest();
    world.note_tangles();
    Ok(())
}

/// The cloth of a saved state, and what holds it.
fn restored_cloth(
    world: &World,
    checkpoint: &Checkpoint,
) -> Result<(ClothState, Handles), RestoreError> {
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
    let vectors = |name: &str, column| -> Result<Vec<World3>, RestoreError> {
        let (vectors, rest) = f64s(name, column)?.as_chunks::<3>();
        let whole = rest.is_empty().then(|| vectors.iter().copied().map(World3::from).collect());
        whole.ok_or_else(|| bad(column))
    };

    let (triangles, rest) = u32s("triangles", "triangles")?.as_chunks::<3>();
    if !rest.is_empty() {
        return Err(bad("triangles"));
    }
    let (material, rest) = f64s("material", "material")?.as_chunks::<6>();
    if !rest.is_empty() {
        return Err(bad("material"));
    }
    let corners = |c: &[f64; 6]| [0, 2, 4].map(|k| Material2::new(c[k], c[k + 1]));
    let material: Vec<[Material2; 3]> = material.iter().map(corners).collect();
    let (x, v) = (vectors("x", "x")?, vectors("v", "v")?);
    let &[next_uid] = u64s("next_uid", "next_uid")? else { return Err(bad("next_uid")) };
    let mesh_error = |source| RestoreError::Mesh { frame, source };
    let (panels, uids) = (u32s("panels", "panels")?.to_vec(), u64s("uids", "uids")?.to_vec());
    let mesh = Mesh::new(x.len(), triangles.to_vec(), material, panels)
        .and_then(|mesh| mesh.with_uids(uids, next_uid))
        .map_err(mesh_error)?;
    let density = world.cloth.densities().to_vec();
    let cloth = ClothState::new(mesh, x, v, density).map_err(mesh_error)?;

    let mut handles = world.handles.clone();
    for (k, handle) in handles.list_mut().iter_mut().enumerate() {
        let names = u64s(&format!("handle {k} uids"), "handle uids")?;
        let homes = vectors(&format!("handle {k} homes"), "handle homes")?;
        if names.len() != homes.len() {
            return Err(bad("handle homes"));
        }
        // They are searched, and no vertex is held twice.
        if !names.is_sorted_by(|a, b| a < b) {
            return Err(bad("handle uids"));
        }
        let place = |x: World3| (!x.x.is_nan()).then_some(x);
        handle.held = names.iter().copied().zip(homes.into_iter().map(place)).collect();
    }
    Ok((cloth, handles))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{LoadOptions, from_sources, parse};

    fn world() -> World {
        let text = "{frames: 2, cloths: [{fabric: 'denim', mesh: {grid: {size_m: [1, 1], cells: [1, 1]}}}],
            handles: [{select: {sides: ['upper']}}]}";
        World::new(&parse(text, "s", &LoadOptions::default(), &from_sources(&[])).unwrap()).unwrap()
    }

    /// Nothing is cut to fit and nothing is put right: what does not fit is named.
    #[test]
    fn what_does_not_fit_is_refused_and_changes_nothing() {
        let mut world = world();
        world.advance().unwrap();
        let good = save(&mut world);
        restore(&mut world, &good).unwrap();
        let before = (world.frame, world.cloth.clone(), world.handles.clone());
        let columns: Vec<String> = good.columns.iter().map(|(name, _)| name.clone()).collect();
        for name in &columns {
            let text: fn(&mut Column) = |c| *c = Column::Text("none".into());
            let longer: fn(&mut Column) = |c| match c {
                Column::F64(values) => values.push(0.5),
                Column::U32(values) => values.push(0),
                Column::U64(values) => values.push(u64::MAX),
                Column::Text(_) => {}
            };
            let shorter: fn(&mut Column) = |c| match c {
                Column::F64(values) => drop(values.pop()),
                Column::U32(values) => drop(values.pop()),
                Column::U64(values) => drop(values.pop()),
                Column::Text(_) => {}
            };
            for change in [text, longer, shorter] {
                let mut bad = good.clone();
                bad.columns.iter_mut().filter(|(n, _)| n == name).for_each(|(_, c)| change(c));
                let error = restore(&mut world, &bad).unwrap_err().to_string();
                assert!(error.starts_with("the checkpoint of frame 1"), "{name}: {error}");
                assert_eq!((world.frame, &world.cloth, &world.handles), (1, &before.1, &before.2));
            }
            let mut without = good.clone();
            without.columns.retain(|(n, _)| n != name);
            let error = restore(&mut world, &without).unwrap_err().to_string();
            assert!(error.contains("no usable column"), "{name}: {error}");
        }
        let mut unsorted = good.clone();
        let names = unsorted.columns.iter_mut().find(|(n, _)| n == "handle 0 uids").unwrap();
        names.1 = Column::U64(vec![3, 2]);
        assert!(restore(&mut world, &unsorted).is_err());
    }
}
