//! Garments: sewn as they should be, clear of the body and of each other, hardly strained.

use mannequin::{Garment, body};
use mesh_core::generate::Sheet;
use mesh_core::geometry::{gradient, inverse_edges};
use mesh_core::{TriangleId, World3};

const ALL: [Garment; 5] =
    [Garment::Dress, Garment::Skirt, Garment::Trousers, Garment::Jacket, Garment::Belt];

/// Corners, middles of edges and middles of all triangles.
fn samples(sheet: &Sheet) -> Vec<World3> {
    let mut samples = sheet.positions.clone();
    for t in sheet.mesh.triangles() {
        let [a, b, c] = t.map(|v| sheet.positions[v as usize]);
        samples.extend([(a + b + c) / 3.0, (a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5]);
    }
    samples
}

/// Smallest and largest principal stretch of every triangle, with its area.
fn stretches(sheet: &Sheet) -> Vec<([f64; 2], f64)> {
    let mesh = &sheet.mesh;
    let of = |t: usize| {
        let x = mesh.triangles()[t].map(|v| sheet.positions[v as usize]);
        let s = gradient(x, &inverse_edges(mesh.material()[t])).singular_values();
        ([s.min(), s.max()], mesh.area(TriangleId(t as u32)))
    };
    (0..mesh.n_triangles()).map(of).collect()
}

fn n_openings(sheet: &Sheet) -> usize {
    mesh_core::generate::boundary_loops(&sheet.mesh).len()
}

#[test]
fn they_are_clear_of_the_body() {
    for garment in ALL {
        for cell in [0.02, 0.03, 0.045] {
            let sheet = garment.sheet(cell).unwrap();
            let (x, least) = samples(&sheet)
                .into_iter()
                .map(|x| (x, body::distance(&x)))
                .min_by(|a, b| a.1.total_cmp(&b.1))
                .unwrap();
            println!(
                "{garment:?} {cell}: {} faces, {least:.4} m at {:.3?}",
                sheet.mesh.n_triangles(),
                x.as_slice()
            );
            assert!(least > 0.008, "{garment:?} {cell}: {least} at {x}");
        }
    }
}

#[test]
fn their_patterns_fit() {
    for garment in ALL {
        for cell in [0.02, 0.03, 0.045] {
            let all = stretches(&garment.sheet(cell).unwrap());
            let low = all.iter().map(|(s, _)| s[0]).fold(f64::INFINITY, f64::min);
            let high = all.iter().map(|(s, _)| s[1]).fold(0.0, f64::max);
            println!("{garment:?} {cell}: {low:.3} {high:.3}");
            if garment == Garment::Belt {
                // Its pattern is three quarters of its start.
                assert!(low > 0.97 && high < 1.34, "{garment:?} {cell}: {low} {high}");
                continue;
            }
            // Cloth that starts with more strain than this in a few small triangles would jump.
            assert!(low > 0.6 && high < 1.6, "{garment:?} {cell}: {low} {high}");
            let whole: f64 = all.iter().map(|(_, area)| area).sum();
            let strained = all.iter().filter(|([low, high], _)| *low < 0.95 || *high > 1.05);
            let share = strained.map(|(_, area)| area).sum::<f64>() / whole;
            println!("  {share:.4} of the area is strained by more than 5 %");
            assert!(share < 0.06, "{garment:?} {cell}: {share}");
        }
    }
}

#[test]
fn they_have_their_panels_and_openings() {
    for garment in ALL {
        let sheet = garment.sheet(0.03).unwrap();
        let n_panels = sheet.mesh.panels().iter().max().unwrap() + 1;
        assert_eq!(n_panels as usize, garment.panels().len());
        let (openings, euler) = match garment {
            // Hem, neck and two arms; a sphere with four holes.
            Garment::Dress => (4, -2),
            Garment::Skirt | Garment::Belt => (2, 0),
            Garment::Trousers => (3, -1),
            // Its front is open: one border from the hem around the neck, and two cuffs.
            Garment::Jacket => (3, -1),
        };
        assert_eq!((n_openings(&sheet), sheet.mesh.euler_characteristic()), (openings, euler));
        for t in 0..sheet.mesh.n_triangles() {
            assert!(sheet.mesh.area(TriangleId(t as u32)) > 1e-6);
        }
        // What bounds it has a name.
        let named: std::collections::HashSet<_> =
            sheet.borders.iter().flat_map(|b| b.vertices.iter().copied()).collect();
        let bounds = mesh_core::generate::boundary_loops(&sheet.mesh);
        assert!(bounds.iter().flatten().all(|v| named.contains(v)), "{garment:?}");
    }
}

#[test]
fn layers_are_apart() {
    // Every vertex of an outer layer is outside of the inner one: farther from the body.
    let layers = [Garment::Trousers, Garment::Jacket, Garment::Belt];
    let sheets = layers.map(|garment| samples(&garment.sheet(0.02).unwrap()));
    for (a, b) in [(0, 1), (1, 2), (0, 2)] {
        let least = sheets[a]
            .iter()
            .flat_map(|x| sheets[b].iter().map(move |y| (x - y).norm()))
            .fold(f64::INFINITY, f64::min);
        println!("{:?} {:?}: {least}", layers[a], layers[b]);
        assert!(least > 0.008, "{:?} and {:?}: {least}", layers[a], layers[b]);
    }
}

#[test]
fn bad_lengths_are_refused() {
    for cell in [0.0, -1.0, 0.1, f64::NAN] {
        let why = Garment::Dress.sheet(cell).unwrap_err().to_string();
        assert!(why.contains("length of edges"), "{why}");
    }
}
