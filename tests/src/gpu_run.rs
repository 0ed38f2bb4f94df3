//! Twin cases on the GPU.

use std::sync::Arc;

use gnomon_raster::{
    AccessBatch, AccessObserver, BlockAccess, ColorAttachment, CommandList, DepthStencilAttachment,
    Draw, Error, Gpu, GpuConfig, IndexBuffer, RenderPass, RenderPipeline, Subresource,
    TextureBinding, TextureDescriptor, TextureId, VertexBuffer, Wants,
};

use crate::twin::{
    Outcome, PassOutcome, TextureSource, TwinCase, TwinDraw, TwinPass, TwinTexture, VertexSource,
    depth_image,
};

const WHOLE: Subresource = Subresource { mip: 0, layer: 0 };

/// The textures of a case.
struct Targets {
    color: Vec<TextureId>,
    depth: Option<TextureId>,
    read: Vec<TextureId>,
}

/// Collects the accesses of each pass.
#[derive(Default)]
struct Collector {
    passes: Vec<Vec<BlockAccess>>,
}

impl AccessObserver for Collector {
    fn batch(&mut self, pass: usize, batch: &AccessBatch<'_>) {
        if self.passes.len() <= pass {
            self.passes.resize(pass + 1, Vec::new());
        }
        self.passes[pass].extend_from_slice(batch.blocks);
    }
}

/// Runs a case; events stay empty.
///
/// # Errors
/// What the GPU refuses.
pub fn run(case: &TwinCase, config: GpuConfig) -> Result<Outcome, Error> {
    run_with(case, config, false)
}

/// Runs a case with an observer, so that events are filled in.
///
/// # Errors
/// What the GPU refuses.
pub fn run_observed(case: &TwinCase, config: GpuConfig) -> Result<Outcome, Error> {
    run_with(case, config, true)
}

fn run_with(case: &TwinCase, config: GpuConfig, observed: bool) -> Result<Outcome, Error> {
    let mut gpu = Gpu::new(config)?;
    let targets = upload(&mut gpu, case)?;
    let list = CommandList {
        passes: case
            .passes
            .iter()
            .map(|p| render_pass(p, &targets))
            .collect(),
    };
    let mut collector = Collector::default();
    let report = if observed {
        let wants = Wants {
            depth_ranges: true,
            ..Wants::default()
        };
        gpu.submit_observed(&list, wants, &mut collector)?
    } else {
        gpu.submit(&list)?
    };
    collector.passes.resize(case.passes.len(), Vec::new());
    let passes = report
        .passes
        .into_iter()
        .zip(collector.passes)
        .map(|(p, events)| PassOutcome {
            draws: p.draws.iter().map(|d| d.counters).collect(),
            clear: p.clear,
            events,
        })
        .collect();
    download(&gpu, &targets, passes)
}

/// Runs a case pass by pass, each on a new GPU whose textures are made from the bytes
/// that the pass before left; events stay empty.
///
/// # Errors
/// What the GPU refuses.
pub fn run_in_pieces(case: &TwinCase, config: GpuConfig) -> Result<Outcome, Error> {
    let mut gpu = Gpu::new(config)?;
    let targets = upload(&mut gpu, case)?;
    let mut passes = Vec::new();
    for pass in &case.passes {
        let saved = gpu.save()?;
        gpu = Gpu::new(config)?;
        gpu.load(&saved)?;
        let list = CommandList {
            passes: vec![render_pass(pass, &targets)],
        };
        let report = gpu.submit(&list)?;
        passes.extend(report.passes.iter().map(|p| PassOutcome {
            draws: p.draws.iter().map(|d| d.counters).collect(),
            clear: p.clear,
            events: Vec::new(),
        }));
    }
    download(&gpu, &targets, passes)
}

fn upload(gpu: &mut Gpu, case: &TwinCase) -> Result<Targets, Error> {
    let [w, h] = case.size;
    let mut color = Vec::new();
    for (k, image) in case.color.iter().enumerate() {
        let id = gpu.create_texture(&TextureDescriptor::d2(
            &format!("color {k}"),
            image.format,
            w,
            h,
        ))?;
        gpu.texture_mut(id)?.write_raw(WHOLE, &image.texels)?;
        color.push(id);
    }
    let mut depth = None;
    if let Some(image) = &case.depth {
        let id = gpu.create_texture(&TextureDescriptor::d2("depth", image.format, w, h))?;
        gpu.texture_mut(id)?
            .write_depth_stencil(WHOLE, &image.depth, &image.stencil)?;
        depth = Some(id);
    }
    let read = case.textures.iter().map(|t| upload_texture(gpu, t));
    Ok(Targets {
        color,
        depth,
        read: read.collect::<Result<_, _>>()?,
    })
}

