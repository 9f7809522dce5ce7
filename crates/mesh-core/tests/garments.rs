//! Sewing: what fits, what does not, and the garments made by it.

use mesh_core::generate::{
    Chain, Diagonal, GenerateError, Seam, Sheet, Skirt, Tunic, boundary_loops, disc, grid, lay_out,
    poncho, sew, skirt, tunic,
};
use mesh_core::{ClothState, HalfEdge, Material2, Mesh, MeshError, VertexId, World3, geometry};
use std::f64::consts::PI;

fn chain(sheet: usize, vertices: &[u32]) -> Chain {
    Chain::new(sheet, vertices.iter().map(|&v| VertexId(v)))
}

fn seam(first: Chain, second: Chain) -> Seam {
    Seam { first, second }
}

/// Relative stretch of every half-edge.
fn stretches(sheet: &Sheet) -> impl Iterator<Item = f64> + '_ {
    let mesh = &sheet.mesh;
    (0..3 * mesh.n_triangles() as u32).map(HalfEdge).map(|h| {
        let world = sheet.positions[mesh.dest(h).index()] - sheet.positions[mesh.origin(h).index()];
        world.norm() / mesh.material_edge(h).norm() - 1.0
    })
}

fn worst_stretch(sheet: &Sheet) -> f64 {
    stretches(sheet).fold(0.0, |worst, s| worst.max(s.abs()))
}

fn n_seams(mesh: &Mesh) -> usize {
    mesh.edges().filter(|&h| mesh.is_seam(h)).count()
}

fn worst_aspect(mesh: &Mesh) -> f64 {
    mesh.material().iter().map(|&[a, b, c]| geometry::aspect(a, b, c)).fold(1.0, f64::min)
}

fn loop_lengths(mesh: &Mesh) -> Vec<usize> {
    let mut lengths: Vec<_> = boundary_loops(mesh).iter().map(Vec::len).collect();
    lengths.sort_unstable();
    lengths
}

/// Boxes around the panels in material space must not touch.
fn assert_laid_out(mesh: &Mesh) {
    let n = *mesh.panels().iter().max().unwrap();
    let mut right = f64::NEG_INFINITY;
    for panel in 0..=n {
        let corners = || {
            let of_panel = mesh.panels().iter().zip(mesh.material()).filter(|(p, _)| **p == panel);
            of_panel.flat_map(|(_, u)| u)
        };
        let low = corners().fold(f64::INFINITY, |low, u| low.min(u.x));
        assert!(low > right, "panel {panel} begins at {low}, the one before ends at {right}");
        right = corners().fold(low, |high, u| high.max(u.x));
        assert!(corners().all(|u| u.y > -1e-12));
    }
}

/// Two squares of 1 × 1 cells: vertices 0 1 / 2 3.
fn squares() -> Vec<Sheet> {
    let square = grid([1.0, 1.0], [1, 1], Diagonal::One).unwrap();
    let mut beside = square.clone();
    beside.positions.iter_mut().for_each(|x| *x += World3::new(1.5, 0.0, 0.25));
    vec![square, beside]
}

#[test]
fn two_squares() {
    let mut sheets = squares();
    lay_out(&mut sheets, 0.5);
    let sewn = sew(&sheets, &[seam(chain(0, &[1, 3]), chain(1, &[0, 2]))]).unwrap();
    let Sheet { mesh, positions, .. } = &sewn.sheet;
    mesh.validate().unwrap();
    assert_eq!((mesh.n_vertices(), mesh.euler_characteristic()), (6, 1));
    assert_eq!((n_seams(mesh), mesh.panels()), (1, &[0, 0, 1, 1][..]));
    // Seam vertices in the middle; the others where they were.
    assert_eq!(positions[1], World3::new(1.25, 0.0, 0.125));
    assert_eq!(positions[4], World3::new(2.5, 0.0, 0.25));
    let names = |s: usize| sewn.vertex_of[s].iter().map(|v| v.0).collect::<Vec<_>>();
    assert_eq!((names(0), names(1)), (vec![0, 1, 2, 3], vec![1, 4, 3, 5]));
    assert_eq!(mesh.material()[2][0], Material2::new(1.5, 0.0));
    assert_eq!(mesh.total_area(), 2.0);
}

