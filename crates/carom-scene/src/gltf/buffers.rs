//! Binary data: buffers, views into them, and the accessors that say what the bytes are.

use super::base64;
use super::json::{At, Document};
use crate::SceneError;
use std::borrow::Cow;
use std::path::{Path, PathBuf};

/// The largest external buffer that is read, bytes: the same bound that holds for a scene file.
const LARGEST_FILE: u64 = 1 << 30;
/// The most elements of an accessor that has no bytes of its own (sparse on a ground of zeros).
const MOST_ZEROS: usize = 1 << 24;

/// The buffers of a file. Each is fetched when it is first needed: physics needs few of them.
pub(super) struct Buffers<'a> {
    document: Document<'a>,
    binary: Option<&'a [u8]>,
    folder: PathBuf,
    fetched: Vec<Option<Cow<'a, [u8]>>>,
}

impl<'a> Buffers<'a> {
    /// The buffers of `document`, with the binary chunk of a `.glb` and the folder for the paths of files.
    pub fn new(document: &Document<'a>, binary: Option<&'a [u8]>, folder: &Path) -> Result<Self, SceneError> {
        let fetched = vec![None; document.table("buffers")?.len()];
        Ok(Self { document: document.clone(), binary, folder: folder.to_owned(), fetched })
    }

    /// All numbers of an accessor, element after element: `kind` and `width` are such as `VEC3` and 3.
    pub fn numbers(&mut self, accessor: &At<'a>, kind: &str, width: usize) -> Result<Vec<f64>, SceneError> {
        let found = accessor.need("type", kind)?;
        if found.value.as_str() != Some(kind) {
            return Err(found.error(format!("{kind}, for what it is used as")));
        }
        let component = accessor.need("componentType", "a component type")?;
        let form = Component::read(&component)?;
        let normalized = accessor.get("normalized")?.map_or(Ok(false), |at| at.boolean())?;
        let count_at = accessor.need("count", "the number of elements")?;
        let count = count_at.count()?;
        let sparse = accessor.get("sparse")?;
        let mut numbers = match accessor.get("bufferView")? {
            Some(view) => {
                let layout = Layout { form, normalized, width, count };
                let offset = accessor.count_or("byteOffset", 0)?;
                self.strided(&view, offset, &layout, &count_at)?
            }
            None if sparse.is_none() => {
                return Err(accessor.refused("no bufferView", "uncompressed data in a bufferView"));
            }
            None if count > MOST_ZEROS => {
                return Err(count_at.error(format!("at most {MOST_ZEROS} elements without a bufferView")));
            }
            None => vec![0.0; count * width],
        };
        if let Some(sparse) = sparse {
            self.replace(&sparse, &mut numbers, &Layout { form, normalized, width, count })?;
        }
        match numbers.iter().position(|number| !number.is_finite()) {
            Some(i) => {
                Err(accessor.refused(format!("{} in element {}", numbers[i], i / width), "finite numbers"))
            }
            None => Ok(numbers),
        }
    }

    /// Puts the elements of a sparse accessor in their places.
    fn replace(&mut self, sparse: &At<'a>, numbers: &mut [f64], to: &Layout) -> Result<(), SceneError> {
        let count_at = sparse.need("count", "the number of replaced elements")?;
        let count = count_at.count()?;
        let indices = sparse.need("indices", "the indices of the replaced elements")?;
        let component = indices.need("componentType", "a component type")?;
        let layout = Layout { form: Component::read(&component)?, normalized: false, width: 1, count };
        if !layout.form.is_index() {
            return Err(component.error("5121, 5123 or 5125 (an unsigned integer)"));
        }
        let view = indices.need("bufferView", "an index into bufferViews")?;
        let places = self.strided(&view, indices.count_or("byteOffset", 0)?, &layout, &count_at)?;
        let values = sparse.need("values", "the replacing elements")?;
        let view = values.need("bufferView", "an index into bufferViews")?;
        let new =
            self.strided(&view, values.count_or("byteOffset", 0)?, &Layout { count, ..*to }, &count_at)?;
        for (place, element) in places.iter().zip(new.chunks_exact(to.width)) {
            let place = *place as usize;
            if place >= to.count {
                return Err(
                    indices.refused(place, format!("indices below the accessor's count, {}", to.count))
                );
            }
            numbers[place * to.width..][..to.width].copy_from_slice(element);
        }
        Ok(())
    }

