//! Plain data as a recording, or as a frame's shape, which needs no shaders.

use std::sync::Arc;

use gnomon_raster::shader::{FragmentStage, ShaderIdentity, ShaderTable, VertexStage};
use gnomon_raster::state::{
    BlendComponent, BlendState, ColorTargetState, ColorWrites, DepthBias, DepthState,
    DepthStencilState, PrimitiveState, ScissorRect, StencilFaceState, StencilState, Viewport,
};
use gnomon_raster::{
    ColorAttachment, DepthStencilAttachment, Draw, IndexBuffer, LoadOp, Recording, RenderPass,
    RenderPipeline, Sampler, StoreOp, Subresource, TextureBinding, TextureDescriptor, TextureId,
    VertexBuffer,
};

use super::blob::Blobs;
use super::numbers::Numbered;
use super::v1;
use crate::frozen;
use crate::shape::{DrawShape, FragmentShape, FrameShape, PassShape};

/// Most bytes that the textures of a frame may take together, padding left out.
const MOST_TEXTURES: u64 = 8 << 30;

/// What is wrong with a section, in words.
type Result<T> = std::result::Result<T, String>;

/// A frame as it is written, and what it refers to.
pub(crate) struct Written<'a> {
    pub(crate) frame: &'a v1::Frame,
    pub(crate) shaders: &'a [v1::Shader],
    pub(crate) blobs: &'a Blobs,
}

/// Where a shader is missing, and why.
pub(crate) struct Unmade {
    pub(crate) pass: String,
    pub(crate) draw: usize,
    pub(crate) label: String,
    pub(crate) source: gnomon_raster::shader::ShaderTableError,
}

/// Why a recording cannot be made.
pub(crate) enum Fault {
    Data(String),
    Shader(Box<Unmade>),
}

impl From<String> for Fault {
    fn from(reason: String) -> Self {
        Self::Data(reason)
    }
}

fn nth<'a, T>(list: &'a [T], number: u32, what: &str) -> Result<&'a T> {
    let found = list.get(number as usize);
    found.ok_or_else(|| format!("{what} {number} is none of the {} there are", list.len()))
}

