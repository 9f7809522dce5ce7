//! The obstacles of a world as recordings hold them.

use io_mcap::OwnedObstacle;

use crate::world::World;

/// Colour of obstacles: a pale grey that no garment has.
const GREY: [u8; 3] = [198, 196, 192];

/// The obstacles of a world that are there now where they are, in the order of the scene. Those that
/// rest are in every frame too, so that each can be read by itself.
pub fn obstacles(world: &World) -> Vec<OwnedObstacle> {
    let [r, g, b] = GREY.map(|c| f32::from(c) / 255.0);
    let there = world.obstacles.iter().filter(|obstacle| obstacle.is_there(world.time()));
    let drawn = there.map(|obstacle| OwnedObstacle {
        name: obstacle.name.clone(),
        points: obstacle.positions(world.time()).into_iter().map(Into::into).collect(),
        triangles: obstacle.triangles.clone(),
        color: [r, g, b, 1.0],
    });
    drawn.collect()
}