    /// Reads elements at `offset` of the view that `view` names. `count_at` is what an error is about.
    fn strided(
        &mut self,
        view: &At<'a>,
        offset: usize,
        layout: &Layout,
        count_at: &At<'a>,
    ) -> Result<Vec<f64>, SceneError> {
        let (_, view) = self.document.follow(view, "bufferViews")?;
        let stride = match view.get("byteStride")? {
            Some(stride) => match stride.count()? {
                bytes if bytes >= layout.bytes() && bytes <= 255 => bytes,
                _ => return Err(stride.error(format!("a stride from {} to 252 bytes", layout.bytes()))),
            },
            None => layout.bytes(),
        };
        let bytes = self.view(&view)?;
        let last = layout.count.checked_sub(1).and_then(|n| n.checked_mul(stride));
        let end = last.and_then(|last| last.checked_add(layout.bytes())?.checked_add(offset));
        match end {
            _ if layout.count == 0 => Ok(Vec::new()),
            Some(end) if end <= bytes.len() => Ok(layout.decode(&bytes[offset..], stride)),
            _ => Err(count_at.error(format!(
                "elements that fit into the {} bytes of {}",
                bytes.len(),
                view.path
            ))),
        }
    }

    fn view(&mut self, view: &At<'a>) -> Result<&[u8], SceneError> {
        let (index, buffer) =
            self.document.follow(&view.need("buffer", "an index into buffers")?, "buffers")?;
        let offset = view.count_or("byteOffset", 0)?;
        let length_at = view.need("byteLength", "the view's length in bytes")?;
        let length = length_at.count()?;
        let bytes = self.buffer(index, &buffer)?;
        let found = bytes.len();
        let range = offset.checked_add(length).and_then(|end| bytes.get(offset..end));
        range.ok_or_else(|| length_at.error(format!("a view within the {found} bytes of {}", buffer.path)))
    }

    fn buffer(&mut self, index: usize, buffer: &At<'a>) -> Result<&[u8], SceneError> {
        if self.fetched[index].is_none() {
            self.fetched[index] = Some(self.fetch(index, buffer)?);
        }
        Ok(self.fetched[index].as_deref().unwrap_or_default())
    }

    fn fetch(&self, index: usize, buffer: &At<'a>) -> Result<Cow<'a, [u8]>, SceneError> {
        let length_at = buffer.need("byteLength", "the buffer's length in bytes")?;
        let length = length_at.count()?;
        let bytes = match buffer.get("uri")? {
            Some(uri) => match uri.text()?.strip_prefix("data:") {
                Some(data) => Cow::Owned(decode_data(data).ok_or_else(|| {
                    uri.error("data:…;base64, and then base64 with its padding and nothing else")
                })?),
                None => Cow::Owned(self.read_file(&uri)?),
            },
            None => match self.binary {
                Some(binary) if index == 0 => Cow::Borrowed(binary),
                _ => {
                    return Err(
                        buffer.refused("no uri", "a uri, or the first buffer of a .glb with a BIN chunk")
                    );
                }
            },
        };
        if bytes.len() < length {
            return Err(length_at.error(format!("at most the {} bytes that are there", bytes.len())));
        }
        Ok(bytes)
    }

    fn read_file(&self, uri: &At<'a>) -> Result<Vec<u8>, SceneError> {
        let path = local_file(&self.folder, uri.text()?)
            .ok_or_else(|| uri.error("a data: URI or a path relative to the scene file"))?;
        let unreadable = |source| SceneError::Unreadable { file: path.display().to_string(), source };
        let about = std::fs::metadata(&path).map_err(|error| {
            uri.error(format!("a file that can be read, since a collider needs it ({error})"))
        })?;
        if !about.is_file() || about.len() > LARGEST_FILE {
            return Err(uri.error("a file of at most 1 GiB"));
        }
        std::fs::read(&path).map_err(unreadable)
    }

    /// Notes the files that are missing without being needed: textures, and buffers of what is only looked at.
    pub fn note_missing(&self, notes: &mut Vec<String>) -> Result<(), SceneError> {
        for table in ["buffers", "images"] {
            for (index, value) in self.document.table(table)?.iter().enumerate() {
                if table == "buffers" && self.fetched[index].is_some() {
                    continue;
                }
                let uri =
                    value.get("uri").and_then(|uri| uri.as_str()).filter(|uri| !uri.starts_with("data:"));
                let Some(uri) = uri else { continue };
                if !local_file(&self.folder, uri).is_some_and(|path| path.exists()) {
                    notes.push(format!("{table}[{index}].uri: {uri} is missing; physics doesn't need it"));
                }
            }
        }
        Ok(())
    }
}

/// How the elements of an accessor are laid out.
#[derive(Clone, Copy)]
struct Layout {
    form: Component,
    normalized: bool,
    width: usize,
    count: usize,
}

impl Layout {
    /// Bytes of an element.
    fn bytes(&self) -> usize {
        self.form.bytes() * self.width
    }

