//! Which triangle is nearest at every sample: an integer rasteriser with a depth buffer.

/// Steps per pixel to which corners are snapped. All coverage is then decided in integers, so that
/// triangles with a common edge share no sample and leave none out.
const STEPS: i64 = 256;
/// Side of the blocks in which large hidden triangles are passed over (px).
pub(super) const BLOCK: usize = 16;
/// Owner of samples that nothing covers.
pub(super) const NOBODY: u32 = u32::MAX;

/// A triangle in the picture.
pub(super) struct Prim {
    /// Snapped corners (px / 256), turned so that the doubled area is positive.
    corners: [[i32; 2]; 3],
    /// Nearness at column x and row y (px): `plane · (x, y, 1)`. Greater is nearer.
    plane: [f64; 3],
    /// Least and greatest nearness of the corners: a sliver's plane may overshoot them.
    range: [f32; 2],
    owner: u32,
}

impl Prim {
    /// A triangle with `corners` in the picture (px), `None` if it covers nothing.
    pub(super) fn new(
        corners: [[f64; 2]; 3],
        plane: [f64; 3],
        range: [f64; 2],
        owner: u32,
    ) -> Option<Self> {
        let mut corners = corners.map(|c| c.map(|x| (x * STEPS as f64).round() as i32));
        let [a, b, c] = corners.map(|c| c.map(i64::from));
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if area == 0 || !plane.iter().all(|x| x.is_finite()) {
            return None;
        }
        if area < 0 {
            corners.swap(1, 2);
        }
        Some(Self { corners, plane, range: range.map(|x| x as f32), owner })
    }

    /// Rows that the triangle may touch (px), clamped to a picture of `height` rows.
    pub(super) fn rows(&self, height: usize) -> std::ops::Range<usize> {
        self.span(1, 0, height)
    }

    /// Pixels touched along one axis, of those from `first` on, as offsets from `first`.
    fn span(&self, axis: usize, first: usize, count: usize) -> std::ops::Range<usize> {
        let pixel =
            |x: i32| (i64::from(x).div_euclid(STEPS) - first as i64).clamp(-1, count as i64);
        let places = self.corners.map(|c| c[axis]);
        let low = places.into_iter().map(pixel).min().unwrap_or(0).max(0);
        let high = places.into_iter().map(pixel).max().unwrap_or(0) + 1;
        low as usize..(high as usize).min(count).max(low as usize)
    }
}

/// One side of a triangle as a function of place, at least zero inside.
struct Edge<const N: usize> {
    /// Change per pixel to the right and down.
    step: [i64; 2],
    /// Value at the top left corner of the picture.
    origin: i64,
    /// Change from the top left corner of a pixel to each of its samples.
    sample: [i64; N],
    /// Least and greatest of them.
    sample_range: [i64; 2],
}

impl<const N: usize> Edge<N> {
    fn new(a: [i64; 2], b: [i64; 2], pattern: &[[i64; 2]; N]) -> Self {
        let d = [b[0] - a[0], b[1] - a[1]];
        let at = |x: i64, y: i64| d[0] * y - d[1] * x;
        // A sample exactly on an edge belongs to one side of it alone.
        let owns = d[1] < 0 || (d[1] == 0 && d[0] > 0);
        let sample = pattern.map(|[x, y]| at(x, y));
        let least = sample.into_iter().min().unwrap_or(0);
        let most = sample.into_iter().max().unwrap_or(0);
        Self {
            step: [at(STEPS, 0), at(0, STEPS)],
            origin: at(-a[0], -a[1]) - i64::from(!owns),
            sample,
            sample_range: [least, most],
        }
    }

    fn at(&self, x: usize, y: usize) -> i64 {
        self.origin + self.step[0] * x as i64 + self.step[1] * y as i64
    }
}

/// A strip of a picture with `N` samples in each pixel.
pub(super) struct Strip<'p, const N: usize> {
    /// Places of the samples in a pixel (px / 256).
    pattern: &'p [[i64; 2]; N],
    pub(super) width: usize,
    pub(super) height: usize,
    /// First row of the picture in the strip.
    top: usize,
    /// Nearness of every sample; 0 is infinitely far.
    pub(super) nearness: Vec<[f32; N]>,
    pub(super) owner: Vec<[u32; N]>,
    blocks_across: usize,
    /// For every block, a nearness that all its samples reach at least.
    floor: Vec<f32>,
    /// Whether the block changed since its floor was found.
    stale: Vec<bool>,
}

impl<'p, const N: usize> Strip<'p, N> {
    /// An empty strip; `farthest` is the nearness of samples that nothing covers.
    pub(super) fn new(
        pattern: &'p [[i64; 2]; N],
        width: usize,
        height: usize,
        farthest: f32,
    ) -> Self {
        let blocks_across = width.div_ceil(BLOCK);
        let n_blocks = blocks_across * height.div_ceil(BLOCK);
        Self {
            pattern,
            width,
            height,
            top: 0,
            nearness: vec![[farthest; N]; width * height],
            owner: vec![[NOBODY; N]; width * height],
            blocks_across,
            floor: vec![farthest; n_blocks],
            stale: vec![false; n_blocks],
        }
    }

