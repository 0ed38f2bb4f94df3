//! From labels and numbers to a texture and a moment of a frame.

use gnomon_raster::{Recording, Subresource, TextureDescriptor};
use gnomon_traces::Until;

use super::request::{ShowRequest, refuse};
use crate::error::CliError;
use crate::output::textures::Aspect;

/// What a request means in a frame.
pub(super) struct Found {
    /// Number of the texture.
    pub(super) texture: usize,
    pub(super) image: Subresource,
    pub(super) aspect: Aspect,
    pub(super) until: Until,
    /// What the picture shows.
    pub(super) title: String,
}

impl Found {
    pub(super) fn new(recording: &Recording, request: &ShowRequest) -> Result<Self, CliError> {
        let (until, moment) = moment(recording, request)?;
        let (texture, image, aspect) = buffer(recording, request)?;
        let descriptor = recording.textures()[texture].descriptor();
        let level = match (image.mip, image.layer) {
            (0, 0) => String::new(),
            (mip, layer) => format!(", level {mip}, layer {layer}"),
        };
        let title = format!(
            "{}{} of `{}` ({:?}{level}) {moment}",
            aspect.name()[..1].to_uppercase(),
            &aspect.name()[1..],
            descriptor.label,
            descriptor.format,
        );
        Ok(Self {
            texture,
            image,
            aspect,
            until,
            title,
        })
    }
}

/// Number of the label, or the number itself; the first of several of a label.
fn number(text: &str, labels: &[&str]) -> Option<usize> {
    let labelled = labels.iter().position(|l| *l == text);
    labelled.or_else(|| text.parse().ok().filter(|n| *n < labels.len()))
}

fn moment(recording: &Recording, request: &ShowRequest) -> Result<(Until, String), CliError> {
    let Some(pass_text) = &request.pass else {
        return Ok((Until::End, "at the end of the frame".to_owned()));
    };
    let passes = &recording.list.passes;
    let labels: Vec<&str> = passes.iter().map(|p| p.label.as_str()).collect();
    let pass = number(pass_text, &labels)
        .ok_or_else(|| refuse(request, listed("the frame has the passes", &labels)))?;
    let label = &passes[pass].label;
    let Some(draw_text) = &request.draw else {
        return Ok((Until::Pass(pass), format!("after pass {pass} `{label}`")));
    };
    let draws: Vec<&str> = passes[pass]
        .draws
        .iter()
        .map(|d| d.label.as_str())
        .collect();
    let draw = number(draw_text, &draws).ok_or_else(|| {
        refuse(
            request,
            listed(&format!("pass {pass} `{label}` has the draws"), &draws),
        )
    })?;
    let said = format!(
        "after draw {draw} `{}` of pass {pass} `{label}`",
        draws[draw]
    );
    Ok((Until::Draw([pass, draw]), said))
}

/// Names that an error lists.
const LISTED: usize = 24;

fn listed(what: &str, labels: &[&str]) -> String {
    let all = labels.iter().enumerate().take(LISTED);
    let mut names: Vec<String> = all.map(|(i, l)| format!("{i} {l}")).collect();
    if labels.len() > LISTED {
        names.push(format!("and {} more", labels.len() - LISTED));
    }
    match names.is_empty() {
        true => format!("{what} none"),
        false => format!("{what} {}", names.join(", ")),
    }
}

type Buffer = (usize, Subresource, Aspect);