#[test]
fn panels_of_sewn_sheets_are_numbered_on() {
    let sheets = squares();
    let pair = sew(&sheets, &[seam(chain(0, &[1, 3]), chain(1, &[0, 2]))]).unwrap().sheet;
    let both = sew(&[sheets[0].clone(), pair], &[]).unwrap().sheet;
    assert_eq!(both.mesh.panels(), [0, 0, 1, 1, 2, 2]);
    assert_eq!(both.mesh.euler_characteristic(), 2);
}

#[test]
fn seams_that_do_not_fit() {
    let sheets = squares();
    let fails = |first, second| sew(&sheets, &[seam(first, second)]).unwrap_err();
    let right = || chain(0, &[1, 3]);
    assert_eq!(
        fails(right(), chain(1, &[0, 2, 3])),
        GenerateError::SeamLength { seam: 0, first: 2, second: 3 }
    );
    assert_eq!(
        fails(chain(0, &[]), chain(1, &[])),
        GenerateError::SeamLength { seam: 0, first: 0, second: 0 }
    );
    assert_eq!(
        fails(right(), chain(1, &[0, 4])),
        GenerateError::SeamVertex { seam: 0, sheet: 1, vertex: 4 }
    );
    assert_eq!(
        fails(right(), chain(7, &[0, 2])),
        GenerateError::SeamVertex { seam: 0, sheet: 7, vertex: 0 }
    );
    // The diagonal 0–3 lies inside; 1–2 is no edge at all.
    for (a, b) in [(0, 3), (1, 2)] {
        assert_eq!(
            fails(right(), chain(1, &[a, b])),
            GenerateError::NotBoundary { seam: 0, sheet: 1, a, b }
        );
    }
    assert_eq!(
        fails(right(), chain(1, &[2, 0])),
        GenerateError::SeamDirection { seam: 0, step: 0 }
    );
    // Three sheets at one edge.
    let twice = [seam(right(), chain(1, &[0, 2])), seam(right(), chain(1, &[3, 1]))];
    assert!(matches!(sew(&sheets, &twice), Err(GenerateError::Mesh(_))));
    assert_eq!(sew(&[], &[]), Err(GenerateError::Mesh(MeshError::Empty)));
}

/// A disc and the same one seen from behind.
fn two_sides(rings: usize) -> [Sheet; 2] {
    let disc = disc(1.0, rings).unwrap();
    let flip = |u: &Material2| Material2::new(-u.x, u.y);
    let triangles: Vec<_> = disc.mesh.triangles().iter().map(|t| [t[0], t[2], t[1]]).collect();
    let material = disc.mesh.material().iter().map(|[a, b, c]| [flip(a), flip(c), flip(b)]);
    let panels = vec![0; triangles.len()];
    let n = disc.mesh.n_vertices();
    let mesh = Mesh::new(n, triangles, material.collect(), panels).unwrap();
    let back = Sheet { mesh, positions: disc.positions.clone(), borders: Vec::new() };
    [disc, back]
}

#[test]
fn a_ball_of_two_discs() {
    let rim: Vec<u32> = (7..19).chain([7]).collect();
    let ball = sew(&two_sides(2), &[seam(chain(0, &rim), chain(1, &rim))]).unwrap().sheet;
    ball.mesh.validate().unwrap();
    assert_eq!((ball.mesh.euler_characteristic(), boundary_loops(&ball.mesh).len()), (2, 0));
}

