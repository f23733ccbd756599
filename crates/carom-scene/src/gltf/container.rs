//! The wrapping of a glTF file: JSON alone (`.gltf`), or JSON and binary data in chunks (`.glb`).
//!
//! ```text
//! .glb = "glTF" version length (chunk)*      chunk = length type data      all numbers u32, little-endian
//! ```

use crate::SceneError;
use serde_json::Value;

const MAGIC: &[u8] = b"glTF";
const JSON: &[u8] = b"JSON";
const BIN: &[u8] = b"BIN\0";

/// What a file holds: its JSON, and the binary chunk of a `.glb`.
pub(super) struct Container<'a> {
    pub json: Value,
    pub binary: Option<&'a [u8]>,
}

/// Takes the wrapping off. A file that begins with the letters `glTF` is a `.glb`, whatever its name.
pub(super) fn open<'a>(file: &str, bytes: &'a [u8], named_glb: bool) -> Result<Container<'a>, SceneError> {
    let fault = |value: String, expected: &str| Err(SceneError::invalid(file, "", value, expected));
    if !bytes.starts_with(MAGIC) {
        if named_glb {
            let start = String::from_utf8_lossy(&bytes[..bytes.len().min(4)]).into_owned();
            return fault(format!("{start:?}"), "the letters glTF at the start of a .glb file");
        }
        return Ok(Container { json: parse(file, bytes)?, binary: None });
    }
    let Some(header) = bytes.get(..12) else {
        return fault(format!("{} bytes", bytes.len()), "a .glb file with its header of 12 bytes");
    };
    let version = u32_at(header, 4);
    if version != 2 {
        return fault(format!("version {version}"), "version 2 of the .glb format");
    }
    let length = u32_at(header, 8) as usize;
    if length != bytes.len() {
        return fault(
            format!("{} bytes", bytes.len()),
            &format!("the {length} bytes that its header announces"),
        );
    }
    let (mut json, mut binary) = (None, None);
    let mut rest = &bytes[12..];
    while !rest.is_empty() {
        let at = bytes.len() - rest.len();
        let Some((head, body)) = rest.split_at_checked(8) else {
            return fault(format!("{} bytes at byte {at}", rest.len()), "a chunk's header of 8 bytes");
        };
        let length = u32_at(head, 0) as usize;
        let Some((data, after)) = body.split_at_checked(length) else {
            return fault(
                format!("a chunk of {length} bytes at byte {at}"),
                &format!("a chunk within the {} bytes that follow", body.len()),
            );
        };
        match (&head[4..8], json.is_some()) {
            (JSON, false) => json = Some(parse(file, data)?),
            (kind, false) => {
                return fault(
                    format!("{:?}", String::from_utf8_lossy(kind)),
                    "a JSON chunk before all others",
                );
            }
            (BIN, true) if binary.is_none() => binary = Some(data),
            // The format asks readers to skip what they don't know.
            _ => {}
        }
        rest = after;
    }
    match json {
        Some(json) => Ok(Container { json, binary }),
        None => fault("no chunk".to_owned(), "a JSON chunk"),
    }
}

fn parse(file: &str, bytes: &[u8]) -> Result<Value, SceneError> {
    let text = std::str::from_utf8(bytes).map_err(|error| {
        let value = format!("no UTF-8 at byte {} of the JSON", error.valid_up_to());
        SceneError::invalid(file, "", value, "JSON in UTF-8")
    })?;
    serde_json::from_str(text).map_err(|error| SceneError::Syntax {
        file: file.to_owned(),
        line: error.line(),
        column: error.column(),
        message: error.to_string().split(" at line ").next().unwrap_or_default().to_owned(),
    })
}

fn u32_at(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]])
}
