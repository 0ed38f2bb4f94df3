//! A recording as plain data: what `FRAM`, `SHAD` and `BLOB` hold.

use std::collections::BTreeMap;
use std::sync::Arc;

use gnomon_raster::shader::{FragmentStage, ShaderIdentity, VertexStage};
use gnomon_raster::state::{
    BlendComponent, ColorTargetState, DepthStencilState, PrimitiveState, StencilFaceState,
};
use gnomon_raster::{
    ColorAttachment, DepthStencilAttachment, Draw, IndexBuffer, LoadOp, Recording, RenderPass,
    RenderPipeline, StoreOp, TextureBinding, VertexBuffer,
};

use super::blob::Blobs;
use super::numbers::Numbered;
use super::v1;
use crate::error::TraceError;

/// A frame and the shaders that it names.
pub(crate) struct Encoded {
    pub(crate) frame: v1::Frame,
    pub(crate) shaders: Vec<v1::Shader>,
}

/// Writes `recording` down; its data goes to `blobs`.
pub(crate) fn encode(recording: &Recording, blobs: &mut Blobs) -> Result<Encoded, TraceError> {
    let mut encoder = Encoder::new(blobs);
    encoder.textures(recording);
    for pass in &recording.list.passes {
        let pass = encoder.pass(pass)?;
        encoder.frame.passes.push(pass);
    }
    let outputs = recording.outputs();
    let outputs = outputs.map(|(name, id)| (name.to_owned(), id.index() as u32));
    encoder.frame.outputs = outputs.collect();
    Ok(Encoded {
        frame: encoder.frame,
        shaders: encoder.shaders.list,
    })
}

/// Values, each once, by number.
struct Numbers<T> {
    list: Vec<T>,
    numbers: BTreeMap<Vec<u8>, u32>,
}

impl<T> Numbers<T> {
    fn new() -> Self {
        Self {
            list: Vec::new(),
            numbers: BTreeMap::new(),
        }
    }

    /// The number of the value that `key` stands for.
    fn add(&mut self, key: Vec<u8>, value: T) -> u32 {
        let next = self.list.len() as u32;
        let number = *self.numbers.entry(key).or_insert(next);
        if number == next {
            self.list.push(value);
        }
        number
    }
}

struct Encoder<'a> {
    blobs: &'a mut Blobs,
    frame: v1::Frame,
    shaders: Numbers<v1::Shader>,
    /// Numbers by content.
    pipelines: Numbers<()>,
    vertices: BTreeMap<(u32, u64), u32>,
    indices: BTreeMap<u32, u32>,
    /// Numbers of what has been seen already, by address: large buffers are hashed once.
    seen_pipelines: BTreeMap<*const RenderPipeline, u32>,
    seen_vertices: BTreeMap<*const VertexBuffer, u32>,
    seen_indices: BTreeMap<*const IndexBuffer, u32>,
}

/// Where a draw is.
struct At<'a> {
    pass: &'a str,
    number: usize,
    draw: &'a Draw,
}

impl At<'_> {
    fn nameless(&self, stage: &'static str) -> TraceError {
        TraceError::NoIdentity {
            pass: self.pass.to_owned(),
            draw: self.number,
            label: self.draw.label.clone(),
            stage,
        }
    }
}

impl<'a> Encoder<'a> {
    fn new(blobs: &'a mut Blobs) -> Self {
        Self {
            blobs,
            frame: v1::Frame::default(),
            shaders: Numbers::new(),
            pipelines: Numbers::new(),
            vertices: BTreeMap::new(),
            indices: BTreeMap::new(),
            seen_pipelines: BTreeMap::new(),
            seen_vertices: BTreeMap::new(),
            seen_indices: BTreeMap::new(),
        }
    }

    fn textures(&mut self, recording: &Recording) {
        for texture in recording.textures() {
            let d = texture.descriptor();
            let blobs = &mut *self.blobs;
            let contents = texture.contents();
            let contents = contents.map(|(s, bytes)| (s.mip, s.layer, blobs.add(bytes)));
            self.frame.textures.push(v1::Texture {
                label: d.label.clone(),
                dimension: d.dimension.number(),
                format: d.format.number(),
                size: d.size,
                mip_levels: d.mip_levels,
                contents: contents.collect(),
            });
        }
    }

