//! Reading OBJ: what is read, what is ignored, and the line that every error names.

use mesh_core::obj::{self, MAX_COORDINATE, ObjError, ObjMesh};
use mesh_core::{Material2, VertexId, World3};

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

fn read(text: &str) -> Result<ObjMesh, ObjError> {
    obj::read(text.as_bytes())
}

fn square(faces: &str) -> Result<ObjMesh, ObjError> {
    read(&format!("{SQUARE}{faces}"))
}

#[test]
fn coordinates_are_f64() {
    let file = read("v 0.1 1e-7 -123456.78901234567\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    assert_eq!(file.positions[0], World3::new(0.1, 1e-7, -123456.78901234567));
}

#[test]
fn polygons_become_fans() {
    let file = square("v -1 0.5 0\nf 1 2 3 4 5\nf 2 1 3\n").unwrap();
    assert_eq!(file.triangles, [[0, 1, 2], [0, 2, 3], [0, 3, 4], [1, 0, 2]]);
    assert_eq!(file.n_faces(), 2);
    let faces: Vec<_> = (0..4).map(|t| (file.face(t), file.line(t))).collect();
    assert_eq!(faces, [(0, 6), (0, 6), (0, 6), (1, 7)]);
}

#[test]
fn everything_else_is_ignored() {
    let plain = square("f 1 2 3\nf 1 3 4\n").unwrap();
    let decorated = read(
        "\u{feff}# a comment\r\nmtllib none.mtl\r\no thing\r\nv 0 0 0 # first\r\nvv 1 2 3\r\n\
         vn 0 0 1\r\nv 1 0 0 1\r\nv 1 1 0 0.5 0.5 0.5\r\n\tv   0\t1 0\r\ng one\r\nusemtl red\r\ns 1\r\n\
         f 1//1 2//1 3//1\r\ng two\r\nl 1 2\r\np 1\r\ncurv nonsense nan\r\nf -4//-1 \\\r\n -2// -1\r\n",
    )
    .unwrap();
    assert_eq!(decorated.positions, plain.positions);
    assert_eq!(decorated.triangles, plain.triangles);
    assert_eq!(decorated.texture, None);
    assert_eq!((decorated.line(0), decorated.line(1)), (13, 18));
    assert_eq!(decorated.vertex_line(3), 9);
}

#[test]
fn groups_share_vertices_and_keep_the_numbering() {
    // A parser that numbers by first use, or anew in every group, fails here.
    let file = square("g b\nf 3 4 1\ng a\nf 1 2 3\n").unwrap();
    assert_eq!(file.triangles, [[2, 3, 0], [0, 1, 2]]);
    assert_eq!(file.to_mesh().unwrap().mesh.n_vertices(), 4);
}

#[test]
fn groups_and_objects_are_panels() {
    let text =
        "v -1 0 0\ng gone\nf 1 2 3\no Back side \ng front # main\nf 1 3 4\ng gone\nf 5 1 4\n";
    let file = square(text).unwrap();
    assert_eq!(file.groups, ["gone", "front"]);
    assert_eq!([0, 1, 2].map(|t| file.group(t)), [0, 1, 0]);
    assert_eq!(file.to_mesh().unwrap().mesh.panels(), [0, 1, 0]);
    let file = square("f 1 2 3\no Back\t side \nf 1 3 4\n").unwrap();
    assert_eq!(file.groups, ["default", "Back side"]);
    let file = square("g\nf 1 2 3 4\n").unwrap();
    assert_eq!((&*file.groups, file.group(1)), (&[String::new()][..], 0));
}

#[test]
fn relative_and_later_indices() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nf 2 4 3\nv 1 1 0\n";
    assert_eq!(read(text).unwrap().triangles, [[0, 1, 2], [1, 3, 2]]);
}

