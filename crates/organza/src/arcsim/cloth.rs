//! Cloths, materials, transforms and remeshing of ARCSim.

use serde_json::Value;

use std::collections::BTreeMap;

use super::format::{ArcsimCloth, ArcsimMaterial, ArcsimRemeshing, ArcsimTransform};
use super::translate::Notes;
use crate::scene::format::{
    BendingModel, ClothFile, Damping, FabricChoice, MeshFile, Multipliers, Remeshing, SizeRange,
    Spin, default_hysteresis, default_max_vertices,
};
use crate::scene::limits;
use crate::scene::motion::{AxisAngle, Transform};
use crate::scene::unsupported::asks;

/// Translates cloth number `i`.
pub(super) fn translate(
    cloth: &ArcsimCloth,
    i: usize,
    bending: BendingModel,
    notes: &mut Notes,
) -> Option<ClothFile> {
    let at = format!("cloths[{i}]");
    notes.rename(&format!("{at}.mesh.obj"), &format!("{at}.mesh"));
    notes.rename(&format!("{at}.initial_velocity"), &format!("{at}.velocity.linear"));
    notes.rename(&format!("{at}.initial_spin.angular_velocity"), &format!("{at}.velocity.angular"));
    notes.rename(&format!("{at}.initial_spin.center"), &format!("{at}.velocity.origin"));
    if cloth.reference.as_ref().is_some_and(asks) {
        notes.unsupported(&format!("{at}.reference"), "reference shapes (ARCSim 0.3)");
    }
    if cloth.materials.len() > 1 {
        notes.unsupported(&format!("{at}.materials[1]"), "several materials on one cloth");
    }
    let remeshing = cloth.remeshing.as_ref().filter(|_| !notes.is_disabled("remeshing"));
    let remeshing = match remeshing {
        Some(remeshing) => Some(translate_remeshing(remeshing, &at, notes)?),
        None => None,
    };
    let Some(material) = cloth.materials.first() else {
        notes.complain(&at, "has no material");
        return None;
    };
    let at = format!("{at}.materials[0]");
    check_material(material, &at, notes);
    rename_material(i, &at, notes);
    let Some(data) = material.data.clone() else {
        notes.complain(&at, "has no `data`; a material needs a file with measurements");
        return None;
    };
    let transform = format!("cloths[{i}].transform");
    let velocity = cloth.velocity.as_ref();
    let spin = velocity.and_then(|velocity| {
        let angular_velocity = velocity.angular?;
        Some(Spin { angular_velocity, center: velocity.origin.unwrap_or_default() })
    });
    Some(ClothFile {
        name: None,
        mesh: MeshFile { obj: Some(cloth.mesh.clone()), ..MeshFile::default() },
        transform: translate_transform(cloth.transform, [&transform, &transform], notes),
        fabric: FabricChoice::Measured(data),
        panel_fabrics: BTreeMap::new(),
        thicken: material.thicken.unwrap_or(1.0),
        multipliers: Multipliers {
            density: material.density_mult.unwrap_or(1.0),
            stretching: material.stretching_mult.unwrap_or(1.0),
            bending: material.bending_mult.unwrap_or(1.0),
        },
        thickness_m: None,
        strain_limits: material.strain_limits.filter(|_| !notes.is_disabled("strainlimiting")),
        tension_field: false,
        bending,
        damping: Damping { mass_per_s: 0.0, stiffness_s: material.damping.unwrap_or(0.0) },
        initial_velocity: velocity.and_then(|v| v.linear).unwrap_or_default(),
        initial_spin: spin,
        remeshing,
        restraint: None,
    })
}

fn rename_material(i: usize, at: &str, notes: &mut Notes) {
    for (ours, theirs) in [
        ("fabric.measured", "data"),
        ("thicken", "thicken"),
        ("multipliers.density", "density_mult"),
        ("multipliers.stretching", "stretching_mult"),
        ("multipliers.bending", "bending_mult"),
        ("strain_limits", "strain_limits"),
        ("damping.stiffness_s", "damping"),
    ] {
        notes.rename(&format!("cloths[{i}].{ours}"), &format!("{at}.{theirs}"));
    }
}

