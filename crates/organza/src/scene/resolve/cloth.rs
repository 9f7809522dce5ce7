//! Checks and resolves a cloth.

use super::super::check::At;
use super::super::data::Cloth;
use super::super::format::{ClothFile, FabricChoice, Multipliers, Remeshing, Spin};
use super::super::limits::{self, MAX_DENSITY_KG_PER_M2, MAX_STIFFNESS};
use super::restraint::Run;
use super::{Context, beyond, mesh};
use crate::fabric::{Fabric, OrthotropicFabric, preset, read_measured};

pub(super) fn resolve(
    cloth: ClothFile,
    name: String,
    run: Run,
    at: &At<'_>,
    context: &mut Context<'_, '_>,
) -> Option<Cloth> {
    check_factors(&cloth, at);
    let multipliers = Multipliers {
        density: cloth.multipliers.density * cloth.thicken,
        stretching: cloth.multipliers.stretching * cloth.thicken,
        bending: cloth.multipliers.bending * cloth.thicken,
    };
    let common = fabric(cloth.fabric, &at.key("fabric"), context);
    let panels = at.key("panel_fabrics");
    let panel_fabrics: Vec<(String, Option<Fabric>)> = cloth
        .panel_fabrics
        .into_iter()
        .map(|(panel, choice)| {
            let fabric = fabric(choice, &panels.member(&panel), context);
            (panel, fabric)
        })
        .collect();
    for fabric in common.iter().chain(panel_fabrics.iter().filter_map(|(_, f)| f.as_ref())) {
        check_products(fabric, multipliers, at);
    }
    let panel_fabrics: Option<Vec<_>> =
        panel_fabrics.into_iter().map(|(panel, fabric)| Some((panel, fabric?))).collect();
    let mesh = mesh::resolve(cloth.mesh, &cloth.transform, at, context);
    super::handle::check_transform(&cloth.transform, &at.key("transform"));
    if let Some(thickness) = cloth.thickness_m {
        at.key("thickness_m").positive(thickness, limits::MAX_THICKNESS_M, "m");
    }
    if let Some(limits) = cloth.strain_limits {
        check_strain_limits(limits, &at.key("strain_limits"));
    }
    let damping = at.key("damping");
    damping.key("mass_per_s").not_negative(cloth.damping.mass_per_s, limits::MAX_DAMPING, "1/s");
    damping.key("stiffness_s").not_negative(cloth.damping.stiffness_s, limits::MAX_DAMPING, "s");
    at.key("initial_velocity").vector(&cloth.initial_velocity, limits::MAX_SPEED_M_PER_S, "m/s");
    if let Some(spin) = &cloth.initial_spin {
        check_spin(spin, &at.key("initial_spin"));
    }
    if let Some(remeshing) = &cloth.remeshing {
        check_remeshing(remeshing, &at.key("remeshing"));
    }
    let restraint = cloth.restraint.and_then(|wish| {
        super::restraint::thresholds(wish.thresholds, wish.law, run, &at.key("restraint"))
    });
    Some(Cloth {
        name,
        mesh: mesh?,
        transform: cloth.transform,
        fabric: common?,
        panel_fabrics: panel_fabrics?,
        multipliers,
        thickness_m: cloth.thickness_m,
        strain_limits: cloth.strain_limits,
        tension_field: cloth.tension_field,
        bending: cloth.bending,
        damping: cloth.damping,
        initial_velocity: cloth.initial_velocity,
        initial_spin: cloth.initial_spin,
        remeshing: cloth.remeshing,
        restraint,
    })
}

fn check_factors(cloth: &ClothFile, at: &At<'_>) {
    at.key("thicken").factor(cloth.thicken);
    let multipliers = at.key("multipliers");
    multipliers.key("density").factor(cloth.multipliers.density);
    multipliers.key("stretching").factor(cloth.multipliers.stretching);
    multipliers.key("bending").factor(cloth.multipliers.bending);
}

fn check_products(fabric: &Fabric, multipliers: Multipliers, at: &At<'_>) {
    let products = [
        (fabric.density_kg_per_m2(), multipliers.density, MAX_DENSITY_KG_PER_M2, "kg/m²"),
        (fabric.max_stretching(), multipliers.stretching, MAX_STIFFNESS, "N/m"),
        (fabric.max_bending(), multipliers.bending, MAX_STIFFNESS, "N·m"),
    ];
    for (value, multiplier, limit, unit) in products {
        // A value beyond the limit by itself is complained of where it is written.
        if value <= limit && value * multiplier > limit {
            let product = beyond(value * multiplier, limit, unit);
            at.key("thicken").complain(format!("{value} times {multiplier}: {product}"));
        }
    }
}

