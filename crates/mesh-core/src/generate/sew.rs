//! Sewing sheets together along their boundaries.

use super::limits::check_triangles;
use super::{Border, GenerateError, Sheet};
use crate::geometry::{Material2, World3};
use crate::ids::VertexId;
use crate::mesh::Mesh;

/// Vertices along the boundary of a sheet, neighbour by neighbour: one side of a seam.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chain {
    /// Index of the sheet in the list that is sewn.
    pub sheet: usize,
    /// The vertices, numbered as in that sheet.
    pub vertices: Vec<VertexId>,
}

impl Chain {
    /// The chain of these vertices.
    pub fn new(sheet: usize, vertices: impl IntoIterator<Item = VertexId>) -> Chain {
        Chain { sheet, vertices: vertices.into_iter().collect() }
    }
}

/// Two chains that become one, vertex by vertex: the boundaries of two sheets, or two parts of the
/// boundary of one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Seam {
    /// One side.
    pub first: Chain,
    /// The other side; it runs along the same direction in space, so the other way around.
    pub second: Chain,
}

/// Sheets sewn into one, and where their vertices went.
#[derive(Clone, Debug, PartialEq)]
pub struct Sewn {
    /// The whole.
    pub sheet: Sheet,
    /// For every sheet the new index of each of its vertices.
    pub vertex_of: Vec<Vec<VertexId>>,
}

impl Sewn {
    /// Names a part of the boundary, given by vertices of the sheets that were sewn.
    pub fn name_border(&mut self, name: &'static str, parts: &[Chain]) {
        let number = |part: &Chain| {
            let vertex_of = &self.vertex_of[part.sheet];
            part.vertices.iter().map(|v| vertex_of[v.index()]).collect::<Vec<_>>()
        };
        let mut vertices: Vec<VertexId> = parts.iter().flat_map(number).collect();
        vertices.sort_unstable();
        vertices.dedup();
        self.sheet.borders.push(Border { name, vertices });
    }
}

/// Sews sheets into one mesh: vertices joined by a seam become one vertex in the mean of their
/// positions, every side keeps its own material coordinates, and the panels of later sheets are
/// numbered after those of earlier ones. Vertices and triangles keep the order of the sheets.
///
/// Where the material coordinates of both sides happen to agree an edge does not count as a seam:
/// use [`lay_out`] first, unless the sides lie apart anyway.
///
/// ```
/// use mesh_core::generate::{Chain, Diagonal, Seam, boundary_chain, grid, sew};
/// use mesh_core::VertexId;
///
/// // A strip of 3 × 1 cells becomes a ring: its left side (vertices 0, 4) on its right one (3, 7).
/// let strip = grid([3.0, 1.0], [3, 1], Diagonal::One)?;
/// let right = boundary_chain(&strip.mesh, VertexId(3), VertexId(7))?;
/// let left = [VertexId(0), VertexId(4)];
/// let seam = Seam { first: Chain::new(0, left), second: Chain::new(0, right) };
/// let ring = sew(&[strip], &[seam])?.sheet;
/// assert_eq!(ring.mesh.euler_characteristic(), 0);
/// # Ok::<(), mesh_core::generate::GenerateError>(())
/// ```
///
/// # Errors
/// If the sides of a seam differ in length, do not follow the boundary or run the same way around;
/// if an opening between seams falls shut; if the result is not a manifold; if it is too large.
pub fn sew(sheets: &[Sheet], seams: &[Seam]) -> Result<Sewn, GenerateError> {
    check_triangles(&[sheets.iter().map(|s| s.mesh.n_triangles()).sum()])?;
    for (number, seam) in seams.iter().enumerate() {
        check_seam(sheets, number, seam)?;
    }
    let firsts = running_total(sheets.iter().map(|s| s.mesh.n_vertices()));
    let mut groups = Groups::new(firsts[sheets.len()]);
    for seam in seams {
        for (a, b) in seam.first.vertices.iter().zip(&seam.second.vertices) {
            groups
                .join(firsts[seam.first.sheet] + a.index(), firsts[seam.second.sheet] + b.index());
        }
    }
    let (number, n_vertices) = groups.numbers();

    let mut sums = vec![(World3::zeros(), 0.0); n_vertices];
    for (x, &v) in sheets.iter().flat_map(|s| &s.positions).zip(&number) {
        sums[v as usize].0 += x;
        sums[v as usize].1 += 1.0;
    }
    let (mut triangles, mut material, mut panels) = (Vec::new(), Vec::new(), Vec::new());
    let mut first_panel = 0;
    for (sheet, &first) in sheets.iter().zip(&firsts) {
        let renumbered = |t: &[u32; 3]| t.map(|v| number[first + v as usize]);
        triangles.extend(sheet.mesh.triangles().iter().map(renumbered));
        material.extend_from_slice(sheet.mesh.material());
        panels.extend(sheet.mesh.panels().iter().map(|p| first_panel + p));
        first_panel += sheet.mesh.panels().iter().max().map_or(0, |p| p + 1);
    }
    let mesh = Mesh::new(n_vertices, triangles, material, panels)?;

    let n_open = |mesh: &Mesh| mesh.edges().filter(|&h| mesh.is_boundary_edge(h)).count();
    let before: usize = sheets.iter().map(|s| n_open(&s.mesh)).sum();
    let expected: usize = seams.iter().map(|s| s.first.vertices.len() - 1).sum();
    let got = (before - n_open(&mesh)) / 2;
    if got != expected {
        return Err(GenerateError::Closed { expected, got });
    }
    let positions = sums.iter().map(|(sum, count)| sum / *count).collect();
    let vertex_of =
        firsts.windows(2).map(|w| number[w[0]..w[1]].iter().map(|&v| VertexId(v)).collect());
    let sheet = Sheet { mesh, positions, borders: Vec::new() };
    Ok(Sewn { vertex_of: vertex_of.collect(), sheet })
}