/// `LABEL`, `LABEL.depth`, `LABEL.stencil`, or a number instead of the label; `:MIP` and
/// `:LAYER` behind it.
fn buffer(recording: &Recording, request: &ShowRequest) -> Result<Buffer, CliError> {
    let textures = recording.textures();
    let descriptors: Vec<&TextureDescriptor> = textures.iter().map(|t| t.descriptor()).collect();
    let labels: Vec<&str> = descriptors.iter().map(|d| d.label.as_str()).collect();
    let mut parts = request.buffer.split(':');
    let name = parts.next().unwrap_or_default();
    let index = parts.map(str::parse::<u32>).collect::<Result<Vec<_>, _>>();
    let (name, wanted) = match name.rsplit_once('.') {
        Some((label, "depth")) => (label, Some(Aspect::Depth)),
        Some((label, "stencil")) => (label, Some(Aspect::Stencil)),
        _ => (name, None),
    };
    let found = number(name, &labels)
        .ok_or_else(|| refuse(request, listed("the frame has the textures", &labels)))?;
    let descriptor = descriptors[found];
    let aspect = aspect(descriptor, wanted).map_err(|valid| refuse(request, valid))?;
    let image = match index.as_deref() {
        Ok([]) => Some(Subresource::default()),
        Ok([mip]) => Some(Subresource {
            mip: *mip,
            layer: 0,
        }),
        Ok([mip, layer]) => Some(Subresource {
            mip: *mip,
            layer: *layer,
        }),
        _ => None,
    };
    let image = image.filter(|i| descriptor.images().any(|known| known == *i));
    let image = image.ok_or_else(|| {
        let last = descriptor.images().last().unwrap_or_default();
        let valid = format!(
            "behind the texture may stand :MIP and :LAYER, up to :{}:{}",
            last.mip, last.layer
        );
        refuse(request, valid)
    })?;
    Ok((found, image, aspect))
}

fn aspect(of: &TextureDescriptor, wanted: Option<Aspect>) -> Result<Aspect, String> {
    match (of.format.is_depth_stencil(), wanted) {
        (true, wanted) => Ok(wanted.unwrap_or(Aspect::Depth)),
        (false, None) => Ok(Aspect::Color),
        (false, Some(_)) => Err(format!(
            "`{}` is {:?}: it has neither depth nor stencil",
            of.label, of.format
        )),
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use gnomon_raster::state::{DepthStencilState, PrimitiveState};
    use gnomon_raster::{
        ColorAttachment, Draw, Format, LoadOp, RenderPass, RenderPipeline, StoreOp,
        TextureDimension,
    };
    use gnomon_shaders::transform::FullScreen;

    use super::*;

    /// A cube of three levels, and a pass with two draws.
    fn recording() -> Recording {
        let mut r = Recording::default();
        let cube = TextureDescriptor {
            mip_levels: 3,
            dimension: TextureDimension::Cube,
            ..TextureDescriptor::d2("cube", Format::Rgba8Unorm, 8, 8)
        };
        let texture = r.create(&cube).unwrap();
        let pipeline = Arc::new(RenderPipeline {
            label: "sky".into(),
            vertex: FullScreen.stage(),
            fragment: None,
            primitive: PrimitiveState::default(),
            depth_stencil: DepthStencilState::default(),
            color_targets: Vec::new(),
        });
        let draw = |label: &str| Draw::vertices_only(label, &pipeline, 3);
        r.list.passes = vec![RenderPass {
            label: "sky".into(),
            color: vec![ColorAttachment {
                texture,
                subresource: Subresource::default(),
                load: LoadOp::Load,
                store: StoreOp::Store,
            }],
            depth_stencil: None,
            draws: vec![draw("first"), draw("second")],
        }];
        r
    }

    fn found(text: &str) -> Found {
        let request = ShowRequest::parse(text).unwrap();
        Found::new(&recording(), &request).unwrap()
    }

    #[test]
    fn levels_and_layers_are_those_that_were_asked_for() {
        for (text, mip, layer) in [
            ("cube", 0, 0),
            ("cube:2", 2, 0),
            ("cube:1:5", 1, 5),
            ("0:0:3", 0, 3),
        ] {
            assert_eq!(found(text).image, Subresource { mip, layer }, "{text}");
        }
    }

    #[test]
    fn moments_are_those_that_were_asked_for() {
        for (text, until) in [
            ("cube", Until::End),
            ("cube@sky", Until::Pass(0)),
            ("cube@sky/first", Until::Draw([0, 0])),
            ("cube@0/1", Until::Draw([0, 1])),
        ] {
            assert_eq!(found(text).until, until, "{text}");
        }
    }
}