impl Written<'_> {
    /// The frame's shape.
    pub(crate) fn shape(&self) -> Result<FrameShape> {
        let ids = self.texture_ids()?;
        let recording = self.empty_textures()?;
        let textures = recording.textures().iter();
        let pass = |pass: &v1::Pass| self.pass_shape(pass, &ids);
        Ok(FrameShape {
            textures: textures.map(|t| t.descriptor().clone()).collect(),
            passes: self.frame.passes.iter().map(pass).collect::<Result<_>>()?,
        })
    }

    /// Ids are given by recordings only.
    fn texture_ids(&self) -> Result<Vec<TextureId>> {
        let mut recording = Recording::default();
        let textures = self.frame.textures.iter();
        let id = |t: &v1::Texture| {
            let created = recording.create(&descriptor(t)?);
            created.map_err(|e| e.to_string())
        };
        textures.map(id).collect()
    }

    fn empty_textures(&self) -> Result<Recording> {
        let mut recording = Recording::default();
        let mut bytes = 0u64;
        for texture in &self.frame.textures {
            let d = descriptor(texture)?;
            recording.create(&d).map_err(|e| e.to_string())?;
            bytes = bytes.saturating_add(texture_bytes(&d));
        }
        match bytes {
            0..=MOST_TEXTURES => Ok(recording),
            _ => Err(format!(
                "its textures take {bytes} bytes, the limit is {MOST_TEXTURES}"
            )),
        }
    }

    fn pass_shape(&self, pass: &v1::Pass, ids: &[TextureId]) -> Result<PassShape> {
        let draw = |draw: &v1::Draw| self.draw_shape(draw, ids);
        Ok(PassShape {
            label: pass.label.clone(),
            color: colors(pass, ids)?,
            depth_stencil: depth(pass, ids)?,
            draws: pass.draws.iter().map(draw).collect::<Result<_>>()?,
        })
    }

    fn draw_shape(&self, draw: &v1::Draw, ids: &[TextureId]) -> Result<DrawShape> {
        let pipeline = nth(&self.frame.pipelines, draw.pipeline, "pipeline")?;
        let fragment = pipeline.fragment.map(|f| nth(self.shaders, f, "shader"));
        let fragment = fragment.transpose()?.map(|shader| FragmentShape {
            discards: shader.outputs.0,
            depth: shader.outputs.1,
            textures: shader.outputs.2 as usize,
        });
        let vertices = draw
            .vertices
            .map(|v| nth(&self.frame.vertices, v, "vertex buffer"));
        Ok(DrawShape {
            label: draw.label.clone(),
            pipeline: pipeline.label.clone(),
            primitive: primitive(&pipeline.primitive)?,
            depth_stencil: depth_stencil(&pipeline.depth_stencil)?,
            color_targets: color_targets(&pipeline.color_targets)?,
            fragment,
            vertex_stride: vertices.transpose()?.map(|v| v.stride as usize),
            indexed: draw.indices.is_some(),
            first: draw.first,
            count: draw.count,
            instances: draw.instances,
            stencil_reference: draw.stencil_reference,
            viewport: draw.viewport.map(viewport),
            scissor: draw.scissor.map(scissor),
            textures: bindings(draw, ids)?,
        })
    }

    /// The recording itself, its shaders made by `table`.
    pub(crate) fn recording(&self, table: &ShaderTable) -> std::result::Result<Recording, Fault> {
        let ids = self.texture_ids()?;
        let mut recording = self.empty_textures()?;
        self.fill(&mut recording, &ids)?;
        let parts = self.parts()?;
        let mut pipelines = vec![None; self.frame.pipelines.len()];
        for pass in &self.frame.passes {
            let mut draws = Vec::new();
            for (number, draw) in pass.draws.iter().enumerate() {
                let pipeline = self.pipeline(draw, table, &mut pipelines);
                let pipeline = pipeline.map_err(|fault| fault.at(pass, number, draw))?;
                draws.push(parts.draw(draw, pipeline, &ids)?);
            }
            recording.list.passes.push(RenderPass {
                label: pass.label.clone(),
                color: colors(pass, &ids)?,
                depth_stencil: depth(pass, &ids)?,
                draws,
            });
        }
        for (name, id) in &self.frame.outputs {
            let id = *nth(&ids, *id, "texture")?;
            recording.name_output(name, id).map_err(|e| e.to_string())?;
        }
        Ok(recording)
    }

    fn fill(&self, recording: &mut Recording, ids: &[TextureId]) -> Result<()> {
        for (texture, id) in self.frame.textures.iter().zip(ids) {
            for &(mip, layer, blob) in &texture.contents {
                let bytes = self.blobs.get(blob)?.clone();
                let image = Subresource { mip, layer };
                let done = recording.write_packed(*id, image, bytes);
                done.map_err(|e| e.to_string())?;
            }
        }
        Ok(())
    }

    fn parts(&self) -> Result<Parts> {
        let vertices = self.frame.vertices.iter();
        let vertices = vertices.map(|v| {
            let data = words(self.blobs.get(v.blob)?)?;
            let stride = usize::try_from(v.stride).map_err(|e| e.to_string())?;
            Ok(Arc::new(VertexBuffer {
                data: data.map(f32::from_bits).collect(),
                stride,
            }))
        });
        let indices = self.frame.indices.iter();
        let indices = indices.map(|blob| {
            let indices = words(self.blobs.get(*blob)?)?.collect();
            Ok(Arc::new(IndexBuffer::new(indices)))
        });
        Ok(Parts {
            vertices: vertices.collect::<Result<_>>()?,
            indices: indices.collect::<Result<_>>()?,
        })
    }

    fn pipeline(
        &self,
        draw: &v1::Draw,
        table: &ShaderTable,
        made: &mut [Option<Arc<RenderPipeline>>],
    ) -> std::result::Result<Arc<RenderPipeline>, PipelineFault> {
        let written = nth(&self.frame.pipelines, draw.pipeline, "pipeline")?;
        let made = &mut made[draw.pipeline as usize];
        if let Some(pipeline) = made {
            return Ok(pipeline.clone());
        }
        let pipeline = Arc::new(RenderPipeline {
            label: written.label.clone(),
            vertex: self.vertex(written.vertex, table)?,
            fragment: match written.fragment {
                Some(shader) => Some(self.fragment(shader, table)?),
                None => None,
            },
            primitive: primitive(&written.primitive)?,
            depth_stencil: depth_stencil(&written.depth_stencil)?,
            color_targets: color_targets(&written.color_targets)?,
        });
        *made = Some(pipeline.clone());
        Ok(pipeline)
    }

    fn identity(&self, number: u32, stage: u8) -> Result<ShaderIdentity> {
        let shader = nth(self.shaders, number, "shader")?;
        if shader.stage != stage {
            return Err(format!("shader {number} is of the other stage"));
        }
        Ok(ShaderIdentity {
            name: shader.name.clone(),
            version: shader.version,
            uniforms: shader.uniforms.clone(),
        })
    }

    fn vertex(
        &self,
        number: u32,
        table: &ShaderTable,
    ) -> std::result::Result<VertexStage, PipelineFault> {
        let identity = self.identity(number, 0)?;
        match frozen::is_frozen(&identity.name) {
            true => Ok(frozen::table().vertex(&identity)?),
            false => Ok(table.vertex(&identity)?),
        }
    }

    /// What the shader may do must be what it was when it was recorded: shapes rely on it.
    fn fragment(
        &self,
        number: u32,
        table: &ShaderTable,
    ) -> std::result::Result<FragmentStage, PipelineFault> {
        let identity = self.identity(number, 1)?;
        let stage = match frozen::is_frozen(&identity.name) {
            true => frozen::table().fragment(&identity)?,
            false => table.fragment(&identity)?,
        };
        let (o, shader) = (stage.outputs(), &self.shaders[number as usize]);
        let given = (o.discards, o.depth, o.textures as u32);
        if given == shader.outputs {
            return Ok(stage);
        }
        Err(PipelineFault::Data(format!(
            "shader {number} `{}` discards, writes depth, reads textures: {:?}; here {given:?}",
            shader.name, shader.outputs
        )))
    }
}

