//! Where material points of a sheet are in space, whatever its mesh.

use std::fs;
use std::path::Path;

/// A point of material space (m).
type Material = [f64; 2];
/// A point of space (m).
pub(super) type World = [f64; 3];

/// How far outside of a triangle a point may be, as a barycentric coordinate, before no triangle
/// holds it: points on the border of a sheet are off it by rounding.
const TOLERANCE: f64 = 1e-6;

/// One sheet that maps material space to the world, a triangle at a time.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Surface {
    triangles: Vec<([Material; 3], [World; 3])>,
}

impl Surface {
    /// Reads an OBJ file with `v`, `vt` and triangles `f v/vt v/vt v/vt`.
    pub(super) fn read(path: &Path) -> Result<Surface, String> {
        let text = fs::read_to_string(path).map_err(|error| error.to_string());
        text.and_then(|text| Surface::parse(&text)).map_err(|e| format!("{}: {e}", path.display()))
    }

    fn parse(obj: &str) -> Result<Surface, String> {
        let (mut v, mut vt) = (Vec::<World>::new(), Vec::<Material>::new());
        let mut surface = Surface::default();
        for (number, line) in (1..).zip(obj.lines()) {
            let wrong = || format!("line {number}: cannot read `{line}`");
            let mut words = line.split_whitespace();
            match words.next() {
                Some("v") => v.push(numbers(words).ok_or_else(wrong)?),
                Some("vt") => vt.push(numbers(words).ok_or_else(wrong)?),
                Some("f") => {
                    let corners: Vec<_> = words.map(|word| corner(word, &v, &vt)).collect();
                    let [Some(a), Some(b), Some(c)] = corners[..] else { return Err(wrong()) };
                    surface.triangles.push(([a.0, b.0, c.0], [a.1, b.1, c.1]));
                }
                _ => {}
            }
        }
        if surface.triangles.is_empty() { Err("it has no triangles".into()) } else { Ok(surface) }
    }

    /// The centre of mass of a sheet of one density (m).
    pub(super) fn center(&self) -> World {
        let (mut sum, mut all) = ([0.0; 3], 0.0);
        for ([a, b, c], corners) in &self.triangles {
            let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            all += area.abs();
            for k in 0..3 {
                sum[k] += area.abs() * corners.iter().map(|x| x[k]).sum::<f64>() / 3.0;
            }
        }
        sum.map(|s| s / all)
    }

    /// Smallest and largest material coordinates (m).
    pub(super) fn extent(&self) -> [Material; 2] {
        let start = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        let corners = self.triangles.iter().flat_map(|(material, _)| material);
        corners.fold(start, |[low, high], p| {
            [[low[0].min(p[0]), low[1].min(p[1])], [high[0].max(p[0]), high[1].max(p[1])]]
        })
    }

    /// Where a material point is; `None` if it is not on the sheet. Looks at every triangle, and
    /// takes the one that holds the point best.
    pub(super) fn at(&self, point: Material) -> Option<World> {
        let mut best = (-TOLERANCE, None);
        for (material, world) in &self.triangles {
            let Some(weights) = barycentric(material, point) else { continue };
            let inside = weights.into_iter().fold(f64::INFINITY, f64::min);
            if inside > best.0 {
                best = (inside, Some((weights, world)));
            }
        }
        let (weights, world) = best.1?;
        Some(std::array::from_fn(|k| (0..3).map(|i| weights[i] * world[i][k]).sum()))
    }

    /// Where material points are. The error names one that is not on the sheet.
    pub(super) fn places(&self, points: &[Material]) -> Result<Vec<World>, String> {
        let place = |&point: &Material| {
            self.at(point)
                .ok_or_else(|| format!("the material point {point:?} is not on the cloth"))
        };
        points.iter().map(place).collect()
    }

    /// Root mean square distance between the same material points of two surfaces (m). The error
    /// names a point that is not on both.
    pub(super) fn rms_distance(&self, other: &Surface, points: &[Material]) -> Result<f64, String> {
        Ok(rms(&self.places(points)?, &other.places(points)?))
    }
}

