//! Pictures of patches, and the look-up of cones in them.

use std::sync::Arc;

use glam::DVec3;
use gnomon_raster::shader::FragmentStage;
use gnomon_raster::{Format, Recording, TextureDescriptor, TextureId};
use gnomon_shaders::cones::patches::PatchShape;
use gnomon_shaders::cones::{
    AllPatches, ConeShadow, DiscSamples, LightSphere, PatchTree, WIDEST_CONE,
};

use super::samples::gaussian_poisson;
use super::settings::{Method, Settings};
use super::tree::BoxTextures;
use crate::parts::maps::light_view::{
    Fitted, LightExtent, PictureTarget, Surroundings, ViewedLight, views_of,
};
use crate::parts::maps::pictured::{PictureLookUp, PicturedLight, PicturedView, Pictures};
use crate::parts::shadowed_frame::LightTurn;
use crate::technique::{Pass, PassRole, TechniqueError, Warning};
use crate::world::light::{Light, LightShape};
use crate::world::mesh::narrow;

/// Textures of all views, which use them in turn.
pub(super) struct PatchPictures {
    technique: &'static str,
    settings: Settings,
    patches: TextureId,
    depth: TextureId,
    /// Where patches are found by their boxes.
    boxes: Option<BoxTextures>,
    /// Where they are looked up at points.
    points: Arc<[[f32; 3]]>,
}

impl PatchPictures {
    pub(super) fn create(
        technique: &'static str,
        settings: &Settings,
        recording: &mut Recording,
    ) -> Result<Self, TechniqueError> {
        let side = settings.side;
        let mut create = |label: &str, format| {
            recording.create(&TextureDescriptor::d2(label, format, side, side))
        };
        let patches = create("patches", Format::Rgba32Float)?;
        let depth = create("light view depth", Format::Depth32FloatStencil8)?;
        let boxes = match settings.method {
            Method::Octree => Some(BoxTextures::create(side, recording)?),
            Method::Kernel | Method::All => None,
        };
        let points = match settings.method {
            Method::Kernel => gaussian_poisson(settings.samples, settings.spread, settings.seed),
            Method::Octree | Method::All => Arc::new([]),
        };
        Ok(Self {
            technique,
            settings: *settings,
            patches,
            depth,
            boxes,
            points,
        })
    }

    fn shader<S>(&self, light: &Sphere, view: &PicturedView<'_>, search: S) -> ConeShadow<S> {
        let fitted = view.fitted;
        ConeShadow {
            mapping: fitted.mapping(view.view, self.settings.side),
            light: LightSphere {
                centre: narrow(view.view.relative(light.centre)),
                radius: light.radius as f32,
            },
            shape: match self.settings.rectangles {
                true => PatchShape::Rectangle(fitted.frame.axes.map(narrow)),
                false => PatchShape::Sphere,
            },
            search,
        }
    }

    fn stage(&self, light: &Sphere, view: &PicturedView<'_>) -> FragmentStage {
        match &self.boxes {
            Some(boxes) => {
                let tree = PatchTree { root: boxes.root };
                self.shader(light, view, tree).stage()
            }
            None if self.settings.method == Method::All => {
                self.shader(light, view, AllPatches).stage()
            }
            None => {
                let points = self.points.clone();
                self.shader(light, view, DiscSamples { points }).stage()
            }
        }
    }
}

impl Pictures for PatchPictures {
    type Light = Sphere;

    fn light(
        &self,
        turn: &mut LightTurn<'_, '_>,
        around: &Surroundings<'_>,
    ) -> Result<PicturedLight<Sphere>, TechniqueError> {
        let (light, number) = (turn.light(), turn.number);
        let sphere = Sphere::of(self.technique, light, number)?;
        let viewed = ViewedLight::new(self.technique, light, number)?;
        turn.notes.warnings.extend(sphere_instead(light, number));
        let viewed = sphere.widened(viewed, around, &self.settings);
        let view = &self.settings.view;
        Ok(PicturedLight {
            viewed,
            views: views_of(&viewed, around, view.views, &view.fitting),
            data: sphere,
        })
    }