enum PipelineFault {
    Data(String),
    Shader(gnomon_raster::shader::ShaderTableError),
}

impl From<String> for PipelineFault {
    fn from(reason: String) -> Self {
        Self::Data(reason)
    }
}

impl From<gnomon_raster::shader::ShaderTableError> for PipelineFault {
    fn from(source: gnomon_raster::shader::ShaderTableError) -> Self {
        Self::Shader(source)
    }
}

impl PipelineFault {
    fn at(self, pass: &v1::Pass, number: usize, draw: &v1::Draw) -> Fault {
        match self {
            Self::Data(reason) => Fault::Data(reason),
            Self::Shader(source) => Fault::Shader(Box::new(Unmade {
                pass: pass.label.clone(),
                draw: number,
                label: draw.label.clone(),
                source,
            })),
        }
    }
}

/// Buffers, by number.
struct Parts {
    vertices: Vec<Arc<VertexBuffer>>,
    indices: Vec<Arc<IndexBuffer>>,
}

impl Parts {
    fn draw(&self, d: &v1::Draw, pipeline: Arc<RenderPipeline>, ids: &[TextureId]) -> Result<Draw> {
        let vertices = d.vertices.map(|v| nth(&self.vertices, v, "vertex buffer"));
        let indices = d.indices.map(|i| nth(&self.indices, i, "index buffer"));
        Ok(Draw {
            label: d.label.clone(),
            pipeline,
            vertices: vertices.transpose()?.cloned(),
            indices: indices.transpose()?.cloned(),
            first: d.first,
            count: d.count,
            instances: d.instances,
            stencil_reference: d.stencil_reference,
            blend_constant: d.blend_constant,
            viewport: d.viewport.map(viewport),
            scissor: d.scissor.map(scissor),
            textures: bindings(d, ids)?,
        })
    }
}

fn words(bytes: &[u8]) -> Result<impl Iterator<Item = u32>> {
    let (words, rest) = bytes.as_chunks();
    match rest.len() {
        0 => Ok(words.iter().map(|w| u32::from_le_bytes(*w))),
        _ => Err(format!(
            "a buffer has {} bytes, not whole words",
            bytes.len()
        )),
    }
}

fn texture_bytes(d: &TextureDescriptor) -> u64 {
    let texel = d.format.bytes() + u64::from(d.format.is_depth_stencil());
    let size = |s: Subresource| {
        let [w, h] = [0, 1].map(|k| u64::from((d.size[k] >> s.mip.min(31)).max(1)));
        w * h * texel
    };
    d.images().map(size).sum()
}

fn descriptor(t: &v1::Texture) -> Result<TextureDescriptor> {
    Ok(TextureDescriptor {
        label: t.label.clone(),
        dimension: Numbered::numbered(t.dimension)?,
        format: Numbered::numbered(t.format)?,
        size: t.size,
        mip_levels: t.mip_levels,
    })
}

fn load<T: Copy>(op: &v1::LoadOp<T>) -> LoadOp<T> {
    match op {
        v1::LoadOp::Load => LoadOp::Load,
        v1::LoadOp::Clear(v) => LoadOp::Clear(*v),
        v1::LoadOp::DontCare => LoadOp::DontCare,
    }
}

