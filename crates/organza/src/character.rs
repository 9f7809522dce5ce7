//! Characters: surfaces moved by nodes, skeletons and animations of glTF 2.0 files.
//!
//! Read are all triangles of a file's default scene (its first where it names none, all nodes where
//! it has none), node hierarchies, skins with any number of joints per vertex, and one animation of
//! translations, rotations and scales, by steps, lines or cubic splines. Vertices that agree in place
//! and joints are one; triangles that have no area for that reason are left out. Materials
//! and the like are ignored; cameras are read on their own. Morph targets and compressed meshes are refused.
//!
//! Positions are in the file's frame: metres, y up.

mod accessor;
mod camera;
mod channel;
mod container;
mod read;
mod vertices;

pub(crate) use camera::read_camera;
pub(crate) use container::{Container, buffer_files};
pub(crate) use read::read;

use channel::{Channel, Pose};
use mesh_core::World3;
use nalgebra::{Matrix4, Point3, Vector3};

/// A surface whose vertices hang on moving nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct Character {
    nodes: Vec<Node>,
    /// All nodes, parents before their children.
    order: Vec<usize>,
    bones: Vec<Bone>,
    /// Where the vertices are as the file has them (m).
    rest: Vec<World3>,
    /// Bones of the vertices with their weights, which add up to one for each.
    influences: Vec<(u32, f64)>,
    /// The first influence of every vertex, and the number of all.
    first: Vec<usize>,
    triangles: Vec<[u32; 3]>,
    channels: Vec<Channel>,
    /// When the animation begins (s).
    start: f64,
}

/// One node of the hierarchy.
#[derive(Clone, Debug, PartialEq)]
struct Node {
    parent: Option<usize>,
    rest: Local,
}

/// A node's transform to its parent, as the file has it.
#[derive(Clone, Debug, PartialEq)]
enum Local {
    /// As parts, which an animation can change.
    Pose(Pose),
    /// As a matrix, which none can.
    Matrix(Matrix4<f64>),
}

/// What vertices hang on: a node, and the way from the vertices' frame to that of the node.
#[derive(Clone, Debug, PartialEq)]
struct Bone {
    node: usize,
    inverse_bind: Matrix4<f64>,
}

impl Character {
    /// Three vertices each.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Number of vertices.
    pub fn n_vertices(&self) -> usize {
        self.rest.len()
    }

    /// Whether an animation moves it.
    pub fn is_moving(&self) -> bool {
        !self.channels.is_empty()
    }

    /// Where the vertices are at `time` (s), in the file's frame (m): the animation's first moment
    /// before it begins, and its last after its end.
    pub fn positions(&self, time: f64) -> Vec<World3> {
        let bones = self.bones_at(time - self.start);
        let place = |v: usize| {
            let x = Point3::from(self.rest[v]);
            let parts = &self.influences[self.first[v]..self.first[v + 1]];
            parts.iter().fold(Vector3::zeros(), |sum, &(bone, weight)| {
                sum + bones[bone as usize].transform_point(&x).coords * weight
            })
        };
        (0..self.rest.len()).map(place).collect()
    }

    /// The maps of the bones at a time of the animation (s).
    fn bones_at(&self, time: f64) -> Vec<Matrix4<f64>> {
        let global = globals(&self.nodes, &self.order, &self.channels, time);
        self.bones.iter().map(|bone| global[bone.node] * bone.inverse_bind).collect()
    }
}

/// The transforms of all nodes at a time of the animation (s).
fn globals(nodes: &[Node], order: &[usize], channels: &[Channel], time: f64) -> Vec<Matrix4<f64>> {
    let mut locals: Vec<Local> = nodes.iter().map(|node| node.rest.clone()).collect();
    for channel in channels {
        if let Local::Pose(pose) = &mut locals[channel.node] {
            channel.apply(time, pose);
        }
    }
    let mut global = vec![Matrix4::identity(); nodes.len()];
    for &k in order {
        let local = match &locals[k] {
            Local::Pose(pose) => pose.matrix(),
            Local::Matrix(matrix) => *matrix,
        };
        global[k] = nodes[k].parent.map_or(local, |parent| global[parent] * local);
    }
    global
}
