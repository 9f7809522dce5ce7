//! Tests that `validate` finds every kind of damage, planted in a sound mesh from inside the crate.

use crate::construct::MeshError;
use crate::generate::{Diagonal, grid};
use crate::ids::NONE;
use crate::mesh::Mesh;

/// The message of `validate` after `damage`.
fn found(damage: impl FnOnce(&mut Mesh)) -> String {
    let mut mesh = grid([2.0, 2.0], [2, 2], Diagonal::One).unwrap().mesh;
    mesh.validate().unwrap();
    damage(&mut mesh);
    match mesh.validate() {
        Err(MeshError::Broken(text)) => text,
        Err(other) => other.to_string(),
        Ok(()) => "nothing".into(),
    }
}

/// Half-edge 2 of the sheet is the diagonal of its first cell: inside.
const INSIDE: usize = 2;

#[test]
fn lengths() {
    assert!(found(|m| m.twin.truncate(5)).starts_with("lengths"));
    assert!(found(|m| m.material.truncate(5)).starts_with("lengths"));
    assert!(found(|m| m.panel.push(0)).starts_with("lengths"));
}

#[test]
fn corners() {
    assert!(found(|m| m.tri[0][1] = m.tri[0][0]).contains("half-edge 0 runs from 0 to 0"));
    assert!(found(|m| m.tri[0][1] = 99).contains("runs from 99 to 4"));
    assert!(found(|m| m.tri[0].swap(0, 1)).contains("disagree"));
}

#[test]
fn twins() {
    assert!(found(|m| m.twin[INSIDE] = 999).contains("half-edge 2 and its twin 999 disagree"));
    assert!(found(|m| m.twin[INSIDE] = 0).contains("half-edge 2 and its twin 0 disagree"));
    assert!(found(|m| m.twin[INSIDE] = NONE).contains("disagree"));
    // Both sides cut open: the table is consistent, but the fans are torn.
    let torn = found(|m| {
        let other = m.twin[INSIDE] as usize;
        (m.twin[INSIDE], m.twin[other]) = (NONE, NONE);
    });
    assert!(torn.contains("fan of"), "{torn}");
}

#[test]
fn doubled_triangles() {
    let doubled = found(|m| {
        m.tri.push(m.tri[0]);
        m.material.push(m.material[0]);
        m.panel.push(0);
        m.twin.extend([NONE; 3]);
    });
    assert!(doubled.contains("two half-edges run from"), "{doubled}");
}

#[test]
fn fans() {
    assert!(found(|m| m.out[4] = NONE).contains("vertex 4 has the outgoing half-edge"));
    assert!(found(|m| m.out[4] = 9999).contains("vertex 4 has the outgoing half-edge 9999"));
    assert!(found(|m| m.out[4] = m.out[0]).contains("vertex 4 has the outgoing half-edge"));
    // A boundary vertex must start at its boundary edge, or its fan comes out short.
    let unanchored = found(|m| {
        let second = m.outgoing(crate::VertexId(1)).nth(1).unwrap();
        m.out[1] = second.0;
    });
    assert!(unanchored.contains("vertex 1"), "{unanchored}");
    let isolated = found(|m| {
        m.out.push(0);
        m.uid.push(9);
        m.next_uid = 10;
    });
    assert!(isolated.contains("vertex 9 has the outgoing half-edge 0"), "{isolated}");
}

#[test]
fn material_areas() {
    assert!(found(|m| m.material[3].swap(0, 1)).contains("triangle 3 has area -0.5 m²"));
    assert!(found(|m| m.material[3][0].x = f64::NAN).contains("triangle 3 has area NaN m²"));
}

#[test]
fn names() {
    assert!(found(|m| m.uid[3] = m.uid[5]).contains("not unique"));
    assert!(found(|m| m.next_uid = 8).contains("not unique"));
}
