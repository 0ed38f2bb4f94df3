//! Frames that were drawn again.

use gnomon::documents::numpy_type;
use gnomon::pipeline::measure::render::SrgbEncoder;
use gnomon::raster::{Error, Subresource, Texture};
use gnomon::traces::Replayed;
use numpy::PyArray3;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays;
use crate::errors::raise;

/// A frame that was drawn again, and what it left.
#[pyclass(frozen, module = "gnomon")]
pub(crate) struct Replay {
    /// What differs, in words; `None` where nothing does.
    #[pyo3(get)]
    difference: Option<String>,
    /// Attachments that were compared, over all passes.
    #[pyo3(get)]
    attachments: usize,
    /// Draws that were compared.
    #[pyo3(get)]
    draws: usize,
    /// The picture, opaque; `None` where the frame has no result called `color`.
    #[pyo3(get)]
    rgba8: Option<Py<PyArray3<u8>>>,
    arrays: Py<PyDict>,
}

#[pymethods]
impl Replay {
    /// Whether every attachment is what was recorded.
    #[getter]
    fn equal(&self) -> bool {
        self.difference.is_none()
    }

    /// What each result of the frame holds, as it is stored.
    #[getter]
    fn outputs(&self, py: Python<'_>) -> PyResult<Py<PyDict>> {
        Ok(self.arrays.bind(py).copy()?.unbind())
    }

    fn __repr__(&self) -> String {
        match &self.difference {
            None => format!("<gnomon.Replay: {} attachments equal>", self.attachments),
            Some(what) => format!("<gnomon.Replay: {what}>"),
        }
    }
}

/// A replay whose arrays are vectors still.
pub(crate) struct Read {
    difference: Option<String>,
    attachments: usize,
    draws: usize,
    picture: Option<([u32; 2], Vec<[u8; 4]>)>,
    outputs: Vec<Stored>,
}

/// An image as it is stored.
struct Stored {
    name: String,
    size: [u32; 2],
    kind: &'static str,
    /// 0 for an array without such an axis.
    channels: usize,
    bytes: Vec<u8>,
}

impl Replay {
    /// Reads what the frame left.
    pub(crate) fn read(replayed: &Replayed) -> PyResult<Read> {
        let (mut outputs, mut picture) = (Vec::new(), None);
        for (name, id) in replayed.recording.outputs() {
            let texture = replayed.gpu.texture(id).map_err(raise)?;
            outputs.extend(stored(name, texture).map_err(raise)?);
            if name == "color" {
                picture = Some(pictured(texture).map_err(raise)?);
            }
        }
        Ok(Read {
            difference: replayed.difference.as_ref().map(ToString::to_string),
            attachments: replayed.attachments,
            draws: replayed.draws,
            picture,
            outputs,
        })
    }
}

impl Read {
    pub(crate) fn into_arrays(self, py: Python<'_>) -> PyResult<Replay> {
        let arrays = PyDict::new(py);
        for output in self.outputs {
            let [columns, rows] = output.size.map(|s| s as usize);
            let mut shape = vec![rows, columns];
            shape.extend((output.channels > 0).then_some(output.channels));
            let array = arrays::typed(py, output.bytes, output.kind, shape)?;
            arrays.set_item(output.name, array)?;
        }
        let rgba8 = self.picture;
        let rgba8 = rgba8.map(|(size, pixels)| arrays::channels(py, size, pixels));
        Ok(Replay {
            difference: self.difference,
            attachments: self.attachments,
            draws: self.draws,
            rgba8: rgba8.transpose()?,
            arrays: arrays.unbind(),
        })
    }
}

/// A colour image, or depth and stencil apart.
fn stored(name: &str, texture: &Texture) -> Result<Vec<Stored>, Error> {
    let image = Subresource::default();
    let [width, height, _] = texture.mip_size(image.mip);
    let format = texture.descriptor().format;
    let of = |name: String, kind, channels, bytes| Stored {
        name,
        size: [width, height],
        kind,
        channels,
        bytes,
    };
    if !format.is_depth_stencil() {
        let channels = match format.channels() {
            1 => 0,
            n => n,
        };
        let bytes = texture.read_packed(image)?;
        return Ok(vec![of(
            name.to_owned(),
            numpy_type(format),
            channels,
            bytes,
        )]);
    }
    let depth = texture.read_depth_bits(image)?;
    let depth: Vec<u8> = depth.iter().flat_map(|d| d.to_le_bytes()).collect();
    let stencil = texture.read_stencil(image)?;
    Ok(vec![
        of(format!("{name}:depth"), numpy_type(format), 0, depth),
        of(format!("{name}:stencil"), "|u1", 0, stencil),
    ])
}

/// Colours, clamped to 0..=1, encoded as sRGB, and opaque.
fn pictured(texture: &Texture) -> Result<([u32; 2], Vec<[u8; 4]>), Error> {
    let image = Subresource::default();
    let [width, height, _] = texture.mip_size(image.mip);
    let encoder = SrgbEncoder::new();
    let texels = texture.read_color(image)?;
    let pixels = texels.iter().map(|t| {
        let [r, g, b, _] = encoder.encode(t.0);
        [r, g, b, 255]
    });
    Ok(([width, height], pixels.collect()))
}
