//! From a glTF file to a character.

use super::channel::{self, Channel, Pose};
use super::vertices::Vertices;
use super::{Bone, Character, Container, Local, Node};
use crate::scene::format::AnimationRef;
use crate::scene::limits::MAX_COORDINATE_M;
use crate::scene::suggestion;
use gltf::json::Root;
use gltf::json::scene::Node as JsonNode;
use nalgebra::{Matrix4, Quaternion, UnitQuaternion, Vector3};

/// Most nodes times keyframes: far more than any character has.
const MAX_POSES: usize = 100_000_000;

/// Builds the character of a file.
///
/// # Errors
/// A sentence without its subject, the file, that names the place in it.
pub(crate) fn read(
    file: &Container,
    animation: Option<&AnimationRef>,
    start: f64,
) -> Result<Character, String> {
    let root = &file.root;
    let (nodes, order) = hierarchy(root)?;
    let mut bones = Vec::new();
    let mut bones_of_skin = vec![None; root.skins.len()];
    let mut vertices = Vertices::default();
    for k in drawn(root, &nodes, &order)? {
        let Some(mesh) = root.nodes[k].mesh else { continue };
        let mesh = root.meshes.get(mesh.value()).ok_or(format!("nodes[{k}]: has no mesh"))?;
        let skin = root.nodes[k].skin.map(|skin| skin.value());
        let joints = match skin {
            None => {
                bones.push(Bone { node: k, inverse_bind: Matrix4::identity() });
                None
            }
            // Skins are often shared by the parts of a body.
            Some(skin) => Some(match bones_of_skin.get(skin).copied().flatten() {
                Some(joints) => joints,
                None => {
                    let own = skin_bones(file, skin).map_err(|e| format!("skins[{skin}]: {e}"))?;
                    let joints = (bones.len() as u32, own.len() as u32);
                    bones.extend(own);
                    bones_of_skin[skin] = Some(joints);
                    joints
                }
            }),
        };
        let number = root.nodes[k].mesh.map_or(0, |mesh| mesh.value());
        for (p, primitive) in mesh.primitives.iter().enumerate() {
            let bone = bones.len() as u32 - 1;
            vertices
                .add(file, primitive, joints, bone)
                .map_err(|e| format!("meshes[{number}].primitives[{p}]: {e}"))?;
        }
    }
    let Vertices { rest, influences, first, triangles, .. } = vertices;
    if triangles.is_empty() {
        return Err("has no triangles in its scene".into());
    }
    let channels = channels(file, animation)?;
    let character =
        Character { nodes, order, bones, rest, influences, first, triangles, channels, start };
    check_reach(&character)?;
    Ok(character)
}

/// Refuses maps that take vertices so far that nothing can be reckoned with them.
fn check_reach(character: &Character) -> Result<(), String> {
    let keyframes = character.channels.iter().flat_map(|channel| channel.times());
    let mut times: Vec<f64> = keyframes.copied().chain([0.0]).collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    if times.len().saturating_mul(character.nodes.len()) > MAX_POSES {
        return Err(format!("has {} nodes at {} times", character.nodes.len(), times.len()));
    }
    for time in times {
        let bones = character.bones_at(time);
        // Also true of what is not a number.
        let far = |bone: &Matrix4<f64>| !bone.iter().all(|c| c.abs() <= MAX_COORDINATE_M);
        if let Some(bone) = bones.iter().position(far) {
            let node = character.bones[bone].node;
            return Err(format!("nodes[{node}]: is too far or too large at {time} s"));
        }
    }
    Ok(())
}

/// All nodes with their parents, and an order in which parents come first.
pub(super) fn hierarchy(root: &Root) -> Result<(Vec<Node>, Vec<usize>), String> {
    let mut nodes = Vec::with_capacity(root.nodes.len());
    for (k, node) in root.nodes.iter().enumerate() {
        let rest = local(node).ok_or(format!("nodes[{k}]: its rotation is zero"))?;
        nodes.push(Node { parent: None, rest });
    }
    let children = |k: usize| root.nodes[k].children.iter().flatten().map(|child| child.value());
    for k in 0..nodes.len() {
        for child in children(k) {
            let node =
                nodes.get_mut(child).ok_or(format!("nodes[{k}]: there is no node {child}"))?;
            if node.parent.replace(k).is_some() {
                return Err(format!("nodes[{child}]: has two parents"));
            }
        }
    }
    let mut order: Vec<usize> = (0..nodes.len()).filter(|&k| nodes[k].parent.is_none()).collect();
    let mut next = 0;
    while next < order.len() {
        order.extend(children(order[next]));
        next += 1;
    }
    if order.len() < nodes.len() {
        return Err("nodes: some are their own ancestors".into());
    }
    Ok((nodes, order))
}

