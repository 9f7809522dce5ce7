//! What a scene does not need is not built, and the report of every frame says so.

use organza::report::Seconds;
use organza::scene::{self, LoadOptions};
use organza::world::World;

fn world(extra: &str) -> World {
    let text = format!(
        r#"{{ frames: 2, frames_per_second: 25, substeps: 1, {extra}
          cloths: [{{ mesh: {{ grid: {{ size_m: [0.2, 0.2], cells: [3, 3] }} }},
                      fabric: "woven-light" EXTRA_CLOTH }}] }}"#
    );
    let text = match extra {
        "" => text.replace("EXTRA_CLOTH", ""),
        _ => text.replace(
            "EXTRA_CLOTH",
            ", strain_limits: [0.9, 1.1], tension_field: true, remeshing: { size_m: { min: 0.02, max: 0.1 } }",
        ),
    };
    let options = LoadOptions::default();
    let loaded = scene::parse(text, "scene.json5", &options, &scene::from_sources(&[])).unwrap();
    World::new(&loaded).unwrap()
}

#[test]
fn absent_parts_are_absent() {
    let mut bare = world("");
    assert_eq!(bare.force_names(), ["membrane", "bending", "gravity"]);
    let report = bare.advance().unwrap();
    for stage in [
        "remeshing",
        "sizing by obstacles",
        "view",
        "wind",
        "strain limits",
        "tension field",
        "handles",
        "contact",
        "restraint",
        "fluid",
    ] {
        assert!(report.skipped.iter().any(|s| s.contains(stage)), "{stage}: {:?}", report.skipped);
    }
    assert!(report.remesh.is_none() && report.view.is_none());
    let Seconds { view, sizing, remesh, .. } = report.seconds;
    assert_eq!([view, sizing, remesh], [0.0; 3]);

    let mut full = world(
        r#"wind: { velocity: [1, 0, 0] }, handles: [{ select: { corners: ["lower-left"] } }],
           camera: { position: [0, -2, 1], target: [0, 0, 0] }, view: {}, contact: {},
           restraint: { thresholds: { speed: { rest_m_per_s: 1e-6, full_m_per_s: 1e-5 } } },
           obstacles: [{ mesh: { sphere: { radius_m: 0.1 } },
                                      transform: { translate: [0, 0, -1] } }],"#,
    );
    let forces = ["membrane", "bending", "strain limits", "wind", "gravity", "contact"];
    assert_eq!(full.force_names(), forces);
    let report = full.advance().unwrap();
    let idle = [
        "sizing by obstacles: no mesh size depends on them",
        "fluid: none in the scene",
        "untangling: nothing passes through anything",
    ];
    assert_eq!(report.skipped, idle);
    assert!(report.remesh.is_some() && report.view.is_some());
}
