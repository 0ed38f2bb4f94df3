//! Without an environment: each light of the scene is one of the lights that cast shadow,
//! and its visibility is what the receiver itself leaves of it times what other objects
//! do; the light is then added as every technique does.

use std::sync::Arc;

use gnomon_raster::state::ColorTargetState;
use gnomon_raster::{
    Draw, Format, LoadOp, RenderPass, RenderPipeline, TextureDescriptor, TextureId, VertexBuffer,
};
use gnomon_shaders::deferred::obscured::{DistantVisibility, OcclusionMap, Transported};

use super::atlas::{Atlas, Occluders};
use super::bodies::{Body, Evaluation, bodies, normal_of};
use super::environment::bilinear;
use super::keeping::Keeping;
use super::notes::Found;
use super::settings::Settings;
use super::shadows::{Job, Receivers, turns};
use super::sheets::{Sheet, Sheets};
use super::sources::Source;
use crate::parts::passes::{LitTest, SceneDraws, equal_depth};
use crate::parts::shadowed_frame::{LightTurn, ShadowedFrame};
use crate::parts::visibility::{VisibilityTexture, attachment};
use crate::technique::{Frame, KeptPictures, Pass, PassRole, TechniqueError};
use crate::world::mesh::widen;
use crate::world::scene::Scene;

/// The frame of a scene with lights of its own.
pub(super) fn frame(
    scene: &Scene,
    (size, before): ([u32; 2], Option<&KeptPictures>),
    settings: &Settings,
) -> Result<Frame, TechniqueError> {
    let mut frame = ShadowedFrame::new(scene, size, &settings.frame)?.with_ambient();
    let bodies = bodies(scene, &frame.draws, settings);
    let receivers = Receivers::new(&bodies, settings);
    let maps = receivers.most_maps();
    let atlas = Atlas::create(
        maps,
        settings.side,
        settings.half_floats,
        &mut frame.recording,
    )?;
    let desc = TextureDescriptor::d2("visibility", Format::R32Float, size[0], size[1]);
    let visibility = frame.recording.create(&desc)?;
    let distant = Distant {
        bodies: &bodies,
        receivers: &receivers,
        atlas: &atlas,
        settings,
        visibility,
    };
    let mut found = Found::of(&bodies);
    found.lights(frame.lights.len(), settings);
    let test = LitTest::Visibility(VisibilityTexture::red(visibility));
    let last = frame.lights.first().copied();
    let mut keeping = before.map(|before| Keeping::new(before, &frame.draws));
    let frame = frame.lit(test, |turn| {
        let passes = distant.passes(turn, &mut found, keeping.as_mut())?;
        if Some(turn.number) == last {
            found.keeping(keeping.as_ref());
            found.tell(&bodies, turn.notes);
        }
        Ok(passes)
    })?;
    Ok(Frame {
        keep: keeping.map_or(Vec::new(), Keeping::finish),
        ..frame
    })
}

struct Distant<'f, 'a> {
    bodies: &'f [Body<'a>],
    receivers: &'f Receivers<'f, 'a>,
    atlas: &'f Atlas,
    settings: &'f Settings,
    visibility: TextureId,
}