    fn pass(&mut self, pass: &RenderPass) -> Result<v1::Pass, TraceError> {
        let draws = pass.draws.iter().enumerate();
        let draws = draws.map(|(number, draw)| {
            self.draw(&At {
                pass: &pass.label,
                number,
                draw,
            })
        });
        Ok(v1::Pass {
            draws: draws.collect::<Result<_, _>>()?,
            label: pass.label.clone(),
            color: pass.color.iter().map(color_attachment).collect(),
            depth_stencil: pass.depth_stencil.as_ref().map(depth_attachment),
        })
    }

    fn draw(&mut self, at: &At<'_>) -> Result<v1::Draw, TraceError> {
        let d = at.draw;
        let viewport = d.viewport.as_ref();
        Ok(v1::Draw {
            label: d.label.clone(),
            pipeline: self.pipeline(at)?,
            vertices: d.vertices.as_ref().map(|v| self.vertex_buffer(v)),
            indices: d.indices.as_ref().map(|i| self.index_buffer(i)),
            first: d.first,
            count: d.count,
            instances: d.instances,
            stencil_reference: d.stencil_reference,
            blend_constant: d.blend_constant,
            viewport: viewport.map(|v| [v.x, v.y, v.width, v.height, v.min_depth, v.max_depth]),
            scissor: d.scissor.map(|s| [s.x, s.y, s.width, s.height]),
            textures: d.textures.iter().map(binding).collect(),
        })
    }

    fn pipeline(&mut self, at: &At<'_>) -> Result<u32, TraceError> {
        let pipeline = &at.draw.pipeline;
        if let Some(number) = self.seen_pipelines.get(&Arc::as_ptr(pipeline)) {
            return Ok(*number);
        }
        let vertex = self.vertex_shader(&pipeline.vertex);
        let vertex = vertex.ok_or_else(|| at.nameless("vertex"))?;
        let fragment = match &pipeline.fragment {
            None => None,
            Some(stage) => {
                let number = self.fragment_shader(stage);
                Some(number.ok_or_else(|| at.nameless("fragment"))?)
            }
        };
        let written = v1::Pipeline {
            label: pipeline.label.clone(),
            vertex,
            fragment,
            primitive: primitive(&pipeline.primitive),
            depth_stencil: depth_stencil(&pipeline.depth_stencil),
            color_targets: pipeline.color_targets.iter().map(color_target).collect(),
        };
        let number = self.pipelines.add(bytes_of(&written), ());
        if number as usize == self.frame.pipelines.len() {
            self.frame.pipelines.push(written);
        }
        self.seen_pipelines.insert(Arc::as_ptr(pipeline), number);
        Ok(number)
    }

    fn vertex_shader(&mut self, stage: &VertexStage) -> Option<u32> {
        let identity = stage.identity()?;
        Some(self.shader(0, identity, (false, false, 0)))
    }

    fn fragment_shader(&mut self, stage: &FragmentStage) -> Option<u32> {
        let identity = stage.identity()?;
        let o = stage.outputs();
        Some(self.shader(1, identity, (o.discards, o.depth, o.textures as u32)))
    }

    fn shader(&mut self, stage: u8, of: ShaderIdentity, outputs: (bool, bool, u32)) -> u32 {
        let shader = v1::Shader {
            stage,
            name: of.name,
            version: of.version,
            uniforms: of.uniforms,
            outputs,
        };
        self.shaders.add(bytes_of(&shader), shader)
    }

    fn vertex_buffer(&mut self, buffer: &Arc<VertexBuffer>) -> u32 {
        if let Some(number) = self.seen_vertices.get(&Arc::as_ptr(buffer)) {
            return *number;
        }
        let bytes: Vec<u8> = buffer
            .data
            .iter()
            .flat_map(|f| f.to_bits().to_le_bytes())
            .collect();
        let (blob, stride) = (self.blobs.add(&bytes.into()), buffer.stride as u64);
        let next = self.frame.vertices.len() as u32;
        let number = *self.vertices.entry((blob, stride)).or_insert(next);
        if number == next {
            self.frame.vertices.push(v1::Vertices { blob, stride });
        }
        self.seen_vertices.insert(Arc::as_ptr(buffer), number);
        number
    }