    fn decode(&self, bytes: &[u8], stride: usize) -> Vec<f64> {
        let mut numbers = Vec::with_capacity(self.count * self.width);
        for element in bytes.chunks(stride).take(self.count) {
            for part in element.chunks_exact(self.form.bytes()).take(self.width) {
                let number = self.form.decode(part);
                numbers.push(if self.normalized { self.form.normalize(number) } else { number });
            }
        }
        numbers
    }
}

/// The types of a single number, with glTF's codes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Component {
    I8 = 5120,
    U8 = 5121,
    I16 = 5122,
    U16 = 5123,
    U32 = 5125,
    F32 = 5126,
}

impl Component {
    const ALL: [Component; 6] = [Self::I8, Self::U8, Self::I16, Self::U16, Self::U32, Self::F32];

    fn read(at: &At) -> Result<Self, SceneError> {
        let code = at.count().ok();
        let found = Self::ALL.into_iter().find(|form| Some(*form as usize) == code);
        found.ok_or_else(|| at.error("one of 5120, 5121, 5122, 5123, 5125, 5126"))
    }

    fn is_index(self) -> bool {
        matches!(self, Self::U8 | Self::U16 | Self::U32)
    }

    fn bytes(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// `part` has as many bytes as the type.
    fn decode(self, part: &[u8]) -> f64 {
        match (self, part) {
            (Self::I8, &[a]) => f64::from(a as i8),
            (Self::U8, &[a]) => f64::from(a),
            (Self::I16, &[a, b]) => f64::from(i16::from_le_bytes([a, b])),
            (Self::U16, &[a, b]) => f64::from(u16::from_le_bytes([a, b])),
            (Self::U32, &[a, b, c, d]) => f64::from(u32::from_le_bytes([a, b, c, d])),
            (Self::F32, &[a, b, c, d]) => f64::from(f32::from_le_bytes([a, b, c, d])),
            _ => 0.0,
        }
    }

    /// The fraction that a normalised integer stands for: −1 to 1, or 0 to 1.
    fn normalize(self, number: f64) -> f64 {
        match self {
            Self::I8 => (number / 127.0).max(-1.0),
            Self::U8 => number / 255.0,
            Self::I16 => (number / 32_767.0).max(-1.0),
            Self::U16 => number / 65_535.0,
            Self::U32 | Self::F32 => number,
        }
    }
}

/// Refuses an accessor that can't be one of indices.
pub(super) fn check_index_type(accessor: &At) -> Result<(), SceneError> {
    let component = accessor.need("componentType", "a component type")?;
    if Component::read(&component)?.is_index() {
        Ok(())
    } else {
        Err(component.error("5121, 5123 or 5125 (an unsigned integer)"))
    }
}

fn decode_data(data: &str) -> Option<Vec<u8>> {
    let (kind, text) = data.split_once(',')?;
    kind.ends_with(";base64").then(|| base64::decode(text)).flatten()
}

/// The file that a relative reference names; nothing for other schemes and absolute paths.
fn local_file(folder: &Path, uri: &str) -> Option<PathBuf> {
    let scheme = uri.split(['/', '?', '#']).next().is_some_and(|first| first.contains(':'));
    if scheme || uri.is_empty() || uri.starts_with(['/', '\\']) {
        return None;
    }
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let [first, tail @ ..] = rest {
        let hex = |digit: u8| char::from(digit).to_digit(16).map(|digit| digit as u8);
        let (byte, after) = match (first, tail) {
            (b'%', [high, low, after @ ..]) => (hex(*high)? * 16 + hex(*low)?, after),
            (b'%', _) => return None,
            (byte, after) => (*byte, after),
        };
        bytes.push(byte);
        rest = after;
    }
    let path = String::from_utf8(bytes).ok()?;
    (!path.contains('\0') && !path.starts_with(['/', '\\'])).then(|| folder.join(path))
}
