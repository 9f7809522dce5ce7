//! Cameras of glTF files, moved by nodes and animations as characters are.

use super::channel::Channel;
use super::read::{channels, hierarchy};
use super::{Container, Node, globals};
use crate::scene::format::AnimationRef;
use crate::scene::suggestion;
use mesh_core::World3;
use nalgebra::{Matrix3, Rotation3, UnitQuaternion};

/// A camera that moves.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MovingCamera {
    nodes: Vec<Node>,
    order: Vec<usize>,
    channels: Vec<Channel>,
    /// The node it hangs on.
    node: usize,
    /// Angle between the lower and the upper edge of the picture (rad).
    pub(crate) vertical_fov: f64,
}

/// Reads the perspective camera of this name, or the first that a node has.
///
/// # Errors
/// A sentence without its subject, the file, that names the place in it.
pub(crate) fn read_camera(
    file: &Container,
    name: Option<&str>,
    animation: Option<&AnimationRef>,
) -> Result<MovingCamera, String> {
    let root = &file.root;
    let (nodes, order) = hierarchy(root)?;
    let of_node = |k: usize| {
        let camera = root.cameras.get(root.nodes[k].camera?.value())?;
        // Files name the camera or the node it hangs on.
        Some((k, camera, [camera.name.as_deref(), root.nodes[k].name.as_deref()]))
    };
    let all: Vec<_> = (0..root.nodes.len()).filter_map(of_node).collect();
    let found = match name {
        None => all.first().ok_or("has no node with a camera")?,
        Some(name) => {
            all.iter().find(|(_, _, names)| names.contains(&Some(name))).ok_or_else(|| {
                let names: Vec<&str> =
                    all.iter().flat_map(|(.., n)| n.iter().flatten().copied()).collect();
                format!("there is no camera `{name}`{}", suggestion(name, &names))
            })?
        }
    };
    let &(node, camera, _) = found;
    let perspective = camera
        .perspective
        .as_ref()
        .ok_or(format!("nodes[{node}]: its camera has no perspective"))?;
    let vertical_fov = f64::from(perspective.yfov);
    let channels = channels(file, animation)?;
    Ok(MovingCamera { nodes, order, channels, node, vertical_fov })
}

impl MovingCamera {
    /// The first and the last time of its animation; none if nothing moves (s).
    pub(crate) fn span(&self) -> Option<[f64; 2]> {
        let times = || self.channels.iter().flat_map(|channel| channel.times()).copied();
        let [first, last] =
            [times().fold(f64::INFINITY, f64::min), times().fold(f64::NEG_INFINITY, f64::max)];
        (first <= last).then_some([first, last])
    }

    /// Where it is at a time of the animation, in the frame of the file (m), and its axes: right, down
    /// and forward. None if its node has no volume left.
    pub(crate) fn at(&self, time: f64) -> Option<(World3, UnitQuaternion<f64>)> {
        let map = globals(&self.nodes, &self.order, &self.channels, time)[self.node];
        let [x, y] = [0, 1].map(|k| map.fixed_view::<3, 1>(0, k).into_owned());
        let right = x.try_normalize(1e-12)?;
        let up = (y - right * right.dot(&y)).try_normalize(1e-12)?;
        // It looks along its −z axis.
        let axes = Matrix3::from_columns(&[right, -up, right.cross(&-up)]);
        let rotation =
            UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
        Some((map.fixed_view::<3, 1>(0, 3).into_owned(), rotation))
    }
}
