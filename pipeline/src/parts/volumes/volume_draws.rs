//! Draws that count shadow volumes into the stencil, caster by caster.

use std::sync::Arc;

use gnomon_raster::state::{ColorTargetState, DepthStencilState};
use gnomon_raster::{Draw, RenderPipeline, VertexBuffer};
use gnomon_shaders::transform::HomogeneousPoints;

use super::near_pyramid::{NearPyramid, outside_view};
use super::stencil_ranges::{self, OVERFLOW, Overflow, end_of_range, in_range};
use crate::choices;
use crate::geometry::caster::CasterPolicy;
use crate::geometry::layers::most_layers;
use crate::geometry::volume::ShadowVolume;
use crate::parts::casters::{self, Examined, OPEN_CASTERS, SKIP};
use crate::parts::passes::{self, View};
use crate::technique::{
    CasterUse, Param, ParamInfo, Params, TechniqueError, VolumeMethod, Warning,
};
use crate::world::light::HardLight;
use crate::world::scene::Scene;

choices! {
    /// How volumes are counted.
    pub(crate) enum CountMethod {
        /// The cheaper one that is right, caster by caster.
        Auto = "auto",
        /// Before surfaces.
        DepthPass = "zpass",
        /// Beyond surfaces.
        DepthFail = "zfail",
    }
}

pub(crate) const METHOD: Param<CountMethod> = Param::choice(
    "method",
    CountMethod::Auto.word(),
    "auto: z-pass for casters that cannot shadow the near rectangle, z-fail for the others",
);

impl CountMethod {
    /// The method for all casters; `None` where each has its own.
    pub(crate) fn forced(self) -> Option<VolumeMethod> {
        match self {
            Self::Auto => None,
            Self::DepthPass => Some(VolumeMethod::DepthPass),
            Self::DepthFail => Some(VolumeMethod::DepthFail),
        }
    }
}

/// Settings of techniques that count volumes into the stencil.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct VolumeSettings {
    method: CountMethod,
    overflow: Overflow,
    open_casters: CasterPolicy,
    skip: bool,
}

impl VolumeSettings {
    pub(crate) const PARAMS: &'static [ParamInfo] =
        &[METHOD.info, OVERFLOW.info, OPEN_CASTERS.info, SKIP.info];

    pub(crate) fn read(params: &Params) -> Result<Self, TechniqueError> {
        Ok(Self {
            method: params.get(&METHOD)?,
            overflow: params.get(&OVERFLOW)?,
            open_casters: casters::open_casters(params)?,
            skip: params.get(&SKIP)?,
        })
    }
}

/// The casters of a scene, examined once for all lights.
pub(crate) struct VolumeCasters<'a> {
    scene: &'a Scene,
    view: View,
    size: [u32; 2],
    method: Option<VolumeMethod>,
    skip: bool,
    /// Whether more than 255 volumes may wrap the stencil.
    wraps: bool,
    examined: Vec<Examined<'a>>,
}

/// A caster's volume, or a part of it, that is to be drawn.
struct Thrown<'a> {
    examined: &'a Examined<'a>,
    method: VolumeMethod,
    volume: ShadowVolume,
}

/// Whether the stencil counts all volumes at once.
#[derive(Clone, Copy)]
enum Ranges {
    One,
    Several,
}

/// The volumes of all casters for one light point.
#[derive(Default)]
pub(crate) struct CasterVolumes {
    /// One for each caster that is drawn.
    pub(crate) draws: Vec<Draw>,
    /// One for each caster.
    pub(crate) uses: Vec<CasterUse>,
    pub(crate) warnings: Vec<Warning>,
}

impl<'a> VolumeCasters<'a> {
    /// Examines the casters of `scene`.
    ///
    /// # Errors
    /// A caster is not closed and must be.
    pub(crate) fn new(
        scene: &'a Scene,
        size: [u32; 2],
        settings: &VolumeSettings,
    ) -> Result<Self, TechniqueError> {
        Ok(Self {
            scene,
            view: View::new(&scene.camera, size),
            size,
            method: settings.method.forced(),
            skip: settings.skip,
            wraps: settings.overflow == Overflow::Wrap,
            examined: casters::examine(scene, settings.open_casters)?,
        })
    }

    /// What was examined.
    pub(crate) fn examined(&self) -> &[Examined<'a>] {
        &self.examined
    }

