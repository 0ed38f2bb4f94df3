//! Textures that coverage is added up in, and passes over the whole screen that make
//! visibility of them. All of them are of 8-bit channels, but for the visibility that
//! the horizon limits.

use gnomon_raster::state::{ColorTargetState, ColorWrites, DepthStencilState, PrimitiveState};
use gnomon_raster::{
    Format, LoadOp, Recording, RenderPass, RenderPipeline, TextureDescriptor, TextureId,
};
use gnomon_shaders::split_volumes::resolve::{ResolveSplit, UNITS};
use gnomon_shaders::transform::FullScreen;

use super::settings::OptimisedSettings;
use crate::parts::visibility::{VisibilityTexture, attachment, binding, full_screen};
use crate::technique::TechniqueError;

/// Textures that coverage is added up in.
pub(super) struct Buffers {
    size: [u32; 2],
    /// The frame's, whose stencil holds the hard count of a group.
    depth_stencil: TextureId,
    /// One for all colours, or one each.
    colours: Vec<ColourBuffers>,
    visibility: VisibilityTexture,
}

/// Textures of one colour of the light.
#[derive(Clone, Copy)]
struct ColourBuffers {
    /// Additive and subtractive coverage of a group.
    split: [TextureId; 2],
    /// What groups hide, before and after the last, where there are several.
    groups: Option<[TextureId; 2]>,
    /// What is seen of a light's parts, before and after the last, where there are several.
    parts: Option<[TextureId; 2]>,
}

impl Buffers {
    pub(super) fn create(
        size: [u32; 2],
        depth_stencil: TextureId,
        settings: &OptimisedSettings,
        recording: &mut Recording,
    ) -> Result<Self, TechniqueError> {
        let mut colours = Vec::new();
        for _ in 0..settings.colours() {
            colours.push(ColourBuffers {
                split: pair(["coverage added", "coverage taken"], size, recording)?,
                groups: None,
                parts: None,
            });
        }
        let mut visibility = |format| {
            let desc = TextureDescriptor::d2("visibility", format, size[0], size[1]);
            recording.create(&desc)
        };
        let visibility = if colours.len() > 1 {
            VisibilityTexture {
                coloured: true,
                ..VisibilityTexture::red(visibility(Format::Rgba8Unorm)?)
            }
        } else if settings.soft.horizon {
            VisibilityTexture::red(visibility(Format::R32Float)?)
        } else {
            VisibilityTexture::bytes(visibility(Format::Rg8Unorm)?, 1.0 / UNITS)
        };
        Ok(Self {
            size,
            depth_stencil,
            colours,
            visibility,
        })
    }

    pub(super) fn visibility(&self) -> VisibilityTexture {
        self.visibility
    }

    /// The additive and the subtractive buffer of each colour.
    pub(super) fn split(&self) -> Vec<[TextureId; 2]> {
        self.colours.iter().map(|c| c.split).collect()
    }

    /// After group number `group`, which is not the last.
    pub(super) fn group_pass(
        &mut self,
        label: String,
        shader: ResolveSplit,
        [colour, group]: [usize; 2],
        recording: &mut Recording,
    ) -> Result<RenderPass, TechniqueError> {
        let of = &mut self.colours[colour];
        let groups = made(
            &mut of.groups,
            ["hidden", "hidden before"],
            self.size,
            recording,
        )?;
        let before = (group > 0).then(|| groups[(group + 1) % 2]);
        Ok(self.pass(label, shader, colour, [before, None], groups[group % 2]))
    }

    /// After the last group, number `group`, of part number `part`, which is not the last.
    pub(super) fn part_pass(
        &mut self,
        label: String,
        shader: ResolveSplit,
        [colour, group, part]: [usize; 3],
        recording: &mut Recording,
    ) -> Result<RenderPass, TechniqueError> {
        let of = &mut self.colours[colour];
        let parts = made(
            &mut of.parts,
            ["parts", "parts before"],
            self.size,
            recording,
        )?;
        let before = of.before([group, part]);
        Ok(self.pass(label, shader, colour, before, parts[part % 2]))
    }

    /// After the last group, number `group`, of the last part, number `part`.
    pub(super) fn visibility_pass(
        &self,
        label: String,
        shader: ResolveSplit,
        [colour, group, part]: [usize; 3],
    ) -> RenderPass {
        let before = self.colours[colour].before([group, part]);
        let mut pass = self.pass(label, shader, colour, before, self.visibility.texture);
        if colour > 0 {
            pass.color[0].load = LoadOp::Load;
        }
        pass
    }

    fn pass(
        &self,
        label: String,
        shader: ResolveSplit,
        colour: usize,
        before: [Option<TextureId>; 2],
        to: TextureId,
    ) -> RenderPass {
        let [added, taken] = self.colours[colour].split;
        let sources = [added, taken, self.depth_stencil].into_iter();
        let sources = sources.chain(before.into_iter().flatten()).map(binding);
        let pipeline = RenderPipeline {
            label: label.clone(),
            vertex: FullScreen.stage(),
            fragment: Some(shader.stage()),
            primitive: PrimitiveState::default(),
            depth_stencil: DepthStencilState::default(),
            color_targets: vec![ColorTargetState {
                write_mask: self.channels(to, colour),
                ..ColorTargetState::OPAQUE
            }],
        };
        RenderPass {
            label,
            color: vec![attachment(to, LoadOp::DontCare)],
            depth_stencil: None,
            draws: vec![full_screen(pipeline, sources.collect())],
        }
    }

    /// Of a visibility in colours the colour's own.
    fn channels(&self, to: TextureId, colour: usize) -> ColorWrites {
        if to != self.visibility.texture || self.colours.len() == 1 {
            return ColorWrites::ALL;
        }
        ColorWrites(1 << colour)
    }
}

impl ColourBuffers {
    /// Groups and parts before these numbers.
    fn before(&self, [group, part]: [usize; 2]) -> [Option<TextureId>; 2] {
        let latest = |of: Option<[TextureId; 2]>, number: usize| {
            of.filter(|_| number > 0).map(|pair| pair[(number + 1) % 2])
        };
        [latest(self.groups, group), latest(self.parts, part)]
    }
}

/// The textures as they are, or new ones.
fn made(
    of: &mut Option<[TextureId; 2]>,
    labels: [&str; 2],
    size: [u32; 2],
    recording: &mut Recording,
) -> Result<[TextureId; 2], TechniqueError> {
    let textures = match *of {
        Some(textures) => textures,
        None => pair(labels, size, recording)?,
    };
    *of = Some(textures);
    Ok(textures)
}

/// Two textures of four 8-bit channels.
fn pair(
    labels: [&str; 2],
    [width, height]: [u32; 2],
    recording: &mut Recording,
) -> Result<[TextureId; 2], TechniqueError> {
    let mut create = |label| {
        let desc = TextureDescriptor::d2(label, Format::Rgba8Unorm, width, height);
        recording.create(&desc)
    };
    Ok([create(labels[0])?, create(labels[1])?])
}
