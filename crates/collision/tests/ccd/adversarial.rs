//! Continuous collision on adversarial queries with exact truth, where they are at hand: a folder
//! named by the environment variable `ORGANZA_REFERENCE`, or `shared/reference` beside the workspace.

use crate::exact::Truth;
use collision::ccd::{self, Ccd};
use mesh_core::World3;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

struct Query {
    category: String,
    is_edges: bool,
    touches: bool,
    x_t0: [World3; 4],
    x_t1: [World3; 4],
}

/// A hexadecimal floating-point number such as `-0x1.8p-3`, exactly.
fn hex(text: &str) -> f64 {
    let (sign, rest) = text.strip_prefix('-').map_or((1.0, text), |rest| (-1.0, rest));
    let (mantissa, exponent) = rest.strip_prefix("0x").unwrap().split_once('p').unwrap();
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits = u64::from_str_radix(&format!("{whole}{fraction}"), 16).unwrap();
    assert!(digits < 1 << 53, "{text} has more digits than a number holds");
    let exponent = exponent.parse::<i32>().unwrap() - 4 * fraction.len() as i32;
    sign * digits as f64 * 2f64.powi(exponent)
}

fn queries() -> Option<Vec<Query>> {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/reference");
    let folder = std::env::var_os("ORGANZA_REFERENCE").map_or_else(beside, PathBuf::from);
    let file = folder.join("ccd/adversarial_queries.csv");
    let Ok(text) = std::fs::read_to_string(&file) else {
        eprintln!("skipped: no {}", file.display());
        return None;
    };
    let parse = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        let number: Vec<f64> = cells[4..28].iter().map(|cell| hex(cell)).collect();
        let x = |from: usize| {
            std::array::from_fn(|i| World3::from_column_slice(&number[from + 3 * i..][..3]))
        };
        Query {
            category: cells[1].to_owned(),
            is_edges: cells[2] == "ee",
            touches: cells[3] == "1",
            x_t0: x(0),
            x_t1: x(12),
        }
    };
    Some(text.lines().skip(1).map(parse).collect())
}

impl Query {
    /// The query with integer coordinates, in the largest unit that allows them, around its first
    /// point.
    fn exact(&self) -> crate::exact::Query {
        let all = || self.x_t0.iter().chain(&self.x_t1).flat_map(|x| x.iter());
        let mut unit = 1.0;
        while all().any(|c| (c / unit).fract() != 0.0) {
            unit *= 0.5;
        }
        let integer = |x: f64, k: usize| (x / unit) as i64 - (self.x_t0[0][k] / unit) as i64;
        let integers = |x: &[World3; 4]| x.map(|p| std::array::from_fn(|k| integer(p[k], k)));
        crate::exact::Query {
            is_edges: self.is_edges,
            x_t0: integers(&self.x_t0),
            x_t1: integers(&self.x_t1),
        }
    }

    fn test(&self, separation: f64) -> Ccd {
        let test = if self.is_edges { ccd::edge_edge } else { ccd::vertex_triangle };
        test(&self.x_t0, &self.x_t1, separation)
    }
}

#[test]
fn no_hit_is_missed_and_no_miss_hit() {
    let Some(queries) = queries() else { return };
    assert_eq!(queries.len(), 300);
    let mut rows: BTreeMap<&str, [usize; 3]> = BTreeMap::new();
    for q in &queries {
        let row = rows.entry(&q.category).or_default();
        row[0] += 1;
        let hit = q.test(0.0).is_hit();
        row[1] += usize::from(q.touches && !hit);
        row[2] += usize::from(!q.touches && hit);
    }
    for (category, [n, missed, false_hits]) in &rows {
        println!("{category:28} {n:4} queries, {missed} missed, {false_hits} false");
    }
    let total = |k: usize| rows.values().map(|row| row[k]).sum::<usize>();
    assert_eq!((total(1), total(2)), (0, 0), "(missed, false)");
}

#[test]
fn touching_at_the_start_is_a_hit_at_the_start() {
    let Some(queries) = queries() else { return };
    let start = queries.iter().filter(|q| q.category.starts_with("touching at t=0"));
    assert_eq!(start.map(|q| assert_eq!(q.test(0.0), Ccd::Hit { t: 0.0 })).count(), 20);
}

#[test]
fn hits_are_reported_at_their_times() {
    let Some(queries) = queries() else { return };
    let mut n_certain = 0;
    for q in &queries {
        // The file's numbers are dyadic: as integers they have an exact truth of their own.
        let t = q.test(0.0).free_until();
        match q.exact().truth() {
            Truth::Free => assert!(!q.touches, "{}", q.category),
            Truth::Hit { from, to } => {
                n_certain += 1;
                assert!(q.touches && t <= to && t > from - 1e-4, "{} {t} {from}", q.category);
            }
            Truth::Unclear => {}
        }
    }
    assert!(n_certain > 50, "{n_certain}");
}