/// Root mean square distance of points and their counterparts (m).
pub(super) fn rms(one: &[World], other: &[World]) -> f64 {
    let square = |(a, b): (&World, &World)| (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>();
    (one.iter().zip(other).map(square).sum::<f64>() / one.len() as f64).sqrt()
}

/// `nx` by `ny` points over a rectangle, its border included; at least two in each direction.
pub(super) fn lattice([low, high]: [Material; 2], [nx, ny]: [usize; 2]) -> Vec<Material> {
    let at = |k: usize, i: usize, n: usize| {
        let t = i as f64 / (n - 1) as f64;
        low[k] * (1.0 - t) + high[k] * t
    };
    (0..ny).flat_map(|j| (0..nx).map(move |i| [at(0, i, nx), at(1, j, ny)])).collect()
}

/// Barycentric coordinates of a point; `None` in a triangle without area.
fn barycentric([a, b, c]: &[Material; 3], p: Material) -> Option<[f64; 3]> {
    let cross = |o: &Material, u: &Material, v: &Material| {
        (u[0] - o[0]) * (v[1] - o[1]) - (u[1] - o[1]) * (v[0] - o[0])
    };
    let area = cross(a, b, c);
    (area != 0.0).then(|| [cross(&p, b, c) / area, cross(&p, c, a) / area, cross(&p, a, b) / area])
}

/// The first `N` words as numbers; more may follow.
fn numbers<'a, const N: usize>(mut words: impl Iterator<Item = &'a str>) -> Option<[f64; N]> {
    let mut out = [0.0; N];
    for x in &mut out {
        *x = words.next()?.parse().ok()?;
    }
    Some(out)
}

/// The corner `v/vt` or `v/vt/vn` of a face, counted from 1.
fn corner(word: &str, v: &[World], vt: &[Material]) -> Option<(Material, World)> {
    let mut numbers = word.split('/').map(|number| number.parse::<usize>().ok()?.checked_sub(1));
    let (position, material) = (numbers.next()??, numbers.next()??);
    Some((*vt.get(material)?, *v.get(position)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of 2 m by 1 m, folded along its diagonal. The corners (2, 1) of the two triangles
    /// have entries `vt` of their own.
    const FOLDED: &str = "g sheet\nv 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 5\n\
                          vt 0 0\nvt 2 0\nvt 2 1\nvt 0 1\nvt 2 1\n\
                          f 1/1 2/2 3/3\nf 1/1 3/5 4/4/1\n";

    #[test]
    fn points_are_interpolated_in_their_triangle() {
        let surface = Surface::parse(FOLDED).unwrap();
        assert_eq!(surface.extent(), [[0.0, 0.0], [2.0, 1.0]]);
        let near = |point, expected: World| {
            let x = surface.at(point).unwrap();
            assert!((0..3).all(|k| (x[k] - expected[k]).abs() < 1e-14), "{point:?}: {x:?}");
        };
        near([1.5, 0.25], [1.5, 0.25, 0.0]);
        // (0, 1) is the corner lifted by 5; half-way between it and the diagonal's middle (1, 0.5).
        near([0.5, 0.75], [0.5, 0.75, 2.5]);
        near([1.0, 0.5], [1.0, 0.5, 0.0]);
        near([0.0, 1.0], [0.0, 1.0, 5.0]);
    }

    #[test]
    fn the_border_is_on_the_sheet_what_is_beyond_is_not() {
        let surface = Surface::parse(FOLDED).unwrap();
        assert!(surface.at([2.0 + 1e-12, 0.5]).is_some());
        assert_eq!(surface.at([2.01, 0.5]), None);
        assert_eq!(surface.at([1.0, -0.01]), None);
        assert!(surface.rms_distance(&surface, &[[3.0, 0.0]]).unwrap_err().contains("3.0"));
    }

    #[test]
    fn distance_of_a_shifted_and_of_a_refined_sheet() {
        let surface = Surface::parse(FOLDED).unwrap();
        let points = lattice(surface.extent(), [25, 17]);
        let mut moved = surface.clone();
        moved.triangles.iter_mut().flat_map(|(_, world)| world).for_each(|x| x[1] -= 0.25);
        assert!((moved.rms_distance(&surface, &points).unwrap() - 0.25).abs() < 1e-14);
        // Its first triangle cut in two at (1, 0): the same surface.
        let refined =
            FOLDED.replace("f 1/1 2/2 3/3", "v 1 0 0\nvt 1 0\nf 1/1 5/6 3/3\nf 5/6 2/2 3/3");
        let refined = Surface::parse(&refined).unwrap();
        assert_eq!(refined.triangles.len(), 3);
        assert!(refined.rms_distance(&surface, &points).unwrap() < 1e-14);
    }

    #[test]
    fn the_lattice_reaches_the_corners() {
        let points = lattice([[-1.0, 0.0], [2.0, 0.5]], [4, 3]);
        assert_eq!(points.len(), 12);
        assert_eq!((points[0], points[11]), ([-1.0, 0.0], [2.0, 0.5]));
        let [x, y] = points[5];
        assert!(x.abs() < 1e-15 && y == 0.25, "{x}, {y}");
    }

    #[test]
    fn bad_lines_are_named() {
        for (bad, line) in
            [("f 1/1 2/2 9/3", "line 13"), ("f 1 2 3", "line 13"), ("v 1 x", "line 13")]
        {
            let why = Surface::parse(&format!("{FOLDED}{bad}\n")).unwrap_err();
            assert!(why.contains(line), "{bad}: {why}");
        }
        assert!(Surface::parse("v 0 0 0\n").is_err());
    }
}