fn upload_texture(gpu: &mut Gpu, t: &TwinTexture) -> Result<TextureId, Error> {
    let id = gpu.create_texture(&TextureDescriptor {
        label: "texture".to_owned(),
        dimension: t.dimension,
        format: t.format,
        size: t.size,
        mip_levels: t.images.len() as u32,
    })?;
    let texture = gpu.texture_mut(id)?;
    for (mip, layers) in t.images.iter().enumerate() {
        for (layer, texels) in layers.iter().enumerate() {
            let at = Subresource {
                mip: mip as u32,
                layer: layer as u32,
            };
            if t.format.is_depth_stencil() {
                let d = depth_image(t.format, texels);
                texture.write_depth_stencil(at, &d.depth, &d.stencil)?;
            } else {
                texture.write_raw(at, texels)?;
            }
        }
    }
    Ok(id)
}

fn download(gpu: &Gpu, targets: &Targets, passes: Vec<PassOutcome>) -> Result<Outcome, Error> {
    let mut color = Vec::new();
    for id in &targets.color {
        color.push(gpu.texture(*id)?.read_raw(WHOLE)?);
    }
    let (mut depth, mut stencil) = (Vec::new(), Vec::new());
    if let Some(id) = targets.depth {
        depth = gpu.texture(id)?.read_depth_bits(WHOLE)?;
        stencil = gpu.texture(id)?.read_stencil(WHOLE)?;
    }
    Ok(Outcome {
        color,
        depth,
        stencil,
        passes,
    })
}

fn render_pass(pass: &TwinPass, targets: &Targets) -> RenderPass {
    let color = |c: &crate::twin::ColorUse| ColorAttachment {
        texture: targets.color[c.image],
        subresource: WHOLE,
        load: c.load,
        store: c.store,
    };
    let depth_stencil = pass.depth.as_ref().map(|d| DepthStencilAttachment {
        texture: targets
            .depth
            .expect("a pass with depth belongs to a case with depth"),
        subresource: WHOLE,
        depth_load: d.depth_load,
        depth_store: d.depth_store,
        stencil_load: d.stencil_load,
        stencil_store: d.stencil_store,
    });
    RenderPass {
        label: "pass".to_owned(),
        color: pass.color.iter().map(color).collect(),
        depth_stencil,
        draws: pass.draws.iter().map(|d| draw(d, targets)).collect(),
    }
}

fn draw(d: &TwinDraw, targets: &Targets) -> Draw {
    let pipeline = Arc::new(RenderPipeline {
        label: "render pipeline".to_owned(),
        vertex: d.vertex_stage(),
        fragment: d.fragment_stage(),
        primitive: d.primitive.clone(),
        depth_stencil: d.depth_stencil,
        color_targets: d.targets.clone(),
    });
    Draw {
        vertices: (d.vertex_source == VertexSource::Buffer).then(|| Arc::new(vertex_buffer(d))),
        indices: d
            .indices
            .as_ref()
            .map(|i| Arc::new(IndexBuffer::new(i.clone()))),
        first: d.first,
        count: d.count,
        instances: d.instances,
        stencil_reference: d.stencil_reference,
        blend_constant: d.blend_constant,
        viewport: d.viewport,
        scissor: d.scissor,
        textures: textures(d, targets),
        ..Draw::vertices_only("draw", &pipeline, d.count)
    }
}

fn textures(d: &TwinDraw, targets: &Targets) -> Vec<TextureBinding> {
    let bind = |t: &crate::twin::TextureUse| TextureBinding {
        texture: match t.source {
            TextureSource::Texture(k) => targets.read[k],
            TextureSource::Color(k) => targets.color[k],
            TextureSource::Depth => targets.depth.expect("the case has one"),
        },
        sampler: t.sampler,
    };
    d.textures.iter().map(bind).collect()
}

/// Position, then varyings.
fn vertex_buffer(d: &TwinDraw) -> VertexBuffer {
    let n = d.interpolation.len();
    let mut data = Vec::new();
    for (position, varyings) in d.positions.iter().zip(&d.varyings) {
        data.extend(position);
        data.extend(&varyings[..n]);
    }
    VertexBuffer {
        data,
        stride: 4 + n,
    }
}