#[test]
fn texture_coordinates_make_seams() {
    let vt = "vt 0 0\nvt 2 0\nvt 2 3 0\nvt 5 0\nvt 7 3\nvt 5 3\n";
    let file = square(&format!("{vt}f 1/1 2/2 3/3\nf 1/4/9 3/5 4/-1\n")).unwrap();
    let u = file.texture.clone().unwrap();
    assert_eq!(
        u[1],
        [Material2::new(5.0, 0.0), Material2::new(7.0, 3.0), Material2::new(5.0, 3.0)]
    );
    let cloth = file.to_mesh().unwrap();
    cloth.mesh.validate().unwrap();
    assert_eq!(cloth.mesh.total_area(), 6.0);
    assert_eq!(cloth.mesh.edges().filter(|&h| cloth.mesh.is_seam(h)).count(), 1);
    assert_eq!(cloth.mesh.panels(), [0, 0]);
}

#[test]
fn texture_coordinates_that_no_face_uses_do_not_count() {
    let file = square("vt 9 9\nvt 8 8\nvt 7 7\nvt 6 6\nvt 5 5\nvt 4 4\nf 1 2 3\n").unwrap();
    assert_eq!(file.texture, None);
    assert_eq!(file.to_mesh().unwrap().mesh.total_area(), 0.5);
}

#[test]
fn unused_vertices_are_left_out_but_named() {
    let file = read("v 9 9 9\nv 0 0 0\nv 8 8 8\nv 1 0 0\nv 0 1 0\nv 7 7 7\nf 2 4 5\n").unwrap();
    assert_eq!(file.positions.len(), 6);
    assert_eq!(file.positions[2], World3::new(8.0, 8.0, 8.0));
    let cloth = file.to_mesh().unwrap();
    let v = |i| Some(VertexId(i));
    assert_eq!(cloth.vertex_of_file, [None, v(0), None, v(1), v(2), None]);
    assert_eq!(cloth.positions, [World3::zeros(), World3::x(), World3::y()]);
    let surface = file.to_surface();
    assert_eq!((surface.positions, surface.triangles), (cloth.positions, vec![[0, 1, 2]]));
}

#[test]
fn equal_positions_stay_apart() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 4 5 6\n";
    let mesh = read(text).unwrap().to_mesh().unwrap().mesh;
    assert_eq!((mesh.n_vertices(), mesh.euler_characteristic()), (6, 2));
}

#[test]
fn separate_material_space() {
    // A band standing upright over its pattern, cut in two pieces with vertices of their own.
    let world =
        read("v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 1 1 0\nv 1 1 1\nf 1 2 3 4\nf 2 5 3\nf 3 5 6\n");
    let pattern = "v 5 0 3\nv 4 0 3\nv 4 2 3\nv 5 2 3\nv 7 0 0\nv 8 0 0\nv 8 2 0\nv 7 2 0\n\
                   f 2 1 4 3\nf 5 6 8\nf 8 6 7\n";
    let cloth = world.unwrap().to_mesh_with(&read(pattern).unwrap()).unwrap();
    cloth.mesh.validate().unwrap();
    assert_eq!((cloth.mesh.n_vertices(), cloth.mesh.total_area()), (6, 4.0));
    assert_eq!(cloth.mesh.edges().filter(|&h| cloth.mesh.is_seam(h)).count(), 1);
    let u = cloth.mesh.material()[0];
    assert_eq!(u, [[4.0, 0.0], [5.0, 0.0], [5.0, 2.0]].map(Material2::from));
    assert_eq!(cloth.positions[2], World3::new(1.0, 0.0, 1.0));
}

#[test]
fn separate_material_space_with_other_faces() {
    let world = square("f 1 2 3\nf 1 3 4\n").unwrap();
    let error = world.to_mesh_with(&square("f 1 2 3\n").unwrap()).unwrap_err();
    assert!(error.to_string().ends_with("1 instead of 2"), "{error}");
    let quads = square("f 1 2 3 4\nf 1 2 3\n").unwrap();
    let error = world.to_mesh_with(&quads).unwrap_err();
    assert!(matches!(&error, ObjError::MaterialFaces(text) if text.contains("line 5")), "{error}");
    let last = square("f 1 2 3\nf 1 2 3 4\n").unwrap();
    let error = world.to_mesh_with(&last).unwrap_err();
    assert!(matches!(&error, ObjError::MaterialFaces(text) if text.contains("line 6")), "{error}");

    let turned = read("# flat\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 3 2\n").unwrap();
    let error = world.to_mesh_with(&turned).unwrap_err();
    let inner = ObjError::MaterialArea { line: 6, face: 2, area: -0.5 };
    assert_eq!(error, ObjError::MaterialSpace(Box::new(inner)));
}

