//! The exact state of a fluid as columns of a checkpoint.

use super::Water;
use crate::checkpoint::RestoreError;
use io_mcap::{Checkpoint, Column};

/// Names of the columns, all of which a checkpoint with a fluid has.
const NUMBERS: &str = "fluid numbers";
const NAMES: &str = "fluid names";
const COUNTS: &str = "fluid counts";
const LAYERS: &str = "fluid layers";
const DENSITIES: &str = "fluid densities";
const WALLS: &str = "fluid walls";
const TOUCHED: &str = "fluid touched walls";
const OVERDUE: [&str; 3] = ["fluid overdue near", "fluid overdue changed", "fluid overdue walls"];
/// Only where cloth or bodies move in the fluid.
const SHEETS: &str = "fluid by surfaces";
const GIVEN: &str = "fluid impulses";
const POINTS: [&str; 5] = ["fluid x", "fluid w", "fluid u", "fluid a", "fluid listed"];

/// The state of a fluid.
pub(crate) fn columns(water: &Water) -> Vec<(String, Column)> {
    let sph::Checkpoint {
        time,
        id,
        next_id,
        x,
        w,
        u,
        a,
        density,
        by_sheets,
        given,
        listed,
        walls,
        touched,
        mended,
        age,
        overdue,
        greatest: [fastest, hardest, farthest],
        layers,
        incremental,
    } = water.fluid.checkpoint();
    let mut columns = vec![
        (NUMBERS, Column::F64(vec![time, fastest, hardest, farthest])),
        (COUNTS, Column::U64(vec![next_id, incremental.into(), mended, age.into()])),
        (NAMES, Column::U64(id)),
        (LAYERS, Column::U64(layers)),
        (DENSITIES, Column::F64(density)),
        (WALLS, Column::F64(walls.into_flattened())),
        (TOUCHED, Column::U64(wide(touched))),
    ];
    columns.extend(OVERDUE.into_iter().zip(overdue.map(|list| Column::U64(wide(list)))));
    if water.meeting.is_some() {
        columns.push((SHEETS, Column::F64(by_sheets.into_flattened())));
        columns.push((GIVEN, Column::F64(given.into_flattened())));
    }
    let points = [x, w, u, a, listed].map(|list| Column::F64(list.into_flattened()));
    columns.extend(POINTS.into_iter().zip(points));
    columns.into_iter().map(|(name, column)| (name.to_owned(), column)).collect()
}

fn wide(list: Vec<u32>) -> Vec<u64> {
    list.into_iter().map(u64::from).collect()
}

/// Puts a fluid of the same scene into the state that `checkpoint` holds.
///
/// # Errors
/// If it does not fit; the fluid is then as it was.
pub(crate) fn restore(water: &mut Water, checkpoint: &Checkpoint) -> Result<(), RestoreError> {
    let frame = checkpoint.frame;
    let bad = |column| RestoreError::Column { frame, column };
    let f64s = |column: &'static str| match checkpoint.column(column) {
        Some(Column::F64(values)) => Ok(values.as_slice()),
        _ => Err(bad(column)),
    };
    let u64s = |column: &'static str| match checkpoint.column(column) {
        Some(Column::U64(values)) => Ok(values.as_slice()),
        _ => Err(bad(column)),
    };
    let points = |column: &'static str| {
        let (points, rest) = f64s(column)?.as_chunks::<4>();
        if rest.is_empty() { Ok(points.to_vec()) } else { Err(bad(column)) }
    };
    let &[time, fastest, hardest, farthest] = f64s(NUMBERS)? else { return Err(bad(NUMBERS)) };
    let &[next_id, incremental, mended, age] = u64s(COUNTS)? else { return Err(bad(COUNTS)) };
    let u32s = |column: &'static str| {
        let narrow = u64s(column)?.iter().map(|&i| u32::try_from(i).map_err(|_| bad(column)));
        narrow.collect::<Result<Vec<u32>, _>>()
    };
    let [near, changed, overdue_walls] = OVERDUE;
    let (walls, rest) = f64s(WALLS)?.as_chunks::<2>();
    if !rest.is_empty() {
        return Err(bad(WALLS));
    }
    let meets = water.meeting.is_some();
    let [x, w, u, a, listed] = POINTS;
    let state = sph::Checkpoint {
        time,
        id: u64s(NAMES)?.to_vec(),
        next_id,
        x: points(x)?,
        w: points(w)?,
        u: points(u)?,
        a: points(a)?,
        density: f64s(DENSITIES)?.to_vec(),
        by_sheets: if meets { points(SHEETS)? } else { Vec::new() },
        given: if meets { points(GIVEN)? } else { Vec::new() },
        listed: points(listed)?,
        walls: walls.to_vec(),
        touched: u32s(TOUCHED)?,
        mended,
        age: u32::try_from(age).map_err(|_| bad(COUNTS))?,
        overdue: [u32s(near)?, u32s(changed)?, u32s(overdue_walls)?],
        greatest: [fastest, hardest, farthest],
        layers: u64s(LAYERS)?.to_vec(),
        incremental: incremental != 0,
    };
    water.restore(&state).map_err(|source| RestoreError::Fluid { frame, source })
}