    /// Empties the strip and moves it to begin at row `top`.
    pub(super) fn restart(&mut self, top: usize, farthest: f32) {
        self.top = top;
        self.nearness.fill([farthest; N]);
        self.owner.fill([NOBODY; N]);
        self.floor.fill(farthest);
        self.stale.fill(false);
    }

    /// Puts a triangle into the strip. Of equally near triangles the first stays.
    pub(super) fn fill(&mut self, prim: &Prim) {
        let columns = prim.span(0, 0, self.width);
        let rows = prim.span(1, self.top, self.height);
        if columns.is_empty() || rows.is_empty() {
            return;
        }
        let [a, b, c] = prim.corners.map(|c| c.map(i64::from));
        let edges = [(a, b), (b, c), (c, a)].map(|(a, b)| Edge::new(a, b, self.pattern));
        for block_row in rows.start / BLOCK..rows.end.div_ceil(BLOCK) {
            let y = rows.start.max(block_row * BLOCK)..rows.end.min((block_row + 1) * BLOCK);
            for block_column in columns.start / BLOCK..columns.end.div_ceil(BLOCK) {
                let x = columns.start.max(block_column * BLOCK)
                    ..columns.end.min((block_column + 1) * BLOCK);
                let block = block_row * self.blocks_across + block_column;
                if self.may_show(prim, &edges, block, x.clone(), y.clone()) {
                    self.fill_block(prim, &edges, block, x, y.clone());
                }
            }
        }
    }

    /// Whether a triangle can win a sample in the part `x`, `y` of a block. Keeps the cost of many
    /// large triangles down to that of their visible parts.
    fn may_show(
        &mut self,
        prim: &Prim,
        edges: &[Edge<N>; 3],
        block: usize,
        x: std::ops::Range<usize>,
        y: std::ops::Range<usize>,
    ) -> bool {
        let (across, down) = (x.len() - 1, y.len() - 1);
        if across + down < BLOCK {
            return true;
        }
        let outside = edges.iter().any(|edge| {
            let best_x = if edge.step[0] > 0 { x.end - 1 } else { x.start };
            let best_y = if edge.step[1] > 0 { y.end - 1 } else { y.start };
            edge.at(best_x, best_y + self.top) + edge.sample_range[1] < 0
        });
        if outside {
            return false;
        }
        let place = |slope: f64, range: &std::ops::Range<usize>| {
            (if slope > 0.0 { range.end } else { range.start }) as f64
        };
        let [dx, dy, origin] = prim.plane;
        let best = dx * place(dx, &x) + dy * (place(dy, &y) + self.top as f64) + origin;
        let best = (best as f32).min(prim.range[1]);
        if best > self.floor[block] && self.stale[block] {
            self.refresh(block);
        }
        best > self.floor[block]
    }

    fn refresh(&mut self, block: usize) {
        let (x, y) = (block % self.blocks_across * BLOCK, block / self.blocks_across * BLOCK);
        let mut floor = f32::INFINITY;
        for row in y..(y + BLOCK).min(self.height) {
            let line = row * self.width;
            for cell in &self.nearness[line + x..line + (x + BLOCK).min(self.width)] {
                floor = cell.iter().fold(floor, |a, &b| if b < a { b } else { a });
            }
        }
        self.floor[block] = floor;
        self.stale[block] = false;
    }

    fn fill_block(
        &mut self,
        prim: &Prim,
        edges: &[Edge<N>; 3],
        block: usize,
        columns: std::ops::Range<usize>,
        rows: std::ops::Range<usize>,
    ) {
        let [dx, dy, origin] = prim.plane;
        let [least, most] = prim.range;
        let sample = self.pattern.map(|[x, y]| (dx * x as f64 + dy * y as f64) / STEPS as f64);
        for y in rows {
            let row = y + self.top;
            let mut e: [i64; 3] = std::array::from_fn(|k| edges[k].at(columns.start, row));
            let base = dy * row as f64 + origin;
            for x in columns.clone() {
                let lowest = (0..3).map(|k| e[k] + edges[k].sample_range[0]);
                let highest = (0..3).map(|k| e[k] + edges[k].sample_range[1]);
                if highest.fold(0, |all, e| all | e) >= 0 {
                    let inside = lowest.fold(0, |all, e| all | e) >= 0;
                    let here = base + dx * x as f64;
                    let cell = y * self.width + x;
                    let (nearness, owner) = (&mut self.nearness[cell], &mut self.owner[cell]);
                    for s in 0..N {
                        // The sign bit of the union is set if any of the three is negative.
                        let e = (0..3).fold(0, |all, k| all | (e[k] + edges[k].sample[s]));
                        let q = ((here + sample[s]) as f32).clamp(least, most);
                        if (inside || e >= 0) && q > nearness[s] {
                            nearness[s] = q;
                            owner[s] = prim.owner;
                        }
                    }
                }
                for k in 0..3 {
                    e[k] += edges[k].step[0];
                }
            }
        }
        self.stale[block] = true;
    }
}
