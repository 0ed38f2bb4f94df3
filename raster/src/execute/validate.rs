//! Everything that can be wrong with a render pass, found before anything runs.

use crate::command::{Draw, IndexBuffer, RenderPass};
use crate::error::Error;
use crate::format::Format;
use crate::geometry::{GUARD_MAX, GUARD_MIN};
use crate::gpu::Gpu;
use crate::state::Sampler;
use crate::state::{BlendFactor, BlendState, DepthStencilState, ScissorRect, Viewport};
use crate::texture::{Texture, TextureId};
use crate::{
    MAX_CLIP_PLANES, MAX_COLOR_ATTACHMENTS, MAX_DRAW_VERTICES, MAX_INSTANCES, MAX_SHADER_COUNTS,
    MAX_TEXTURES, MAX_VARYINGS, MIN_VIEWPORT_SIDE,
};

/// Widest line and largest point, in pixels.
const MAX_WIDTH: f32 = 256.0;

pub(super) fn render_pass(gpu: &Gpu, pass: &RenderPass) -> Result<(), Error> {
    let attached = attachments(gpu, pass)?;
    pass.draws
        .iter()
        .try_for_each(|d| draw(gpu, pass, &attached, d))
}

/// Checks the attachments; gives their textures.
fn attachments(gpu: &Gpu, pass: &RenderPass) -> Result<Vec<TextureId>, Error> {
    let name = || pass.label.clone();
    if pass.color.len() > MAX_COLOR_ATTACHMENTS {
        return Err(Error::TooManyAttachments {
            pass: name(),
            given: pass.color.len(),
            limit: MAX_COLOR_ATTACHMENTS,
        });
    }
    let depth = pass
        .depth_stencil
        .as_ref()
        .map(|d| (d.texture, d.subresource, true));
    let all: Vec<_> = pass
        .color
        .iter()
        .map(|c| (c.texture, c.subresource, false))
        .chain(depth)
        .collect();
    let mut size = None;
    for (i, &(id, subresource, wants_depth)) in all.iter().enumerate() {
        let t = gpu.texture(id)?;
        t.check_subresource(subresource)?;
        check_format(pass, t, wants_depth)?;
        if all[..i]
            .iter()
            .any(|(other, s, _)| (*other, *s) == (id, subresource))
        {
            return Err(Error::AttachedTwice {
                pass: name(),
                texture: t.desc.label.clone(),
            });
        }
        let [w, h, _] = t.mip_size(subresource.mip);
        let expected = *size.get_or_insert([w, h]);
        if expected != [w, h] {
            return Err(Error::AttachmentSize {
                pass: name(),
                texture: t.desc.label.clone(),
                given: [w, h],
                expected,
            });
        }
    }
    if size.is_none() {
        return Err(Error::NoAttachment { pass: name() });
    }
    Ok(all.into_iter().map(|(id, ..)| id).collect())
}

fn check_format(pass: &RenderPass, t: &Texture, wants_depth: bool) -> Result<(), Error> {
    if t.desc.format.is_depth_stencil() == wants_depth {
        return Ok(());
    }
    Err(Error::AttachmentFormat {
        pass: pass.label.clone(),
        texture: t.desc.label.clone(),
        format: t.desc.format,
        wanted: if wants_depth {
            "depth-stencil"
        } else {
            "colour"
        },
    })
}

fn draw(gpu: &Gpu, pass: &RenderPass, attached: &[TextureId], d: &Draw) -> Result<(), Error> {
    color_targets(gpu, pass, d)?;
    if pass.depth_stencil.is_none() && d.pipeline.depth_stencil != DepthStencilState::default() {
        return Err(Error::NoDepthStencil {
            draw: d.label.clone(),
            pass: pass.label.clone(),
        });
    }
    primitive_state(d)?;
    if let Some(v) = &d.viewport {
        viewport(d, v)?;
    }
    if let Some(s) = &d.scissor {
        scissor(d, s)?;
    }
    depth_state(d)?;
    textures(gpu, attached, d)?;
    geometry(d)
}

