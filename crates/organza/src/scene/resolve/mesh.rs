//! Checks and resolves where a mesh comes from.

use super::super::check::At;
use super::super::data::{Garment, MeshSource};
use super::super::format::{Disc, GarmentFile, Grid, MeshFile, Poncho, Skirt, Tube, Tunic};
use super::super::limits::{MAX_COORDINATE_M, MAX_MESH_BYTES, MAX_TRIANGLES};
use super::super::motion::Transform;
use super::{Context, beyond};

/// Checks the one source that `mesh` names. `cloth` is the place of the cloth.
pub(super) fn resolve(
    mesh: MeshFile,
    transform: &Transform,
    cloth: &At<'_>,
    context: &mut Context<'_, '_>,
) -> Option<MeshSource> {
    let at = cloth.key("mesh");
    let MeshFile { obj, material_obj, grid, disc, tube, skirt, tunic, poncho, garment } = mesh;
    if material_obj.is_some() && obj.is_none() {
        at.key("material_obj").complain("needs `obj`, whose flat pattern it is");
    }
    let sources = [
        obj.map(|obj| MeshSource::Obj { obj, material_obj }),
        grid.map(MeshSource::Grid),
        disc.map(MeshSource::Disc),
        tube.map(MeshSource::Tube),
        skirt.map(MeshSource::Skirt),
        tunic.map(MeshSource::Tunic),
        poncho.map(MeshSource::Poncho),
        garment.map(|garment| MeshSource::Garment(worn(garment, context, &at.key("garment")))),
    ];
    let mut given = sources.into_iter().flatten();
    let (first, more) = (given.next(), given.count());
    let Some(source) = first.filter(|_| more == 0) else {
        let n = if more == 0 { 0 } else { more + 1 };
        let all = "obj, grid, disc, tube, skirt, tunic, poncho, garment";
        at.complain(format!("must have exactly one of {all}; has {n}"));
        return None;
    };
    match &source {
        MeshSource::Obj { obj, material_obj } => {
            context.read(&at.key("obj"), obj, MAX_MESH_BYTES)?;
            if let Some(material_obj) = material_obj {
                context.read(&at.key("material_obj"), material_obj, MAX_MESH_BYTES)?;
            }
        }
        MeshSource::Grid(grid) => check_grid(grid, &at.key("grid")),
        MeshSource::Disc(disc) => check_disc(disc, &at.key("disc")),
        MeshSource::Tube(tube) => check_tube(tube, &at.key("tube")),
        MeshSource::Skirt(skirt) => check_skirt(skirt, &at.key("skirt")),
        MeshSource::Tunic(tunic) => check_tunic(tunic, &at.key("tunic")),
        MeshSource::Poncho(poncho) => check_poncho(poncho, &at.key("poncho")),
        MeshSource::Garment(garment) => check_garment(garment, &at.key("garment")),
    }
    let reach = extent(&source) * transform.scale;
    if extent(&source) <= MAX_COORDINATE_M && reach > MAX_COORDINATE_M {
        let reach = beyond(reach, MAX_COORDINATE_M, "m");
        cloth.key("transform.scale").complain(format!("the cloth as scaled: {reach}"));
    }
    Some(source)
}

/// The largest length in a generated mesh (m); 0 for files, whose coordinates are not known yet.
fn extent(source: &MeshSource) -> f64 {
    match source {
        MeshSource::Obj { .. } => 0.0,
        MeshSource::Grid(grid) => grid.size_m[0].max(grid.size_m[1]),
        MeshSource::Disc(disc) => disc.radius_m,
        MeshSource::Tube(tube) => tube.radius_m.max(tube.length_m),
        MeshSource::Skirt(skirt) => skirt.waist_m.max(skirt.hem_m).max(skirt.length_m),
        MeshSource::Tunic(tunic) => {
            let reach = tunic.width_m + tunic.sleeve_m.unwrap_or(0.0);
            reach.max(tunic.hem_width_m.unwrap_or(0.0)).max(tunic.length_m)
        }
        MeshSource::Poncho(poncho) => poncho.width_m.max(poncho.length_m),
        MeshSource::Garment(_) => 2.0,
    }
}

/// A garment; in a crowd nobody wears it yet.
fn worn(garment: GarmentFile, context: &Context<'_, '_>, at: &At<'_>) -> Garment {
    let GarmentFile { kind, on, cell_m } = garment;
    match (&on, context.in_crowd) {
        (None, false) => at.complain("needs `on`, the name of the character that wears it"),
        (Some(_), true) => at.key("on").complain("goes without saying in a crowd: leave it out"),
        _ => {}
    }
    Garment { kind, on: on.unwrap_or_default(), cell_m }
}

