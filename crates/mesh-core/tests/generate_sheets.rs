//! Grids, discs, tubes, spheres, boxes, capsules and rings against closed forms.

use mesh_core::generate::{
    Diagonal, GenerateError, MAX_SIZE, MAX_TRIANGLES, Sheet, Surface, boundary_chain,
    boundary_loops, capsule, cuboid, disc, grid, sphere, torus, tube,
};
use mesh_core::{HalfEdge, Mesh, VertexId, World3, geometry};
use std::f64::consts::{PI, TAU};

/// Largest relative difference of an edge's lengths in world and material space.
fn worst_stretch(sheet: &Sheet) -> f64 {
    let mesh = &sheet.mesh;
    let stretch = |h: HalfEdge| {
        let world = sheet.positions[mesh.dest(h).index()] - sheet.positions[mesh.origin(h).index()];
        (world.norm() / mesh.material_edge(h).norm() - 1.0).abs()
    };
    (0..3 * mesh.n_triangles() as u32).map(|h| stretch(HalfEdge(h))).fold(0.0, f64::max)
}

fn n_seams(mesh: &Mesh) -> usize {
    mesh.edges().filter(|&h| mesh.is_seam(h)).count()
}

fn close(a: f64, b: f64, relative: f64) {
    assert!((a / b - 1.0).abs() <= relative, "{a} instead of {b}");
}

#[test]
fn grids() {
    for diagonal in [Diagonal::One, Diagonal::Alternating] {
        let sheet = grid([3.0, 2.0], [6, 4], diagonal).unwrap();
        let mesh = &sheet.mesh;
        mesh.validate().unwrap();
        assert_eq!((mesh.n_vertices(), mesh.n_triangles()), (35, 48));
        assert_eq!(mesh.euler_characteristic(), 1);
        close(mesh.total_area(), 6.0, 1e-15);
        assert_eq!(worst_stretch(&sheet), 0.0);
        assert_eq!(n_seams(mesh), 0);
        assert_eq!(sheet.positions[2 * 7 + 3], World3::new(1.5, 1.0, 0.0));
        let loops = boundary_loops(mesh);
        assert_eq!(loops.iter().map(Vec::len).collect::<Vec<_>>(), [20]);
    }
}

#[test]
fn discs() {
    for rings in [1, 2, 3, 10, 40] {
        let sheet = disc(0.5, rings).unwrap();
        let mesh = &sheet.mesh;
        mesh.validate().unwrap();
        assert_eq!(mesh.n_vertices(), 1 + 3 * rings * (rings + 1));
        assert_eq!(mesh.n_triangles(), 6 * rings * rings);
        assert_eq!(mesh.euler_characteristic(), 1);
        // The area of the regular polygon on the circle.
        let corners = (6 * rings) as f64;
        close(mesh.total_area(), 0.5 * corners * 0.25 * (TAU / corners).sin(), 1e-13);
        assert_eq!(worst_stretch(&sheet), 0.0);
        let rim = &boundary_loops(mesh)[0];
        assert_eq!(rim.len(), 6 * rings);
        assert!(rim.iter().all(|v| (sheet.positions[v.index()].norm() - 0.5).abs() < 1e-15));
        // Edges of about the same length, triangles far from degenerate.
        let worst = mesh.material().iter().map(|&[a, b, c]| geometry::aspect(a, b, c));
        assert!(worst.fold(1.0, f64::min) > 0.8);
    }
}

#[test]
fn tubes() {
    for (around, along) in [(3, 1), (4, 2), (12, 5), (13, 7)] {
        let sheet = tube(0.2, 1.5, around, along).unwrap();
        let mesh = &sheet.mesh;
        mesh.validate().unwrap();
        assert_eq!(
            (mesh.n_vertices(), mesh.n_triangles()),
            (around * (along + 1), 2 * around * along)
        );
        assert_eq!(mesh.euler_characteristic(), 0);
        let perimeter = around as f64 * 2.0 * 0.2 * (PI / around as f64).sin();
        close(mesh.total_area(), perimeter * 1.5, 1e-14);
        assert!(worst_stretch(&sheet) < 1e-14);
        // The seam is one line of edges in the plane y = 0.
        assert_eq!(n_seams(mesh), along);
        for h in mesh.edges().filter(|&h| mesh.is_seam(h)) {
            assert_eq!(sheet.positions[mesh.origin(h).index()].y, 0.0);
        }
        let lengths: Vec<_> = boundary_loops(mesh).iter().map(Vec::len).collect();
        assert_eq!(lengths, [around, around]);
        for t in mesh.triangles() {
            let [a, b, c] = t.map(|v| sheet.positions[v as usize]);
            let outward = ((a + b + c) / 3.0).component_mul(&World3::new(1.0, 1.0, 0.0));
            assert!(geometry::area_vector(a, b, c).dot(&outward) > 0.0);
        }
    }
}

