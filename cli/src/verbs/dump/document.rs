//! A line of `dump`: a texture, a pass or a draw.

use gnomon_raster::TextureDescriptor;
use gnomon_traces::{DrawShape, PassShape};
use serde::Serialize;

#[derive(Serialize)]
#[serde(tag = "command", rename_all = "kebab-case")]
pub(super) enum Line {
    Texture {
        id: usize,
        label: String,
        dimension: String,
        format: String,
        size: [u32; 3],
        mip_levels: u32,
    },
    RenderPass {
        pass: usize,
        label: String,
        color: Vec<Attachment>,
        depth_stencil: Option<Attachment>,
    },
    Draw {
        pass: usize,
        draw: usize,
        label: String,
        pipeline: String,
        topology: String,
        front_face: String,
        cull_mode: String,
        depth_clamp: bool,
        depth_stencil: String,
        color_targets: Vec<String>,
        discards: bool,
        writes_depth: bool,
        vertex_stride: Option<usize>,
        indexed: bool,
        first: u32,
        count: u32,
        instances: u32,
        stencil_reference: [u8; 2],
        viewport: Option<String>,
        scissor: Option<[u32; 4]>,
        textures: Vec<usize>,
    },
}

#[derive(Serialize)]
pub(super) struct Attachment {
    texture: usize,
    mip: u32,
    layer: u32,
    load: String,
    store: String,
}

impl Line {
    pub(super) fn texture(id: usize, d: &TextureDescriptor) -> Self {
        Self::Texture {
            id,
            label: d.label.clone(),
            dimension: format!("{:?}", d.dimension),
            format: format!("{:?}", d.format),
            size: d.size,
            mip_levels: d.mip_levels,
        }
    }

    pub(super) fn pass(number: usize, pass: &PassShape) -> Self {
        let color = pass.color.iter().map(|a| Attachment {
            texture: a.texture.index(),
            mip: a.subresource.mip,
            layer: a.subresource.layer,
            load: format!("{:?}", a.load),
            store: format!("{:?}", a.store),
        });
        let depth_stencil = pass.depth_stencil.as_ref().map(|a| Attachment {
            texture: a.texture.index(),
            mip: a.subresource.mip,
            layer: a.subresource.layer,
            load: format!("depth {:?}, stencil {:?}", a.depth_load, a.stencil_load),
            store: format!("depth {:?}, stencil {:?}", a.depth_store, a.stencil_store),
        });
        Self::RenderPass {
            pass: number,
            label: pass.label.clone(),
            color: color.collect(),
            depth_stencil,
        }
    }

    pub(super) fn draw(pass: usize, number: usize, d: &DrawShape) -> Self {
        let fragment = d.fragment.unwrap_or_default();
        Self::Draw {
            pass,
            draw: number,
            label: d.label.clone(),
            pipeline: d.pipeline.clone(),
            topology: format!("{:?}", d.primitive.topology),
            front_face: format!("{:?}", d.primitive.front_face),
            cull_mode: format!("{:?}", d.primitive.cull_mode),
            depth_clamp: d.primitive.depth_clamp,
            depth_stencil: format!("{:?}", d.depth_stencil),
            color_targets: d.color_targets.iter().map(|t| format!("{t:?}")).collect(),
            discards: fragment.discards,
            writes_depth: fragment.depth,
            vertex_stride: d.vertex_stride,
            indexed: d.indexed,
            first: d.first,
            count: d.count,
            instances: d.instances,
            stencil_reference: d.stencil_reference,
            viewport: d.viewport.map(|v| format!("{v:?}")),
            scissor: d.scissor.map(|s| [s.x, s.y, s.width, s.height]),
            textures: d.textures.iter().map(|b| b.texture.index()).collect(),
        }
    }
}