fn limit(d: &Draw, what: &'static str, given: usize, limit: usize) -> Result<(), Error> {
    if given <= limit {
        Ok(())
    } else {
        Err(Error::Limit {
            draw: d.label.clone(),
            what,
            given,
            limit,
        })
    }
}

fn range(d: &Draw, what: &'static str, ok: bool, given: String, valid: &str) -> Result<(), Error> {
    if ok {
        Ok(())
    } else {
        Err(Error::OutOfRange {
            draw: d.label.clone(),
            what,
            given,
            valid: valid.to_owned(),
        })
    }
}

fn color_targets(gpu: &Gpu, pass: &RenderPass, d: &Draw) -> Result<(), Error> {
    let targets = &d.pipeline.color_targets;
    if targets.len() != pass.color.len() {
        return Err(Error::ColorTargetCount {
            draw: d.label.clone(),
            given: targets.len(),
            expected: pass.color.len(),
        });
    }
    for (i, (t, a)) in targets.iter().zip(&pass.color).enumerate() {
        let format = gpu.texture(a.texture)?.desc.format;
        let Some(reason) = t.blend.and_then(|b| why_unblendable(format, &b)) else {
            continue;
        };
        return Err(Error::Unblendable {
            draw: d.label.clone(),
            target: i,
            format,
            reason,
        });
    }
    Ok(())
}

fn why_unblendable(format: Format, b: &BlendState) -> Option<&'static str> {
    if !format.is_blendable() {
        return Some("the format takes no blending; set blend to None");
    }
    let simple = |f| matches!(f, BlendFactor::One | BlendFactor::Zero);
    let factors = [b.color.src_factor, b.color.dst_factor];
    (format == Format::R16Sint && !factors.iter().all(|&f| simple(f)))
        .then_some("R16Sint blends with factors One and Zero only")
}

fn primitive_state(d: &Draw) -> Result<(), Error> {
    let p = &d.pipeline.primitive;
    limit(
        d,
        "the number of clip planes",
        p.clip_planes.len(),
        MAX_CLIP_PLANES,
    )?;
    let planes_finite = p.clip_planes.iter().flatten().all(|v| v.is_finite());
    range(
        d,
        "clip plane",
        planes_finite,
        format!("{:?}", p.clip_planes),
        "all components must be finite",
    )?;
    for (what, v) in [("line width", p.line_width), ("point size", p.point_size)] {
        range(
            d,
            what,
            v > 0.0 && v <= MAX_WIDTH,
            v.to_string(),
            "valid is above 0, up to 256 pixels",
        )?;
    }
    limit(
        d,
        "the number of varyings",
        d.pipeline.vertex.0.varyings().len(),
        MAX_VARYINGS,
    )
}

fn viewport(d: &Draw, v: &Viewport) -> Result<(), Error> {
    let inside =
        |at: f32, size: f32| at >= GUARD_MIN && size >= MIN_VIEWPORT_SIDE && at + size <= GUARD_MAX;
    let ok = inside(v.x, v.width) && inside(v.y, v.height);
    range(
        d,
        "viewport",
        ok,
        format!("{v:?}"),
        "sizes must be at least 2⁻¹¹² (1.93e-34) and edges within -4096..=12288 pixels",
    )?;
    let unit = |z: f32| (0.0..=1.0).contains(&z);
    let ok = unit(v.min_depth) && unit(v.max_depth);
    range(
        d,
        "viewport depth",
        ok,
        format!("{}..{}", v.min_depth, v.max_depth),
        "valid is 0..=1",
    )
}

fn scissor(d: &Draw, s: &ScissorRect) -> Result<(), Error> {
    let ok = s.x.checked_add(s.width).is_some() && s.y.checked_add(s.height).is_some();
    range(
        d,
        "scissor",
        ok,
        format!("{s:?}"),
        "its far edges must fit in 32 bits",
    )
}