#[test]
fn an_opening_of_two_edges_falls_shut() {
    let sheets = two_sides(1);
    let along = |rim: &[u32]| sew(&sheets, &[seam(chain(0, rim), chain(1, rim))]);
    // All but one edge of the rim: the ends of the last one are joined, so it cannot stay open.
    let error = along(&[1, 2, 3, 4, 5, 6]).unwrap_err();
    assert_eq!(error, GenerateError::Closed { expected: 5, got: 6 });
    let pocket = along(&[1, 2, 3, 4, 5]).unwrap().sheet;
    assert_eq!((pocket.mesh.euler_characteristic(), loop_lengths(&pocket.mesh)), (1, vec![4]));
}

#[test]
fn skirts() {
    let base = Skirt::default();
    let shapes = [
        base,
        Skirt { hem_radius: base.waist_radius, ..base },
        Skirt { hem_radius: base.waist_radius * (1.0 + 1e-9), ..base },
        Skirt { hem_radius: 0.05, ..base },
        Skirt { hem_radius: base.waist_radius + base.length, ..base },
        Skirt { panels: 1, around: 3, along: 1, ..base },
        Skirt { panels: 2, around: 9, along: 4, hem_radius: 0.7, ..base },
    ];
    for shape in shapes {
        let sheet = skirt(&shape).unwrap();
        let (mesh, columns) = (&sheet.mesh, shape.panels * shape.around);
        mesh.validate().unwrap();
        assert_eq!(mesh.euler_characteristic(), 0);
        assert_eq!(mesh.n_vertices(), columns * (shape.along + 1));
        assert_eq!(loop_lengths(mesh), [columns, columns]);
        assert_eq!(n_seams(mesh), shape.panels * shape.along);
        assert_laid_out(mesh);
        assert!(worst_stretch(&sheet) < 1e-13, "{shape:?}: {}", worst_stretch(&sheet));
        // The facets are trapezoids between two chords.
        let half = (PI / columns as f64).sin();
        let [top, bottom] = [2.0 * shape.waist_radius * half, 2.0 * shape.hem_radius * half];
        let height = (shape.length.powi(2) - (0.5 * (bottom - top)).powi(2)).sqrt();
        let area = columns as f64 * 0.5 * (top + bottom) * height;
        assert!((mesh.total_area() / area - 1.0).abs() < 1e-13);
        let waist = sheet.positions.iter().filter(|x| x.z == 0.0).count();
        let flat = shape.hem_radius - shape.waist_radius >= shape.length;
        assert_eq!(waist, if flat { mesh.n_vertices() } else { columns });
        for t in mesh.triangles().iter().filter(|_| !flat) {
            let [a, b, c] = t.map(|v| sheet.positions[v as usize]);
            let axis = World3::new(a.x + b.x + c.x, a.y + b.y + c.y, 0.0);
            assert!(geometry::area_vector(a, b, c).dot(&axis) > 0.0);
        }
        ClothState::at_rest(sheet.mesh, sheet.positions, vec![0.2; shape.panels]).unwrap();
    }
}

#[test]
fn bad_skirts() {
    let base = Skirt::default();
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e9] {
        for shape in [
            Skirt { waist_radius: bad, ..base },
            Skirt { hem_radius: bad, ..base },
            Skirt { length: bad, ..base },
        ] {
            let error = skirt(&shape).unwrap_err();
            assert!(matches!(error, GenerateError::Size { .. }), "{error}");
        }
    }
    // Radii that differ by more than the cloth is long, both ways.
    for (waist, hem) in [(0.1, 0.8), (0.8, 0.1)] {
        let error = skirt(&Skirt { waist_radius: waist, hem_radius: hem, ..base }).unwrap_err();
        assert!(matches!(error, GenerateError::Size { value: 0.8, .. }), "{error}");
    }
    for shape in [
        Skirt { panels: 0, ..base },
        Skirt { around: 0, ..base },
        Skirt { along: 0, ..base },
        Skirt { panels: 2, around: 1, ..base },
    ] {
        assert!(matches!(skirt(&shape), Err(GenerateError::TooFew { .. })), "{shape:?}");
    }
    let huge = Skirt { panels: usize::MAX, around: usize::MAX, ..base };
    assert!(matches!(skirt(&huge), Err(GenerateError::TooMany { .. })));
}

