//! The borders that generators name: whole loops of the boundary, or sides of a rectangle.

use mesh_core::VertexId;
use mesh_core::generate::*;

fn border<'a>(sheet: &'a Sheet, name: &str) -> &'a [VertexId] {
    let found = sheet.borders.iter().find(|b| b.name == name);
    &found.unwrap_or_else(|| panic!("no border {name}")).vertices
}

/// Asserts that the borders are these, and together the loops of the boundary, one each.
#[track_caller]
fn assert_loops(sheet: &Sheet, names: &[&str]) {
    let named: Vec<&str> = sheet.borders.iter().map(|b| b.name).collect();
    assert_eq!(named, names);
    let mut loops = boundary_loops(&sheet.mesh);
    loops.iter_mut().for_each(|vertices| vertices.sort_unstable());
    let mut borders: Vec<_> = sheet.borders.iter().map(|b| b.vertices.clone()).collect();
    loops.sort();
    borders.sort();
    assert_eq!(borders, loops);
}

/// Asserts that a border lies at the height z (m).
#[track_caller]
fn assert_level(sheet: &Sheet, name: &str, z: f64) {
    for &v in border(sheet, name) {
        assert!((sheet.positions[v.index()].z - z).abs() < 1e-12, "{name}");
    }
}

#[test]
fn sides_of_a_grid() {
    let sheet = grid([3.0, 2.0], [3, 2], Diagonal::Alternating).unwrap();
    for (name, axis, at, n) in
        [("left", 0, 0.0, 3), ("right", 0, 3.0, 3), ("lower", 1, 0.0, 4), ("upper", 1, 2.0, 4)]
    {
        let vertices = border(&sheet, name);
        assert_eq!(vertices.len(), n, "{name}");
        assert!(vertices.iter().all(|v| sheet.positions[v.index()][axis] == at), "{name}");
    }
    assert_eq!(sheet.borders.len(), 4);
}

#[test]
fn openings_of_round_sheets() {
    assert_loops(&disc(1.0, 3).unwrap(), &["rim"]);
    let sheet = tube(0.5, 2.0, 7, 3).unwrap();
    assert_loops(&sheet, &["lower", "upper"]);
    assert_level(&sheet, "lower", 0.0);
    assert_level(&sheet, "upper", 2.0);
    // Wider below, straight, narrower below, and a half circle in one panel.
    for (hem_radius, panels) in [(0.4, 6), (0.12, 2), (0.06, 3), (0.44, 1)] {
        let shape = Skirt { hem_radius, panels, ..Skirt::default() };
        let sheet = skirt(&shape).unwrap();
        assert_loops(&sheet, &["hem", "waist"]);
        assert_level(&sheet, "waist", 0.0);
        assert_eq!(border(&sheet, "waist").len(), panels * shape.around);
    }
}

#[test]
fn openings_of_garments_of_two_layers() {
    for (sleeve, names) in [
        (Some(0.3), ["hem", "neck", "right-cuff", "left-cuff"]),
        (None, ["hem", "neck", "right-armhole", "left-armhole"]),
    ] {
        let sheet = tunic(&Tunic { sleeve, ..Tunic::default() }).unwrap();
        assert_loops(&sheet, &names);
        assert_level(&sheet, "hem", -0.8);
        let side = |name: &str| border(&sheet, name).iter().map(|v| sheet.positions[v.index()].x);
        assert!(side(names[2]).all(|x| x > 0.25) && side(names[3]).all(|x| x < -0.25));
        assert!(side("neck").all(|x| x.abs() < 0.13 + 1e-12));
    }
    assert_loops(&poncho(1.2, 0.8, 0.3, 0.1).unwrap(), &["neck", "outline"]);
}