fn store(discard: bool) -> StoreOp {
    match discard {
        true => StoreOp::Discard,
        false => StoreOp::Store,
    }
}

fn colors(pass: &v1::Pass, ids: &[TextureId]) -> Result<Vec<ColorAttachment>> {
    let color = |a: &v1::Color| {
        Ok(ColorAttachment {
            texture: *nth(ids, a.texture, "texture")?,
            subresource: Subresource {
                mip: a.mip,
                layer: a.layer,
            },
            load: load(&a.load),
            store: store(a.discard),
        })
    };
    pass.color.iter().map(color).collect()
}

fn depth(pass: &v1::Pass, ids: &[TextureId]) -> Result<Option<DepthStencilAttachment>> {
    let Some(a) = &pass.depth_stencil else {
        return Ok(None);
    };
    Ok(Some(DepthStencilAttachment {
        texture: *nth(ids, a.texture, "texture")?,
        subresource: Subresource {
            mip: a.mip,
            layer: a.layer,
        },
        depth_load: load(&a.depth_load),
        depth_store: store(a.depth_discard),
        stencil_load: load(&a.stencil_load),
        stencil_store: store(a.stencil_discard),
    }))
}

fn primitive(p: &v1::Primitive) -> Result<PrimitiveState> {
    Ok(PrimitiveState {
        topology: Numbered::numbered(p.topology)?,
        front_face: Numbered::numbered(p.front_face)?,
        cull_mode: Numbered::numbered(p.cull_mode)?,
        depth_clamp: p.depth_clamp,
        clip_planes: p.clip_planes.clone(),
        line_width: p.line_width,
        point_size: p.point_size,
    })
}

fn depth_stencil(s: &v1::DepthStencil) -> Result<DepthStencilState> {
    let [constant, slope, clamp] = s.bias;
    Ok(DepthStencilState {
        depth: DepthState {
            compare: Numbered::numbered(s.compare)?,
            write: s.write,
            bounds: s.bounds,
        },
        stencil: StencilState {
            front: face(&s.front)?,
            back: face(&s.back)?,
        },
        bias: DepthBias {
            constant,
            slope,
            clamp,
        },
    })
}

fn face(f: &v1::Face) -> Result<StencilFaceState> {
    Ok(StencilFaceState {
        compare: Numbered::numbered(f.compare)?,
        fail_op: Numbered::numbered(f.fail_op)?,
        depth_fail_op: Numbered::numbered(f.depth_fail_op)?,
        pass_op: Numbered::numbered(f.pass_op)?,
        read_mask: f.read_mask,
        write_mask: f.write_mask,
    })
}

fn color_targets(targets: &[v1::ColorTarget]) -> Result<Vec<ColorTargetState>> {
    let component = |[src, dst, operation]: [u8; 3]| -> Result<BlendComponent> {
        Ok(BlendComponent {
            src_factor: Numbered::numbered(src)?,
            dst_factor: Numbered::numbered(dst)?,
            operation: Numbered::numbered(operation)?,
        })
    };
    let target = |t: &v1::ColorTarget| {
        let blend = t.blend.map(|[color, alpha]| -> Result<BlendState> {
            Ok(BlendState {
                color: component(color)?,
                alpha: component(alpha)?,
            })
        });
        Ok(ColorTargetState {
            blend: blend.transpose()?,
            write_mask: ColorWrites(t.write_mask),
        })
    };
    targets.iter().map(target).collect()
}

fn viewport([x, y, width, height, min_depth, max_depth]: [f32; 6]) -> Viewport {
    Viewport {
        x,
        y,
        width,
        height,
        min_depth,
        max_depth,
    }
}

fn scissor([x, y, width, height]: [u32; 4]) -> ScissorRect {
    ScissorRect {
        x,
        y,
        width,
        height,
    }
}

fn bindings(draw: &v1::Draw, ids: &[TextureId]) -> Result<Vec<TextureBinding>> {
    let binding = |b: &v1::Binding| {
        let [mag, min, mip] = b.filters;
        let [u, v, w] = b.address;
        Ok(TextureBinding {
            texture: *nth(ids, b.texture, "texture")?,
            sampler: Sampler {
                address: [
                    Numbered::numbered(u)?,
                    Numbered::numbered(v)?,
                    Numbered::numbered(w)?,
                ],
                mag: Numbered::numbered(mag)?,
                min: Numbered::numbered(min)?,
                mip: Numbered::numbered(mip)?,
                lod: b.lod,
                lod_bias: b.lod_bias,
                border: b.border,
            },
        })
    };
    draw.textures.iter().map(binding).collect()
}
