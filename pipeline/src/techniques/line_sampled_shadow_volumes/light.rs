//! One light: its hard volumes, its lines, and the edges before it.

use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
use gnomon_raster::{LoadOp, Recording, RenderPass, RenderPipeline, TextureId};
use gnomon_shaders::line_samples::{LightSums, LineSamples, LineSource};
use gnomon_shaders::transform::FullScreen;

use super::image::{STEPS, sums};
use super::settings::LineSettings;
use super::tables::{self, Kept, SourceFrame};
use super::{LineFrame, NAME};
use crate::geometry::line_sampling::edges::{ContourEdge, LineCasters};
use crate::geometry::line_sampling::kept_lists::KeptLists;
use crate::geometry::line_sampling::light::{Extent, Line, LineLight, double_area};
use crate::geometry::line_sampling::lists::{BlockLists, Culling};
use crate::geometry::line_sampling::shaft::Bounds;
use crate::parts::shadowed_frame::LightTurn;
use crate::parts::tables::table;
use crate::parts::visibility::{attachment, binding, full_screen};
use crate::parts::wedges::soft::light::light_origin;
use crate::technique::{Figure, Pass, PassRole, TechniqueError};
use crate::world::light::Light;
use crate::world::mesh::narrow;

/// Depth's rounding, in steps of 24 bits, times what the shader makes of a pixel's.
const DEPTH_STEPS: f64 = 8.0 / 16_777_216.0;
/// Heights that are neither before nor behind a plane, as a share of coordinates.
const SLACK: f64 = 1e-5;

/// The passes of a light, which leave its visibility; lists for the next frame go to `left`.
pub(super) fn passes(
    frame: &LineFrame<'_>,
    turn: &mut LightTurn<'_, '_>,
    left: &mut KeptLists,
) -> Result<Vec<Pass>, TechniqueError> {
    let volumes = frame.volumes.volumes(turn.number, turn.light().hard(), &[]);
    let counted = !volumes
        .warnings
        .iter()
        .any(|w| w.code == "stencil-overflow");
    turn.notes.casters.extend(volumes.uses);
    turn.notes.warnings.extend(volumes.warnings);
    let hard = RenderPass {
        label: turn.label("volumes"),
        color: Vec::new(),
        depth_stencil: turn.targets.depth_stencil(LoadOp::Load, LoadOp::Clear(0)),
        draws: volumes.draws,
    };
    let (shader, textures) = LightLines::of(frame, turn, counted, left)?;
    let pipeline = RenderPipeline {
        label: "lines".into(),
        vertex: FullScreen.stage(),
        fragment: Some(shader.stage()),
        primitive: PrimitiveState::default(),
        depth_stencil: DepthStencilState::default(),
        color_targets: vec![ColorTargetState::OPAQUE],
    };
    let lines = RenderPass {
        label: turn.label("lines"),
        color: vec![attachment(
            frame.visibility.texture,
            LoadOp::Clear([1.0; 4]),
        )],
        depth_stencil: None,
        draws: vec![full_screen(pipeline, textures.map(binding).to_vec())],
    };
    Ok(vec![
        Pass::new(PassRole::Volumes, hard),
        Pass::new(PassRole::LineSamples, lines),
    ])
}

/// What a light has in textures.
struct LightLines;

