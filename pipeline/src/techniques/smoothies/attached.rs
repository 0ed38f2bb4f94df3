//! What is attached to the silhouettes of a light's casters, view by view.

use std::sync::Arc;

use glam::DVec3;
use gnomon_raster::VertexBuffer;

use super::settings::{Construction, Settings};
use crate::geometry::caster::{Caster, Counting};
use crate::geometry::silhouette::{Orientation, Silhouette, light_facing};
use crate::geometry::smoothie::{
    Attachment, PictureFrame, Reach, SmoothieVertex, Smoothies, attach, mean_distance,
};
use crate::parts::maps::light_view::{
    Fitted, LightExtent, LightViews, Surroundings, ViewedLight, views_of,
};
use crate::parts::passes::View;
use crate::parts::shadowed_frame::LightTurn;
use crate::technique::{Figure, TechniqueError};
use crate::world::light::{HardLight, Light, LightShape};
use crate::world::mesh::{Mesh, narrow};

/// Triangles attached to one caster, as [`gnomon_shaders::smoothies::SmoothieVertices`]
/// takes them.
pub(super) struct Attached {
    pub(super) name: String,
    pub(super) vertices: Arc<VertexBuffer>,
}

/// A light's views and what is attached in each.
pub(super) struct LightAttached {
    pub(super) viewed: ViewedLight,
    pub(super) views: LightViews,
    pub(super) attached: Vec<Vec<Attached>>,
}

/// The silhouette of a caster.
struct Outline<'a> {
    object: usize,
    mesh: &'a Mesh,
    silhouette: Silhouette,
}

/// Finds silhouettes from the light's centre, fits views to casters and what is attached
/// to them, and attaches it.
pub(super) fn attached(
    technique: &'static str,
    settings: &Settings,
    turn: &mut LightTurn<'_, '_>,
    around: &Surroundings<'_>,
) -> Result<LightAttached, TechniqueError> {
    let (light, number) = (turn.light(), turn.number);
    let HardLight::Point(_) = light.hard() else {
        return Err(TechniqueError::UnsuitableLight {
            technique,
            light: number,
            why: "it is directional, and widths follow from ratios of distances to it".to_owned(),
            valid: "points, rectangles, discs, spheres and polygons",
        });
    };
    let whole = ViewedLight::new(technique, light, number)?;
    let sizes = Sizes {
        settings,
        radius: half_width(light, &whole),
        outlines: outlines(light.hard(), around),
    };
    let viewed = as_point(whole);
    let (views, kinds) = sizes.fit(&viewed, around);
    let labels = turn.labels();
    let mut total = Smoothies::default();
    let mut all = Vec::new();
    for (fitted, kind) in views.views.iter().zip(&kinds) {
        all.push(sizes.attach(turn, fitted, *kind, &mut total));
    }
    let mut figure = |name: &str, value: f64| {
        let name = labels(name);
        turn.notes.figures.push(Figure { name, value });
    };
    if settings.construction == Construction::Smoothies {
        let widest = kinds.iter().map(|k| k.size()).fold(0.0, f64::max);
        figure("smoothie-width", widest);
    }
    figure("attached-edges", total.edges as f64);
    figure("attached-corners", total.corners as f64);
    figure("concave-corners", total.concave as f64);
    figure("cut-edges", total.cut as f64);
    Ok(LightAttached {
        viewed,
        views,
        attached: all,
    })
}

/// The light, of which only the centre is looked at.
fn as_point(light: ViewedLight) -> ViewedLight {
    let extent = match light.extent {
        LightExtent::Flat(_) => LightExtent::Flat([DVec3::ZERO; 2]),
        LightExtent::Ball(_) | LightExtent::None => LightExtent::None,
    };
    ViewedLight { extent, ..light }
}

/// How far a light reaches from its centre: a round one's radius; of others the mean of
/// half their widths.
fn half_width(light: &Light, viewed: &ViewedLight) -> f64 {
    match light.shape {
        LightShape::Sphere { radius, .. } | LightShape::Disc { radius, .. } => radius,
        _ => {
            let [right, down, _] = viewed.frame.axes;
            (viewed.extent.half_along(right) + viewed.extent.half_along(down)) / 2.0
        }
    }
}

