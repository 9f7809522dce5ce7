//! Contact in a whole scene: the same bits with any number of threads, and nothing for what is far.

use mesh_core::par;
use organza::scene::{self, LoadOptions};
use organza::world::World;

fn world(more: &str) -> World {
    let text = format!(
        "{{ frames: 6, substeps: 4, contact: {{ thickness_m: 0.004 }}, {more}
          cloths: [{{ mesh: {{ grid: {{ size_m: [0.3, 0.3], cells: [12, 12] }} }},
                      fabric: 'woven-light', transform: {{ translate: [-0.15, -0.15, 0.105] }},
                      remeshing: {{ size_m: {{ min: 0.01, max: 0.05 }} }} }}] }}"
    );
    let loaded =
        scene::parse(&text, "s", &LoadOptions::default(), &scene::from_sources(&[])).unwrap();
    World::new(&loaded).unwrap()
}

const BALL: &str = "obstacles: [{ mesh: { sphere: { radius_m: 0.1 } } }],";
const FAR_BALL: &str = "obstacles: [{ mesh: { sphere: { radius_m: 0.1 } },
                                      transform: { translate: [0, 0, -100] } }],";

/// Numbers of the mesh after some frames.
fn bits(world: &mut World) -> Vec<u64> {
    let mut touched = 0;
    for _ in 0..6 {
        let report = world.advance().unwrap();
        assert_eq!(report.crossings, Some(0));
        touched += report.contacts;
    }
    let numbers = world.cloth.x.iter().chain(&world.cloth.v).flat_map(|x| x.iter().copied());
    numbers.map(f64::to_bits).chain([touched as u64]).collect()
}

#[test]
fn bits_are_the_same_at_one_and_at_two_threads() {
    let run = |n| par::with_threads(n, || bits(&mut world(BALL))).unwrap();
    let one = run(1);
    assert!(*one.last().unwrap() > 100, "cloth touches the ball");
    assert_eq!(one, run(2));
}

/// A body that nothing comes near changes no bit, and no contact is found.
#[test]
fn a_distant_obstacle_changes_nothing() {
    let far = bits(&mut world(FAR_BALL));
    let without = bits(&mut world(""));
    assert_eq!(far, without);
}
