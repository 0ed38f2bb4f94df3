//! Which images a history follows, and what they hold.

use gnomon_raster::{Error, Format, Gpu, Recording, RenderPass, Subresource, TextureId};

use super::HistoryError;

/// An image that a history tells of.
#[derive(Clone, Debug, PartialEq)]
pub struct Attachment {
    /// The texture.
    pub texture: TextureId,
    /// Which of its images.
    pub subresource: Subresource,
    /// The texture's label.
    pub label: String,
    /// Its format.
    pub format: Format,
}

/// What is stored at a pixel of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Value {
    /// Raw channels.
    Color([u32; 4]),
    /// The D24 integer or the bits of a float, and stencil.
    DepthStencil(u32, u8),
}

/// An image together with all that passes attach beside it, directly or not.
#[derive(Debug)]
pub(super) struct Attachments {
    pub(super) list: Vec<Attachment>,
    pub(super) size: [u32; 2],
}

/// A texture, and which of its images.
pub(super) type Image = (TextureId, Subresource);

impl Attachments {
    /// Those of the output `name` of `recording`.
    pub(super) fn of(recording: &Recording, name: Option<&str>) -> Result<Self, HistoryError> {
        let passes = &recording.list.passes;
        let all = || passes.iter().flat_map(attached);
        let first = match start(recording, name)? {
            Some(texture) => all().filter(|(t, _)| *t == texture).take(1).collect(),
            None => passes.last().into_iter().flat_map(attached).collect(),
        };
        Self::beside(recording, first)
    }

    /// `images` themselves, and what is attached beside them.
    pub(super) fn beside(
        recording: &Recording,
        mut images: Vec<Image>,
    ) -> Result<Self, HistoryError> {
        let passes = &recording.list.passes;
        // Each round adds what is attached beside the images so far.
        let mut known = 0;
        while known < images.len() {
            known = images.len();
            for pass in passes {
                let beside: Vec<Image> = attached(pass).collect();
                if beside.iter().any(|i| images.contains(i)) {
                    let new: Vec<_> = beside.into_iter().filter(|i| !images.contains(i)).collect();
                    images.extend(new);
                }
            }
        }
        images.sort_unstable();
        let first = *images.first().ok_or(HistoryError::NotDrawn)?;
        Ok(Self {
            size: size(recording, first)?,
            list: images
                .into_iter()
                .map(|image| attachment(recording, image))
                .collect::<Result<_, _>>()?,
        })
    }

    /// Number of an image in the list.
    pub(super) fn find(&self, texture: TextureId, subresource: Subresource) -> Option<usize> {
        let is_it = |a: &Attachment| a.texture == texture && a.subresource == subresource;
        self.list.iter().position(is_it)
    }

    /// Whether a pass draws to the images.
    pub(super) fn has(&self, pass: &RenderPass) -> bool {
        attached(pass).any(|(t, s)| self.find(t, s).is_some())
    }

    /// What the images hold at `pixel`.
    pub(super) fn read(&self, gpu: &Gpu, [x, y]: [u32; 2]) -> Result<Vec<Value>, Error> {
        let at = y as usize * self.size[0] as usize + x as usize;
        let value = |a: &Attachment| {
            let texture = gpu.texture(a.texture)?;
            Ok(match a.format.is_depth_stencil() {
                true => Value::DepthStencil(
                    texture.read_depth_bits(a.subresource)?[at],
                    texture.read_stencil(a.subresource)?[at],
                ),
                false => Value::Color(texture.read_raw(a.subresource)?[at]),
            })
        };
        self.list.iter().map(value).collect()
    }
}

/// The output that is looked at; `None` where there are no outputs.
fn start(recording: &Recording, name: Option<&str>) -> Result<Option<TextureId>, HistoryError> {
    let names: Vec<&str> = recording.outputs().map(|(name, _)| name).collect();
    let default = if names.contains(&"color") {
        Some("color")
    } else {
        names.first().copied()
    };
    let Some(name) = name.or(default) else {
        return Ok(None);
    };
    let found = recording.output(name);
    found.map(Some).ok_or_else(|| HistoryError::NoImage {
        name: name.to_owned(),
        valid: match names.is_empty() {
            true => "none".to_owned(),
            false => names.join(", "),
        },
    })
}

fn attached(pass: &RenderPass) -> impl Iterator<Item = Image> {
    let color = pass.color.iter().map(|a| (a.texture, a.subresource));
    let depth = pass.depth_stencil.iter();
    color.chain(depth.map(|a| (a.texture, a.subresource)))
}

fn size(recording: &Recording, (texture, image): Image) -> Result<[u32; 2], Error> {
    let [w, h, _] = recording.texture(texture)?.descriptor().size;
    let at = |v: u32| v.checked_shr(image.mip).unwrap_or(0).max(1);
    Ok([at(w), at(h)])
}

fn attachment(recording: &Recording, (texture, subresource): Image) -> Result<Attachment, Error> {
    let d = recording.texture(texture)?.descriptor();
    Ok(Attachment {
        texture,
        subresource,
        label: d.label.clone(),
        format: d.format,
    })
}
