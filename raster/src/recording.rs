//! A frame as data: textures with what they hold at first, commands, named results.
//!
//! Whoever makes a frame writes it down here, without a GPU: no storage is
//! allocated, and what is wrong with a texture is said at once, as a
//! [`crate::Gpu`] says it. [`crate::Gpu::load`] then makes the textures, after
//! which [`Recording::list`] can be submitted any number of times.
//!
//! ```
//! use gnomon_raster::{Format, Gpu, GpuConfig, Recording, Subresource, TextureDescriptor};
//!
//! let mut recording = Recording::default();
//! let table = recording.create(&TextureDescriptor::d2("table", Format::R8Unorm, 2, 1))?;
//! recording.write(table, Subresource::default(), &[[0.0; 4], [1.0; 4]])?;
//! recording.name_output("table", table)?;
//!
//! let mut gpu = Gpu::new(GpuConfig { threads: 1, ..GpuConfig::default() })?;
//! gpu.load(&recording)?;
//! gpu.submit(&recording.list)?;
//! let table = gpu.texture(recording.output("table").unwrap())?;
//! assert_eq!(table.read_packed(Subresource::default())?, [0, 255]);
//! # Ok::<(), gnomon_raster::Error>(())
//! ```

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::command::CommandList;
use crate::error::Error;
use crate::format::encode;
use crate::gpu::{Gpu, GpuConfig, SubmitReport};
use crate::memory::reserve;
use crate::texture::{
    Subresource, Texture, TextureDescriptor, TextureId, check_packed, image_size, pack, validate,
};

/// A frame: its textures, its commands, and where its results are afterwards.
#[derive(Clone, Default)]
pub struct Recording {
    textures: Vec<RecordedTexture>,
    /// What is drawn; it names textures by the ids that [`Recording::create`] gave.
    pub list: CommandList,
    outputs: BTreeMap<String, TextureId>,
}

/// A texture and what it holds at first.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedTexture {
    descriptor: TextureDescriptor,
    /// Packed images; those of zeros are left out.
    contents: BTreeMap<Subresource, Arc<[u8]>>,
}

impl Recording {
    /// `textures` and what they hold.
    pub(crate) fn of(textures: &[Texture]) -> Result<Self, Error> {
        let textures = textures.iter().map(RecordedTexture::of);
        Ok(Self {
            textures: textures.collect::<Result<_, _>>()?,
            ..Self::default()
        })
    }

    /// Adds a texture of zeros.
    ///
    /// # Errors
    /// For sizes or levels that are not possible.
    pub fn create(&mut self, descriptor: &TextureDescriptor) -> Result<TextureId, Error> {
        validate(descriptor)?;
        self.textures.push(RecordedTexture {
            descriptor: descriptor.clone(),
            contents: BTreeMap::new(),
        });
        Ok(TextureId(self.textures.len() as u32 - 1))
    }

    /// Sets what a colour image holds at first; values are converted as a shader's
    /// output would be, `texels` are rows from the top.
    ///
    /// # Errors
    /// There is no such image, it is not colour, or it has another size.
    pub fn write(
        &mut self,
        texture: TextureId,
        image: Subresource,
        texels: &[[f32; 4]],
    ) -> Result<(), Error> {
        let texture = self.texture_mut(texture)?;
        let bytes = packed_color(&texture.descriptor, image, texels)?;
        texture.set(image, bytes.into());
        Ok(())
    }

    /// Sets what an image holds at first, as [`Texture::read_packed`] gives it.
    ///
    /// # Errors
    /// As [`Texture::write_packed`].
    pub fn write_packed(
        &mut self,
        texture: TextureId,
        image: Subresource,
        bytes: Arc<[u8]>,
    ) -> Result<(), Error> {
        let texture = self.texture_mut(texture)?;
        check_packed(&texture.descriptor, image, &bytes)?;
        texture.set(image, bytes);
        Ok(())
    }

    /// Names a texture as a result; a name given again means the later texture.
    ///
    /// # Errors
    /// There is no such texture.
    pub fn name_output(&mut self, name: &str, texture: TextureId) -> Result<(), Error> {
        self.texture(texture)?;
        self.outputs.insert(name.to_owned(), texture);
        Ok(())
    }

