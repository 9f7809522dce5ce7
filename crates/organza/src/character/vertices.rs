//! The vertices and triangles of a character while they are put together.

use super::Container;
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;
use mesh_core::World3;
use std::collections::BTreeMap;

/// Vertices with what they hang on, and triangles.
#[derive(Default)]
pub(super) struct Vertices {
    pub(super) rest: Vec<World3>,
    pub(super) influences: Vec<(u32, f64)>,
    pub(super) first: Vec<usize>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// The vertex of every place with its influences.
    known: BTreeMap<Key, u32>,
}

/// Place and influences of a vertex, by their bits.
type Key = (Vec<u64>, Vec<(u32, u64)>);

impl Vertices {
    /// Adds the triangles of a primitive, on the joints of a skin (the number of the first bone and
    /// how many there are) or on the one `bone`.
    pub(super) fn add(
        &mut self,
        file: &Container,
        primitive: &Primitive,
        joints: Option<(u32, u32)>,
        bone: u32,
    ) -> Result<(), String> {
        let Checked::Valid(mode) = primitive.mode else { return Err("has no known mode".into()) };
        if !matches!(mode, Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
            return Ok(());
        }
        if primitive.targets.as_ref().is_some_and(|targets| !targets.is_empty()) {
            return Err("morph targets are not supported".into());
        }
        let attribute = |semantic| primitive.attributes.get(&Checked::Valid(semantic)).copied();
        let positions = attribute(Semantic::Positions).ok_or("has no positions")?;
        let positions = file.numbers::<3>(positions)?;
        let mut hangs: Vec<Vec<(u32, f64)>> = vec![Vec::new(); positions.len()];
        match joints {
            None => hangs.fill(vec![(bone, 1.0)]),
            Some(joints) => {
                for set in 0.. {
                    let pair =
                        attribute(Semantic::Joints(set)).zip(attribute(Semantic::Weights(set)));
                    let Some((numbers, weights)) = pair else { break };
                    let (numbers, weights) =
                        (file.numbers::<4>(numbers)?, file.numbers::<4>(weights)?);
                    if numbers.len() != positions.len() || weights.len() != positions.len() {
                        return Err("has not as many joints as positions".into());
                    }
                    for (v, (numbers, weights)) in numbers.iter().zip(&weights).enumerate() {
                        hang(&mut hangs[v], numbers, weights, joints)
                            .map_err(|e| format!("vertex {v}: {e}"))?;
                    }
                }
            }
        }
        let number: Result<Vec<u32>, String> = positions
            .iter()
            .zip(hangs)
            .enumerate()
            .map(|(v, (x, hangs))| {
                self.vertex(World3::from(*x), hangs).ok_or(format!("vertex {v}: no joint moves it"))
            })
            .collect();
        let number = number?;
        let corners: Vec<usize> = match primitive.indices {
            None => (0..number.len()).collect(),
            Some(indices) => {
                file.numbers::<1>(indices)?.into_iter().map(|[i]| i as usize).collect()
            }
        };
        if let Some(k) = corners.iter().position(|&c| c >= number.len()) {
            let n = number.len();
            return Err(format!("index {k} is {} and there are {n} vertices", corners[k]));
        }
        let faces: Vec<[usize; 3]> = match mode {
            Mode::TriangleStrip => {
                // Every other one turns the other way.
                let turn = |(k, w): (usize, &[usize])| {
                    if k % 2 == 0 { [w[0], w[1], w[2]] } else { [w[1], w[0], w[2]] }
                };
                corners.windows(3).enumerate().map(turn).collect()
            }
            Mode::TriangleFan => {
                corners.windows(2).skip(1).map(|w| [corners[0], w[0], w[1]]).collect()
            }
            _ if !corners.len().is_multiple_of(3) => {
                return Err(format!("has {} corners, not three a triangle", corners.len()));
            }
            _ => corners.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
        };
        let faces = faces.into_iter().map(|face| face.map(|c| number[c]));
        self.triangles.extend(faces.filter(|&[a, b, c]| a != b && b != c && c != a));
        Ok(())
    }

    /// The number of a vertex, which is a new one unless there is its like; `None` if nothing moves
    /// it.
    fn vertex(&mut self, x: World3, mut hangs: Vec<(u32, f64)>) -> Option<u32> {
        hangs.retain(|&(_, weight)| weight > 0.0);
        hangs.sort_by_key(|&(bone, _)| bone);
        // Files round their weights.
        let sum: f64 = hangs.iter().map(|(_, weight)| weight).sum();
        if sum <= 0.0 {
            return None;
        }
        hangs.iter_mut().for_each(|(_, weight)| *weight /= sum);
        // Zero has two signs.
        let place = x.iter().map(|c| (c + 0.0).to_bits()).collect();
        let key = (place, hangs.iter().map(|&(bone, w)| (bone, w.to_bits())).collect());
        Some(*self.known.entry(key).or_insert_with(|| {
            if self.first.is_empty() {
                self.first.push(0);
            }
            self.rest.push(x);
            self.influences.extend(&hangs);
            self.first.push(self.influences.len());
            self.rest.len() as u32 - 1
        }))
    }
}

/// Adds four joints with their weights.
fn hang(
    hangs: &mut Vec<(u32, f64)>,
    numbers: &[f64; 4],
    weights: &[f64; 4],
    (first, n): (u32, u32),
) -> Result<(), String> {
    for (&joint, &weight) in numbers.iter().zip(weights) {
        if weight < 0.0 {
            return Err(format!("a weight is {weight}"));
        }
        if weight > 0.0 {
            if joint >= f64::from(n) {
                return Err(format!("there is no joint {joint}, the skin has {n}"));
            }
            hangs.push((first + joint as u32, weight));
        }
    }
    Ok(())
}
