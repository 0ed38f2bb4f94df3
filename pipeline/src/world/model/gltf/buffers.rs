//! The bytes of buffers and their views, read when they are wanted.

use std::collections::BTreeMap;
use std::path::Path;

use super::error::{Checked, GltfProblem, element};
use super::schema::Root;
use super::uri::{self, Uri};
use crate::world::files::{FileError, SceneFolder};

/// Bytes of all buffers of a file that are read at most.
pub(super) const MAX_BUFFER_BYTES: u64 = 256 << 20;

/// Where buffers that are files of their own come from.
pub(super) struct Beside<'a> {
    /// The file that names them.
    pub(super) path: &'a Path,
    pub(super) folder: &'a SceneFolder,
}

impl Beside<'_> {
    fn read(&self, name: &str, limit: u64) -> Result<Vec<u8>, FileError> {
        let folder = self.path.parent().unwrap_or(Path::new(""));
        self.folder.read(&folder.join(name), limit)
    }
}

/// The buffers of a file.
pub(super) struct Buffers<'a> {
    root: &'a Root,
    /// The buffer of a `.glb`.
    own: Option<&'a [u8]>,
    beside: Option<Beside<'a>>,
    read: BTreeMap<usize, Vec<u8>>,
    /// Bytes that may still be read.
    left: u64,
}

impl<'a> Buffers<'a> {
    pub(super) fn new(root: &'a Root, own: Option<&'a [u8]>, beside: Option<Beside<'a>>) -> Self {
        Self {
            root,
            own,
            beside,
            read: BTreeMap::new(),
            left: MAX_BUFFER_BYTES,
        }
    }

    /// The bytes of view `index`, which `place` asks for, and its stride if it has one.
    pub(super) fn view(&mut self, index: usize, place: &str) -> Checked<(&[u8], Option<u64>)> {
        let view = element(&self.root.buffer_views, index, "bufferViews", place)?;
        let place = format!("bufferViews[{index}]");
        let bytes = self.buffer(view.buffer, &place)?;
        let end = view.byte_offset.saturating_add(view.byte_length);
        let length = bytes.len() as u64;
        if end > length {
            let of = "its buffer";
            return Err(GltfProblem::TooShort { of, end, length }.at(place));
        }
        let bytes = &bytes[view.byte_offset as usize..end as usize];
        // As exporters write it that mean none.
        Ok((bytes, view.byte_stride.filter(|s| *s > 0)))
    }

    fn buffer(&mut self, index: usize, place: &str) -> Checked<&[u8]> {
        let buffer = element(&self.root.buffers, index, "buffers", place)?;
        let place = format!("buffers[{index}]");
        let whole = match (&buffer.uri, self.own) {
            (Some(uri), _) => {
                if !self.read.contains_key(&index) {
                    let loaded = self.load(uri, self.left);
                    let bytes = loaded.map_err(|p| p.at(format!("{place}.uri")))?;
                    self.left = self.left.saturating_sub(bytes.len() as u64);
                    self.read.insert(index, bytes);
                }
                &self.read[&index][..]
            }
            (None, Some(own)) if index == 0 => own,
            (None, _) => return Err(GltfProblem::Missing { what: "uri" }.at(place)),
        };
        let (end, length) = (buffer.byte_length, whole.len() as u64);
        if end > length {
            let of = "what it names";
            return Err(GltfProblem::TooShort { of, end, length }.at(place));
        }
        Ok(&whole[..end as usize])
    }

    /// The bytes of a picture that a URI names; they are none of the buffers'.
    pub(super) fn picture(&self, uri: &str, limit: u64) -> Result<Vec<u8>, GltfProblem> {
        self.load(uri, limit)
    }

    /// What a URI names; of a file at most `limit` bytes.
    fn load(&self, text: &str, limit: u64) -> Result<Vec<u8>, GltfProblem> {
        Ok(match (uri::read(text), &self.beside) {
            (Ok(Uri::Data(bytes)), _) => bytes,
            (Ok(Uri::File(name)), Some(beside)) => beside.read(&name, limit)?,
            (Ok(Uri::File(_)), None) => return Err(GltfProblem::Missing { what: "a folder" }),
            (Err(valid), _) => {
                return Err(GltfProblem::Bad {
                    what: "uri",
                    value: format!("'{}'", crate::world::tally::beginning(text, 40)),
                    valid,
                });
            }
        })
    }
}