impl LightLines {
    fn of(
        frame: &LineFrame<'_>,
        turn: &mut LightTurn<'_, '_>,
        counted: bool,
        left: &mut KeptLists,
    ) -> Result<(LineSamples, [TextureId; 8]), TechniqueError> {
        let light = line_light(turn.light(), turn.number, frame.settings.angle)?;
        let casters = frame.casters_of(turn.light());
        let lines = light
            .as_ref()
            .map_or_else(Vec::new, |l| l.lines(frame.settings.lines));
        let recording = &mut *turn.recording;
        let (table_of_lines, coloured) = line_table(
            frame.settings,
            (turn.number, &turn.scene.lights[turn.number]),
            (light.as_ref(), &lines),
            recording,
        )?;
        let work = Work::new(frame, &casters, light.as_ref(), left);
        let source = SourceFrame::of(
            frame,
            turn.scene.lights[turn.number].clone(),
            light.as_ref(),
        );
        let all = (!frame.settings.skip && light.is_some()).then_some(work.edges.len());
        let lists = tables::lists(&work.lists, all, recording)?;
        let (edges, planes) = tables::edges(&source, &work.edges, &casters.planes, recording)?;
        let boxes = tables::boxes(&casters.facets, frame.view(), recording)?;
        let tables: [Kept; 5] = [
            table_of_lines,
            lists.lists,
            edges,
            boxes.nodes,
            boxes.facets,
        ];
        let shader = LineSamples {
            source: source.uniform(frame, light.as_ref()),
            lines: lines.len() as u32,
            spacing: spacing(&lines),
            whole: if coloured { 1.0 } else { whole(&lines) },
            corners: corners(light.as_ref()).len() as u32,
            double_area: match light.as_ref().map(|l| &l.extent) {
                Some(Extent::Polygon(outline)) => double_area(outline) as f32,
                _ => 0.0,
            },
            straight: lines
                .windows(2)
                .all(|l| l[0].slope as f32 == l[1].slope as f32),
            sums: LightSums {
                steps: if coloured { STEPS } else { 0 },
            },
            tables: tables.map(|(_, table)| table),
            planes,
            nodes: boxes.count,
            counted,
            depth_step: (DEPTH_STEPS / frame.view().camera().near) as f32,
            all: lists.all,
        };
        let label = turn.labels();
        let figure = |what: &str, value: f64| Figure {
            name: label(what),
            value,
        };
        turn.notes.figures.extend([
            figure("candidate-edges", work.edges.len() as f64),
            figure("list-entries", work.lists.len() as f64),
            figure("list-tests", work.lists.tests as f64),
            figure("list-bytes", lists.bytes as f64),
        ]);
        let [a, b, c, d, e] = tables.map(|(texture, _)| texture);
        let depth = turn.targets.depth_texture();
        let textures = [frame.positions.texture, depth, a, lists.blocks, b, c, d, e];
        Ok((shader, textures))
    }
}

fn line_light(
    light: &Light,
    number: usize,
    angle: f64,
) -> Result<Option<LineLight>, TechniqueError> {
    LineLight::new(&light.shape, angle).map_err(|why| TechniqueError::UnsuitableLight {
        technique: NAME,
        light: number,
        why: why.to_string(),
        valid: "rectangles, convex polygons, discs and spheres, and points and directions for \
                hard shadows",
    })
}

/// Lines, and sums of the image where there is one and the light has lines.
fn line_table(
    settings: &LineSettings,
    (number, source): (usize, &Light),
    (light, lines): (Option<&LineLight>, &[Line]),
    recording: &mut Recording,
) -> Result<(Kept, bool), TechniqueError> {
    let texel = |l: &Line| [l.y, l.left, l.right, l.slope].map(|v| v as f32);
    let mut texels: Vec<[f32; 4]> = lines.iter().map(texel).collect();
    texels.extend(corners(light));
    let coloured = match (&settings.image, light) {
        (Some(image), Some(light)) => {
            let sums = sums(&source.shape, light, lines, image);
            texels.extend(sums.ok_or_else(|| TechniqueError::UnsuitableLight {
                technique: NAME,
                light: number,
                why: "an image was asked for on a light that is no rectangle".to_owned(),
                valid: "rectangles for light-image",
            })?);
            true
        }
        _ => false,
    };
    Ok((table("lines", texels, recording)?, coloured))
}

/// Corners of a polygon, each with the next.
fn corners(light: Option<&LineLight>) -> Vec<[f32; 4]> {
    let Some(Extent::Polygon(outline)) = light.map(|l| &l.extent) else {
        return Vec::new();
    };
    let next = outline.iter().cycle().skip(1);
    let both = |(a, b): (&[f64; 2], &[f64; 2])| [a[0], a[1], b[0], b[1]].map(|v| v as f32);
    outline.iter().zip(next).map(both).collect()
}