    /// The result called `name`.
    #[must_use]
    pub fn output(&self, name: &str) -> Option<TextureId> {
        self.outputs.get(name).copied()
    }

    /// All results, by name.
    pub fn outputs(&self) -> impl Iterator<Item = (&str, TextureId)> {
        self.outputs.iter().map(|(name, id)| (name.as_str(), *id))
    }

    /// All textures in the order of their ids.
    #[must_use]
    pub fn textures(&self) -> &[RecordedTexture] {
        &self.textures
    }

    /// A texture.
    ///
    /// # Errors
    /// Where there is none of that id.
    pub fn texture(&self, id: TextureId) -> Result<&RecordedTexture, Error> {
        let count = self.textures.len();
        let found = self.textures.get(id.0 as usize);
        found.ok_or(Error::NoSuchTexture { id: id.0, count })
    }

    fn texture_mut(&mut self, id: TextureId) -> Result<&mut RecordedTexture, Error> {
        let count = self.textures.len();
        let found = self.textures.get_mut(id.0 as usize);
        found.ok_or(Error::NoSuchTexture { id: id.0, count })
    }

    /// Draws the frame on a GPU of its own.
    ///
    /// # Errors
    /// As [`Gpu::new`], [`Gpu::load`] and [`Gpu::submit`].
    pub fn draw(&self, config: GpuConfig) -> Result<Drawn, Error> {
        let mut gpu = Gpu::new(config)?;
        gpu.load(self)?;
        let report = gpu.submit(&self.list)?;
        Ok(Drawn {
            gpu,
            report,
            outputs: self.outputs.clone(),
        })
    }

    /// Adds the textures and passes of `other` behind those that are here; its names
    /// of results are forgotten. Gives what became of its textures' ids.
    pub fn append(&mut self, other: Self) -> impl Fn(TextureId) -> TextureId + use<> {
        let count = self.textures.len() as u32;
        let moved = move |id: TextureId| TextureId(id.0.saturating_add(count));
        let mut list = other.list;
        texture_ids(&mut list).for_each(|id| *id = moved(*id));
        self.textures.extend(other.textures);
        self.list.passes.extend(list.passes);
        moved
    }
}

/// A frame that was drawn: what it left, and what it counted.
pub struct Drawn {
    /// The GPU with all textures.
    pub gpu: Gpu,
    /// Counters of passes and draws.
    pub report: SubmitReport,
    outputs: BTreeMap<String, TextureId>,
}

impl Drawn {
    /// The pixels of the result called `name`, as [`Texture::read_rgba8`] gives them.
    ///
    /// # Errors
    /// There is none, or it is not colour.
    pub fn read_rgba8(&self, name: &str) -> Result<Vec<[u8; 4]>, Error> {
        self.output(name)?.read_rgba8()
    }

    /// The result called `name`.
    ///
    /// # Errors
    /// There is none.
    pub fn output(&self, name: &str) -> Result<&Texture, Error> {
        match self.outputs.get(name) {
            Some(id) => self.gpu.texture(*id),
            None => Err(Error::NoSuchOutput {
                name: name.to_owned(),
                outputs: self.outputs.keys().cloned().collect::<Vec<_>>().join(", "),
            }),
        }
    }
}

/// Every mention of a texture in `list`.
fn texture_ids(list: &mut CommandList) -> impl Iterator<Item = &mut TextureId> {
    list.passes.iter_mut().flat_map(|pass| {
        let color = pass.color.iter_mut().map(|a| &mut a.texture);
        let depth = pass.depth_stencil.iter_mut().map(|a| &mut a.texture);
        let bound = pass.draws.iter_mut().flat_map(|d| &mut d.textures);
        color.chain(depth).chain(bound.map(|b| &mut b.texture))
    })
}

fn packed_color(
    descriptor: &TextureDescriptor,
    image: Subresource,
    texels: &[[f32; 4]],
) -> Result<Vec<u8>, Error> {
    let [width, height] = image_size(descriptor, image)?;
    let format = descriptor.format;
    if format.is_depth_stencil() {
        return Err(Error::WrongAspect {
            texture: descriptor.label.clone(),
            format,
            wanted: "color",
        });
    }
    let expected = width as usize * height as usize;
    if texels.len() != expected {
        return Err(Error::TexelCount {
            texture: descriptor.label.clone(),
            given: texels.len(),
            expected,
        });
    }
    let mut bytes = Vec::new();
    let size = expected * format.bytes() as usize;
    reserve(&mut bytes, size, || {
        format!("the texels of `{}`", descriptor.label)
    })?;
    for texel in texels {
        pack(format, encode(format, *texel), &mut bytes);
    }
    Ok(bytes)
}

