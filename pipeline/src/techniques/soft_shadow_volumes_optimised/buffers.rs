//! Textures that coverage is added up in, and passes over the whole screen that make
//! visibility of them. All of them are of 8-bit channels, but for the visibility that
//! `horizon=on` limits.

use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
use gnomon_raster::{
    Format, LoadOp, Recording, RenderPass, RenderPipeline, TextureDescriptor, TextureId,
};
use gnomon_shaders::split_volumes::resolve::{ResolveSplit, UNITS};
use gnomon_shaders::transform::FullScreen;

use crate::parts::visibility::{VisibilityTexture, attachment, binding, full_screen};
use crate::technique::TechniqueError;

/// Textures that coverage is added up in.
pub(super) struct Buffers {
    size: [u32; 2],
    /// Additive and subtractive coverage of a group.
    pub(super) split: [TextureId; 2],
    /// The frame's, whose stencil holds the hard count of a group.
    depth_stencil: TextureId,
    /// What groups hide, before and after the last, where there are several.
    groups: Option<[TextureId; 2]>,
    /// What is seen of a light's parts, before and after the last, where there are several.
    parts: Option<[TextureId; 2]>,
    visibility: VisibilityTexture,
}

impl Buffers {
    pub(super) fn create(
        size: [u32; 2],
        depth_stencil: TextureId,
        horizon: bool,
        recording: &mut Recording,
    ) -> Result<Self, TechniqueError> {
        let mut create = |label: &str, format| {
            recording.create(&TextureDescriptor::d2(label, format, size[0], size[1]))
        };
        Ok(Self {
            size,
            split: [
                create("coverage added", Format::Rgba8Unorm)?,
                create("coverage taken", Format::Rgba8Unorm)?,
            ],
            depth_stencil,
            groups: None,
            parts: None,
            visibility: if horizon {
                VisibilityTexture::red(create("visibility", Format::R32Float)?)
            } else {
                let texture = create("visibility", Format::Rg8Unorm)?;
                VisibilityTexture::bytes(texture, 1.0 / UNITS)
            },
        })
    }

    pub(super) fn visibility(&self) -> VisibilityTexture {
        self.visibility
    }

    /// After group number `group`, which is not the last.
    pub(super) fn group_pass(
        &mut self,
        label: String,
        shader: ResolveSplit,
        group: usize,
        recording: &mut Recording,
    ) -> Result<RenderPass, TechniqueError> {
        let groups = self.groups(recording)?;
        let before = (group > 0).then(|| groups[(group + 1) % 2]);
        Ok(self.pass(label, shader, [before, None], groups[group % 2]))
    }

    /// After the last group, number `group`, of part number `part`, which is not the last.
    pub(super) fn part_pass(
        &mut self,
        label: String,
        shader: ResolveSplit,
        [group, part]: [usize; 2],
        recording: &mut Recording,
    ) -> Result<RenderPass, TechniqueError> {
        let parts = self.parts(recording)?;
        let before = self.before([group, part]);
        Ok(self.pass(label, shader, before, parts[part % 2]))
    }

    /// After the last group, number `group`, of the last part, number `part`.
    pub(super) fn visibility_pass(
        &self,
        label: String,
        shader: ResolveSplit,
        [group, part]: [usize; 2],
    ) -> RenderPass {
        let before = self.before([group, part]);
        self.pass(label, shader, before, self.visibility.texture)
    }

    /// Groups and parts before these numbers.
    fn before(&self, [group, part]: [usize; 2]) -> [Option<TextureId>; 2] {
        let latest = |of: Option<[TextureId; 2]>, number: usize| {
            of.filter(|_| number > 0).map(|pair| pair[(number + 1) % 2])
        };
        [latest(self.groups, group), latest(self.parts, part)]
    }

    fn groups(&mut self, recording: &mut Recording) -> Result<[TextureId; 2], TechniqueError> {
        let made = pair(
            self.groups,
            ["hidden", "hidden before"],
            self.size,
            recording,
        )?;
        self.groups = Some(made);
        Ok(made)
    }

    fn parts(&mut self, recording: &mut Recording) -> Result<[TextureId; 2], TechniqueError> {
        let made = pair(self.parts, ["parts", "parts before"], self.size, recording)?;
        self.parts = Some(made);
        Ok(made)
    }

    fn pass(
        &self,
        label: String,
        shader: ResolveSplit,
        before: [Option<TextureId>; 2],
        to: TextureId,
    ) -> RenderPass {
        let [added, taken] = self.split;
        let sources = [added, taken, self.depth_stencil].into_iter();
        let sources = sources.chain(before.into_iter().flatten()).map(binding);
        let pipeline = RenderPipeline {
            label: label.clone(),
            vertex: FullScreen.stage(),
            fragment: Some(shader.stage()),
            primitive: PrimitiveState::default(),
            depth_stencil: DepthStencilState::default(),
            color_targets: vec![ColorTargetState::OPAQUE],
        };
        RenderPass {
            label,
            color: vec![attachment(to, LoadOp::DontCare)],
            depth_stencil: None,
            draws: vec![full_screen(pipeline, sources.collect())],
        }
    }
}

/// The textures as they are, or new ones of four 8-bit channels.
fn pair(
    made: Option<[TextureId; 2]>,
    labels: [&str; 2],
    [width, height]: [u32; 2],
    recording: &mut Recording,
) -> Result<[TextureId; 2], TechniqueError> {
    if let Some(made) = made {
        return Ok(made);
    }
    let mut create = |label| {
        recording.create(&TextureDescriptor::d2(
            label,
            Format::Rgba8Unorm,
            width,
            height,
        ))
    };
    Ok([create(labels[0])?, create(labels[1])?])
}
