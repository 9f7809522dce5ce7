//! Which vertices of a cloth a handle names.

use crate::build::Piece;
use crate::scene::format::{Corner, Select, Side};
use crate::scene::suggestion;
use mesh_core::{Material2, Mesh, VertexId};

/// The vertices of `piece` that are chosen, in any order, some perhaps more than once.
///
/// # Errors
/// If one is named that does not exist.
pub(super) fn select(select: &Select, piece: &Piece) -> Result<Vec<VertexId>, String> {
    let mesh = &piece.mesh;
    match select {
        Select::Vertices(numbers) => {
            let n = piece.vertex_of_file.as_ref().map_or(mesh.n_vertices(), Vec::len);
            let one = |&k: &u32| match &piece.vertex_of_file {
                Some(map) => map.get(k as usize).copied().flatten(),
                None => ((k as usize) < n).then_some(VertexId(k)),
            };
            let missing = |k: &u32| match piece.vertex_of_file {
                Some(_) if (*k as usize) < n => format!("no face uses vertex {k}"),
                _ => format!("there is no vertex {k} in a cloth of {n} vertices"),
            };
            numbers.iter().map(|k| one(k).ok_or_else(|| missing(k))).collect()
        }
        Select::Corners(corners) => {
            let pattern = Pattern::of(mesh);
            Ok(corners.iter().filter_map(|&corner| pattern.nearest(corner)).collect())
        }
        Select::Sides(sides) => collect(sides, |&side| side_of(piece, side)),
        Select::Borders(names) => collect(names, |name| border(piece, name)),
        Select::Panels(names) => collect(names, |name| panel(piece, name)),
        Select::Box(area) => Ok(Pattern::of(mesh).inside(area.min.into(), area.max.into())),
        Select::Boundary => Ok(mesh.vertices().filter(|&v| mesh.is_boundary_vertex(v)).collect()),
        Select::All => Ok(mesh.vertices().collect()),
    }
}

/// All vertices that `one` gives for some name.
fn collect<T>(
    names: &[T],
    one: impl Fn(&T) -> Result<Vec<VertexId>, String>,
) -> Result<Vec<VertexId>, String> {
    Ok(names.iter().map(one).collect::<Result<Vec<_>, _>>()?.concat())
}

/// All vertices of a panel, its outline included.
fn panel(piece: &Piece, name: &str) -> Result<Vec<VertexId>, String> {
    let panel = piece.panel(name)?;
    let triangles = piece.mesh.triangles().iter().zip(piece.mesh.panels());
    let inside = triangles.filter(|&(_, &p)| p == panel);
    Ok(inside.flat_map(|(t, _)| t.map(VertexId)).collect())
}

/// A border of a generated mesh.
fn border(piece: &Piece, name: &str) -> Result<Vec<VertexId>, String> {
    let found = piece.borders.iter().find(|border| border.name == name);
    found.map(|border| border.vertices.clone()).ok_or_else(|| {
        if piece.borders.is_empty() {
            return format!(
                "there is no border `{name}`: those of a mesh from a file have no names"
            );
        }
        let names: Vec<&str> = piece.borders.iter().map(|border| border.name).collect();
        format!("there is no border `{name}`{}", suggestion(name, &names))
    })
}

/// A side of the pattern: of a generated mesh the border that is there, whatever its shape; of
/// another the vertices that touch the rectangle around it.
fn side_of(piece: &Piece, side: Side) -> Result<Vec<VertexId>, String> {
    let (name, other) = match side {
        Side::Left => ("left", None),
        Side::Right => ("right", None),
        Side::Lower => ("lower", Some("hem")),
        Side::Upper => ("upper", Some("waist")),
    };
    if piece.borders.is_empty() {
        return Ok(Pattern::of(&piece.mesh).side(side));
    }
    let is_it = |border: &str| border == name || Some(border) == other;
    let found = piece.borders.iter().find(|border| is_it(border.name));
    found.map(|border| border.vertices.clone()).ok_or_else(|| {
        let names: Vec<&str> = piece.borders.iter().map(|border| border.name).collect();
        format!("the cloth has no side `{name}`; its borders are {}", names.join(", "))
    })
}

/// Every vertex with each of its places in the pattern, and the rectangle around them.
struct Pattern {
    points: Vec<(VertexId, Material2)>,
    low: Material2,
    high: Material2,
}

impl Pattern {
    fn of(mesh: &Mesh) -> Pattern {
        let corners = mesh.triangles().iter().zip(mesh.material());
        let points: Vec<(VertexId, Material2)> =
            corners.flat_map(|(t, u)| [0, 1, 2].map(|k| (VertexId(t[k]), u[k]))).collect();
        let low = points.iter().fold(Material2::repeat(f64::INFINITY), |a, (_, u)| a.inf(u));
        let high = points.iter().fold(Material2::repeat(f64::NEG_INFINITY), |a, (_, u)| a.sup(u));
        Pattern { points, low, high }
    }

    /// The vertex nearest to a corner of the rectangle.
    fn nearest(&self, corner: Corner) -> Option<VertexId> {
        let (low, high) = (self.low, self.high);
        let at = match corner {
            Corner::LowerLeft => low,
            Corner::LowerRight => Material2::new(high.x, low.y),
            Corner::UpperRight => high,
            Corner::UpperLeft => Material2::new(low.x, high.y),
        };
        let distance = |u: &Material2| (u - at).norm_squared();
        let nearest = self.points.iter().min_by(|a, b| distance(&a.1).total_cmp(&distance(&b.1)));
        nearest.map(|&(v, _)| v)
    }

    /// The vertices on a side of the rectangle.
    fn side(&self, side: Side) -> Vec<VertexId> {
        let (low, high) = (self.low, self.high);
        match side {
            Side::Left => self.inside(low, Material2::new(low.x, high.y)),
            Side::Right => self.inside(Material2::new(high.x, low.y), high),
            Side::Lower => self.inside(low, Material2::new(high.x, low.y)),
            Side::Upper => self.inside(Material2::new(low.x, high.y), high),
        }
    }

    /// The vertices inside a part of the pattern, its border included.
    fn inside(&self, min: Material2, max: Material2) -> Vec<VertexId> {
        let slack = 1e-9 * (self.high - self.low).norm();
        let keep = |(_, u): &&(VertexId, Material2)| {
            u.x >= min.x - slack
                && u.y >= min.y - slack
                && u.x <= max.x + slack
                && u.y <= max.y + slack
        };
        self.points.iter().filter(keep).map(|&(v, _)| v).collect()
    }
}