impl<'a> Distant<'_, 'a> {
    fn passes(
        &self,
        turn: &mut LightTurn<'_, 'a>,
        found: &mut Found,
        mut keeping: Option<&mut Keeping<'_>>,
    ) -> Result<Vec<Pass>, TechniqueError> {
        let label = turn.labels();
        let source = Source::of_light(turn.light());
        let jobs = self.receivers.jobs(0, &source, self.settings, |_| true);
        found.maps.add(&jobs);
        let sheets = Sheets::new(self.bodies, turn.draws);
        let (turns, left_out) = turns(jobs, self.atlas.capacity());
        found.maps.left_out += left_out;
        // What nothing else shades is shaded by itself, before all others.
        let mut passes = vec![self.own(turn, &sheets, &source, &label)];
        for jobs in turns.iter().filter(|t| t.iter().any(Job::hides)) {
            let occluders = Occluders {
                bodies: self.bodies,
                draws: turn.draws,
                label: &label,
            };
            let keeping = keeping.as_deref_mut();
            let own = self.atlas.fill(jobs, &occluders, turn.recording, keeping)?;
            passes.extend(own.passes);
            passes.push(self.looked_up(turn, &sheets, &source, (jobs, own.maps), &label));
        }
        Ok(passes)
    }

    /// Self-visibility of every body that takes shadow.
    fn own(
        &self,
        turn: &LightTurn<'_, 'a>,
        sheets: &Sheets<'_, 'a>,
        source: &Source,
        label: &dyn Fn(&str) -> String,
    ) -> Pass {
        let receives = |s: &&Sheet<'_, '_>| s.surface.object.receives;
        let own = sheets.all.iter().filter(receives);
        let nothing = self.atlas.shared();
        let draws = own.map(|s| self.draw(turn.draws, s, source, (Vec::new(), nothing)));
        self.pass(
            turn,
            LoadOp::Clear([1.0; 4]),
            draws.collect(),
            label("self-visibility"),
        )
    }

    /// The same of the bodies of `jobs`, less what their maps take.
    fn looked_up(
        &self,
        turn: &LightTurn<'_, 'a>,
        sheets: &Sheets<'_, 'a>,
        source: &Source,
        (jobs, texture): (&[Job], TextureId),
        label: &dyn Fn(&str) -> String,
    ) -> Pass {
        let (mut cell, mut draws) = (0, Vec::new());
        for job in jobs {
            let look_up = |(k, map)| self.atlas.look_up(map, cell + k, turn.view());
            let maps: Vec<_> = job.placed().map(look_up).collect();
            cell += job.maps.len();
            let hidden = !maps.is_empty();
            let own = sheets.all.iter().filter(|s| hidden && s.body == job.body);
            draws.extend(own.map(|s| self.draw(turn.draws, s, source, (maps.clone(), texture))));
        }
        self.pass(turn, LoadOp::Load, draws, label("occlusion"))
    }

    fn pass(
        &self,
        turn: &LightTurn<'_, 'a>,
        load: LoadOp<[f32; 4]>,
        draws: Vec<Draw>,
        label: String,
    ) -> Pass {
        let pass = RenderPass {
            label,
            color: vec![attachment(self.visibility, load)],
            depth_stencil: turn.targets.depth_stencil(LoadOp::Load, LoadOp::Load),
            draws,
        };
        Pass::new(PassRole::LookUp, pass)
    }

    fn draw(
        &self,
        draws: &SceneDraws<'_>,
        sheet: &Sheet<'_, '_>,
        source: &Source,
        (maps, texture): (Vec<OcclusionMap>, TextureId),
    ) -> Draw {
        let vertices = self.visible(draws, sheet, source);
        let shader = DistantVisibility {
            combine: self.settings.combine,
            maps,
        };
        let pipeline = RenderPipeline {
            label: "visibility".into(),
            vertex: Transported {
                clip_from_world: draws.view.clip_from_world,
                light: 0,
            }
            .stage(),
            fragment: Some(shader.stage()),
            primitive: sheet.primitive(),
            depth_stencil: equal_depth(),
            color_targets: vec![ColorTargetState::OPAQUE],
        };
        Draw {
            textures: vec![bilinear(texture)],
            ..sheet.draw(pipeline, &vertices)
        }
    }

    /// Position, normal, and how much of the light each vertex leaves visible.
    fn visible(
        &self,
        draws: &SceneDraws<'_>,
        sheet: &Sheet<'_, '_>,
        source: &Source,
    ) -> Arc<VertexBuffer> {
        let body = &self.bodies[sheet.body];
        let evaluation = Evaluation::new(self.settings);
        let hides = body.object.casts;
        let rows = sheet.vertices.iter().flat_map(|&v| {
            let (position, normal) = sheet.vertex(v);
            let at = draws.view.absolute(widen(position));
            let towards = body.own(source.at.towards_from(at).normalize_or_zero());
            let own_normal = body.own(normal_of(sheet.surface, v, sheet.sign.into()));
            let seen = if hides {
                evaluation.visible(&sheet.transport, v as usize, towards, own_normal)
            } else {
                1.0
            };
            let values = [0.0, seen as f32];
            position.into_iter().chain(normal).chain(values)
        });
        Arc::new(VertexBuffer {
            data: rows.collect(),
            stride: 8,
        })
    }
}
