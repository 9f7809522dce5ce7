//! Every way in which building a mesh or a state can fail, and what the message says.

use mesh_core::generate::{Diagonal, grid};
use mesh_core::{ClothState, Material2, Mesh, MeshError, World3};

fn u(x: f64, y: f64) -> Material2 {
    Material2::new(x, y)
}

/// A mesh over corners of the unit square and a few points around it, material = position.
fn build(triangles: &[[u32; 3]]) -> Result<Mesh, MeshError> {
    let points = [
        u(0.0, 0.0),
        u(1.0, 0.0),
        u(1.0, 1.0),
        u(0.0, 1.0),
        u(-1.0, 0.0),
        u(0.0, -1.0),
        u(2.0, 2.0),
    ];
    let material = triangles.iter().map(|t| t.map(|v| points[v as usize % 7])).collect();
    let used = triangles.iter().flatten().map(|v| v % 100 + 1).max().unwrap_or(0) as usize;
    Mesh::new(used.min(7), triangles.to_vec(), material, vec![0; triangles.len()])
}

fn unit() -> [Material2; 3] {
    [u(0.0, 0.0), u(1.0, 0.0), u(0.0, 1.0)]
}

#[test]
fn a_square() {
    let mesh = build(&[[0, 1, 2], [0, 2, 3]]).unwrap();
    mesh.validate().unwrap();
    assert_eq!((mesh.n_vertices(), mesh.total_area(), mesh.euler_characteristic()), (4, 1.0, 1));
    assert_eq!(mesh.edges().filter(|&h| mesh.is_boundary_edge(h)).count(), 4);
}

#[test]
fn empty() {
    assert_eq!(build(&[]), Err(MeshError::Empty));
}

#[test]
fn lengths() {
    let triangles = vec![[0, 1, 2]];
    let error = Mesh::new(3, triangles.clone(), vec![], vec![0]).unwrap_err();
    assert_eq!(error, MeshError::Length { what: "material corners", expected: 1, got: 0 });
    let error = Mesh::new(3, triangles, vec![unit()], vec![0, 0]).unwrap_err();
    assert_eq!(error, MeshError::Length { what: "panels", expected: 1, got: 2 });
    assert_eq!(error.to_string(), "panels: expected 1 entries, got 2");
}

#[test]
fn indices() {
    for vertex in [3, u32::MAX] {
        let error = Mesh::new(3, vec![[0, 1, vertex]], vec![unit()], vec![0]).unwrap_err();
        assert_eq!(error, MeshError::Index { triangle: 0, vertex, n_vertices: 3 });
    }
    for (corners, vertex) in [([0, 0, 1], 0), ([1, 0, 0], 0), ([0, 1, 0], 0), ([2, 2, 2], 2)] {
        let error = Mesh::new(3, vec![corners], vec![unit()], vec![0]).unwrap_err();
        assert_eq!(error, MeshError::RepeatedVertex { triangle: 0, vertex });
    }
}

#[test]
fn material_coordinates() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let corners = [u(0.0, 0.0), u(1.0, 0.0), u(0.0, bad)];
        let error = Mesh::new(3, vec![[0, 1, 2]], vec![corners], vec![0]).unwrap_err();
        assert!(matches!(error, MeshError::NotFinite { index: 0, .. }), "{error}");
    }
    assert_eq!(
        build(&[[0, 1, 2], [0, 3, 2]]),
        Err(MeshError::MaterialArea { triangle: 1, area: -0.5 })
    );
    assert_eq!(build(&[[4, 0, 1]]), Err(MeshError::MaterialArea { triangle: 0, area: 0.0 }));
    // A height below the rounding of the coordinates counts as none, however small the triangle.
    for size in [1.0, 1e-9] {
        let corners = [u(0.0, 0.0), u(size, 0.0), u(0.5 * size, 1e-16 * size)];
        let error = Mesh::new(3, vec![[0, 1, 2]], vec![corners], vec![0]).unwrap_err();
        assert!(matches!(error, MeshError::MaterialArea { triangle: 0, .. }), "{error}");
    }
}

