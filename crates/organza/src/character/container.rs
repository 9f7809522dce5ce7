//! A glTF file and its buffers.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use gltf::json::Root;

/// Beginnings of required extensions that do not touch what is read here, or that reading respects
/// anyway.
const HARMLESS: [&str; 5] =
    ["KHR_mesh_quantization", "KHR_materials_", "KHR_texture_", "KHR_lights_", "EXT_texture_"];

/// A file that was read: its description and the bytes of its buffers.
pub(crate) struct Container {
    pub(super) root: Root,
    pub(super) buffers: Vec<Vec<u8>>,
}

/// Where a buffer is.
enum Place {
    /// In the binary part of a `.glb` file.
    Blob(Vec<u8>),
    /// In the text of the file.
    Data(Vec<u8>),
    /// In a file of its own.
    File(String),
}

/// The names of the files that hold buffers, as the glTF file of this name would have them found.
///
/// # Errors
/// A sentence without its subject, the file.
pub(crate) fn buffer_files(name: &str, bytes: &[u8]) -> Result<Vec<String>, String> {
    let (root, blob) = parse(bytes)?;
    let places = places(&root, blob, name)?;
    let files = places.into_iter().filter_map(|place| match place {
        Place::File(file) => Some(file),
        Place::Blob(_) | Place::Data(_) => None,
    });
    Ok(files.collect())
}

impl Container {
    /// Reads the file `name`; `file` gives the content of those that [`buffer_files`] names.
    ///
    /// # Errors
    /// A sentence without its subject, the file.
    pub(crate) fn new<'f>(
        name: &str,
        bytes: &[u8],
        file: impl Fn(&str) -> Option<&'f [u8]>,
    ) -> Result<Container, String> {
        let (root, blob) = parse(bytes)?;
        let mut buffers = Vec::new();
        for (k, place) in places(&root, blob, name)?.into_iter().enumerate() {
            let bytes = match place {
                Place::Blob(bytes) | Place::Data(bytes) => bytes,
                Place::File(name) => file(&name)
                    .ok_or_else(|| format!("buffers[{k}]: there is no file `{name}`"))?
                    .to_vec(),
            };
            let (got, wanted) = (bytes.len() as u64, root.buffers[k].byte_length.0);
            if got < wanted {
                return Err(format!("buffers[{k}]: has {got} bytes instead of {wanted}"));
            }
            buffers.push(bytes);
        }
        Ok(Container { root, buffers })
    }
}

/// The description and the binary part.
fn parse(bytes: &[u8]) -> Result<(Root, Option<Vec<u8>>), String> {
    let no_json = |error: gltf::json::Error| format!("is not glTF: {error}");
    let (root, blob) = if bytes.starts_with(b"glTF") {
        // The library subtracts the size of the header from the length that the header names.
        let length = bytes.get(8..12).and_then(|b| b.try_into().ok()).map(u32::from_le_bytes);
        if length.is_none_or(|length| length < 12) {
            return Err("is not glTF: the header is cut off".into());
        }
        let glb = gltf::Glb::from_slice(bytes).map_err(|e| format!("is not glTF: {e}"))?;
        let root = gltf::json::deserialize::from_slice(&glb.json).map_err(no_json)?;
        (root, glb.bin.map(std::borrow::Cow::into_owned))
    } else {
        (gltf::json::deserialize::from_slice(bytes).map_err(no_json)?, None)
    };
    check(&root)?;
    Ok((root, blob))
}

/// Refuses other versions, and files that cannot be read without an extension that is not known.
/// The library's own validation is left alone: it panics on some files, and reading checks all that
/// it uses.
fn check(root: &Root) -> Result<(), String> {
    if root.asset.version.split('.').next() != Some("2") {
        return Err(format!("is glTF {}, and 2.0 alone is read", root.asset.version));
    }
    let known = |name: &String| HARMLESS.iter().any(|start| name.starts_with(start));
    match root.extensions_required.iter().find(|name| !known(name)) {
        Some(name) => Err(format!("needs the extension `{name}`, which is not supported")),
        None => Ok(()),
    }
}

/// Where all buffers are.
fn places(root: &Root, mut blob: Option<Vec<u8>>, name: &str) -> Result<Vec<Place>, String> {
    let folder = name.rfind(['/', '\\']).map_or("", |end| &name[..=end]);
    let place = |(k, buffer): (usize, &gltf::json::Buffer)| match buffer.uri.as_deref() {
        None if k == 0 => {
            blob.take().map(Place::Blob).ok_or_else(|| "buffers[0]: has no data".to_owned())
        }
        None => Err(format!("buffers[{k}]: has no data")),
        Some(uri) => match uri.strip_prefix("data:").map(|data| data.split_once(";base64,")) {
            Some(Some((_, data))) => {
                STANDARD.decode(data).map(Place::Data).map_err(|e| format!("buffers[{k}]: {e}"))
            }
            Some(None) => Err(format!("buffers[{k}]: its data is not base64")),
            None if uri.contains("://") => Err(format!("buffers[{k}]: `{uri}` is not a file")),
            None => Ok(Place::File(format!("{folder}{}", unescaped(uri)))),
        },
    };
    root.buffers.iter().enumerate().map(place).collect()
}

/// A URI's path with its `%20` and the like as characters.
fn unescaped(uri: &str) -> String {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let [first, more @ ..] = rest {
        let code = more.get(..2).and_then(|code| std::str::from_utf8(code).ok());
        match code.and_then(|code| u8::from_str_radix(code, 16).ok()) {
            Some(byte) if *first == b'%' => {
                bytes.push(byte);
                rest = &more[2..];
            }
            _ => {
                bytes.push(*first);
                rest = more;
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}
