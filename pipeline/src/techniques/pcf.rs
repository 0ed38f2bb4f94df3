//! Percentage-closer filtering: depths are compared one by one, then the outcomes
//! are filtered by one kernel for all receivers (docs/papers.md, baselines). It hides the
//! texels of hard shadows. It is no soft shadow: the kernel knows nothing of light
//! and blockers, which the parallel plates show.

use gnomon_shaders::shadow_maps::{BoxTaps, CubicTaps};

use crate::parts::frame_settings::FrameSettings;
use crate::parts::horizon::HORIZON;
use crate::parts::maps::mapped::{MapSettings, Mapped, Margin, Planes, Sources};
use crate::technique::{
    Capabilities, Condition, Frame, Param, ParamInfo, Params, ShadowKind, Technique, TechniqueError,
};
use crate::world::scene::Scene;
use crate::{choices, param_list};

/// The registry's entry.
pub(crate) struct Pcf;

choices! {
    /// What outcomes are filtered by.
    enum Kernel {
        /// A mean.
        Box = "box",
        /// A cubic B-spline.
        Bicubic = "bicubic",
    }
}

const KERNEL: Param<Kernel> = Param::choice(
    "kernel",
    Kernel::Box.word(),
    "the mean of taps x taps texels, or the cubic B-spline over 16",
);

const TAPS: Param<u32> =
    Param::<u32>::whole("taps", 4, [1, 64], "texels along a side of the box kernel")
        .unit("texels")
        .when(Condition::Is("kernel", &["box"]));

/// What parameters decide.
struct PcfSettings {
    kernel: Kernel,
    taps: u32,
    maps: MapSettings,
    frame: FrameSettings,
}

impl PcfSettings {
    fn read(params: &Params) -> Result<Self, TechniqueError> {
        Ok(Self {
            kernel: params.get(&KERNEL)?,
            taps: params.get(&TAPS)?,
            maps: MapSettings::read(params)?,
            frame: FrameSettings::read(params)?,
        })
    }

    /// Width of the kernel in texels.
    fn width(&self) -> u32 {
        match self.kernel {
            Kernel::Box => self.taps,
            Kernel::Bicubic => 4,
        }
    }
}

impl Technique for Pcf {
    fn name(&self) -> &'static str {
        "pcf"
    }

    fn summary(&self) -> &'static str {
        "shadow mapping with edges blurred by a kernel of fixed width"
    }

    fn params(&self) -> &'static [ParamInfo] {
        param_list!(
            &[KERNEL.info, TAPS.info],
            MapSettings::PARAMS,
            &[HORIZON.info],
            FrameSettings::PARAMS
        )
    }

    fn capabilities(&self) -> Capabilities {
        Capabilities::of_light_views(ShadowKind::Hard)
    }

    fn frame(
        &self,
        scene: &Scene,
        size: [u32; 2],
        params: &Params,
    ) -> Result<Frame, TechniqueError> {
        let settings = PcfSettings::read(params)?;
        // Over a kernel a slope bias would have to be as wide as it is, and part shadows
        // from their casters by as much.
        let width = settings.width();
        let margin = Margin {
            bias: 0.5,
            slope: if width > 1 { 0.0 } else { 0.5 },
            planes: if width > 1 {
                Planes::Always
            } else {
                Planes::Far
            },
        };
        let mapped = Mapped {
            scene,
            size,
            frame: settings.frame,
            maps: settings.maps,
            horizon: params.get(&HORIZON)?,
            margin,
            apart: false,
        };
        mapped.frame(
            |light| Sources::centre(self.name(), scene, light),
            |look_up| match settings.kernel {
                Kernel::Bicubic => look_up.whole(CubicTaps).stage(),
                Kernel::Box => look_up.whole(BoxTaps(settings.taps)).stage(),
            },
        )
    }
}
