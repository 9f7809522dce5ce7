//! Takes the common mesh of a world apart into its garments.

use io_mcap::OwnedGarment;

use crate::world::World;

/// Colours of garments in the order of the scene, then again from the first: red, green, blue.
/// Chosen to stay apart from each other and from the warm back side in pictures.
pub const PALETTE: [[u8; 3]; 6] =
    [[88, 131, 165], [168, 84, 80], [96, 140, 96], [130, 104, 156], [70, 138, 138], [150, 96, 124]];

/// The garments of a world as they are now, in the order of the scene: vertices keep their order,
/// and are numbered anew inside each garment.
pub fn garments(world: &World) -> Vec<OwnedGarment> {
    let mesh = &world.cloth.mesh;
    let n_panels = world.garments.iter().map(|g| g.panels.end as usize).max().unwrap_or(0);
    let mut garment_of_panel = vec![usize::MAX; n_panels];
    for (k, garment) in world.garments.iter().enumerate() {
        garment_of_panel[garment.panels.start as usize..garment.panels.end as usize].fill(k);
    }
    // A garment is a set of whole components: each vertex belongs to one.
    let mut garment_of_vertex = vec![usize::MAX; mesh.n_vertices()];
    for (t, &panel) in mesh.triangles().iter().zip(mesh.panels()) {
        for &v in t {
            garment_of_vertex[v as usize] = garment_of_panel[panel as usize];
        }
    }
    let mut out: Vec<OwnedGarment> = world
        .garments
        .iter()
        .enumerate()
        .map(|(k, garment)| {
            let [r, g, b] = PALETTE[k % PALETTE.len()].map(|c| f32::from(c) / 255.0);
            OwnedGarment {
                name: garment.name.clone(),
                points: Vec::new(),
                triangles: Vec::new(),
                material: Vec::new(),
                color: [r, g, b, 1.0],
            }
        })
        .collect();
    let mut local = vec![0; mesh.n_vertices()];
    for (v, &k) in garment_of_vertex.iter().enumerate() {
        if let Some(garment) = out.get_mut(k) {
            local[v] = garment.points.len() as u32;
            garment.points.push(world.cloth.x[v].into());
        }
    }
    for ((t, u), &panel) in mesh.triangles().iter().zip(mesh.material()).zip(mesh.panels()) {
        let garment = &mut out[garment_of_panel[panel as usize]];
        garment.triangles.push(t.map(|v| local[v as usize]));
        garment.material.push(u.map(Into::into));
    }
    out
}
