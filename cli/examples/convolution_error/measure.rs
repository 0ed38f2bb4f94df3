//! Frames against the truth.

use std::error::Error;
use std::fmt::Write as _;

use gnomon_pipeline::measure::comparison::{BANDING_EDGE, Reference, ReferenceKind, facing};
use gnomon_pipeline::measure::render::{RenderSettings, Rendered, render};
use gnomon_pipeline::technique::Params;
use gnomon_pipeline::techniques::find;
use gnomon_pipeline::truth::metrics::banding::Banding;
use gnomon_pipeline::truth::metrics::visibility::VisibilityError;
use gnomon_pipeline::truth::oracle::area::LightRegion;
use gnomon_pipeline::world::scene::Scene;
use gnomon_raster::GpuConfig;

const SIZE: [u32; 2] = [320, 240];
/// Threads, so that times are of as many on every machine.
const THREADS: usize = 2;
/// Milliseconds below which frames are timed more often.
const SHORT: f64 = 100.0;

pub(crate) const TECHNIQUE: &str = "convolution-soft-shadows";
pub(crate) const PCSS: &str = "pcss";
pub(crate) const ORDERS: [u32; 5] = [1, 2, 4, 8, 16];
pub(crate) const SIDES: [u32; 4] = [128, 256, 512, 1024];
/// `filter` and `format`.
pub(crate) const FILTERS: [[&str; 2]; 4] = [
    ["mip", "paper"],
    ["mip", "float"],
    ["sat", "paper"],
    ["sat-u32", "paper"],
];
/// `a` and `b` beside the default of 30 and 20.
const SHARPENING: [[u32; 2]; 3] = [[0, 20], [30, 5], [30, 10]];

/// What a frame was drawn with.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Setup {
    pub(crate) technique: &'static str,
    /// 0 for techniques without a series.
    pub(crate) order: u32,
    pub(crate) side: u32,
    pub(crate) filter: &'static str,
    pub(crate) format: &'static str,
    pub(crate) sharpening: [u32; 2],
}

impl Setup {
    fn convolution(order: u32, side: u32, [filter, format]: [&'static str; 2]) -> Self {
        Self {
            technique: TECHNIQUE,
            order,
            side,
            filter,
            format,
            sharpening: [30, 20],
        }
    }

    fn pcss(side: u32) -> Self {
        Self {
            technique: PCSS,
            ..Self::convolution(0, side, ["all texels", "-"])
        }
    }

    fn set(&self) -> Vec<String> {
        let side = format!("map-size={}", self.side);
        if self.technique == PCSS {
            return vec![side, "sampling=all".to_owned()];
        }
        let [a, b] = self.sharpening;
        vec![
            side,
            format!("m={}", self.order),
            format!("filter={}", self.filter),
            format!("format={}", self.format),
            format!("a={a}"),
            format!("b={b}"),
        ]
    }

    /// Everything that is measured: order x side x filter, sharpening by order, and
    /// PCSS by side; but what takes seconds and gigabytes a frame and tells nothing new.
    fn all() -> Vec<Self> {
        let mut all = Vec::new();
        for side in SIDES {
            for filter in FILTERS {
                let dear = side == SIDES[3] && filter[0] != "mip";
                let orders = ORDERS.into_iter().filter(|order| !dear || *order <= 4);
                all.extend(orders.map(|order| Self::convolution(order, side, filter)));
            }
            all.extend((side < SIDES[3]).then(|| Self::pcss(side)));
        }
        for sharpening in SHARPENING {
            let of = |order| Self {
                sharpening,
                ..Self::convolution(order, 512, FILTERS[3])
            };
            all.extend(ORDERS.map(of));
        }
        all
    }
}

/// A frame's errors and cost.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    pub(crate) scene: String,
    pub(crate) setup: Setup,
    /// Where the surface faces the light; what does not is dark anyhow.
    pub(crate) rmse: f64,
    /// The same by region of the truth: umbra, penumbra, lit; NaN where there is none.
    regions: [f64; 3],
    /// Of all surfaces.
    rmse_all: f64,
    mean: f64,
    p99: f64,
    max: f64,
    /// Step height in penumbrae that 99% do not exceed.
    steps: f64,
    /// Of the passes that make the shadow: the least.
    pub(crate) ms: f64,
    pub(crate) bytes: f64,
}

impl Row {
    /// Whether all parameters have the technique's defaults.
    pub(crate) fn is_default(&self) -> bool {
        self.setup == Setup::convolution(4, 512, FILTERS[0])
    }