#[test]
fn tunics() {
    let base = Tunic::default();
    let shapes = [
        base,
        Tunic { sleeve: None, ..base },
        Tunic { cell: 0.1, neck_depth: [0.0, 0.0], ..base },
        Tunic { cell: 10.0, ..base },
        Tunic { cell: 0.02, hem_width: 0.4, sleeve: Some(0.02), ..base },
    ];
    for shape in shapes {
        let sheet = tunic(&shape).unwrap();
        let mesh = &sheet.mesh;
        mesh.validate().unwrap();
        // A sphere with four holes, with sleeves or without.
        assert_eq!(mesh.euler_characteristic(), 2 - 4);
        assert_eq!(boundary_loops(mesh).len(), 4);
        assert_laid_out(mesh);
        assert!(worst_stretch(&sheet) < 2e-3, "{shape:?}: {}", worst_stretch(&sheet));
        assert!(stretches(&sheet).all(|s| s > -1e-12), "nothing is compressed");
        let n_panels = if shape.sleeve.is_some() { 4 } else { 2 };
        assert_eq!(mesh.panels().iter().max(), Some(&(n_panels - 1)));
        ClothState::at_rest(sheet.mesh, sheet.positions, vec![0.2; n_panels as usize]).unwrap();
    }
}

#[test]
fn parts_of_a_tunic() {
    // Round measures: 4 + 6 + 4 columns, 10 + 4 rows, sleeves of 5 × 8 cells.
    let shape = Tunic {
        width: 0.7,
        hem_width: 0.7,
        length: 0.7,
        armhole: 0.2,
        neck_width: 0.3,
        neck_depth: [0.12, 0.04],
        sleeve: Some(0.25),
        cell: 0.05,
    };
    let sheet = tunic(&shape).unwrap();
    let Sheet { mesh, positions, .. } = &sheet;
    assert_eq!(loop_lengths(mesh), [8, 8, 12, 28], "cuffs, neck, hem");
    // Shoulders, sides, armholes, underarms.
    assert_eq!(n_seams(mesh), 2 * 4 + 2 * 10 + 2 * 8 + 2 * 5);
    // Two rectangles without the polygons in the parabolas of the neckline, and two sleeves.
    let necklines = (0.12 + 0.04) * 0.3 * (2.0 / 3.0) * (1.0 - 1.0 / 36.0);
    let area = 2.0 * 0.49 - necklines + 2.0 * 0.4 * 0.25;
    assert!((mesh.total_area() - area).abs() < 1e-13, "{} {area}", mesh.total_area());

    // From cuff to cuff, from the hem to the shoulders; layers a tenth of a cell apart.
    let range = |k: usize| {
        let low = positions.iter().map(|x| x[k]).fold(f64::INFINITY, f64::min);
        (low, positions.iter().map(|x| x[k]).fold(low, f64::max))
    };
    let near = |(a, b): (f64, f64), (c, d): (f64, f64)| (a - c).abs().max((b - d).abs()) < 1e-12;
    assert!(near(range(0), (-0.6, 0.6)) && near(range(2), (-0.7, 0.0)), "{:?}", range(0));
    assert!(near(range(1), (-0.00125, 0.00125)), "{:?}", range(1));
    // Normals away from the other layer; front before back.
    for (t, &panel) in mesh.triangles().iter().zip(mesh.panels()) {
        let [a, b, c] = t.map(|v| positions[v as usize]);
        let (normal, y) = (geometry::area_vector(a, b, c).y, (a + b + c).y);
        assert!(normal * y > 0.0 && (panel > 1 || (y > 0.0) == (panel == 1)));
    }
    // The right sleeve is panel 2.
    let right = mesh.triangles().iter().zip(mesh.panels()).filter(|(_, p)| **p == 2);
    assert!(right.flat_map(|(t, _)| t).all(|&v| positions[v as usize].x > 0.35 - 1e-12));

    let bare = tunic(&Tunic { sleeve: None, ..shape }).unwrap();
    assert_eq!(loop_lengths(&bare.mesh), [8, 8, 12, 28], "armholes, neck, hem");
    let flared = tunic(&Tunic { hem_width: 0.9, neck_depth: [0.0; 2], ..shape }).unwrap();
    let area = 2.0 * (0.5 * (0.7 + 0.9) * 0.5 + 0.7 * 0.2) + 2.0 * 0.4 * 0.25;
    assert!((flared.mesh.total_area() - area).abs() < 1e-13);
}