fn outlines<'a>(light: HardLight, around: &Surroundings<'a>) -> Vec<Outline<'a>> {
    let outline = |&(object, mesh): &(usize, &'a Mesh)| {
        let caster = Caster::new(mesh);
        let facing = light_facing(mesh, light);
        let orientation = match caster.counting(mesh, light) {
            Counting::LightFacing => Orientation::closed(&facing),
            Counting::AllTriangles => Orientation::generalised(&facing),
        };
        Outline {
            object,
            mesh,
            silhouette: Silhouette::new(mesh, caster.adjacency(), &orientation),
        }
    };
    around.casters().iter().map(outline).collect()
}

/// What widths follow from.
struct Sizes<'a> {
    settings: &'a Settings,
    /// The light's.
    radius: f64,
    outlines: Vec<Outline<'a>>,
}

impl Sizes<'_> {
    /// Views that hold casters and what is attached to them, and what that is in each.
    fn fit(&self, light: &ViewedLight, around: &Surroundings<'_>) -> (LightViews, Vec<Attachment>) {
        let view = &self.settings.maps.view;
        let margin = match self.settings.width {
            Some(width) if self.settings.construction == Construction::Smoothies => width,
            _ => {
                let plain = views_of(light, around, view.views, &view.fitting);
                let widths = plain.views.iter().map(|v| self.margin(v));
                widths.fold(0.0, f64::max)
            }
        };
        let mut fitting = view.fitting;
        fitting.margin = margin;
        let views = views_of(light, around, view.views, &fitting);
        let kind = |v: &Fitted| match self.settings.construction {
            Construction::Cones => Attachment::Cones(self.radius),
            // Views are fitted to this much.
            Construction::Smoothies => Attachment::Smoothies(self.width(v).min(margin)),
        };
        let kinds = views.views.iter().map(kind).collect();
        (views, kinds)
    }

    /// By how much a view has to hold more than the casters, in tangents.
    fn margin(&self, fitted: &Fitted) -> f64 {
        let Reach { near, far } = reach(fitted);
        match self.settings.construction {
            Construction::Smoothies => self.width(fitted),
            Construction::Cones => self.radius * (1.0 / near - 1.0 / far),
        }
    }

    /// Of smoothies, in tangents: at the mean distance of silhouettes they end where the
    /// penumbra of the light does.
    fn width(&self, fitted: &Fitted) -> f64 {
        if let Some(width) = self.settings.width {
            return width;
        }
        let (frame, reach) = (frame(fitted), reach(fitted));
        let mut sum = (0.0, 0);
        for outline in &self.outlines {
            let (mean, count) = mean_distance(outline.mesh, &outline.silhouette, &frame, reach);
            sum = (sum.0 + mean * count as f64, sum.1 + count);
        }
        if sum.1 == 0 {
            return 0.0;
        }
        self.radius * sum.1 as f64 / sum.0
    }

    /// What is attached to each caster in a view.
    fn attach(
        &self,
        turn: &LightTurn<'_, '_>,
        fitted: &Fitted,
        kind: Attachment,
        total: &mut Smoothies,
    ) -> Vec<Attached> {
        let skip = self.settings.maps.skip;
        let seen = |o: &&Outline<'_>| !skip || fitted.objects.binary_search(&o.object).is_ok();
        let mut all = Vec::new();
        for outline in self.outlines.iter().filter(seen) {
            let own = attach(
                outline.mesh,
                &outline.silhouette,
                &frame(fitted),
                reach(fitted),
                kind,
            );
            total.edges += own.edges;
            total.corners += own.corners;
            total.concave += own.concave;
            total.cut += own.cut;
            if !own.vertices.is_empty() {
                all.push(Attached {
                    name: turn.scene.objects[outline.object].name.clone(),
                    vertices: Arc::new(vertices(&own.vertices, fitted, turn.view())),
                });
            }
        }
        all
    }
}

fn frame(fitted: &Fitted) -> PictureFrame {
    PictureFrame {
        centre: fitted.frame.centre,
        axes: fitted.frame.axes,
    }
}

fn reach(fitted: &Fitted) -> Reach {
    let [near, far] = fitted.range;
    Reach { near, far }
}

/// Distances are relative to the view's base.
fn vertices(all: &[SmoothieVertex], fitted: &Fitted, view: &View) -> VertexBuffer {
    let mut data = Vec::with_capacity(all.len() * 7);
    for vertex in all {
        data.extend(narrow(view.relative(vertex.position)));
        data.push((vertex.distance - fitted.base) as f32);
        data.push((vertex.blocker - fitted.base) as f32);
        data.extend(vertex.offset.to_array().map(|x| x as f32));
    }
    VertexBuffer { data, stride: 7 }
}
