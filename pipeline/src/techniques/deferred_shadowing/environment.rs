//! The paper's frame, under an environment: light of vertices, what is hidden of it at
//! each pixel, and the difference.

use std::sync::Arc;

use glam::DVec3;
use gnomon_raster::state::ColorTargetState;
use gnomon_raster::{
    Draw, Format, LoadOp, Recording, RenderPass, RenderPipeline, Sampler, TextureBinding,
    TextureDescriptor, TextureId,
};
use gnomon_shaders::deferred::lit::LessObscured;
use gnomon_shaders::deferred::obscured::{self, Highlight, ObscuredRadiance};
use gnomon_shaders::transform::Surfaces;

use super::atlas::{Atlas, Occluders};
use super::bodies::{Body, Evaluation, bodies};
use super::grazing;
use super::keeping::Keeping;
use super::light::HarmonicLight;
use super::notes::Found;
use super::radiance::{Radiance, RadianceTextures, float_format, is_glossy};
use super::settings::Settings;
use super::shadows::{Job, turns};
use super::sheets::Sheets;
use super::sources::{Source, of_environment};
use super::transported::{Lit, Transported, jobs, transported};
use crate::parts::passes::{SceneDraws, Targets, equal_depth};
use crate::parts::shadowed_frame::ShadowedFrame;
use crate::parts::visibility::{VisibilityTexture, attachment, binding};
use crate::technique::{Frame, KeptPictures, Pass, PassRole, TechniqueError};
use crate::world::environment::PlacedEnvironment;
use crate::world::mesh::narrow;
use crate::world::scene::Scene;

/// The frame; `scene` has no ambient light, since all of the map is in L_s.
pub(super) fn frame(
    scene: &Scene,
    placed: &PlacedEnvironment,
    (size, before): ([u32; 2], Option<&KeptPictures>),
    settings: &Settings,
) -> Result<Frame, TechniqueError> {
    let mut frame = ShadowedFrame::new(scene, size, &settings.frame)?.with_ambient();
    let bodies = bodies(scene, &frame.draws, settings);
    let sheets = Sheets::new(&bodies, &frame.draws);
    let given = Given {
        scene,
        placed,
        bodies: &bodies,
        sheets: &sheets,
        settings,
        highlights: frame.draws.has_highlights(),
    };
    let mut deferred = Deferred::new(given, size, &mut frame.recording)?;
    let mut keeping = before.map(|before| Keeping::new(before, &frame.draws));
    let drawn = Drawn {
        draws: &frame.draws,
        targets: &frame.targets,
    };
    let passes = deferred.passes(drawn, &mut frame.recording, keeping.as_mut())?;
    deferred.found.keeping(keeping.as_ref());
    deferred.found.tell(&bodies, &mut frame.notes);
    let visibility = VisibilityTexture::red(deferred.visibility);
    passes.into_iter().for_each(|pass| frame.push(pass));
    let frame = frame.finish(visibility.output())?;
    Ok(Frame {
        keep: keeping.map_or(Vec::new(), Keeping::finish),
        ..frame
    })
}

/// What a frame is made from.
#[derive(Clone, Copy)]
struct Given<'f, 'a> {
    scene: &'f Scene,
    placed: &'f PlacedEnvironment,
    bodies: &'f [Body<'a>],
    sheets: &'f Sheets<'f, 'a>,
    settings: &'f Settings,
    /// Whether materials have highlights.
    highlights: bool,
}

/// Images of what occluders take: diffuse, and glossy.
struct Obscured {
    diffuse: TextureId,
    glossy: Option<TextureId>,
}

/// What a frame draws, and where.
#[derive(Clone, Copy)]
struct Drawn<'f, 'a> {
    draws: &'f SceneDraws<'a>,
    targets: &'f Targets,
}

struct Deferred<'f, 'a> {
    bodies: &'f [Body<'a>],
    sheets: &'f Sheets<'f, 'a>,
    settings: &'f Settings,
    sources: Vec<Source>,
    light: Arc<HarmonicLight>,
    radiance: RadianceTextures,
    obscured: Obscured,
    /// Share of the environment's light that arrives.
    visibility: TextureId,
    atlas: Atlas,
    /// Of each sheet.
    transported: Vec<Transported>,
    jobs: Vec<Job>,
    found: Found,
}

