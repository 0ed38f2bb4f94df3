//! Shadow maps that are filtered before they are compared: variance, exponential
//! variance, four moments, and variance soft shadow maps; and masks of occluders, which
//! are filtered and not compared (docs/papers.md, baselines).
//!
//! Per light view: its depths become images of a few functions of depth, these become
//! summed-area tables of integers, and each receiver bounds its visibility from their
//! means over a kernel. Kernels have one width for all receivers, or are as wide as the
//! light seems through the mean blocker.
//!
//! Tables are exact, but their values have only as many bits as leave the sum over the
//! largest kernel below 2³²: `table-bits` says how many. No variance below what they
//! resolve is told from none.
//!
//! Known errors, of the methods: a kernel with several depths of blockers, or with
//! depths behind the receiver's, lets light through; pictures hold casters only, and
//! what is cleared to is as far as the farthest receiver. Of masks: all occluders are in
//! one plane; what the picture shows is an occluder and is lit, so that receivers must
//! not cast, and occluders do not shadow one another but where the light's centre does
//! not see them.

mod settings;
mod tables;

use std::sync::Arc;

use gnomon_raster::shader::FragmentStage;
use gnomon_shaders::moments::Moments;
use gnomon_shaders::moments::filter::{FixedKernel, LightKernel, MomentTables};
use gnomon_shaders::moments::occluder_plane::OccluderPlane;
use gnomon_shaders::moments::variance_soft::VarianceSoft;

use self::settings::{Kernel, Settings};
use self::tables::{Made, TableTextures, Tables};
use crate::param_list;
use crate::parts::frame_settings::FrameSettings;
use crate::parts::horizon::HORIZON;
use crate::parts::light_samples::Pattern;
use crate::parts::maps::mapped::{
    LookUp, Looked, Mapped, Margin, Planes, Sources, receivers_in_their_own_pictures,
};
use crate::technique::{
    Capabilities, Frame, ParamInfo, Params, ShadowKind, Technique, TechniqueError, Warning,
};
use crate::world::scene::Scene;

/// The registry's entries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MomentMaps {
    /// Depth and its square.
    Variance,
    /// Exponentials of depth and their squares.
    Exponential,
    /// Four powers of depth.
    Four,
    /// Depth and its square, for blockers too.
    VarianceSoft,
    /// Whether there is an occluder.
    Mask,
}

impl Technique for MomentMaps {
    fn name(&self) -> &'static str {
        match self {
            Self::Variance => "vsm",
            Self::Exponential => "evsm",
            Self::Four => "msm",
            Self::VarianceSoft => "vssm",
            Self::Mask => "soler-sillion",
        }
    }

    fn summary(&self) -> &'static str {
        match self {
            Self::Variance => {
                "shadows bounded by mean and variance of depth (Donnelly and Lauritzen 2006)"
            }
            Self::Exponential => "the same of exponentials of depth (Lauritzen and McCool 2008)",
            Self::Four => "shadows bounded by four moments of depth (Peters and Klein 2015)",
            Self::VarianceSoft => {
                "soft shadows by mean and variance of depth alone (Yang et al. 2010)"
            }
            Self::Mask => {
                "soft shadows as the occluders' mask convolved with the light (Soler and Sillion 1998)"
            }
        }
    }

    fn params(&self) -> &'static [ParamInfo] {
        match self {
            Self::Variance => param_list!(
                settings::FILTERED,
                settings::MAPS,
                &[HORIZON.info],
                FrameSettings::PARAMS
            ),
            Self::Exponential => param_list!(
                &[settings::EXPONENT.info],
                settings::FILTERED,
                settings::MAPS,
                &[HORIZON.info],
                FrameSettings::PARAMS
            ),
            Self::Four => param_list!(
                &[settings::SPREAD.info],
                settings::FILTERED,
                settings::MAPS,
                &[HORIZON.info],
                FrameSettings::PARAMS
            ),
            Self::Mask => param_list!(
                &[settings::PLANE.info, settings::GROUPS.info],
                settings::MAPS,
                &[HORIZON.info],
                FrameSettings::PARAMS
            ),
            Self::VarianceSoft => param_list!(
                &[settings::CELLS.info],
                settings::MAPS,
                &[HORIZON.info],
                FrameSettings::PARAMS
            ),
        }
    }

    fn capabilities(&self) -> Capabilities {
        Capabilities::of_light_views(ShadowKind::Soft)
    }

    fn frame(
        &self,
        scene: &Scene,
        size: [u32; 2],
        params: &Params,
    ) -> Result<Frame, TechniqueError> {
        let settings = Settings::read(*self, params)?;
        let mapped = Mapped {
            scene,
            size,
            frame: settings.frame,
            maps: settings.maps,
            horizon: settings.horizon,
            margin: self.margin(settings.kernel),
            apart: settings.apart,
        };
        let side = settings.maps.view.fitting.size;
        let mut frame = mapped.prefiltered_frame(
            |recording| TableTextures::create(self.name(), side, self.functions(), recording),
            |light| Sources::centre(self.name(), scene, light),
            |textures, look_up| self.looked(&settings, textures, look_up),
        )?;
        if *self == Self::Mask {
            let warning = receivers_that_cast(scene, settings.apart);
            frame.warnings.extend(warning);
        }
        Ok(frame)
    }
}