#[test]
fn empty_files() {
    assert_eq!(read(""), Err(ObjError::NoVertices));
    assert_eq!(read("\u{feff}"), Err(ObjError::NoVertices));
    assert_eq!(read("# nothing\n\n\r\n"), Err(ObjError::NoVertices));
    assert_eq!(read("hello, this is a letter\n"), Err(ObjError::NoVertices));
    assert_eq!(read("f 1 2 3\n"), Err(ObjError::NoVertices));
    assert_eq!(square(""), Err(ObjError::NoFaces));
    assert_eq!(square("l 1 2\np 3\n"), Err(ObjError::NoFaces));
}

#[test]
fn bad_numbers() {
    for garbage in ["one", "1,5", "0x10", "--1", "1e", "1.2.3", "1d5", "½"] {
        let error = read(&format!("# head\n{SQUARE}v 0 {garbage} 0\nf 1 2 3\n")).unwrap_err();
        let text = format!("v 0 {garbage} 0");
        assert_eq!(error, ObjError::Number { line: 6, text });
    }
    let error = square("vt 0 1\n\nvt x 1\nf 1/1 2/1 3/1\n").unwrap_err();
    assert_eq!(error, ObjError::Number { line: 7, text: "vt x 1".into() });
    let long = format!("v 0 0 {}\nf 1 1 1\n", "z".repeat(1000));
    let Err(ObjError::Number { line: 1, text }) = read(&long) else { panic!() };
    assert_eq!(text.chars().count(), 41);
}

#[test]
fn too_few_or_many_numbers() {
    for (line, got) in
        [("v", 0), ("v 1", 1), ("v 1 2", 2), ("v 1 2 3 4 5", 5), ("v 1 2 3 4 5 6 7 8", 8)]
    {
        let error = square(&format!("{line}\nf 1 2 3\n")).unwrap_err();
        assert_eq!(error, ObjError::Coordinates { line: 5, keyword: "v", expected: "3", got });
    }
    for (line, got) in [("vt", 0), ("vt 1", 1), ("vt 1 2 3 4", 4)] {
        let error = square(&format!("{line}\nf 1 2 3\n")).unwrap_err();
        assert_eq!(error, ObjError::Coordinates { line: 5, keyword: "vt", expected: "2", got });
    }
}

#[test]
fn coordinates_that_are_not_finite_or_absurd() {
    for value in ["nan", "NaN", "inf", "-Infinity", "1e999"] {
        let error = read(&format!("{SQUARE}v 0 0 {value}\nf 1 2 3\n")).unwrap_err();
        assert!(matches!(error, ObjError::NotFinite { line: 5, keyword: "v", .. }), "{error}");
        let error = square(&format!("vt 0 0\nvt {value} 0\nf 1/1 2/1 3/1\n")).unwrap_err();
        assert!(matches!(error, ObjError::NotFinite { line: 6, keyword: "vt", .. }), "{error}");
    }
    let error = square("v 0 -1e30 0\nf 1 2 3\n").unwrap_err();
    assert_eq!(error, ObjError::TooLarge { line: 5, keyword: "v", value: -1e30 });
    assert!(square(&format!("v 0 {MAX_COORDINATE} 0\nf 1 2 3\n")).is_ok());
}

#[test]
fn faces_without_enough_corners() {
    for (face, got) in [("f", 0), ("f 1", 1), ("f 1 2", 2), ("f 1/1 2/1 # 3/1", 2)] {
        let error = square(&format!("vt 0 0\n{face}\n")).unwrap_err();
        assert_eq!(error, ObjError::Corners { line: 6, got });
    }
}