impl<'f, 'a> Deferred<'f, 'a> {
    fn new(
        given: Given<'f, 'a>,
        size: [u32; 2],
        recording: &mut Recording,
    ) -> Result<Self, TechniqueError> {
        let Given {
            placed,
            bodies,
            sheets,
            settings,
            ..
        } = given;
        let sources = of_environment(placed, &given.scene.lights, settings);
        let glossy = given.highlights && sheets.all.iter().any(is_glossy);
        let bands = settings.transport;
        let light = HarmonicLight::of_map(
            &placed.map.cube,
            bands.bands,
            glossy.then_some(bands.glossy_bands),
        );
        let mut found = Found::of(bodies);
        let lit = Lit {
            sources: &sources,
            remainders: &grazing::remainders(&sources, settings),
            evaluation: Evaluation::new(settings),
            glossy,
        };
        let transported: Vec<_> = sheets
            .all
            .iter()
            .map(|s| transported(s, &bodies[s.body], &lit, &mut found))
            .collect();
        let jobs = jobs(bodies, sheets, &sources, &transported, settings);
        let maps = jobs.iter().map(|j| j.maps.len()).sum();
        let atlas = Atlas::create(maps, settings.side, settings.half_floats, recording)?;
        let radiance = RadianceTextures::create(sheets, size, glossy, settings, recording)?;
        let mut image = |label: &str, format| {
            recording.create(&TextureDescriptor::d2(label, format, size[0], size[1]))
        };
        let obscured = Obscured {
            diffuse: image("obscured radiance", float_format(settings))?,
            glossy: match glossy {
                false => None,
                true => Some(image("obscured glossy radiance", float_format(settings))?),
            },
        };
        found.lights(sources.len(), settings);
        found.maps.add(&jobs);
        Ok(Self {
            bodies,
            sheets,
            settings,
            sources,
            light,
            radiance,
            obscured,
            visibility: image("visibility", Format::R32Float)?,
            atlas,
            transported,
            jobs,
            found,
        })
    }

    fn passes(
        &mut self,
        frame: Drawn<'_, 'a>,
        recording: &mut Recording,
        mut keeping: Option<&mut Keeping<'_>>,
    ) -> Result<Vec<Pass>, TechniqueError> {
        let radiance = Radiance {
            bodies: self.bodies,
            sheets: self.sheets,
            light: &self.light,
            settings: self.settings,
            draws: frame.draws,
            textures: &self.radiance,
            transported: &self.transported,
        };
        let mut passes = radiance.passes(frame.targets);
        let jobs = std::mem::take(&mut self.jobs);
        let (mut turns, left_out) = turns(jobs, self.atlas.capacity());
        self.found.maps.left_out += left_out;
        if turns.is_empty() {
            turns.push(Vec::new()); // the images have to be cleared
        }
        for (turn, jobs) in turns.iter().enumerate() {
            let occluders = Occluders {
                bodies: self.bodies,
                draws: frame.draws,
                label: &|what: &str| what.to_owned(),
            };
            let keeping = keeping.as_deref_mut();
            let own = (self.atlas).fill(jobs, &occluders, recording, keeping)?;
            passes.extend(own.passes);
            passes.push(self.obscure(frame, jobs, (own.maps, turn == 0)));
        }
        passes.push(self.lit(frame));
        Ok(passes)
    }

    /// Adds what the maps in a texture take.
    fn obscure(
        &self,
        frame: Drawn<'_, 'a>,
        jobs: &[Job],
        (texture, first): (TextureId, bool),
    ) -> Pass {
        let load = if first {
            LoadOp::Clear([0.0; 4])
        } else {
            LoadOp::Load
        };
        let mut draws = Vec::new();
        let mut cell = 0;
        for job in jobs {
            let view = &frame.draws.view;
            let look_up = |(k, map)| self.atlas.look_up(map, cell + k, view);
            let maps: Vec<_> = job.placed().map(look_up).collect();
            cell += job.maps.len();
            if maps.is_empty() {
                continue;
            }
            let shader = ObscuredRadiance {
                energy: self.sources[job.light].energy.map(|e| e as f32),
                combine: self.settings.combine,
                maps,
                highlight: None,
            };
            draws.extend(
                self.sheets_of(job)
                    .map(|k| self.take(frame, job, (k, texture), &shader)),
            );
        }
        let images = std::iter::once(self.obscured.diffuse).chain(self.obscured.glossy);
        let pass = RenderPass {
            label: "obscured radiance".into(),
            color: images.map(|t| attachment(t, load)).collect(),
            depth_stencil: frame.targets.depth_stencil(LoadOp::Load, LoadOp::Load),
            draws,
        };
        Pass::new(PassRole::LookUp, pass)
    }