    /// Patches are places in the world: none is in its own way.
    fn bias(&self, _: &Fitted) -> f64 {
        0.0
    }

    fn passes(
        &self,
        _: &Sphere,
        view: &PicturedView<'_>,
        label: &dyn Fn(&str) -> String,
    ) -> Vec<Pass> {
        let target = PictureTarget {
            color: self.patches,
            clear: [0.0; 4],
            buffer: self.depth,
        };
        let (geometry, fitted) = (view.geometry, view.fitted);
        let shader = fitted.patches(geometry, view.view, self.settings.side);
        let (shader, label_of) = (shader.stage(), label("light view"));
        let picture = fitted.pass_by(shader, label_of, geometry, view.view, &target, view.skip);
        let mut passes = vec![Pass::new(PassRole::LightView, picture)];
        if let Some(boxes) = &self.boxes {
            passes.extend(boxes.passes(&label("boxes"), self.patches));
        }
        passes
    }

    fn look_up(&self, light: &Sphere, view: &PicturedView<'_>) -> PictureLookUp {
        let boxes = self.boxes.iter().flat_map(BoxTextures::textures);
        PictureLookUp {
            stage: self.stage(light, view),
            textures: std::iter::once(self.patches).chain(boxes).collect(),
        }
    }
}

/// The ball that a light is, or is taken for; world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sphere {
    centre: DVec3,
    radius: f64,
}

impl Sphere {
    fn of(technique: &'static str, light: &Light, number: usize) -> Result<Self, TechniqueError> {
        let of_area = |centre, area: f64| Self {
            centre,
            radius: (area / std::f64::consts::PI).sqrt(),
        };
        Ok(match &light.shape {
            LightShape::Sphere { centre, radius } => Self {
                centre: *centre,
                radius: *radius,
            },
            LightShape::Disc { centre, radius, .. } => Self {
                centre: *centre,
                radius: *radius,
            },
            LightShape::Rectangle {
                centre,
                edge_u,
                edge_v,
            } => of_area(*centre, edge_u.cross(*edge_v).length()),
            LightShape::Polygon(polygon) => {
                of_area(polygon.centroid(), polygon.area_vector().length())
            }
            LightShape::Point { .. } | LightShape::Directional { .. } => {
                return Err(TechniqueError::UnsuitableLight {
                    technique,
                    light: number,
                    why: "it has no size, so that shadow rays to it are no cone".to_owned(),
                    valid: "spheres, and rectangles, discs and polygons as spheres of their area",
                });
            }
        })
    }

    /// The light as views are fitted to it, so that they hold all patches of all cones.
    fn widened(
        &self,
        viewed: ViewedLight,
        around: &Surroundings<'_>,
        settings: &Settings,
    ) -> ViewedLight {
        let of_radius = |radius| match viewed.extent {
            // What a flat light shows is looked at along its normal.
            LightExtent::Flat(_) => {
                LightExtent::Flat([0, 1].map(|k| viewed.frame.axes[k] * radius))
            }
            LightExtent::Ball(_) | LightExtent::None => LightExtent::Ball(radius),
        };
        let plain = ViewedLight {
            extent: of_radius(self.radius),
            ..viewed
        };
        let found = views_of(&plain, around, settings.view.views, &settings.view.fitting);
        let widening = |v: &Fitted| v.widening(around, self.radius, f64::from(WIDEST_CONE));
        let widest = found.views.iter().map(widening).fold(1.0, f64::max);
        ViewedLight {
            extent: of_radius(self.radius * widest),
            ..viewed
        }
    }
}

/// Lights that are no spheres.
fn sphere_instead(light: &Light, number: usize) -> Option<Warning> {
    let shape = match light.shape {
        LightShape::Disc { .. } => "disc",
        LightShape::Rectangle { .. } => "rectangle",
        LightShape::Polygon(_) => "polygon",
        _ => return None,
    };
    Some(Warning {
        code: "light-as-sphere",
        count: 1,
        message: format!(
            "light {number} is a {shape}; cone culling takes spheres, so one of its area stands for it"
        ),
    })
}
