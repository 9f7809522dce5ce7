//! `organza check`.

use std::fmt::{self, Write};
use std::ops::Range;

use organza::fabric::Fabric;
use organza::fluid::Water;
use organza::record::{garments, place};
use organza::scene::{self, Cloth, Dialect, LoadOptions, Loaded};
use organza::world::World;

use super::args::Check;
use super::{Failure, output};

pub(crate) fn run(args: &Check) -> Result<(), Failure> {
    let load = LoadOptions {
        sets: args.scene.sets.clone(),
        allow_unsupported: args.scene.allow_unsupported,
    };
    let loaded = scene::load(&args.scene.scene, &load)?;
    let world = World::new(&loaded).map_err(|error| place(&loaded, &error))?;
    output::warnings(&loaded.warnings);
    world.warnings.iter().for_each(|warning| output::warning(warning));
    let mut text = String::new();
    // Writing to a String cannot fail.
    let _ = write(&mut text, &loaded, &world);
    output::print(&text)
}

fn write(out: &mut String, loaded: &Loaded, world: &World) -> fmt::Result {
    let scene = &loaded.scene;
    let dialect = match loaded.dialect {
        Dialect::Organza => "Organza",
        Dialect::Arcsim => "ARCSim",
    };
    let file = loaded.sources.first().map_or("", |source| &source.name);
    writeln!(out, "{file}: a good scene of {dialect}, named {}", scene.name)?;
    writeln!(
        out,
        "time: {} frames at {} 1/s ({} s), {} steps a frame of {} s",
        scene.frames,
        scene.frames_per_second,
        f64::from(scene.frames) * scene.frame_s(),
        world.substeps(),
        scene.frame_s() / f64::from(world.substeps()),
    )?;
    let parts = world.garments.iter().zip(garments(world));
    for (cloth, (part, garment)) in scene.cloths.iter().zip(parts) {
        let (area, mass) = area_and_mass(world, &part.panels);
        let density = cloth.fabric.density_kg_per_m2() * cloth.multipliers.density;
        writeln!(
            out,
            "cloth {}: {} vertices, {} faces, {area:.4} m², {mass:.4} kg, {} fabric of {density:.4} kg/m²",
            cloth.name,
            garment.points.len(),
            garment.triangles.len(),
            match cloth.fabric {
                Fabric::Orthotropic(_) => "orthotropic",
                Fabric::Measured(_) => "measured",
            },
        )?;
        if !cloth.panel_fabrics.is_empty() {
            let panels: Vec<&str> = cloth.panel_fabrics.iter().map(|(p, _)| p.as_str()).collect();
            writeln!(out, "  panels of other fabrics: {}", panels.join(", "))?;
        }
        options(out, cloth)?;
    }
    let held: usize = world.handles.list().iter().map(|handle| handle.held.len()).sum();
    writeln!(out, "handles: {} on {held} vertices", world.handles.list().len())?;
    for obstacle in &world.obstacles {
        let moving = if obstacle.is_moving() { "moving" } else { "still" };
        writeln!(
            out,
            "obstacle {}: {} vertices, {} faces, {moving}, friction {}{}",
            obstacle.name,
            obstacle.n_vertices(),
            obstacle.triangles.len(),
            obstacle.friction,
            presence(obstacle.times()),
        )?;
    }
    if let Some(water) = &world.fluid {
        fluid(out, water)?;
    }
    match &world.contact {
        None => writeln!(out, "contact: none")?,
        Some(contact) => writeln!(
            out,
            "contact: thickness {} m; cloth on cloth: {}",
            contact.thickness,
            if contact.self_contact {
                format!("friction {}", contact.friction)
            } else {
                "none".into()
            },
        )?,
    }
    if !world.has_cloth() {
        return Ok(());
    }
    let wind = scene.wind.as_ref().map_or("none".into(), |w| format!("{:?} m/s", w.velocity));
    writeln!(out, "wind: {wind}")?;
    writeln!(out, "forces: {}", world.force_names().join(", "))
}

fn fluid(out: &mut String, water: &Water) -> fmt::Result {
    let (fluid, settings) = (&water.fluid, water.fluid.settings());
    writeln!(
        out,
        "fluid {}: {} particles {} m apart, {:.4} kg, {} particles of walls, sound {:.4} m/s, steps \
         of {:.3e} s at the start, restraint: {}",
        water.name,
        fluid.len(),
        settings.spacing,
        fluid.len() as f64 * fluid.particle_mass(),
        fluid.walls().n_particles(),
        settings.sound_speed,
        fluid.step_bound(),
        if water.is_restrained { "yes" } else { "none" },
    )
}

/// When an obstacle is there, if not always.
fn presence([start, end]: [f64; 2]) -> String {
    let from = if start > 0.0 { format!(", from {start} s on") } else { String::new() };
    let until = if end.is_finite() { format!(", until {end} s") } else { String::new() };
    from + &until
}

fn options(out: &mut String, cloth: &Cloth) -> fmt::Result {
    match &cloth.remeshing {
        Some(wish) => {
            let (min, max) = (wish.size_m.min, wish.size_m.max);
            write!(out, "  remeshing: edges from {min} m to {max} m")?;
        }
        None => write!(out, "  remeshing: none, the mesh is fixed")?,
    }
    match cloth.strain_limits {
        Some([min, max]) => write!(out, "; stretch limits {min} to {max}")?,
        None => write!(out, "; stretch limits: none")?,
    }
    writeln!(out, "{}", if cloth.tension_field { "; a tension field" } else { "" })
}

/// Area (m²) and mass (kg) of some panels.
fn area_and_mass(world: &World, panels: &Range<u32>) -> (f64, f64) {
    let (mesh, density) = (&world.cloth.mesh, world.cloth.densities());
    let triangles = mesh.triangle_ids().zip(mesh.panels());
    let inside = triangles.filter(|(_, panel)| panels.contains(panel));
    inside.fold((0.0, 0.0), |(area, mass), (t, &panel)| {
        (area + mesh.area(t), mass + mesh.area(t) * density[panel as usize])
    })
}
