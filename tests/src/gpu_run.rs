//! Twin cases on the GPU.

use std::sync::Arc;

use gnomon_raster::{
    AccessBatch, AccessObserver, BlockAccess, BlockView, BlockWitness, ColorAttachment, ColorBlock,
    CommandList, DepthStencilAttachment, Draw, Error, Format, FragmentRecord, Gpu, GpuConfig,
    IndexBuffer, PassReport, Recording, RenderPass, RenderPipeline, ShadedBlock, Subresource,
    TexelAccess, TextureBinding, TextureDescriptor, TextureId, VertexBuffer, Wants,
};

use crate::twin::{
    BlockHash, EventDetails, Outcome, PassOutcome, TextureSource, TwinCase, TwinDraw, TwinPass,
    TwinTexture, VertexSource, depth_image,
};

const WHOLE: Subresource = Subresource { mip: 0, layer: 0 };

/// The textures of a case.
struct Targets {
    color: Vec<TextureId>,
    depth: Option<TextureId>,
    read: Vec<TextureId>,
}

/// Collects the accesses of each pass, numbered through.
#[derive(Default)]
struct Collector {
    passes: Vec<(Vec<BlockAccess>, EventDetails)>,
}

impl AccessObserver for Collector {
    fn batch(&mut self, pass: usize, batch: &AccessBatch<'_>) {
        if self.passes.len() <= pass {
            self.passes.resize(pass + 1, Default::default());
        }
        let (blocks, d) = &mut self.passes[pass];
        let (events, values) = (blocks.len() as u32, d.values.len() as u32);
        blocks.extend_from_slice(batch.blocks);
        d.texels.extend(batch.texels.iter().map(|t| TexelAccess {
            event: t.event + events,
            ..*t
        }));
        d.fragments
            .extend(batch.fragments.iter().map(|f| FragmentRecord {
                event: f.event + events,
                ..*f
            }));
        d.outputs.extend(batch.outputs.iter().map(|o| ShadedBlock {
            event: o.event + events,
            first: o.first + values,
            ..*o
        }));
        d.values.extend_from_slice(batch.values);
        d.left.extend_from_slice(batch.left);
    }

    /// When each is told of is left open: they are ordered here.
    fn end(&mut self, pass: usize, _: &PassReport) {
        if let Some((_, d)) = self.passes.get_mut(pass) {
            d.left.sort_by_key(|l| (l.draw, l.block[1], l.block[0]));
        }
    }
}

/// Hashes blocks as the twin does.
#[derive(Clone, Copy, Debug, Default)]
pub struct HashWitness;

impl BlockWitness for HashWitness {
    fn after(&self, view: &BlockView<'_>) -> u64 {
        let mut hash = BlockHash::default();
        for pixel in (0..64).filter(|p| view.inside >> p & 1 != 0) {
            if let Some((depth, stencil)) = view.depth_stencil {
                hash.word(depth[pixel]);
                hash.word(stencil[pixel].into());
            }
            for (block, format) in view.color.iter().zip(view.formats) {
                let all = channels(block, *format, pixel);
                all.into_iter().for_each(|c| hash.word(c));
            }
        }
        hash.0
    }
}

/// The channels of a pixel, taken out of what is stored.
fn channels(block: &ColorBlock<'_>, format: Format, pixel: usize) -> [u32; 4] {
    match (block, format) {
        (ColorBlock::B16(v), Format::Rg8Unorm) => {
            [u32::from(v[pixel] & 0xff), u32::from(v[pixel] >> 8), 0, 0]
        }
        (ColorBlock::B32(v), Format::Rgba8Unorm) => [0, 8, 16, 24].map(|s| v[pixel] >> s & 0xff),
        (ColorBlock::B8(v), _) => [v[pixel].into(), 0, 0, 0],
        (ColorBlock::B16(v), _) => [v[pixel].into(), 0, 0, 0],
        (ColorBlock::B32(v), _) => [v[pixel], 0, 0, 0],
        (ColorBlock::B16x4(v), _) => v.map(|c| c[pixel].into()),
        (ColorBlock::B32x4(v), _) => v.map(|c| c[pixel]),
    }
}

/// Runs a case; events stay empty.
///
/// # Errors
/// What the GPU refuses.
pub fn run(case: &TwinCase, config: GpuConfig) -> Result<Outcome, Error> {
    run_with(case, config, None)
}

/// Runs a case with an observer, so that events are filled in.
///
/// # Errors
/// What the GPU refuses.
pub fn run_observed(case: &TwinCase, config: GpuConfig) -> Result<Outcome, Error> {
    let wants = Wants {
        depth_ranges: true,
        ..Wants::default()
    };
    run_with(case, config, Some(wants))
}

/// Runs a case with an observer who wants all that there is, of pixel `probe`.
///
/// # Errors
/// What the GPU refuses.
pub fn run_probed(case: &TwinCase, config: GpuConfig, probe: [u32; 2]) -> Result<Outcome, Error> {
    let wants = Wants {
        depth_ranges: true,
        texels: true,
        outputs: true,
        probe: Some(probe),
        witness: Some(&HashWitness),
        left: Some(&HashWitness),
    };
    run_with(case, config, Some(wants))
}

/// A case as a recording, commands and all.
///
/// # Errors
/// What the GPU refuses.
pub fn recorded(case: &TwinCase) -> Result<Recording, Error> {
    let mut gpu = Gpu::new(GpuConfig {
        threads: 1,
        ..GpuConfig::default()
    })?;
    let targets = upload(&mut gpu, case)?;
    let mut recording = gpu.save()?;
    let passes = case.passes.iter().map(|p| render_pass(p, &targets));
    recording.list.passes = passes.collect();
    Ok(recording)
}

fn run_with(
    case: &TwinCase,
    config: GpuConfig,
    wants: Option<Wants<'_>>,
) -> Result<Outcome, Error> {
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
    let report = match wants {
        Some(wants) => gpu.submit_observed(&list, wants, &mut collector)?,
        None => gpu.submit(&list)?,
    };
    collector
        .passes
        .resize(case.passes.len(), Default::default());
    let passes = report
        .passes
        .into_iter()
        .zip(collector.passes)
        .map(|(p, (events, details))| PassOutcome {
            draws: p.draws.iter().map(|d| d.counters).collect(),
            clear: p.clear,
            events,
            details,
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
            details: EventDetails::default(),
        }));
    }
    download(&gpu, &targets, passes)
}

/// A case as a recording, without outputs.
///
/// # Errors
/// What the GPU refuses.
pub fn recording(case: &TwinCase, config: GpuConfig) -> Result<Recording, Error> {
    let mut gpu = Gpu::new(config)?;
    let targets = upload(&mut gpu, case)?;
    let mut recording = gpu.save()?;
    let passes = case.passes.iter();
    recording.list.passes = passes.map(|p| render_pass(p, &targets)).collect();
    Ok(recording)
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