/// Volume inside, area, and vertices − edges + triangles of a surface whose edges must all pair up.
fn measure(surface: &Surface) -> (f64, f64, i64) {
    let mut edges = std::collections::BTreeMap::new();
    let (mut volume, mut area) = (0.0, 0.0);
    for t in &surface.triangles {
        let [a, b, c] = t.map(|v| surface.positions[v as usize]);
        volume += a.dot(&b.cross(&c)) / 6.0;
        area += geometry::area_vector(a, b, c).norm();
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            *edges.entry((a.min(b), a.max(b))).or_insert(0) += if a < b { 1 } else { -1 };
        }
    }
    assert!(edges.values().all(|&balance| balance == 0), "not closed or not oriented");
    let euler =
        surface.positions.len() as i64 - edges.len() as i64 + surface.triangles.len() as i64;
    (volume, area, euler)
}

#[test]
fn spheres() {
    let mut gaps = Vec::new();
    for n in 0..6u32 {
        let ball = sphere(2.0, n as usize).unwrap();
        assert_eq!(ball.positions.len(), 10 * 4usize.pow(n) + 2);
        assert_eq!(ball.triangles.len(), 20 * 4usize.pow(n));
        assert!(ball.positions.iter().all(|p| (p.norm() - 2.0).abs() < 1e-14));
        let (volume, area, euler) = measure(&ball);
        assert_eq!(euler, 2);
        gaps.push([volume / (32.0 * PI / 3.0) - 1.0, area / (16.0 * PI) - 1.0]);
    }
    // The icosahedron: V = 5 (3 + √5) a³ / 12, A = 5 √3 a² with a = R / sin(2π/5).
    let edge = 2.0 / (TAU / 5.0).sin();
    close(
        gaps[0][0] + 1.0,
        5.0 * (3.0 + 5f64.sqrt()) / 12.0 * edge.powi(3) / (32.0 * PI / 3.0),
        1e-14,
    );
    close(gaps[0][1] + 1.0, 5.0 * 3f64.sqrt() * edge * edge / (16.0 * PI), 1e-14);
    // Second order in the edge length, from inside.
    for pair in gaps[2..].windows(2) {
        for k in 0..2 {
            assert!(
                pair[1][k] < 0.0 && (3.8..4.2).contains(&(pair[0][k] / pair[1][k])),
                "{gaps:?}"
            );
        }
    }
}

#[test]
fn boxes() {
    let block = cuboid([2.0, 3.0, 5.0]).unwrap();
    assert_eq!((block.positions.len(), block.triangles.len()), (8, 12));
    // Every corner once, around the origin.
    for (k, corner) in block.positions.iter().enumerate() {
        assert_eq!(corner.abs(), World3::new(1.0, 1.5, 2.5));
        assert!(!block.positions[..k].contains(corner));
    }
    let (volume, area, euler) = measure(&block);
    assert_eq!(euler, 2);
    close(volume, 30.0, 1e-15);
    close(area, 62.0, 1e-15);
}

#[test]
fn capsules() {
    let (radius, length) = (0.5, 2.0);
    let mut gaps = Vec::new();
    for around in [8, 16, 32, 64] {
        let rod = capsule(radius, length, around).unwrap();
        let n_rings = around / 4;
        assert_eq!(rod.positions.len(), 2 + 2 * n_rings * around);
        assert_eq!(rod.triangles.len(), 4 * n_rings * around);
        for x in &rod.positions {
            let axis = World3::z() * x.z.clamp(-0.5 * length, 0.5 * length);
            assert!(((x - axis).norm() - radius).abs() < 1e-15, "{x}");
        }
        let (volume, area, euler) = measure(&rod);
        assert_eq!(euler, 2);
        let exact = PI * radius * radius * (length + 4.0 / 3.0 * radius);
        gaps.push([volume / exact - 1.0, area / (TAU * radius * (length + 2.0 * radius)) - 1.0]);
    }
    // Second order in the length of a segment, from inside.
    for pair in gaps.windows(2) {
        for k in 0..2 {
            assert!(
                pair[1][k] < 0.0 && (3.7..4.3).contains(&(pair[0][k] / pair[1][k])),
                "{gaps:?}"
            );
        }
    }
    // Other numbers of segments do as well.
    for around in [4, 5, 7] {
        assert_eq!(measure(&capsule(radius, length, around).unwrap()).2, 2);
    }
}