/// Moves the material coordinates of the sheets along u so that the sheets lie side by side, `gap`
/// (m) apart, each with its smallest u and v at the origin of its place: the pieces on the cloth
/// they are cut from.
pub fn lay_out(sheets: &mut [Sheet], gap: f64) {
    let mut place = 0.0;
    for sheet in sheets {
        let corners = || sheet.mesh.material.iter().flatten();
        let low = corners().fold(Material2::repeat(f64::INFINITY), |low, u| low.inf(u));
        let high = corners().fold(f64::NEG_INFINITY, |high, u| high.max(u.x));
        let shift = Material2::new(place - low.x, -low.y);
        place += high - low.x + gap;
        sheet.mesh.material.iter_mut().flatten().for_each(|u| *u += shift);
    }
}

fn check_seam(sheets: &[Sheet], seam: usize, sides: &Seam) -> Result<(), GenerateError> {
    let (first, second) = (&sides.first, &sides.second);
    let lengths = [first.vertices.len(), second.vertices.len()];
    if lengths[0] != lengths[1] || lengths[0] < 2 {
        let [first, second] = lengths;
        return Err(GenerateError::SeamLength { seam, first, second });
    }
    let ahead = [directions(sheets, seam, first)?, directions(sheets, seam, second)?];
    match ahead[0].iter().zip(&ahead[1]).position(|(a, b)| a == b) {
        Some(step) => Err(GenerateError::SeamDirection { seam, step }),
        None => Ok(()),
    }
}

/// For every step of a chain: does it run with the mesh on its left?
fn directions(sheets: &[Sheet], seam: usize, chain: &Chain) -> Result<Vec<bool>, GenerateError> {
    let sheet = chain.sheet;
    let n = sheets.get(sheet).map_or(0, |s| s.mesh.n_vertices());
    if let Some(v) = chain.vertices.iter().find(|v| v.index() >= n) {
        return Err(GenerateError::SeamVertex { seam, sheet, vertex: v.0 });
    }
    let mesh = &sheets[sheet].mesh;
    let on_boundary = |a, b| mesh.find(a, b).is_some_and(|h| mesh.is_boundary_edge(h));
    let steps = chain.vertices.windows(2).map(|w| match (w[0], w[1]) {
        (a, b) if on_boundary(a, b) => Ok(true),
        (a, b) if on_boundary(b, a) => Ok(false),
        (a, b) => Err(GenerateError::NotBoundary { seam, sheet, a: a.0, b: b.0 }),
    });
    steps.collect()
}

/// 0, then the sums of the first, the first two, … counts.
fn running_total(counts: impl Iterator<Item = usize>) -> Vec<usize> {
    let mut totals = vec![0];
    let mut total = 0;
    totals.extend(counts.map(|n| {
        total += n;
        total
    }));
    totals
}

/// Vertices that become one: each points to a smaller one of its group, the smallest to itself.
struct Groups(Vec<u32>);

impl Groups {
    fn new(n: usize) -> Groups {
        Groups((0..n as u32).collect())
    }

    fn smallest(&mut self, v: usize) -> usize {
        let mut at = v;
        while self.0[at] as usize != at {
            self.0[at] = self.0[self.0[at] as usize];
            at = self.0[at] as usize;
        }
        at
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.smallest(a), self.smallest(b));
        self.0[a.max(b)] = a.min(b) as u32;
    }

    /// The number of every vertex's group, in order of their smallest vertices, and how many.
    fn numbers(mut self) -> (Vec<u32>, usize) {
        let mut number = Vec::with_capacity(self.0.len());
        let mut n = 0;
        for v in 0..self.0.len() {
            let smallest = self.smallest(v);
            if smallest == v {
                number.push(n);
                n += 1;
            } else {
                number.push(number[smallest]);
            }
        }
        (number, n as usize)
    }
}