impl MomentMaps {
    /// What keeps surfaces from shadowing themselves. Slopes are in the variance of a
    /// kernel; blockers that are looked for, and cells, are held against receivers'
    /// planes. A receiver is an occluder within a texel's slope.
    fn margin(self, kernel: Kernel) -> Margin {
        Margin {
            bias: if self == Self::Mask { 1.0 } else { 0.25 },
            slope: 0.0,
            planes: match kernel {
                Kernel::Light(_) if self != Self::Mask => Planes::Always,
                _ => Planes::Never,
            },
        }
    }

    fn functions(self) -> usize {
        match self {
            Self::Mask => 1,
            Self::Variance | Self::VarianceSoft => 2,
            Self::Exponential | Self::Four => 4,
        }
    }

    /// The functions for tables whose values are whole numbers up to `largest`.
    fn moments(self, settings: &Settings, largest: u32) -> Moments {
        match self {
            Self::Mask => Moments::Mask,
            Self::Variance | Self::VarianceSoft => Moments::Variance,
            Self::Exponential => Moments::Exponential(settings.exponent_for(largest) as f32),
            Self::Four => Moments::Four(settings.spread_for(largest) as f32),
        }
    }

    /// Tables of a view, and the shader that looks shadows up in them.
    fn looked(self, settings: &Settings, textures: &TableTextures, look_up: &LookUp<'_>) -> Looked {
        let tables = Tables::of(settings, textures, look_up);
        let made = tables.passes(|largest| self.moments(settings, largest));
        let stage = self.stage(settings, look_up, made.tables);
        let figures = figures(&made);
        let beyond = self == Self::Exponential && settings.exponent_is_beyond(made.largest);
        Looked {
            warnings: if beyond { vec![BEYOND] } else { Vec::new() },
            prefilter: made.passes,
            stage,
            textures: vec![made.binding],
            figures,
        }
    }

    /// The shader that looks shadows up in tables.
    fn stage(
        self,
        settings: &Settings,
        look_up: &LookUp<'_>,
        tables: MomentTables,
    ) -> FragmentStage {
        let light_half = look_up.light_half();
        match (self, settings.kernel) {
            (Self::Mask, _) => {
                let [near, far] = look_up.caster_distances();
                let plane = OccluderPlane {
                    light_half,
                    distance: settings.plane.between(near, far) as f32,
                    own: look_up.bias() as f32,
                    tables,
                };
                look_up.whole(plane).stage()
            }
            (Self::VarianceSoft, _) => {
                let soft = VarianceSoft {
                    light_half,
                    cells: settings.cells,
                    tables,
                };
                look_up.whole(soft).stage()
            }
            (_, Kernel::Fixed(taps)) => {
                let fixed = FixedKernel {
                    half: taps as f32 * 0.5,
                    tables,
                };
                look_up.whole(fixed).stage()
            }
            (_, Kernel::Light(samples)) => {
                let light = LightKernel {
                    light_half,
                    search: search_points(samples),
                    tables,
                };
                look_up.whole(light).stage()
            }
        }
    }
}

/// An exponent that tables do not resolve.
const BEYOND: [&str; 3] = [
    "exponent-beyond-tables",
    "light views have tables whose bits do not tell exponentials of that exponent from 0: \
     receivers far behind the first of two blockers are lit or dark as rounding has it",
    "set exponent to auto, or to no more than the figure `exponent` is then",
];

/// That objects are in the mask from which they take shadow; the method wants occluders and
/// receivers apart, which convex ones can be.
fn receivers_that_cast(scene: &Scene, apart: bool) -> Option<Warning> {
    let both = scene.objects.iter().filter(|o| o.casts && o.receives);
    let (count, what, hint) = match apart {
        false => (both.count(), "", "set groups to each"),
        true => (
            receivers_in_their_own_pictures(scene),
            " and are not convex",
            "cut them into convex pieces",
        ),
    };
    (count > 0).then(|| Warning {
        code: "receivers-that-cast",
        count,
        message: format!(
            "soler-sillion: {count} objects cast and receive{what}: they are in the mask \
             themselves, are lit where the light's centre sees them, and too dark round where it \
             does not; {hint}, set casts or receives to false, or use another technique"
        ),
    })
}

/// Points in -1..1 at which blockers are looked for, the same for all pixels.
fn search_points(samples: u32) -> Arc<[[f32; 2]]> {
    let side = samples.isqrt();
    let cells = (0..side).flat_map(|j| (0..side).map(move |i| [i, j]));
    let point = |cell| {
        let place = Pattern::RotatedGrid.place(cell, side, 0);
        place.map(|a| (2.0 * a - 1.0) as f32)
    };
    cells.map(point).collect()
}

/// What was chosen for a view.
fn figures(made: &Made) -> Vec<(&'static str, f64)> {
    let bits = f64::from(made.largest.ilog2() + 1);
    let mut figures = vec![("table-bits", bits)];
    match made.tables.moments {
        Moments::Variance | Moments::Mask => {}
        Moments::Exponential(c) => figures.push(("exponent", f64::from(c))),
        Moments::Four(spread) => figures.push(("moment-bias", f64::from(spread))),
    }
    figures
}
