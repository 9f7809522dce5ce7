//! What several tests need: tables of reference values.

use std::path::{Path, PathBuf};

/// Rows of numbers separated by commas.
pub(crate) fn table(text: &str) -> Vec<Vec<f64>> {
    let row = |line: &str| line.split(',').map(|cell| cell.parse().unwrap()).collect();
    text.lines().map(row).collect()
}

/// The rows of a whole reference table, without its head: from the folder named by the environment
/// variable `ORGANZA_REFERENCE`, or `shared/reference` beside the workspace. Empty where the folder
/// is missing.
pub(crate) fn reference(name: &str) -> Vec<Vec<f64>> {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/reference");
    let folder = std::env::var_os("ORGANZA_REFERENCE").map_or_else(beside, PathBuf::from);
    let file = folder.join(name);
    match std::fs::read_to_string(&file) {
        Ok(text) => table(text.split_once('\n').unwrap().1),
        Err(_) => {
            eprintln!("skipped: no {}", file.display());
            Vec::new()
        }
    }
}