    fn new(
        scene: &Scene,
        truth: &Reference,
        faces: &[bool],
        setup: Setup,
    ) -> Result<Self, Box<dyn Error>> {
        let done = drawn(scene, &setup)?;
        let under = truth.under(&done.depth)?;
        // Left out on both sides where the truth has nothing to say: outlines.
        let pairs = done.visibility.iter().zip(&under.truth.values);
        let seen: Vec<f32> = pairs
            .map(|(v, t)| if t.is_nan() { f32::NAN } else { *v })
            .collect();
        let whole = VisibilityError::measure(&under.truth, SIZE, &seen)?;
        let only = |(v, faces): (&f32, &bool)| if *faces { *v } else { f32::NAN };
        let seen: Vec<f32> = seen.iter().zip(faces).map(only).collect();
        let error = VisibilityError::measure(&under.truth, SIZE, &seen)?;
        let banding = Banding::measure(&under.truth, SIZE, &seen, BANDING_EDGE)?;
        let all = error.all.ok_or("no surface is seen")?;
        Ok(Self {
            scene: scene.name.clone(),
            setup,
            rmse: all.rmse,
            regions: LightRegion::ALL.map(|r| error.of_region(r).map_or(f64::NAN, |e| e.rmse)),
            rmse_all: whole.all.map_or(f64::NAN, |e| e.rmse),
            mean: all.mean,
            p99: all.p99,
            max: all.max,
            steps: banding.p99,
            ms: done.1,
            bytes: done.2,
        })
    }
}

/// A frame, with time and bytes of its shadow passes.
struct Drawn(Rendered, f64, f64);

impl std::ops::Deref for Drawn {
    type Target = Rendered;

    fn deref(&self) -> &Rendered {
        &self.0
    }
}

fn drawn(scene: &Scene, setup: &Setup) -> Result<Drawn, Box<dyn Error>> {
    let technique = find(setup.technique)?;
    let mut set = setup.set();
    set.push("light=0".to_owned());
    let params = Params::parse(technique, set)?;
    let frame = |repeat| {
        let settings = RenderSettings {
            size: SIZE,
            gpu: GpuConfig {
                threads: THREADS,
                ..GpuConfig::default()
            },
            repeat,
        };
        render(scene, technique, &params, &settings)
    };
    let shadow = |done: &Rendered| -> f64 {
        let passes = done.pass_ms.iter().zip(done.roles.passes());
        let of_shadow = passes.filter(|(_, role)| !role.is_shading());
        of_shadow.map(|((_, ms), _)| ms).sum()
    };
    let done = frame(1)?;
    let mut ms = shadow(&done);
    // What else the machine does only makes times longer.
    if ms < SHORT {
        for _ in 0..3 {
            ms = ms.min(shadow(&frame(3)?));
        }
    } else {
        ms = ms.min(shadow(&frame(1)?));
    }
    let passes = done.report.passes.iter().zip(done.roles.passes());
    let of_shadow = passes.filter(|(_, role)| !role.is_shading());
    let bytes: u64 = of_shadow
        .map(|(p, _)| p.totals().traffic.total_bytes())
        .sum();
    Ok(Drawn(done, ms, bytes as f64))
}

/// All rows of a scene.
pub(crate) fn measure(scene: &Scene) -> Result<Vec<Row>, Box<dyn Error>> {
    let truth = Reference::new(scene, 0, SIZE, ReferenceKind::Exact, None, &|| ())?;
    let faces = facing(scene, 0, SIZE);
    let mut rows = Vec::new();
    for setup in Setup::all() {
        let row = Row::new(scene, &truth, &faces, setup)?;
        println!("{}", line(&row));
        rows.push(row);
    }
    Ok(rows)
}

const HEADER: &str = "scene,technique,m,map_size,filter,format,a,b,rmse,rmse_umbra,rmse_penumbra,\
    rmse_lit,rmse_all,mean,p99,max,steps_p99,shadow_ms,shadow_bytes";

/// The table; an empty cell where there is nothing to tell.
pub(crate) fn csv(rows: &[Row]) -> String {
    let lines = rows.iter().map(line);
    std::iter::once(HEADER.to_owned())
        .chain(lines)
        .fold(String::new(), |text, line| text + &line + "\n")
}

fn line(row: &Row) -> String {
    let setup = &row.setup;
    let mut text = format!("{},{},", row.scene, setup.technique);
    match setup.order {
        0 => _ = write!(text, ",{},{},,,", setup.side, setup.filter),
        m => {
            let [a, b] = setup.sharpening;
            let (side, filter, format) = (setup.side, setup.filter, setup.format);
            _ = write!(text, "{m},{side},{filter},{format},{a},{b}");
        }
    }
    let [umbra, penumbra, lit] = row.regions;
    let errors = [
        row.rmse,
        umbra,
        penumbra,
        lit,
        row.rmse_all,
        row.mean,
        row.p99,
        row.max,
        row.steps,
    ];
    for error in errors {
        match error.is_nan() {
            true => text.push(','),
            false => _ = write!(text, ",{error:.5}"),
        }
    }
    _ = write!(text, ",{:.2},{:.0}", row.ms, row.bytes);
    text
}