fn depth_state(d: &Draw) -> Result<(), Error> {
    let ds = &d.pipeline.depth_stencil;
    let b = ds.bias;
    let finite = b.constant.is_finite() && b.slope.is_finite() && b.clamp.is_finite();
    range(
        d,
        "depth bias",
        finite,
        format!("{b:?}"),
        "all parts must be finite",
    )?;
    let Some([lo, hi]) = ds.depth.bounds else {
        return Ok(());
    };
    let ok = (0.0..=1.0).contains(&lo) && (lo..=1.0).contains(&hi);
    range(
        d,
        "depth bounds",
        ok,
        format!("{lo}..{hi}"),
        "valid is 0 ≤ min ≤ max ≤ 1",
    )
}

fn textures(gpu: &Gpu, attached: &[TextureId], d: &Draw) -> Result<(), Error> {
    limit(d, "the number of textures", d.textures.len(), MAX_TEXTURES)?;
    let outputs = d.pipeline.fragment.as_ref().map(|f| f.0.outputs());
    let outputs = outputs.unwrap_or_default();
    let (reads, counts) = (outputs.textures, outputs.counts.len());
    limit(
        d,
        "the number of counts of the shader",
        counts,
        MAX_SHADER_COUNTS,
    )?;
    limit(
        d,
        "the number of texture slots the shader reads",
        reads,
        MAX_TEXTURES,
    )?;
    if reads > d.textures.len() {
        return Err(Error::MissingTexture {
            draw: d.label.clone(),
            slot: reads - 1,
            bound: d.textures.len(),
        });
    }
    for b in &d.textures {
        let t = gpu.texture(b.texture)?;
        if attached.contains(&b.texture) {
            return Err(Error::FeedbackLoop {
                draw: d.label.clone(),
                texture: t.desc.label.clone(),
            });
        }
        sampler(d, &b.sampler)?;
    }
    Ok(())
}

fn sampler(d: &Draw, s: &Sampler) -> Result<(), Error> {
    let ok = s.lod[0].is_finite()
        && s.lod[1].is_finite()
        && s.lod[0] <= s.lod[1]
        && s.lod_bias.is_finite();
    range(
        d,
        "sampler level of detail",
        ok,
        format!("{:?} bias {}", s.lod, s.lod_bias),
        "finite, min ≤ max",
    )
}

fn geometry(d: &Draw) -> Result<(), Error> {
    let what = "the number of vertices or indices";
    limit(d, what, d.count as usize, MAX_DRAW_VERTICES as usize)?;
    let what = "the number of instances";
    limit(d, what, d.instances as usize, MAX_INSTANCES as usize)?;
    let end = u64::from(d.first) + u64::from(d.count);
    let per = d.pipeline.primitive.topology.vertices();
    let primitives = u64::from(d.count / per) * u64::from(d.instances);
    range(
        d,
        "primitive count",
        primitives < 1 << 31,
        primitives.to_string(),
        "valid is below 2³¹",
    )?;
    let vertices = d.vertices.as_ref().map(|v| v.len());
    match &d.indices {
        Some(i) => indexed(d, i, end, vertices),
        None => {
            let ok = vertices.map_or(end <= 1 << 31, |n| end <= n as u64);
            let most = vertices.map_or(1 << 31, |n| n as u64);
            range(
                d,
                "vertex range",
                ok,
                format!("{}..{end}", d.first),
                &format!("the vertices end at {most}"),
            )
        }
    }
}

fn indexed(d: &Draw, buffer: &IndexBuffer, end: u64, vertices: Option<usize>) -> Result<(), Error> {
    let indices = buffer.indices();
    let ok = end <= indices.len() as u64;
    range(
        d,
        "index range",
        ok,
        format!("{}..{end}", d.first),
        &format!("the indices end at {}", indices.len()),
    )?;
    let n = vertices.unwrap_or(1 << 31);
    if buffer.largest().is_none_or(|i| (i as usize) < n) {
        return Ok(());
    }
    let used = &indices[d.first as usize..end as usize];
    match used.iter().position(|&i| i as usize >= n) {
        Some(at) => Err(Error::IndexOutOfRange {
            draw: d.label.clone(),
            index: used[at],
            at: d.first as usize + at,
            vertices: n,
        }),
        None => Ok(()),
    }
}