#[test]
fn bad_corners() {
    for corner in ["x", "1/x", "1//x", "/1", "//", "1/1/1/1", "1.0", "1\\2", "99999999999999999999"]
    {
        let error = square(&format!("vt 0 0\nvn 0 0 1\nf 1/1 2/1 {corner}\n")).unwrap_err();
        assert_eq!(error, ObjError::Corner { line: 7, text: corner.into() });
    }
}

#[test]
fn indices_out_of_range() {
    let index = |index, keyword, count| ObjError::Index { line: 6, keyword, index, count };
    for i in [0, 5, -5, i64::MAX, i64::MIN] {
        let error = square(&format!("vt 0 0\nf 1 2 {i}\n")).unwrap_err();
        assert_eq!(error, index(i, "v", 4));
        let error = square(&format!("vt 0 0\nf 1/1 2/1 3/{i}\n")).unwrap_err();
        if i != 5 {
            assert_eq!(error, index(i, "vt", 1));
        }
    }
    assert_eq!(square("vt 0 0\nf 1/1 2/2 3/1\n"), Err(index(2, "vt", 1)));
    // Relative to what stands before the face.
    let error = read("v 0 0 0\nv 1 0 0\nf 1 2 -3\nv 0 1 0\n").unwrap_err();
    assert_eq!(error, ObjError::Index { line: 3, keyword: "v", index: -3, count: 2 });
}

#[test]
fn mixed_texture_coordinates() {
    let error = square("vt 0 0\nf 1/1 2/1 3\n").unwrap_err();
    assert_eq!(error, ObjError::MixedTexture { line: 6, has: false });
    let error = square("vt 0 0\nf 1 2 3\nf 1/1 3/1 4/1\n").unwrap_err();
    assert_eq!(error, ObjError::MixedTexture { line: 7, has: true });
    assert!(error.to_string().contains("a face with texture"), "{error}");
}

#[test]
fn binary_data() {
    assert_eq!(obj::read(b"v 0 0 0\n\0\x01\x02"), Err(ObjError::Binary { line: 2 }));
    // UTF-16 as some editors write it.
    let wide: Vec<u8> = SQUARE.encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert_eq!(obj::read(&wide), Err(ObjError::Binary { line: 1 }));
    // Latin-1 in names does no harm.
    assert!(obj::read(&[SQUARE.as_bytes(), b"g gro\xdf\nf 1 2 3\n"].concat()).is_ok());
}

#[test]
fn defects_of_the_mesh_name_lines() {
    let error = |faces: &str| square(faces).unwrap().to_mesh().unwrap_err();
    assert_eq!(
        error("f 1 2 3\n\nf 1 4 3\n"),
        ObjError::MaterialArea { line: 7, face: 2, area: -0.5 }
    );
    // A quad with three corners on a line: its second triangle is empty.
    let flat = "v 0.5 0 0\nf 1 2 3 4\nf 1 5 2\n";
    assert_eq!(error(flat), ObjError::MaterialArea { line: 7, face: 2, area: 0.0 });
    assert_eq!(error("f 1 2 3\nf 4 1 4\n"), ObjError::RepeatedVertex { line: 6, vertex: 4 });

    // Unused vertices in front: numbers are those of the file, not of the mesh.
    let twice = "v 2 0 0\nv 2 1 0\nf 2 5 6 3\nf 2 5 4\n";
    assert_eq!(error(twice), ObjError::Edge { line: 8, other: 7, a: 2, b: 5 });
    // Two triangles that share one vertex only.
    let bow_tie = "v -1 0 0\nv 0 -1 0\nf 1 2 3\nf 1 5 6\n";
    assert_eq!(error(bow_tie), ObjError::Vertex { line: 1, vertex: 1 });
}

#[test]
fn closed_surfaces_have_no_flat_material_space() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    let file = read(text).unwrap();
    assert_eq!(file.to_surface().triangles.len(), 4);
    let error = file.to_mesh().unwrap_err();
    assert_eq!(error, ObjError::MaterialArea { line: 5, face: 1, area: -0.5 });
}