/// What is found out on the CPU: edges, and which matter where.
struct Work {
    edges: Vec<ContourEdge>,
    lists: BlockLists,
}

impl Work {
    /// `left` gets what the next frame may need.
    fn new(
        frame: &LineFrame<'_>,
        casters: &LineCasters,
        light: Option<&LineLight>,
        left: &mut KeptLists,
    ) -> Self {
        let Some(light) = light else {
            let size = frame.blocks.size;
            let lists = BlockLists {
                size,
                starts: vec![0; (size[0] * size[1]) as usize + 1],
                ..BlockLists::default()
            };
            return Self {
                edges: Vec::new(),
                lists,
            };
        };
        let numbers = candidates(frame, casters, light);
        let edges = numbers.iter().map(|k| casters.edges[*k as usize]);
        let edges: Vec<ContourEdge> = edges.collect();
        let ends = casters.ends_of(&numbers);
        let culling = Culling::new((&edges, &ends), &casters.planes, light);
        let mut lists = match frame.before {
            None => culling.lists(&frame.blocks),
            Some(before) => {
                let (lists, own) = culling.lists_after(&frame.blocks, before);
                left.join(own);
                lists
            }
        };
        if frame.settings.skip {
            return Self { edges, lists };
        }
        for entry in &mut lists.entries {
            *entry = numbers[*entry as usize];
        }
        let edges = casters.edges.clone();
        Self { edges, lists }
    }
}

/// Numbers of the edges that may be contours before the light for anything.
fn candidates(frame: &LineFrame<'_>, casters: &LineCasters, light: &LineLight) -> Vec<u32> {
    let centre = light.frame.centre;
    let blocks = frame.blocks.bounds.iter().filter(|b| !b.is_empty());
    let nearest = blocks.fold(f64::INFINITY, |least, b| least.min(b.distance(centre)));
    let growth = light.growth(nearest);
    if !growth.is_finite() {
        return (0..casters.edges.len() as u32).collect();
    }
    let corners = light.corners(growth);
    let ends = casters.facets.iter().flat_map(|f| f.corners);
    let largest = Bounds::of(ends.chain(corners.iter().copied())).largest();
    casters.candidates(&corners, SLACK * largest)
}

/// y of the first line, and the distance of lines.
fn spacing(lines: &[Line]) -> [f32; 2] {
    match lines {
        [] => [0.0, 1.0],
        [one] => [
            one.y as f32,
            (one.right - one.left).max(f64::MIN_POSITIVE) as f32,
        ],
        [first, second, ..] => [first.y as f32, (second.y - first.y) as f32],
    }
}

fn whole(lines: &[Line]) -> f32 {
    lines.iter().map(|l| l.right - l.left).sum::<f64>() as f32
}

impl SourceFrame {
    fn of(frame: &LineFrame<'_>, source: Light, light: Option<&LineLight>) -> Self {
        let (Some(light), crate::world::light::HardLight::Point(centre)) = (light, source.hard())
        else {
            return Self {
                origin: frame.view().camera().eye,
                axes: [glam::DVec3::X, glam::DVec3::Y, glam::DVec3::Z],
            };
        };
        Self {
            origin: light_origin(frame.view(), centre, frame.casters_size()).0,
            axes: light.frame.axes,
        }
    }

    fn uniform(&self, frame: &LineFrame<'_>, light: Option<&LineLight>) -> LineSource {
        let view = frame.view();
        let centre = light.map_or(self.origin, |l| l.frame.centre);
        LineSource {
            origin: narrow(view.relative(self.origin)),
            axes: self.axes.map(narrow),
            offset: narrow(self.direction(self.origin - centre)),
            centre: narrow(view.relative(centre)),
            eye: narrow(self.direction(view.camera().eye - self.origin)),
            radius: match light.map(|l| &l.extent) {
                Some(Extent::Sphere(radius)) => *radius as f32,
                _ => 0.0,
            },
        }
    }
}
