//! The meshes that ARCSim ships, where they are at hand: a folder named by the environment variable
//! `ORGANZA_ARCSIM`, or `shared/arcsim` beside the workspace.

use mesh_core::obj::{self, ObjError, ObjMesh};
use mesh_core::{ClothState, Material2, World3};
use std::path::{Path, PathBuf};

fn mesh(name: &str) -> Option<ObjMesh> {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/arcsim");
    let folder = std::env::var_os("ORGANZA_ARCSIM").map_or_else(beside, PathBuf::from);
    if !folder.is_dir() {
        eprintln!("skipped: no ARCSim data in {}", folder.display());
        return None;
    }
    let bytes = std::fs::read(folder.join("meshes").join(name)).unwrap();
    Some(obj::read(&bytes).unwrap())
}

#[test]
fn flag() {
    let Some(file) = mesh("flag.obj") else { return };
    assert_eq!((file.positions.len(), file.n_faces(), file.triangles.len()), (58, 97, 97));
    assert_eq!(file.texture, None);
    let cloth = file.to_mesh().unwrap();
    cloth.mesh.validate().unwrap();
    assert_eq!(cloth.mesh.euler_characteristic(), 1);
    assert!((cloth.mesh.total_area() - 6.0).abs() < 1e-5, "{}", cloth.mesh.total_area());
    // The scene holds nodes 0 and 3 of the file: the corners at the pole.
    let held = [0, 3].map(|i| cloth.positions[cloth.vertex_of_file[i].unwrap().index()]);
    assert_eq!(held, [World3::zeros(), World3::new(0.0, 2.0, 0.0)]);
    let state = ClothState::at_rest(cloth.mesh, cloth.positions, vec![0.284]).unwrap();
    assert!((state.total_mass() - 0.284 * 6.0).abs() < 1e-5);
}

#[test]
fn square() {
    let Some(file) = mesh("square4.obj") else { return };
    // Texture coordinates with a third number, velocities, faces before later vertices.
    assert_eq!((file.positions.len(), file.triangles.len()), (5, 4));
    let texture = file.texture.clone().unwrap();
    for (t, u) in file.triangles.iter().zip(texture) {
        let flat = t.map(|v| file.positions[v as usize].xy());
        assert_eq!(u, flat.map(|p| Material2::new(p.x, p.y)));
    }
    let cloth = file.to_mesh().unwrap();
    cloth.mesh.validate().unwrap();
    assert_eq!((cloth.mesh.total_area(), cloth.mesh.euler_characteristic()), (1.0, 1));
    assert!(!cloth.mesh.edges().any(|h| cloth.mesh.is_seam(h)));
}

#[test]
fn sphere() {
    let Some(file) = mesh("sphere.obj") else { return };
    let surface = file.to_surface();
    assert_eq!((surface.positions.len(), surface.triangles.len()), (642, 1280));
    // Written with six digits, and not quite round.
    assert!(surface.positions.iter().all(|p| (p.norm() - 1.0).abs() < 2e-5));
    // A closed surface has no flat material space: an obstacle, not cloth.
    let error = file.to_mesh().unwrap_err();
    assert!(matches!(error, ObjError::MaterialArea { .. }), "{error}");
}