fn fabric(choice: FabricChoice, at: &At<'_>, context: &mut Context<'_, '_>) -> Option<Fabric> {
    if let Some(fabric) = preset(&choice) {
        return Some(Fabric::Orthotropic(fabric));
    }
    match choice {
        FabricChoice::Measured(file) => {
            let bytes = context.read(&at.key("measured"), &file, limits::MAX_TEXT_BYTES)?;
            match read_measured(&file, bytes) {
                Ok(fabric) => Some(Fabric::Measured(Box::new(fabric))),
                Err(issues) => {
                    context.foreign.extend(issues);
                    None
                }
            }
        }
        FabricChoice::Custom(fabric) => {
            check_orthotropic(&fabric, &at.key("custom"));
            Some(Fabric::Orthotropic(fabric))
        }
        _ => None,
    }
}

fn check_orthotropic(fabric: &OrthotropicFabric, at: &At<'_>) {
    at.key("density_kg_per_m2").positive(fabric.density_kg_per_m2, MAX_DENSITY_KG_PER_M2, "kg/m²");
    let c = fabric.stretching_n_per_m;
    let stretching = at.key("stretching_n_per_m");
    for (key, value) in [("warp", c.warp), ("weft", c.weft), ("shear", c.shear)] {
        stretching.key(key).positive(value, MAX_STIFFNESS, "N/m");
    }
    if c.warp > 0.0 && c.weft > 0.0 && c.coupling.powi(2) >= c.warp * c.weft {
        let bound = (c.warp * c.weft).sqrt();
        stretching.key("coupling").complain(format!(
            "{} makes the energy negative for some strain: must be smaller in size than \
             √(warp · weft) = {bound} N/m",
            c.coupling
        ));
    }
    let b = fabric.bending_n_m;
    let bending = at.key("bending_n_m");
    for (key, value) in [("warp", b.warp), ("weft", b.weft), ("bias", b.bias)] {
        bending.key(key).not_negative(value, MAX_STIFFNESS, "N·m");
    }
    let zeros = [b.warp, b.weft, b.bias].iter().filter(|b| **b == 0.0).count();
    if (1..3).contains(&zeros) {
        bending.complain("some stiffness is zero: give all three, or zero for all three");
    }
}

fn check_strain_limits([min, max]: [f64; 2], at: &At<'_>) {
    at.index(0).factor(min);
    at.index(1).factor(max);
    if min > max {
        at.complain(format!("reversed: the smallest stretch {min} is above the largest {max}"));
    } else if min >= 1.0 || max <= 1.0 {
        at.complain(format!("must lie below and above the rest state 1, got [{min}, {max}]"));
    }
}

fn check_spin(spin: &Spin, at: &At<'_>) {
    at.key("angular_velocity").vector(&spin.angular_velocity, limits::MAX_SPIN_RAD_PER_S, "rad/s");
    at.key("center").coordinates(&spin.center);
}

fn check_remeshing(remeshing: &Remeshing, at: &At<'_>) {
    let size = at.key("size_m");
    size.key("min").positive(remeshing.size_m.min, limits::MAX_COORDINATE_M, "m");
    size.key("max").positive(remeshing.size_m.max, limits::MAX_COORDINATE_M, "m");
    if remeshing.size_m.min > remeshing.size_m.max {
        let (min, max) = (remeshing.size_m.min, remeshing.size_m.max);
        size.complain(format!("min {min} is above max {max}"));
    }
    let refine = [
        ("refine_angle", remeshing.refine_angle, "rad"),
        ("refine_compression", remeshing.refine_compression, "m"),
        ("refine_obstacle", remeshing.refine_obstacle, "rad"),
        ("refine_velocity", remeshing.refine_velocity, "m/s"),
    ];
    for (key, value, unit) in refine {
        if let Some(value) = value {
            at.key(key).positive(value, limits::MAX_FACTOR, unit);
        }
    }
    let [low, high] = limits::ASPECT_RANGE;
    if !(low..=high).contains(&remeshing.aspect_min) {
        let got = remeshing.aspect_min;
        at.key("aspect_min").complain(format!("must lie between {low} and {high}, got {got}"));
    }
    if !(0.0..1.0).contains(&remeshing.hysteresis) {
        let got = remeshing.hysteresis;
        at.key("hysteresis").complain(format!("must be at least 0 and below 1, got {got}"));
    }
    at.key("max_vertices").at_least(remeshing.max_vertices, 3);
    if f64::from(remeshing.max_vertices) > limits::MAX_VERTICES {
        let n = f64::from(remeshing.max_vertices);
        at.key("max_vertices").complain(beyond(n, limits::MAX_VERTICES, "vertices"));
    }
}
