//! Numbers out of the buffers of a glTF file, every bound checked.

use super::Container;
use gltf::json::Index;
use gltf::json::accessor::{Accessor, ComponentType};
use gltf::json::validation::Checked;

impl Container {
    /// The elements of an accessor with `N` components each; integers that stand for fractions are
    /// made fractions.
    ///
    /// # Errors
    /// A sentence that names the accessor.
    pub(super) fn numbers<const N: usize>(
        &self,
        index: Index<Accessor>,
    ) -> Result<Vec<[f64; N]>, String> {
        let k = index.value();
        let numbers = self.root.accessors.get(k).map(|accessor| self.elements(accessor));
        let numbers = numbers.ok_or_else(|| "it is not there".to_owned()).flatten();
        numbers.map_err(|message| format!("accessors[{k}]: {message}"))
    }

    fn elements<const N: usize>(&self, accessor: &Accessor) -> Result<Vec<[f64; N]>, String> {
        if accessor.sparse.is_some() {
            return Err("sparse accessors are not supported".into());
        }
        let (Checked::Valid(kind), Checked::Valid(component)) =
            (accessor.type_, accessor.component_type)
        else {
            return Err("has no known type".into());
        };
        if kind.multiplicity() != N {
            return Err(format!("has {} numbers an element instead of {N}", kind.multiplicity()));
        }
        let component = component.0;
        let size = component.size() * N;
        let view = accessor.buffer_view.ok_or("has no data")?.value();
        let view = self.root.buffer_views.get(view).ok_or("has no data")?;
        let buffer = self.buffers.get(view.buffer.value()).ok_or("has no buffer")?;
        let stride = view.byte_stride.map_or(size, |stride| stride.0);
        if stride < size {
            return Err(format!("a stride of {stride} bytes is less than an element of {size}"));
        }
        let count = usize::try_from(accessor.count.0).unwrap_or(usize::MAX);
        let slice = |bytes: &[u8], start: u64, length: u64| {
            let end = start.checked_add(length).and_then(|end| usize::try_from(end).ok())?;
            Some(bytes.get(usize::try_from(start).ok()?..end)?.to_vec())
        };
        let view_start = view.byte_offset.map_or(0, |offset| offset.0);
        let data = slice(buffer, view_start, view.byte_length.0);
        let start = accessor.byte_offset.map_or(0, |offset| offset.0);
        let needed = match count {
            0 => Some(0),
            n => (n - 1).checked_mul(stride).and_then(|bytes| bytes.checked_add(size)),
        };
        let data = data
            .zip(needed)
            .and_then(|(data, needed)| slice(&data, start, needed as u64))
            .ok_or("reaches beyond its buffer")?;
        let number = |bytes: &[u8]| number(component, accessor.normalized, bytes);
        let step = component.size();
        let element = |at: &[u8]| std::array::from_fn(|i| number(&at[i * step..(i + 1) * step]));
        let elements: Vec<[f64; N]> =
            (0..count).map(|k| element(&data[k * stride..k * stride + size])).collect();
        match elements.iter().position(|x| !x.iter().all(|c| c.is_finite())) {
            Some(k) => Err(format!("element {k} is not finite")),
            None => Ok(elements),
        }
    }
}

/// One number from as many bytes as its type has.
fn number(kind: ComponentType, normalized: bool, bytes: &[u8]) -> f64 {
    let two = || [bytes[0], bytes[1]];
    let four = || [bytes[0], bytes[1], bytes[2], bytes[3]];
    let (value, most) = match kind {
        ComponentType::I8 => (f64::from(bytes[0] as i8), f64::from(i8::MAX)),
        ComponentType::U8 => (f64::from(bytes[0]), f64::from(u8::MAX)),
        ComponentType::I16 => (f64::from(i16::from_le_bytes(two())), f64::from(i16::MAX)),
        ComponentType::U16 => (f64::from(u16::from_le_bytes(two())), f64::from(u16::MAX)),
        ComponentType::U32 => (f64::from(u32::from_le_bytes(four())), f64::from(u32::MAX)),
        ComponentType::F32 => return f64::from(f32::from_le_bytes(four())),
    };
    // The most negative integer has no positive partner.
    if normalized { (value / most).max(-1.0) } else { value }
}
