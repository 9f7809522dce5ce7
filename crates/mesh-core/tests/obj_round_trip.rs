//! Writing OBJ and reading it back: the same bits; and reading broken files: never a panic.

use mesh_core::generate::{Diagonal, Skirt, Tunic, disc, grid, skirt, sphere, tunic};
use mesh_core::obj::{self, ObjError};
use mesh_core::{Material2, World3};
use proptest::prelude::*;
use std::io::ErrorKind;

fn written(
    positions: &[World3],
    triangles: &[[u32; 3]],
    material: Option<&[[Material2; 3]]>,
) -> String {
    let mut out = Vec::new();
    obj::write(&mut out, positions, triangles, material).unwrap();
    String::from_utf8(out).unwrap()
}

#[test]
fn meshes_come_back_with_the_same_bits() {
    let sheets = [
        grid([3.0, 2.0], [7, 5], Diagonal::Alternating).unwrap(),
        disc(0.7, 5).unwrap(),
        skirt(&Skirt::default()).unwrap(),
        tunic(&Tunic { cell: 0.1, ..Tunic::default() }).unwrap(),
    ];
    for sheet in sheets {
        let mesh = &sheet.mesh;
        let text = written(&sheet.positions, mesh.triangles(), Some(mesh.material()));
        let back = obj::read(text.as_bytes()).unwrap();
        assert_eq!(back.positions, sheet.positions);
        assert_eq!(back.triangles, mesh.triangles());
        assert_eq!(back.texture.as_deref(), Some(mesh.material()));
        let cloth = back.to_mesh().unwrap();
        assert_eq!(cloth.positions, sheet.positions);
        assert_eq!(cloth.mesh.material(), mesh.material());
        let seams = |mesh: &mesh_core::Mesh| mesh.edges().filter(|&h| mesh.is_seam(h)).count();
        assert_eq!(seams(&cloth.mesh), seams(mesh));
    }
}

#[test]
fn equal_texture_coordinates_are_written_once() {
    let sheet = grid([1.0, 1.0], [2, 2], Diagonal::One).unwrap();
    let text = written(&sheet.positions, sheet.mesh.triangles(), Some(sheet.mesh.material()));
    assert_eq!(text.lines().filter(|l| l.starts_with("vt ")).count(), 9);
    assert_eq!(text.lines().filter(|l| l.starts_with("v ")).count(), 9);
    assert_eq!(text.lines().filter(|l| l.starts_with("f ")).count(), 8);
    assert!(text.starts_with("v 0 0 0\nv 0.5 0 0\n"), "{text}");
}

#[test]
fn surfaces_without_material() {
    let ball = sphere(0.3, 2).unwrap();
    let text = written(&ball.positions, &ball.triangles, None);
    assert_eq!(obj::read(text.as_bytes()).unwrap().to_surface(), ball);
}

#[test]
fn what_cannot_be_read_back_is_not_written() {
    let (x, t) = (vec![World3::zeros(); 3], vec![[0u32, 1, 2]]);
    let mut bad = x.clone();
    bad[1].y = f64::NAN;
    let nan = [[Material2::new(0.0, f64::INFINITY); 3]];
    type Case<'a> = (&'a [World3], &'a [[u32; 3]], Option<&'a [[Material2; 3]]>, &'a str);
    let cases: [Case; 4] = [
        (&bad, &t, None, "vertex 1"),
        (&x, &[[0, 1, 3]], None, "3 vertices"),
        (&x, &t, Some(&[]), "of 0"),
        (&x, &t, Some(&nan), "triangle 0"),
    ];
    for (positions, triangles, material, words) in cases {
        let mut out = Vec::new();
        let error = obj::write(&mut out, positions, triangles, material).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::InvalidInput);
        assert!(error.to_string().contains(words), "{error}");
        assert!(out.is_empty());
    }
}

/// Any number that the reader accepts, of all sizes and with all patterns of bits.
fn coordinate() -> impl Strategy<Value = f64> {
    let bits = any::<f64>().prop_filter("accepted", |x| x.abs() <= obj::MAX_COORDINATE);
    prop_oneof![bits, -10.0..10.0f64, Just(-0.0), Just(5e-324), Just(0.1 + 0.2)]
}