/// The transform of a node; `None` if its rotation is none.
fn local(node: &JsonNode) -> Option<Local> {
    if let Some(matrix) = node.matrix {
        return Some(Local::Matrix(Matrix4::from_column_slice(&matrix.map(f64::from))));
    }
    let vector =
        |v: Option<[f32; 3]>, default: f32| Vector3::from(v.unwrap_or([default; 3]).map(f64::from));
    let [x, y, z, w] = node.rotation.unwrap_or_default().0.map(f64::from);
    let rotation = UnitQuaternion::try_new(Quaternion::new(w, x, y, z), 1e-6)?;
    let (translation, scale) = (vector(node.translation, 0.0), vector(node.scale, 1.0));
    Some(Local::Pose(Pose { translation, rotation, scale }))
}

/// The nodes of the scene, parents first.
fn drawn(root: &Root, nodes: &[Node], order: &[usize]) -> Result<Vec<usize>, String> {
    let number = root.scene.map_or(0, |scene| scene.value());
    let Some(scene) = root.scenes.get(number) else {
        return match root.scene {
            None => Ok(order.to_vec()),
            Some(_) => Err(format!("scene: there is no scene {number}")),
        };
    };
    let mut inside = vec![false; nodes.len()];
    for node in scene.nodes.iter().map(|node| node.value()) {
        let there = inside.get_mut(node);
        *there.ok_or(format!("scenes[{number}]: there is no node {node}"))? = true;
    }
    for &k in order {
        inside[k] |= nodes[k].parent.is_some_and(|parent| inside[parent]);
    }
    Ok(order.iter().copied().filter(|&k| inside[k]).collect())
}

/// The joints of a skin.
fn skin_bones(file: &Container, skin: usize) -> Result<Vec<Bone>, String> {
    let skin = file.root.skins.get(skin).ok_or("is not there")?;
    let binds = match skin.inverse_bind_matrices {
        None => vec![Matrix4::identity(); skin.joints.len()],
        Some(index) => {
            let numbers = file.numbers::<16>(index)?;
            numbers.iter().map(|m| Matrix4::from_column_slice(m)).collect()
        }
    };
    if binds.len() < skin.joints.len() {
        return Err(format!("has {} matrices for {} joints", binds.len(), skin.joints.len()));
    }
    let bone = |(joint, inverse_bind): (&gltf::json::Index<JsonNode>, Matrix4<f64>)| {
        let node = joint.value();
        if node >= file.root.nodes.len() {
            return Err(format!("there is no node {node}"));
        }
        Ok(Bone { node, inverse_bind })
    };
    skin.joints.iter().zip(binds).map(bone).collect()
}

/// The channels of the animation that is asked for.
pub(super) fn channels(
    file: &Container,
    wanted: Option<&AnimationRef>,
) -> Result<Vec<Channel>, String> {
    let animations = &file.root.animations;
    let index = match wanted {
        None if animations.is_empty() => return Ok(Vec::new()),
        None => 0,
        Some(AnimationRef::Index(index)) => *index as usize,
        Some(AnimationRef::Name(name)) => {
            let names: Vec<&str> = animations.iter().filter_map(|a| a.name.as_deref()).collect();
            let found = animations.iter().position(|a| a.name.as_deref() == Some(name));
            found.ok_or_else(|| {
                format!("there is no animation `{name}`{}", suggestion(name, &names))
            })?
        }
    };
    let animation = animations
        .get(index)
        .ok_or_else(|| format!("there is no animation {index}, it has {}", animations.len()))?;
    let read = |(k, channel)| {
        channel::read(file, animation, channel)
            .map_err(|e| format!("animations[{index}].channels[{k}]: {e}"))
    };
    animation.channels.iter().enumerate().map(read).collect()
}