    /// Sheets of a job's body that its light reaches.
    fn sheets_of(&self, job: &Job) -> impl Iterator<Item = usize> {
        let sheets = self.sheets.all.iter().enumerate();
        sheets
            .filter(|(k, s)| s.body == job.body && self.transported[*k].reached[job.light])
            .map(|(k, _)| k)
    }

    fn take(
        &self,
        frame: Drawn<'_, 'a>,
        job: &Job,
        (sheet, maps): (usize, TextureId),
        shader: &ObscuredRadiance,
    ) -> Draw {
        let view = &frame.draws.view;
        let (own, vertices) = (&self.sheets.all[sheet], &self.transported[sheet].vertices);
        let highlight = (self.obscured.glossy.is_some() && is_glossy(own)).then(|| Highlight {
            towards: narrow(self.sources[job.light].at.towards_from(DVec3::ZERO)),
            eye: narrow(view.eye()),
            shininess: own.surface.material.shininess,
        });
        let attachments = 1 + usize::from(self.obscured.glossy.is_some());
        let fragment = ObscuredRadiance {
            highlight,
            ..shader.clone()
        };
        let pipeline = RenderPipeline {
            label: "obscured radiance".into(),
            vertex: obscured::Transported {
                clip_from_world: view.clip_from_world,
                light: job.light as u32,
            }
            .stage(),
            fragment: Some(fragment.stage()),
            primitive: own.primitive(),
            depth_stencil: equal_depth(),
            color_targets: vec![ColorTargetState::ADDITIVE; attachments],
        };
        Draw {
            textures: vec![bilinear(maps)],
            ..own.draw(pipeline, vertices)
        }
    }

    /// What is left, onto the picture.
    fn lit(&self, frame: Drawn<'_, 'a>) -> Pass {
        let images = [Some(self.radiance.image), Some(self.obscured.diffuse)];
        let glossy = [self.radiance.glossy_image(), self.obscured.glossy];
        let textures = || images.into_iter().chain(glossy).flatten().map(binding);
        let surfaces = frame.draws.surfaces().iter();
        let draws = surfaces.map(|s| {
            let has_glossy = self.obscured.glossy.is_some() && s.material.specular != [0.0; 3];
            let shader = LessObscured {
                albedo: s.material.albedo,
                specular: has_glossy.then_some(s.material.specular),
            };
            let pipeline = RenderPipeline {
                label: "lit".into(),
                vertex: Surfaces(frame.draws.view.clip_from_world).stage(),
                fragment: Some(shader.stage()),
                primitive: s.primitive.clone(),
                depth_stencil: equal_depth(),
                color_targets: vec![ColorTargetState::ADDITIVE, ColorTargetState::OPAQUE],
            };
            Draw {
                textures: textures().take(if has_glossy { 4 } else { 2 }).collect(),
                ..s.draw(pipeline)
            }
        });
        let mut color = frame.targets.color(LoadOp::Load);
        color.push(attachment(self.visibility, LoadOp::Clear([1.0; 4])));
        let pass = RenderPass {
            label: "lit".into(),
            color,
            depth_stencil: frame.targets.depth_stencil(LoadOp::Load, LoadOp::Load),
            draws: draws.collect(),
        };
        Pass::new(PassRole::Lit, pass)
    }
}

/// For look-ups between texels.
pub(super) fn bilinear(texture: TextureId) -> TextureBinding {
    TextureBinding {
        texture,
        sampler: Sampler::bilinear(),
    }
}