fn check_garment(garment: &Garment, at: &At<'_>) {
    let [low, high] = [mannequin::Garment::MIN_CELL, mannequin::Garment::MAX_CELL];
    if !(low..=high).contains(&garment.cell_m) {
        let got = garment.cell_m;
        at.key("cell_m").complain(format!("must lie between {low} and {high}, got {got}"));
    }
}

fn check_grid(grid: &Grid, at: &At<'_>) {
    for (i, size) in grid.size_m.into_iter().enumerate() {
        at.key("size_m").index(i).size(size);
    }
    check_cells(grid.cells, [1, 1], 1, &at.key("cells"));
}

fn check_disc(disc: &Disc, at: &At<'_>) {
    at.key("radius_m").size(disc.radius_m);
    let rings = at.key("rings");
    rings.at_least(disc.rings, 1);
    let triangles = 6.0 * f64::from(disc.rings).powi(2);
    if triangles > MAX_TRIANGLES {
        rings.complain(beyond(triangles, MAX_TRIANGLES, "triangles"));
    }
}

fn check_tube(tube: &Tube, at: &At<'_>) {
    at.key("radius_m").size(tube.radius_m);
    at.key("length_m").size(tube.length_m);
    check_cells(tube.segments, [3, 1], 1, &at.key("segments"));
}

fn check_skirt(skirt: &Skirt, at: &At<'_>) {
    at.key("panels").at_least(skirt.panels, 1);
    at.key("waist_m").size(skirt.waist_m);
    at.key("hem_m").size(skirt.hem_m);
    at.key("length_m").size(skirt.length_m);
    check_cells(skirt.cells, [1, 1], skirt.panels, &at.key("cells"));
    let around = u64::from(skirt.panels) * u64::from(skirt.cells[0]);
    if skirt.panels > 0 && skirt.cells[0] > 0 && around < 3 {
        at.key("cells")
            .index(0)
            .complain(format!("{around} cells around in all, at least 3 needed"));
    }
    // Cloth that is shorter than the difference of the radii cannot reach from waist to hem.
    let spread = (skirt.hem_m - skirt.waist_m).abs() / std::f64::consts::TAU;
    if spread > skirt.length_m {
        at.key("length_m").complain(format!(
            "{} m is too short for hem {} m and waist {} m: their radii differ by {spread} m",
            skirt.length_m, skirt.hem_m, skirt.waist_m
        ));
    }
}

fn check_tunic(tunic: &Tunic, at: &At<'_>) {
    at.key("width_m").size(tunic.width_m);
    at.key("length_m").size(tunic.length_m);
    for (key, size) in [("hem_width_m", tunic.hem_width_m), ("sleeve_m", tunic.sleeve_m)] {
        if let Some(size) = size {
            at.key(key).size(size);
        }
    }
    check_part(tunic.armhole_m, tunic.length_m, "length", &at.key("armhole_m"));
    check_part(tunic.neck_width_m, tunic.width_m, "width", &at.key("neck_width_m"));
    for (i, depth) in tunic.neck_depth_m.into_iter().enumerate() {
        let at = at.key("neck_depth_m").index(i);
        if !(0.0..=0.5 * tunic.length_m).contains(&depth) {
            at.complain(format!("must lie between 0 and half of the length, got {depth}"));
        }
    }
    at.key("cell_m").size(tunic.cell_m);
}

fn check_poncho(poncho: &Poncho, at: &At<'_>) {
    at.key("width_m").size(poncho.width_m);
    at.key("length_m").size(poncho.length_m);
    check_part(poncho.neck_width_m, poncho.width_m, "width", &at.key("neck_width_m"));
    at.key("cell_m").size(poncho.cell_m);
}

/// A length that must be smaller than another one of its garment (m).
fn check_part(part: f64, whole: f64, name: &str, at: &At<'_>) {
    at.size(part);
    if whole > 0.0 && part >= whole {
        at.complain(format!("{part} m is not below the {name} of the garment, {whole} m"));
    }
}

/// Cells of two triangles each, on `panels` panels.
fn check_cells(cells: [u32; 2], least: [u32; 2], panels: u32, at: &At<'_>) {
    at.index(0).at_least(cells[0], least[0]);
    at.index(1).at_least(cells[1], least[1]);
    let triangles = 2.0 * f64::from(panels) * f64::from(cells[0]) * f64::from(cells[1]);
    if triangles > MAX_TRIANGLES {
        at.complain(beyond(triangles, MAX_TRIANGLES, "triangles"));
    }
}
