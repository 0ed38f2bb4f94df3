//! Texels at integer coordinates (texture rules, §5).

use gnomon_raster::TextureDimension;

use super::texel::{canonical, decode, first_word};
use super::{Bound, Looked, TexelRead, is_depth};

impl Bound {
    /// The stored texel, if it exists, and where it is.
    fn fetch(&self, [i, j, k]: [i32; 3], level: u32) -> Option<([u32; 4], TexelRead)> {
        let layers = self.texture.images.get(level as usize)?;
        let [w, h, _] = self.texture.level_size(level as usize);
        let (j, k) = match self.texture.dimension {
            TextureDimension::D1 => (0, 0),
            TextureDimension::D2 => (j, 0),
            TextureDimension::D3 | TextureDimension::Cube => (j, k),
        };
        let within = |i: i32, n: u32| i64::from(i) >= 0 && i64::from(i) < i64::from(n);
        let exists = within(i, w) && within(j, h) && within(k, layers.len() as u32);
        let read = TexelRead {
            level: level as usize,
            layer: k as usize,
            at: [i.into(), j.into()],
        };
        exists.then(|| (self.stored(read), read))
    }

    /// The four floats.
    pub(in crate::twin) fn fetch_texel(&self, at: [i32; 3], level: u32) -> Looked {
        match self.fetch(at, level) {
            Some((t, read)) => (canonical(decode(self.texture.format, t)), vec![read]),
            None => ([0.0; 4], Vec::new()),
        }
    }

    /// The stored bits of the first word, and the texel if there was one.
    pub(in crate::twin) fn fetch_bits(&self, at: [i32; 3], level: u32) -> (u32, Vec<TexelRead>) {
        match self.fetch(at, level) {
            Some((t, read)) => (first_word(self.texture.format, t), vec![read]),
            None => (0, Vec::new()),
        }
    }

    /// The stencil value, and the texel if there was one.
    pub(in crate::twin) fn fetch_stencil(&self, at: [i32; 3], level: u32) -> (u32, Vec<TexelRead>) {
        match self.fetch(at, level) {
            Some((t, read)) if is_depth(self.texture.format) => (t[1], vec![read]),
            _ => (0, Vec::new()),
        }
    }
}