impl RecordedTexture {
    fn of(texture: &Texture) -> Result<Self, Error> {
        let mut recorded = Self {
            descriptor: texture.descriptor().clone(),
            contents: BTreeMap::new(),
        };
        for image in texture.descriptor().images() {
            recorded.set(image, texture.read_packed(image)?.into());
        }
        Ok(recorded)
    }

    /// What it is.
    #[must_use]
    pub fn descriptor(&self) -> &TextureDescriptor {
        &self.descriptor
    }

    /// Images that are not all zeros at first, packed as [`Texture::read_packed`] does.
    pub fn contents(&self) -> impl Iterator<Item = (Subresource, &Arc<[u8]>)> {
        self.contents.iter().map(|(image, bytes)| (*image, bytes))
    }

    /// Keeps what an image holds, unless that is what it held anyway.
    fn set(&mut self, image: Subresource, bytes: Arc<[u8]>) {
        if bytes.iter().all(|b| *b == 0) {
            self.contents.remove(&image);
        } else {
            self.contents.insert(image, bytes);
        }
    }

    /// The texture itself.
    pub(crate) fn build(&self) -> Result<Texture, Error> {
        let mut texture = Texture::new(&self.descriptor)?;
        for (image, bytes) in &self.contents {
            texture.write_packed(*image, bytes)?;
        }
        Ok(texture)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command::{
        ColorAttachment, DepthStencilAttachment, Draw, LoadOp, RenderPass, RenderPipeline, StoreOp,
        TextureBinding,
    };
    use crate::format::Format;
    use crate::gpu::{Gpu, GpuConfig};
    use crate::shader::{ScalarVertexOutput, per_vertex};
    use crate::state::Sampler;
    use crate::state::{DepthStencilState, PrimitiveState};
    use crate::texture::TextureDimension;

    fn gpu() -> Gpu {
        Gpu::new(GpuConfig {
            threads: 1,
            ..GpuConfig::default()
        })
        .unwrap()
    }

    fn mipmapped(format: Format) -> TextureDescriptor {
        TextureDescriptor {
            mip_levels: 2,
            ..TextureDescriptor::d2("image", format, 11, 6)
        }
    }

    const SMALL: Subresource = Subresource { mip: 1, layer: 0 };

    fn texels(count: usize) -> Vec<[f32; 4]> {
        let value = |i: usize| match i % 9 {
            7 => f32::NAN,
            8 => f32::INFINITY,
            k => i as f32 * 0.037 - k as f32 * 0.2,
        };
        let texel = |i: usize| core::array::from_fn(|c| value(4 * i + c));
        (0..count).map(texel).collect()
    }

    /// A loaded texture is one that was created and written by hand.
    #[test]
    fn textures_are_loaded_as_they_were_written() {
        for format in Format::ALL.into_iter().filter(|f| !f.is_depth_stencil()) {
            let desc = mipmapped(format);
            let mut recording = Recording::default();
            let id = recording.create(&desc).unwrap();
            recording.write(id, SMALL, &texels(15)).unwrap();
            let mut loaded = gpu();
            loaded.load(&recording).unwrap();
            let mut by_hand = gpu();
            let same = by_hand.create_texture(&desc).unwrap();
            let texture = by_hand.texture_mut(same).unwrap();
            texture.write_color(SMALL, &texels(15)).unwrap();
            assert_eq!(id, same);
            for image in [SMALL, Subresource::default()] {
                let raw = |gpu: &Gpu| gpu.texture(id).unwrap().read_raw(image).unwrap();
                assert_eq!(raw(&loaded), raw(&by_hand), "{format:?} {image:?}");
            }
        }
    }

    #[test]
    fn zeros_are_left_out() {
        let mut recording = Recording::default();
        let desc = mipmapped(Format::Rg8Unorm);
        let id = recording.create(&desc).unwrap();
        recording.write(id, SMALL, &texels(15)).unwrap();
        let all = |r: &Recording| r.textures()[0].contents().count();
        assert_eq!(all(&recording), 1);
        recording.write(id, SMALL, &[[0.0; 4]; 15]).unwrap();
        assert_eq!(all(&recording), 0);
    }

    /// What cannot be is refused as a GPU refuses it.
    #[test]
    fn errors_are_the_gpus() {
        let mut recording = Recording::default();
        let mut gpu = gpu();
        let good = [
            mipmapped(Format::R8Unorm),
            mipmapped(Format::Depth24Stencil8),
        ];
        for desc in &good {
            recording.create(desc).unwrap();
            gpu.create_texture(desc).unwrap();
        }
        let bad = [
            TextureDescriptor::d2("none", Format::R8Unorm, 0, 1),
            TextureDescriptor::d2("large", Format::R8Unorm, 8193, 1),
            TextureDescriptor {
                dimension: TextureDimension::Cube,
                ..mipmapped(Format::R8Unorm)
            },
        ];
        for desc in bad {
            let given = recording.create(&desc).unwrap_err();
            assert_eq!(given, gpu.create_texture(&desc).unwrap_err());
        }
        let writes = [
            (TextureId(0), SMALL, 14),
            (TextureId(0), Subresource { mip: 2, layer: 0 }, 15),
            (TextureId(0), Subresource { mip: 0, layer: 1 }, 66),
            (TextureId(1), SMALL, 15),
            (TextureId(2), SMALL, 15),
        ];
        for (id, image, count) in writes {
            let texels = texels(count);
            let given = recording.write(id, image, &texels).unwrap_err();
            let texture = gpu.texture_mut(id);
            let by_hand = texture.and_then(|t| t.write_color(image, &texels));
            assert_eq!(given, by_hand.unwrap_err());
        }
        assert!(recording.name_output("none", TextureId(2)).is_err());
    }

    /// A pass that mentions texture 0 in each way.
    fn pass() -> RenderPass {
        let texture = TextureId(0);
        let pipeline = RenderPipeline {
            label: String::new(),
            vertex: per_vertex(&[], |_| ScalarVertexOutput::default()),
            fragment: None,
            primitive: PrimitiveState::default(),
            depth_stencil: DepthStencilState::default(),
            color_targets: Vec::new(),
        };
        let mut draw = Draw::vertices_only("", &Arc::new(pipeline), 3);
        draw.textures.push(TextureBinding {
            texture,
            sampler: Sampler::default(),
        });
        RenderPass {
            label: String::new(),
            color: vec![ColorAttachment {
                texture,
                subresource: Subresource::default(),
                load: LoadOp::Load,
                store: StoreOp::Store,
            }],
            depth_stencil: Some(DepthStencilAttachment {
                texture,
                subresource: Subresource::default(),
                depth_load: LoadOp::Load,
                depth_store: StoreOp::Store,
                stencil_load: LoadOp::Load,
                stencil_store: StoreOp::Store,
            }),
            draws: vec![draw],
        }
    }

    #[test]
    fn appended_passes_name_their_own_textures() {
        let one = || {
            let mut recording = Recording::default();
            recording.create(&mipmapped(Format::R8Unorm)).unwrap();
            recording.list.passes.push(pass());
            recording
        };
        let (mut all, mut second) = (one(), one());
        let id = second.create(&mipmapped(Format::R16Float)).unwrap();
        let moved = all.append(second)(id);
        assert_eq!(
            all.texture(moved).unwrap().descriptor().format,
            Format::R16Float
        );
        assert_eq!(all.textures().len(), 3);
        let mentioned: Vec<u32> = texture_ids(&mut all.list).map(|id| id.0).collect();
        assert_eq!(mentioned, [0, 0, 0, 1, 1, 1]);
    }

    #[test]
    fn loading_replaces_what_was_there() {
        let mut gpu = gpu();
        for _ in 0..3 {
            gpu.create_texture(&mipmapped(Format::R8Unorm)).unwrap();
        }
        let mut recording = Recording::default();
        let id = recording.create(&mipmapped(Format::R32Float)).unwrap();
        gpu.load(&recording).unwrap();
        assert_eq!(gpu.texture_ids().collect::<Vec<_>>(), [id]);
        assert_eq!(gpu.texture(id).unwrap().desc.format, Format::R32Float);
    }
}
