//! Soft shadow volumes without their two errors: the depth complexity of the light is
//! found exactly along lines across it, from silhouettes as each receiver sees them
//! (docs/line-sampled-shadow-volumes.md).
//!
//! Hard shadow volumes count casters before the light's centre, into the stencil. For
//! blocks of pixels, lists of edges are made that may be contours before the light for some
//! receiver there; they are most of what the technique does before the GPU, and are
//! reported as such. One pass then walks over the light from the centre along lines
//! ([`gnomon_shaders::line_samples`]).
//!
//! Casters that are not closed are refused, or have facets of both sides counted, with
//! `open-casters=generalised`, as in other techniques on volumes. What a facet's own plane
//! hides is always left out: it is part of the truth.

mod image;
mod light;
mod settings;
mod tables;

use gnomon_raster::{Format, TextureDescriptor};

use self::settings::LineSettings;
use crate::geometry::line_sampling::blocks::BlockBounds;
use crate::geometry::line_sampling::edges::LineCasters;
use crate::geometry::line_sampling::kept_lists::KeptLists;
use crate::geometry::line_sampling::patches::Patches;
use crate::param_list;
use crate::parts::frame_settings::FrameSettings;
use crate::parts::passes::LitTest;
use crate::parts::shadowed_frame::ShadowedFrame;
use crate::parts::view::View;
use crate::parts::visibility::{Positions, VisibilityTexture};
use crate::parts::volumes::light_contacts;
use crate::parts::volumes::volume_draws::VolumeCasters;
use crate::technique::{
    Capabilities, Frame, KeptPictures, KeptWork, ParamInfo, Params, ShadowKind, Technique,
    TechniqueError,
};
use crate::world::light::Light;
use crate::world::light_image::LightImage;
use crate::world::scene::{Object, Scene};

const NAME: &str = "line-sampled-shadow-volumes";

/// The registry's entry.
pub(crate) struct LineSampledShadowVolumes;

impl Technique for LineSampledShadowVolumes {
    fn name(&self) -> &'static str {
        NAME
    }

    fn summary(&self) -> &'static str {
        "soft shadows from the exact depth complexity of the light along lines across it"
    }

    fn params(&self) -> &'static [ParamInfo] {
        param_list!(LineSettings::PARAMS, FrameSettings::PARAMS)
    }

    fn capabilities(&self) -> Capabilities {
        Capabilities::of_silhouettes(ShadowKind::Soft)
    }

    fn frame(
        &self,
        scene: &Scene,
        size: [u32; 2],
        params: &Params,
    ) -> Result<Frame, TechniqueError> {
        frame(scene, (size, None), params)
    }

    fn frame_after(
        &self,
        scene: &Scene,
        size: [u32; 2],
        params: &Params,
        kept: &KeptPictures,
    ) -> Result<Frame, TechniqueError> {
        frame(scene, (size, Some(kept)), params)
    }

    fn light_image(&self, params: &Params) -> Result<Option<LightImage>, TechniqueError> {
        settings::image(params)
    }
}