#[test]
fn rings() {
    let (radius, tube_radius) = (2.0, 0.5);
    let mut gaps = Vec::new();
    for n in [8, 16, 32, 64] {
        let ring = torus(radius, tube_radius, 2 * n, n).unwrap();
        assert_eq!((ring.positions.len(), ring.triangles.len()), (2 * n * n, 4 * n * n));
        for x in &ring.positions {
            let circle = World3::new(x.x, x.y, 0.0).normalize() * radius;
            assert!(((x - circle).norm() - tube_radius).abs() < 1e-14, "{x}");
        }
        let (volume, area, euler) = measure(&ring);
        assert_eq!(euler, 0);
        let circle = TAU * radius;
        gaps.push([
            volume / (circle * PI * tube_radius * tube_radius) - 1.0,
            area / (circle * TAU * tube_radius) - 1.0,
        ]);
    }
    // Second order in the length of a segment, from inside.
    for pair in gaps.windows(2) {
        for k in 0..2 {
            assert!(
                pair[1][k] < 0.0 && (3.7..4.3).contains(&(pair[0][k] / pair[1][k])),
                "{gaps:?}"
            );
        }
    }
}

#[test]
fn bad_sizes() {
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-9, 2.0 * MAX_SIZE] {
        let errors = [
            grid([bad, 1.0], [1, 1], Diagonal::One).unwrap_err(),
            grid([1.0, bad], [1, 1], Diagonal::One).unwrap_err(),
            disc(bad, 3).unwrap_err(),
            tube(bad, 1.0, 8, 1).unwrap_err(),
            tube(1.0, bad, 8, 1).unwrap_err(),
            sphere(bad, 1).unwrap_err(),
            cuboid([1.0, bad, 1.0]).unwrap_err(),
            capsule(bad, 1.0, 8).unwrap_err(),
            capsule(1.0, bad, 8).unwrap_err(),
            torus(bad, 0.1, 8, 8).unwrap_err(),
            torus(1.0, bad, 8, 8).unwrap_err(),
        ];
        for error in errors {
            assert!(
                matches!(error, GenerateError::Size { value, .. } if value.to_bits() == bad.to_bits()),
                "{error}"
            );
        }
    }
}

#[test]
fn bad_counts() {
    let few = [
        grid([1.0, 1.0], [0, 1], Diagonal::One).unwrap_err(),
        grid([1.0, 1.0], [1, 0], Diagonal::One).unwrap_err(),
        disc(1.0, 0).unwrap_err(),
        tube(1.0, 1.0, 2, 1).unwrap_err(),
        tube(1.0, 1.0, 3, 0).unwrap_err(),
        capsule(1.0, 1.0, 3).unwrap_err(),
        torus(1.0, 0.5, 2, 8).unwrap_err(),
        torus(1.0, 0.5, 8, 2).unwrap_err(),
    ];
    assert!(matches!(torus(1.0, 1.5, 8, 8).unwrap_err(), GenerateError::Size { .. }));
    for error in few {
        assert!(matches!(error, GenerateError::TooFew { .. }), "{error}");
    }
    let huge = usize::MAX;
    let many = [
        grid([1.0, 1.0], [huge, huge], Diagonal::One).unwrap_err(),
        grid([1.0, 1.0], [MAX_TRIANGLES, 1], Diagonal::One).unwrap_err(),
        disc(1.0, huge).unwrap_err(),
        tube(1.0, 1.0, huge, 1).unwrap_err(),
        sphere(1.0, 10).unwrap_err(),
        sphere(1.0, huge).unwrap_err(),
        capsule(1.0, 1.0, huge).unwrap_err(),
        torus(1.0, 0.5, huge, huge).unwrap_err(),
    ];
    for error in many {
        assert!(matches!(error, GenerateError::TooMany { .. }), "{error}");
    }
}

#[test]
fn extreme_sizes_still_work() {
    for size in [2e-6, 1e6] {
        grid([size, size], [3, 3], Diagonal::Alternating).unwrap().mesh.validate().unwrap();
        disc(size, 4).unwrap().mesh.validate().unwrap();
        tube(size, size, 5, 2).unwrap().mesh.validate().unwrap();
    }
}

#[test]
fn walking_the_boundary() {
    let mesh = grid([1.0, 1.0], [2, 2], Diagonal::One).unwrap().mesh;
    let chain = |a, b| {
        boundary_chain(&mesh, VertexId(a), VertexId(b))
            .map(|chain| chain.into_iter().map(|v| v.0).collect::<Vec<_>>())
    };
    assert_eq!(chain(0, 5).unwrap(), [0, 1, 2, 5]);
    assert_eq!(chain(5, 0).unwrap(), [5, 8, 7, 6, 3, 0]);
    assert_eq!(chain(7, 7).unwrap().len(), 9);
    for (a, b) in [(0, 4), (4, 0), (0, 9), (9, 0)] {
        assert_eq!(chain(a, b), Err(GenerateError::NoChain { from: a, to: b }));
    }
}