#[test]
fn ponchos() {
    let sheet = poncho(1.2, 0.8, 0.3, 0.05).unwrap();
    let mesh = &sheet.mesh;
    mesh.validate().unwrap();
    assert_eq!(mesh.euler_characteristic(), 0);
    assert_eq!(loop_lengths(mesh), [2 * 6, 4 * 16 + 2 * 24]);
    assert!((mesh.total_area() - 2.0 * 1.2 * 0.8).abs() < 1e-13);
    assert_eq!(n_seams(mesh), 18);
    assert_laid_out(mesh);
    assert!(worst_stretch(&sheet) < 2e-3);
}

#[test]
fn garments_have_sound_triangles() {
    let sheets = [
        tunic(&Tunic::default()).unwrap(),
        poncho(1.2, 0.8, 0.3, 0.05).unwrap(),
        skirt(&Skirt::default()).unwrap(),
    ];
    for sheet in sheets {
        assert!(worst_aspect(&sheet.mesh) > 0.4, "{}", worst_aspect(&sheet.mesh));
    }
}

#[test]
fn garments_are_deterministic() {
    let shape = Tunic::default();
    assert_eq!(tunic(&shape), tunic(&shape));
    assert_eq!(skirt(&Skirt::default()), skirt(&Skirt::default()));
}

#[test]
fn bad_tunics() {
    let base = Tunic::default();
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e9] {
        let shapes = [
            Tunic { width: bad, ..base },
            Tunic { hem_width: bad, ..base },
            Tunic { length: bad, ..base },
            Tunic { armhole: bad, ..base },
            Tunic { neck_width: bad, ..base },
            Tunic { sleeve: Some(bad), ..base },
            Tunic { cell: bad, ..base },
        ];
        for shape in shapes {
            assert!(matches!(tunic(&shape), Err(GenerateError::Size { .. })), "{shape:?}");
        }
        for garment in [
            poncho(bad, 1.0, 0.2, 0.1),
            poncho(1.0, bad, 0.2, 0.1),
            poncho(1.0, 1.0, bad, 0.1),
            poncho(1.0, 1.0, 0.2, bad),
        ] {
            assert!(matches!(garment, Err(GenerateError::Size { .. })), "{bad}");
        }
    }
    let impossible = [
        Tunic { armhole: base.length, ..base },
        Tunic { neck_width: base.width, ..base },
        Tunic { neck_depth: [0.6 * base.length, 0.0], ..base },
        Tunic { neck_depth: [0.0, -0.01], ..base },
        Tunic { neck_depth: [0.0, f64::NAN], ..base },
    ];
    for shape in impossible {
        assert!(matches!(tunic(&shape), Err(GenerateError::Size { .. })), "{shape:?}");
    }
    let fine = Tunic { cell: 1e-6, ..base };
    assert!(matches!(tunic(&fine), Err(GenerateError::TooMany { .. })));
    let long_sleeves = Tunic { sleeve: Some(1e6), cell: 1e-3, ..base };
    assert!(matches!(tunic(&long_sleeves), Err(GenerateError::TooMany { .. })));
}