/// Complains of the parts of a material that are not simulated.
fn check_material(material: &ArcsimMaterial, at: &str, notes: &mut Notes) {
    let is =
        |value: &Option<Value>| value.as_ref().is_some_and(|v| asks(v) && v.as_f64() != Some(0.0));
    let parts = [
        ("yield_stretch", &material.yield_stretch, "plasticity"),
        ("plastic_flow", &material.plastic_flow, "plasticity"),
        ("toughness", &material.toughness, "fracture"),
        ("bend_width", &material.bend_width, "fracture"),
        ("initiation_factor", &material.initiation_factor, "fracture"),
        ("thickness", &material.thickness, "elastic"),
        ("density", &material.density, "elastic"),
        ("elastic_modulus", &material.elastic_modulus, "elastic"),
        ("poisson_ratio", &material.poisson_ratio, "elastic"),
        ("bending_factor", &material.bending_factor, "elastic"),
    ];
    // Scenes with it are fit to be seen without.
    if is(&material.yield_curv) && !notes.is_disabled("plasticity") {
        let message = "plasticity is not simulated: the cloth keeps no creases";
        notes.notice(&format!("{at}.yield_curv"), message);
    }
    for (key, value, part) in parts {
        if is(value) && !notes.is_disabled(part) {
            let what = match part {
                "elastic" => "materials by elastic modulus (ARCSim 0.3)",
                part => part,
            };
            notes.unsupported(&format!("{at}.{key}"), what);
        }
    }
}

fn translate_remeshing(
    remeshing: &ArcsimRemeshing,
    at: &str,
    notes: &mut Notes,
) -> Option<Remeshing> {
    notes.rename(&format!("{at}.remeshing.size_m"), &format!("{at}.remeshing.size"));
    notes.rename(&format!("{at}.remeshing.size_m.min"), &format!("{at}.remeshing.size[0]"));
    notes.rename(&format!("{at}.remeshing.size_m.max"), &format!("{at}.remeshing.size[1]"));
    if remeshing.refine_fracture.as_ref().is_some_and(asks) && !notes.is_disabled("fracture") {
        notes.unsupported(&format!("{at}.remeshing.refine_fracture"), "fracture");
    }
    let Some([min, max]) = remeshing.size else {
        notes.complain(&format!("{at}.remeshing"), "key `size` is missing: [min, max] edge length");
        return None;
    };
    Some(Remeshing {
        size_m: SizeRange { min, max },
        refine_angle: remeshing.refine_angle,
        refine_compression: remeshing.refine_compression,
        // ARCSim refines near obstacles without being asked.
        refine_obstacle: remeshing.refine_angle,
        refine_velocity: remeshing.refine_velocity,
        aspect_min: remeshing.aspect_min.unwrap_or(limits::ASPECT_RANGE[0]),
        hysteresis: default_hysteresis(),
        max_vertices: default_max_vertices(),
    })
}

/// Translates a transform, given its paths in our format and in theirs.
pub(super) fn translate_transform(
    transform: Option<ArcsimTransform>,
    [ours, theirs]: [&str; 2],
    notes: &mut Notes,
) -> Transform {
    notes.rename(&format!("{ours}.rotate.axis"), &format!("{theirs}.rotate"));
    notes.rename(&format!("{ours}.rotate.degrees"), &format!("{theirs}.rotate[0]"));
    let Some(transform) = transform else { return Transform::default() };
    let rotate = transform.rotate.filter(|[degrees, ..]| *degrees != 0.0);
    Transform {
        scale: transform.scale.unwrap_or(1.0),
        rotate: rotate.map(|[degrees, x, y, z]| AxisAngle { axis: [x, y, z], degrees }),
        translate: transform.translate.unwrap_or_default(),
    }
}