proptest! {
    #[test]
    fn any_number_comes_back(numbers in prop::collection::vec(coordinate(), 15)) {
        let positions: Vec<World3> = numbers[..9].chunks(3).map(World3::from_row_slice).collect();
        let corners: Vec<Material2> = numbers[9..].chunks(2).map(Material2::from_row_slice).collect();
        let material = [[corners[0], corners[1], corners[2]]];
        let text = written(&positions, &[[0, 1, 2]], Some(&material));
        let back = obj::read(text.as_bytes()).unwrap();
        let bits = |p: &[f64]| p.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        for (a, b) in positions.iter().zip(&back.positions) {
            prop_assert_eq!(bits(a.as_slice()), bits(b.as_slice()));
        }
        for (a, b) in corners.iter().zip(&back.texture.unwrap()[0]) {
            prop_assert_eq!(bits(a.as_slice()), bits(b.as_slice()));
        }
    }
}

/// A fixed 64-bit generator (Knuth's MMIX constants): the same files on every machine.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % n
    }
}

/// Pieces that are likely to hit a weak place.
const PIECES: [&[u8]; 16] = [
    b"nan",
    b"1e999",
    b"-9223372036854775808",
    b"4294967297",
    b"0",
    b"-1",
    b"/",
    b"//",
    b"\\\n",
    b"\r",
    b"\0",
    b"\xff",
    b"\xc2\xa0",
    b"\nf ",
    b"\nv ",
    b"#",
];

fn mutate(bytes: &mut Vec<u8>, random: &mut Random) {
    let at = random.below(bytes.len().max(1)).min(bytes.len());
    let end = (at + random.below(12)).min(bytes.len());
    match random.below(5) {
        0 => bytes[at..end].iter_mut().take(1).for_each(|b| *b ^= 1 << random.below(8)),
        1 => drop(bytes.drain(at..end)),
        2 => drop(bytes.splice(at..at, PIECES[random.below(PIECES.len())].iter().copied())),
        3 => {
            let copy = bytes[at..end].to_vec();
            let to = random.below(bytes.len() + 1);
            drop(bytes.splice(to..to, copy));
        }
        _ => bytes[at..end].iter_mut().take(1).for_each(|b| *b = random.below(256) as u8),
    }
}

#[test]
fn mutated_files_never_panic() {
    let valid = b"\xef\xbb\xbf# sheet\r\nv 0 0 0\r\nv 1 0 0 1\nv 1 1 0\nv 0 1 0\nv 2 0.5 -1e-3\n\
        vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1 0\nvt 2 0.5\nvn 0 0 1\ng one\ns off\n\
        f 1/1/1 2/2/1 3/3/1 4/4/1\nl 1 2\nusemtl a\nf -4/-4 \\\n-1/-1 -3/-3 # end\n";
    obj::read(valid).unwrap().to_mesh().unwrap().mesh.validate().unwrap();
    let mut random = Random(11);
    let (mut meshes, mut files, mut refused) = (0, 0, 0);
    for _ in 0..60_000 {
        let mut bytes = valid.to_vec();
        for _ in 0..=random.below(4) {
            mutate(&mut bytes, &mut random);
        }
        let shown = || String::from_utf8_lossy(&bytes).into_owned();
        match obj::read(&bytes) {
            // What the guard lets pass the library must be able to read.
            Err(ObjError::Parser(text)) => panic!("{text}: {}", shown()),
            Err(error) => {
                assert!(!error.to_string().is_empty());
                refused += 1;
            }
            Ok(file) => {
                let n = file.positions.len() as u32;
                assert!(file.triangles.iter().flatten().all(|&v| v < n), "{}", shown());
                let surface = file.to_surface();
                assert_eq!(surface.triangles.len(), file.triangles.len());
                files += 1;
                if let Ok(cloth) = file.to_mesh() {
                    cloth.mesh.validate().unwrap();
                    meshes += 1;
                }
            }
        }
    }
    assert!(meshes > 1000 && files > meshes && refused > 1000, "{meshes} {files} {refused}");
}