/// A frame of a size, by itself or after another one that left something.
fn frame(
    scene: &Scene,
    (size, before): ([u32; 2], Option<&KeptPictures>),
    params: &Params,
) -> Result<Frame, TechniqueError> {
    let settings = LineSettings::read(params)?;
    let lit = settings.image.as_ref().map(|i| scene.with_light_image(i));
    let scene = lit.as_ref().unwrap_or(scene);
    let volumes = VolumeCasters::new(scene, size, &settings.volumes)?;
    let patches = PatchesOf::new(&volumes)?;
    let frame = ShadowedFrame::new(scene, size, &settings.frame)?;
    let number = |object: &Object, t: u32| patches.number(object, t);
    let (mut frame, positions) = frame.with_numbered_positions(&number)?;
    let coloured = settings.image.is_some();
    let format = match coloured {
        true => Format::Rgba32Float,
        false => Format::R32Float,
    };
    let desc = TextureDescriptor::d2("visibility", format, size[0], size[1]);
    let visibility = VisibilityTexture {
        coloured,
        ..VisibilityTexture::red(frame.recording.create(&desc)?)
    };
    let nothing = KeptLists::default();
    let lines = LineFrame {
        settings: &settings,
        blocks: BlockBounds::new(&scene.camera, size, &receivers(scene)),
        view: View::new(&scene.camera, size),
        volumes: &volumes,
        patches: &patches,
        positions,
        visibility,
        before: before.map(|kept| kept.work.find().unwrap_or(&nothing)),
    };
    let mut left = KeptLists::default();
    let mut frame = frame.lit(LitTest::Visibility(visibility), |turn| {
        let contact = light_contacts::warning(scene, turn.number);
        turn.notes.warnings.extend(contact);
        light::passes(&lines, turn, &mut left)
    })?;
    if before.is_some() {
        frame.work = KeptWork::of(left);
    }
    Ok(frame)
}

fn receivers(scene: &Scene) -> Vec<[glam::DVec3; 3]> {
    let objects = scene.objects.iter().filter(|o| o.receives);
    let all = objects.flat_map(|o| (0..o.mesh.triangles().len()).map(|t| o.mesh.corners(t)));
    all.collect()
}

/// What all lights share.
struct LineFrame<'a> {
    settings: &'a LineSettings,
    blocks: BlockBounds,
    view: View,
    volumes: &'a VolumeCasters<'a>,
    patches: &'a PatchesOf,
    positions: Positions,
    visibility: VisibilityTexture,
    /// Lists of the frame before, in an animation.
    before: Option<&'a KeptLists>,
}

impl LineFrame<'_> {
    fn view(&self) -> &View {
        &self.view
    }

    /// The size of the largest caster; infinite without any.
    fn casters_size(&self) -> f64 {
        let examined = self.volumes.examined().iter();
        let bounds = examined.filter_map(|e| e.object.mesh.bounds());
        let sizes = bounds.map(|(low, high)| (high - low).length());
        sizes.reduce(f64::max).unwrap_or(f64::INFINITY)
    }

    /// What counts of the casters, for a light.
    fn casters_of(&self, light: &Light) -> LineCasters {
        let mut casters = LineCasters::default();
        for (examined, patches) in self.volumes.examined().iter().zip(&self.patches.patches) {
            let mesh = &examined.object.mesh;
            let counting = examined.caster.counting(mesh, light.hard());
            casters.push(mesh, &examined.caster, patches, counting);
        }
        casters
    }
}

/// Planes of all casters, with numbers through all of them.
struct PatchesOf {
    patches: Vec<Patches>,
    /// Each caster, and the number of its first plane.
    first: Vec<(*const Object, u32)>,
}

impl PatchesOf {
    fn new(volumes: &VolumeCasters<'_>) -> Result<Self, TechniqueError> {
        let (mut patches, mut first, mut count) = (Vec::new(), Vec::new(), 0);
        for examined in volumes.examined() {
            let mesh = &examined.object.mesh;
            let own = Patches::new(mesh, examined.caster.adjacency());
            first.push((std::ptr::from_ref(examined.object), count as u32));
            count += own.planes.len();
            patches.push(own);
        }
        if count > tables::MOST_PLANES {
            return Err(TechniqueError::TooManyTriangles {
                technique: NAME,
                given: count,
                most: tables::MOST_PLANES,
            });
        }
        Ok(Self { patches, first })
    }

    /// What a triangle's pixels have for w of positions.
    fn number(&self, object: &Object, t: u32) -> f32 {
        if !object.receives {
            return 0.0;
        }
        let own = std::ptr::from_ref(object);
        let caster = self.first.iter().position(|(of, _)| *of == own);
        match caster {
            Some(k) => (self.first[k].1 + self.patches[k].of_triangle[t as usize] + 2) as f32,
            None => 1.0,
        }
    }
}