    fn index_buffer(&mut self, buffer: &Arc<IndexBuffer>) -> u32 {
        if let Some(number) = self.seen_indices.get(&Arc::as_ptr(buffer)) {
            return *number;
        }
        let bytes: Vec<u8> = buffer
            .indices()
            .iter()
            .flat_map(|i| i.to_le_bytes())
            .collect();
        let blob = self.blobs.add(&bytes.into());
        let next = self.frame.indices.len() as u32;
        let number = *self.indices.entry(blob).or_insert(next);
        if number == next {
            self.frame.indices.push(blob);
        }
        self.seen_indices.insert(Arc::as_ptr(buffer), number);
        number
    }
}

/// What postcard makes of a value; writing to memory does not fail.
pub(crate) fn bytes_of<T: serde::Serialize>(value: &T) -> Vec<u8> {
    postcard::to_stdvec(value).expect("plain data in memory")
}

fn load<T, U>(op: LoadOp<T>, value: impl FnOnce(T) -> U) -> v1::LoadOp<U> {
    match op {
        LoadOp::Load => v1::LoadOp::Load,
        LoadOp::Clear(v) => v1::LoadOp::Clear(value(v)),
        LoadOp::DontCare => v1::LoadOp::DontCare,
    }
}

fn color_attachment(a: &ColorAttachment) -> v1::Color {
    v1::Color {
        texture: a.texture.index() as u32,
        mip: a.subresource.mip,
        layer: a.subresource.layer,
        load: load(a.load, |v| v),
        discard: a.store == StoreOp::Discard,
    }
}

fn depth_attachment(a: &DepthStencilAttachment) -> v1::Depth {
    v1::Depth {
        texture: a.texture.index() as u32,
        mip: a.subresource.mip,
        layer: a.subresource.layer,
        depth_load: load(a.depth_load, |v| v),
        depth_discard: a.depth_store == StoreOp::Discard,
        stencil_load: load(a.stencil_load, |v| v),
        stencil_discard: a.stencil_store == StoreOp::Discard,
    }
}

fn primitive(p: &PrimitiveState) -> v1::Primitive {
    v1::Primitive {
        topology: p.topology.number(),
        front_face: p.front_face.number(),
        cull_mode: p.cull_mode.number(),
        depth_clamp: p.depth_clamp,
        clip_planes: p.clip_planes.clone(),
        line_width: p.line_width,
        point_size: p.point_size,
    }
}

fn depth_stencil(s: &DepthStencilState) -> v1::DepthStencil {
    v1::DepthStencil {
        compare: s.depth.compare.number(),
        write: s.depth.write,
        bounds: s.depth.bounds,
        front: face(&s.stencil.front),
        back: face(&s.stencil.back),
        bias: [s.bias.constant, s.bias.slope, s.bias.clamp],
    }
}

fn face(f: &StencilFaceState) -> v1::Face {
    v1::Face {
        compare: f.compare.number(),
        fail_op: f.fail_op.number(),
        depth_fail_op: f.depth_fail_op.number(),
        pass_op: f.pass_op.number(),
        read_mask: f.read_mask,
        write_mask: f.write_mask,
    }
}

fn color_target(t: &ColorTargetState) -> v1::ColorTarget {
    let component = |c: &BlendComponent| {
        let factors = [c.src_factor.number(), c.dst_factor.number()];
        [factors[0], factors[1], c.operation.number()]
    };
    v1::ColorTarget {
        blend: t.blend.map(|b| [component(&b.color), component(&b.alpha)]),
        write_mask: t.write_mask.0,
    }
}

fn binding(b: &TextureBinding) -> v1::Binding {
    let s = &b.sampler;
    v1::Binding {
        texture: b.texture.index() as u32,
        address: s.address.map(Numbered::number),
        filters: [s.mag, s.min, s.mip].map(Numbered::number),
        lod: s.lod,
        lod_bias: s.lod_bias,
        border: s.border,
    }
}