#[test]
fn edges() {
    // Twice the same triangle, three triangles at one edge, two of opposite orientation.
    let edge = |triangles: &[[u32; 3]]| match build(triangles) {
        Err(MeshError::Edge { a, b, first, second }) => (a, b, first, second),
        other => panic!("{other:?}"),
    };
    assert_eq!(edge(&[[0, 1, 2], [0, 1, 2]]), (0, 1, 0, 1));
    assert_eq!(edge(&[[0, 2, 3], [0, 1, 2], [5, 2, 0]]), (0, 2, 1, 2));
    assert_eq!(edge(&[[0, 1, 2], [0, 1, 3]]), (0, 1, 0, 1));
}

#[test]
fn vertices() {
    let lonely = Mesh::new(4, vec![[0, 1, 3]], vec![unit()], vec![0]);
    assert_eq!(lonely, Err(MeshError::Isolated { vertex: 2 }));
    // Two triangles that meet in vertex 0 only.
    let bow_tie = Mesh::new(5, vec![[0, 1, 2], [0, 3, 4]], vec![unit(); 2], vec![0; 2]);
    assert_eq!(bow_tie, Err(MeshError::Vertex { vertex: 0 }));
    // Two closed fans at one vertex: cones tip to tip.
    let cone = |rim: [u32; 3]| (0..3).map(move |k| [0, rim[k], rim[(k + 1) % 3]]);
    let triangles: Vec<_> = cone([1, 2, 3]).chain(cone([4, 5, 6])).collect();
    let hourglass = Mesh::new(7, triangles, vec![unit(); 6], vec![0; 6]);
    assert_eq!(hourglass, Err(MeshError::Vertex { vertex: 0 }));
}

#[test]
fn names() {
    let mesh = build(&[[0, 1, 2], [0, 2, 3]]).unwrap();
    let named = mesh.clone().with_uids(vec![9, 3, 7, 1], 10).unwrap();
    named.validate().unwrap();
    assert_eq!((named.uids(), named.next_uid()), (&[9, 3, 7, 1][..], 10));
    let error = mesh.clone().with_uids(vec![1, 2], 10).unwrap_err();
    assert_eq!(error, MeshError::Length { what: "vertex names", expected: 4, got: 2 });
    for (uids, next) in [(vec![1, 2, 2, 3], 10), (vec![0, 1, 2, 3], 3)] {
        let error = mesh.clone().with_uids(uids, next).unwrap_err();
        assert!(matches!(error, MeshError::Broken(_)), "{error}");
    }
}

#[test]
fn states() {
    let sheet = grid([1.0, 1.0], [1, 1], Diagonal::One).unwrap();
    let state = |x: Vec<World3>, v: Vec<World3>, density: Vec<f64>| {
        ClothState::new(sheet.mesh.clone(), x, v, density).unwrap_err()
    };
    let (x, v) = (sheet.positions.clone(), vec![World3::zeros(); 4]);
    let few = vec![World3::zeros(); 3];
    let length = |what, got| MeshError::Length { what, expected: 4, got };
    assert_eq!(state(few.clone(), v.clone(), vec![0.1]), length("position of vertex", 3));
    assert_eq!(state(x.clone(), few, vec![0.1]), length("velocity of vertex", 3));
    let panels = MeshError::Length { what: "panel densities", expected: 1, got: 0 };
    assert_eq!(state(x.clone(), v.clone(), vec![]), panels);
    for bad in [f64::NAN, f64::INFINITY] {
        let mut wrong = v.clone();
        wrong[2].z = bad;
        let what = "velocity of vertex";
        assert_eq!(
            state(x.clone(), wrong.clone(), vec![0.1]),
            MeshError::NotFinite { what, index: 2 }
        );
        let what = "position of vertex";
        assert_eq!(state(wrong, v.clone(), vec![0.1]), MeshError::NotFinite { what, index: 2 });
    }
    for density in [0.0, -1.0, f64::INFINITY] {
        let error = state(x.clone(), v.clone(), vec![0.1, density]);
        assert_eq!(error, MeshError::Density { panel: 1, density });
    }
    assert!(matches!(state(x, v, vec![f64::NAN]), MeshError::Density { panel: 0, .. }));
}