    /// The volumes that `hard` throws, a point of light number `light`, for a
    /// pass with colour attachments `color`, of which none is written.
    pub(crate) fn volumes(
        &self,
        light: usize,
        hard: HardLight,
        color: &[ColorTargetState],
    ) -> CasterVolumes {
        let pyramid = NearPyramid::new(&self.scene.camera, self.size, hard);
        let mut built = CasterVolumes::default();
        let mut thrown = Vec::new();
        for examined in &self.examined {
            let mesh = &examined.object.mesh;
            let hidden = self.skip && outside_view(&self.scene.camera, self.size, mesh, hard);
            let method = match self.method {
                _ if hidden => VolumeMethod::Skipped,
                Some(method) => method,
                None if pyramid.may_touch(mesh) => VolumeMethod::DepthFail,
                None => VolumeMethod::DepthPass,
            };
            let mut used = CasterUse {
                object: examined.number,
                light,
                method,
                triangles: [0; 3],
            };
            if !hidden {
                let volume = examined.caster.volume(mesh, hard);
                used.triangles = volume.ranges().map(|r| r.len());
                thrown.push(Thrown {
                    examined,
                    method,
                    volume,
                });
            }
            built.uses.push(used);
        }
        let layers = layers(hard, &thrown);
        let overflows = layers > stencil_ranges::CAPACITY;
        if overflows {
            let warning = stencil_ranges::warning(light, layers, self.wraps);
            built.warnings.push(warning);
        }
        built.draws = if overflows && !self.wraps {
            self.in_ranges(thrown, hard, color)
        } else {
            let draw = |t: &Thrown<'_>| self.draw(t, color, Ranges::One);
            thrown.iter().map(draw).collect()
        };
        built
    }

    /// The volumes in as many groups as there are ranges, each with its end.
    fn in_ranges(
        &self,
        thrown: Vec<Thrown<'_>>,
        hard: HardLight,
        color: &[ColorTargetState],
    ) -> Vec<Draw> {
        let parts = thrown.into_iter().flat_map(|t| {
            let parts = stencil_ranges::parts(t.examined, t.volume, hard).into_iter();
            parts.map(move |(volume, layers)| (Thrown { volume, ..t }, layers))
        });
        let draws = |group: Vec<Thrown<'_>>| {
            let counts = group.iter().map(|t| self.draw(t, color, Ranges::Several));
            let counts: Vec<Draw> = counts.collect();
            counts.into_iter().chain([end_of_range(color)])
        };
        let groups = stencil_ranges::groups(parts).into_iter();
        groups.flat_map(draws).collect()
    }

    fn draw(&self, thrown: &Thrown<'_>, color: &[ColorTargetState], ranges: Ranges) -> Draw {
        let volume = &thrown.volume;
        let depth_pass = thrown.method == VolumeMethod::DepthPass;
        let (label, depth_stencil, triangles) = if depth_pass {
            (
                "z-pass",
                DepthStencilState::z_pass_volumes(),
                volume.sides(),
            )
        } else {
            (
                "z-fail",
                DepthStencilState::z_fail_volumes(),
                volume.triangles(),
            )
        };
        let pipeline = RenderPipeline {
            label: label.into(),
            vertex: HomogeneousPoints(self.view.clip_from_world).stage(),
            fragment: None,
            primitive: passes::clamped(),
            depth_stencil: match ranges {
                Ranges::One => depth_stencil,
                Ranges::Several => in_range(depth_stencil),
            },
            color_targets: color.to_vec(),
        };
        let (positions, triangles) = referenced(volume.positions(), triangles);
        let vertices = VertexBuffer {
            data: positions.iter().flat_map(|v| self.moved(*v)).collect(),
            stride: 4,
        };
        let indices = passes::index_buffer(&triangles);
        Draw::indexed(
            &thrown.examined.object.name,
            &Arc::new(pipeline),
            &Arc::new(vertices),
            &indices,
        )
    }

    /// Points move with the view's origin, directions stay.
    fn moved(&self, [x, y, z, w]: [f32; 4]) -> [f32; 4] {
        if w == 0.0 {
            return [x, y, z, w];
        }
        let [x, y, z] = self.view.point([x, y, z]);
        [x, y, z, w]
    }
}

/// A number of layers that the volumes do not exceed; of few triangles, their number.
fn layers(hard: HardLight, thrown: &[Thrown<'_>]) -> usize {
    let volumes: Vec<&ShadowVolume> = thrown.iter().map(|t| &t.volume).collect();
    let triangles = volumes.iter().map(|v| v.light_cap().len()).sum();
    if triangles <= stencil_ranges::CAPACITY {
        return triangles;
    }
    most_layers(hard, &volumes)
}

/// The positions that `triangles` refer to, in their order, and the triangles on
/// them: a volume's sides need few of its vertices, and hundreds of volumes are
/// kept at a time.
fn referenced(positions: &[[f32; 4]], triangles: &[[u32; 3]]) -> (Vec<[f32; 4]>, Vec<[u32; 3]>) {
    let mut place = vec![u32::MAX; positions.len()];
    triangles
        .iter()
        .flatten()
        .for_each(|&i| place[i as usize] = 0);
    let mut kept = Vec::new();
    for (place, position) in place.iter_mut().zip(positions) {
        if *place == 0 {
            *place = kept.len() as u32;
            kept.push(*position);
        }
    }
    let moved = triangles.iter().map(|t| t.map(|i| place[i as usize]));
    (kept, moved.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_that_nothing_refers_to_are_left_out() {
        let all = [0.0, 1.0, 2.0, 3.0, 4.0].map(|x| [x; 4]);
        let (kept, triangles) = referenced(&all, &[[4, 1, 3], [3, 1, 4]]);
        assert_eq!(kept, [[1.0; 4], [3.0; 4], [4.0; 4]]);
        assert_eq!(triangles, [[2, 0, 1], [1, 0, 2]]);
        assert_eq!(referenced(&all, &[]), (Vec::new(), Vec::new()));
    }
}
