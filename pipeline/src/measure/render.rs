//! The driver: runs a technique's frame on an emulated GPU, times it, and reads
//! the results back as pictures.

use std::time::Instant;

use gnomon_raster::texture::ColorTexel;
use gnomon_raster::{Gpu, GpuConfig, SubmitReport, Subresource, memory};
use gnomon_shaders::line_samples::NEGATIVE_DEPTH;
use thiserror::Error;

pub use super::supersample::MAX_SUPERSAMPLE;
use super::supersample::{each_pixel, mean, resolved};
use super::watch;
use crate::technique::{
    CasterUse, Figure, Frame, KeptPictures, Params, PictureToKeep, Roles, Technique,
    TechniqueError, VisibilityOutput, Warning,
};
use crate::world::scene::Scene;

/// How to render.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RenderSettings {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// How the emulated GPU executes.
    pub gpu: GpuConfig,
    /// Frames that are timed; above 1 another one warms up first. 0 counts as 1.
    pub repeat: u32,
}

impl Default for RenderSettings {
    fn default() -> Self {
        Self {
            size: [960, 540],
            gpu: GpuConfig::default(),
            repeat: 1,
        }
    }
}

/// A rendered frame.
#[derive(Clone, Debug)]
pub struct Rendered {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The picture, sRGB-encoded, rows from the top.
    pub srgb: Vec<[u8; 4]>,
    /// The same in linear light, before it is limited to 0..=1.
    pub color: Vec<[f32; 3]>,
    /// Light's visibility, rows from the top: 1 fully lit, 0 in shadow, NaN
    /// where no surface is seen. With several lights that of the first one.
    pub visibility: Vec<f32>,
    /// Depth in 0..=1, 1 where no surface is seen; rows from the top.
    pub depth: Vec<f32>,
    /// What the technique left in the stencil; rows from the top.
    pub stencil: Vec<u8>,
    /// Counters; the same for every one of the repeated frames.
    pub report: SubmitReport,
    /// What the passes of the report and their draws are for.
    pub roles: Roles,
    /// What the technique took to build its frame, once, in milliseconds: silhouettes,
    /// volumes, tables, commands; loading left out.
    pub build_ms: f64,
    /// Median time of a frame in milliseconds; loading, silhouettes and volumes
    /// left out.
    pub frame_ms: f64,
    /// Times of all timed frames in milliseconds, in the order in which they were drawn.
    pub frames_ms: Vec<f64>,
    /// Median time of every pass, in order.
    pub pass_ms: Vec<(String, f64)>,
    /// The scene's and the technique's warnings, and the counters' events.
    pub warnings: Vec<Warning>,
    /// What became of each caster.
    pub casters: Vec<CasterUse>,
    /// Numbers that the technique chose for the scene, and what its shaders counted.
    pub figures: Vec<Figure>,
}

impl Rendered {
    /// Content hash of the picture: size and sRGB bytes, as 64 hex digits.
    pub fn color_hash(&self) -> String {
        hash(self.size, self.srgb.iter().flatten().copied())
    }

    /// Content hash of the visibility: size and float bits, as 64 hex digits.
    pub fn visibility_hash(&self) -> String {
        hash(
            self.size,
            self.visibility
                .iter()
                .flat_map(|v| v.to_bits().to_le_bytes()),
        )
    }
}

/// BLAKE3 of `size` (two little-endian `u32`) and `bytes`, as 64 hex digits:
/// stable across machines and file formats.
pub fn hash(size: [u32; 2], bytes: impl IntoIterator<Item = u8>) -> String {
    let mut hasher = blake3::Hasher::new();
    size.iter().for_each(|s| {
        hasher.update(&s.to_le_bytes());
    });
    let mut bytes = bytes.into_iter();
    loop {
        let part: Vec<u8> = bytes.by_ref().take(1 << 16).collect();
        if part.is_empty() {
            break;
        }
        hasher.update(&part);
    }
    hasher.finalize().to_hex().to_string()
}

/// Why nothing was rendered.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum RenderError {
    /// The technique gives no frame.
    #[error(transparent)]
    Technique(#[from] TechniqueError),
    /// The GPU refuses its settings or the frame.
    #[error(transparent)]
    Gpu(#[from] gnomon_raster::Error),
}

/// Renders `scene` with `technique`.
///
/// # Errors
/// The technique refuses the scene, or the GPU its settings.
pub fn render(
    scene: &Scene,
    technique: &dyn Technique,
    params: &Params,
    settings: &RenderSettings,
) -> Result<Rendered, RenderError> {
    render_supersampled(scene, technique, params, settings, 1)
}

/// The same from `side` × `side` samples of each pixel, up to [`MAX_SUPERSAMPLE`]: colours are
/// their mean in linear light, resolved by a pass of the frame; visibility is the mean of
/// samples that show a surface, depth the nearest, stencil that of the first sample. One
/// sample is [`render`], to the bit.
///
/// # Errors
/// As [`render`]; the samples of a picture have limits as a picture has.
pub fn render_supersampled(
    scene: &Scene,
    technique: &dyn Technique,
    params: &Params,
    settings: &RenderSettings,
    side: u32,
) -> Result<Rendered, RenderError> {
    let build = |size| technique.frame(scene, size, params);
    Ok(run(scene, technique, params, settings, side, build)?.0)
}

/// Renders the next frame of an animation: what the frame before left in `kept` is not
/// drawn again, and `kept` is then what this one leaves. The picture is that of
/// [`render`]; counters are of what was drawn.
///
/// # Errors
/// As [`render`]; `kept` then stays as it was.
pub fn render_next(
    scene: &Scene,
    technique: &dyn Technique,
    params: &Params,
    settings: &RenderSettings,
    kept: &mut KeptPictures,
) -> Result<Rendered, RenderError> {
    render_next_supersampled(scene, technique, params, (settings, 1), kept)
}

/// The same with the picture of [`render_supersampled`], from the number of samples given.
///
/// # Errors
/// As [`render_next`].
pub fn render_next_supersampled(
    scene: &Scene,
    technique: &dyn Technique,
    params: &Params,
    (settings, side): (&RenderSettings, u32),
    kept: &mut KeptPictures,
) -> Result<Rendered, RenderError> {
    let build = |size| technique.frame_after(scene, size, params, kept);
    let (rendered, left) = run(scene, technique, params, settings, side, build)?;
    *kept = left;
    Ok(rendered)
}

/// Runs the frame that `build` makes; gives what it leaves for the next one too.
fn run(
    scene: &Scene,
    technique: &dyn Technique,
    params: &Params,
    settings: &RenderSettings,
    side: u32,
    build: impl FnOnce([u32; 2]) -> Result<Frame, TechniqueError>,
) -> Result<(Rendered, KeptPictures), RenderError> {
    let side = side.clamp(1, MAX_SUPERSAMPLE);
    let start = Instant::now();
    let mut frame = build(settings.size.map(|s| s.saturating_mul(side)))?;
    let build_ms = start.elapsed().as_secs_f64() * 1e3;
    check_roles(technique, &frame)?;
    if side > 1 {
        frame = resolved(frame, settings.size, side)?;
    }
    frame.warnings.extend(params.without_effect(scene));
    let mut gpu = Gpu::new(settings.gpu)?;
    gpu.load(&frame.recording)?;
    let mut times = Times::measure(&mut gpu, &frame, settings.repeat)?;
    times.build = build_ms;
    let mut left = left_behind(&gpu, &frame.keep)?;
    left.work = frame.work.clone();
    let sizes = (settings.size, side);
    Ok((read_back(&gpu, scene, frame, sizes, times)?, left))
}

/// The pictures that a frame asks to keep; those of one texture follow one another.
fn left_behind(gpu: &Gpu, keep: &[PictureToKeep]) -> Result<KeptPictures, RenderError> {
    let mut left = KeptPictures::default();
    for pictures in keep.chunk_by(|a, b| a.texture == b.texture) {
        let texture = gpu.texture(pictures[0].texture)?;
        let descriptor = texture.descriptor();
        let (width, texel) = (descriptor.size[0], descriptor.format.bytes() as u32);
        let image = texture.read_packed(Subresource::default())?;
        for picture in pictures {
            left.keep(picture.key, picture.cut(&image, width, texel));
        }
    }
    Ok(left)
}

/// Roles are beside the passes, and go wrong without being noticed.
fn check_roles(technique: &dyn Technique, frame: &Frame) -> Result<(), TechniqueError> {
    let [passes, roles] = [
        frame.recording.list.passes.len(),
        frame.roles.passes().len(),
    ];
    if passes == roles {
        return Ok(());
    }
    Err(TechniqueError::MissingRoles {
        technique: technique.name(),
        passes,
        roles,
    })
}

/// Times of building and of repeated frames, and the counters of the last.
struct Times {
    report: SubmitReport,
    build: f64,
    frames: Vec<f64>,
    passes: Vec<Vec<f64>>,
}

impl Times {
    fn measure(gpu: &mut Gpu, frame: &Frame, repeat: u32) -> Result<Self, RenderError> {
        if repeat > 1 {
            watch::submit(gpu, &frame.recording.list)?;
        }
        let mut times = Self {
            report: SubmitReport::default(),
            build: 0.0,
            frames: Vec::new(),
            passes: vec![Vec::new(); frame.recording.list.passes.len()],
        };
        for _ in 0..repeat.max(1) {
            let start = Instant::now();
            let report = match repeat > 1 {
                true => gpu.submit(&frame.recording.list)?,
                false => watch::submit(gpu, &frame.recording.list)?,
            };
            times.frames.push(start.elapsed().as_secs_f64() * 1e3);
            for (all, pass) in times.passes.iter_mut().zip(&report.passes) {
                all.push(pass.time.as_secs_f64() * 1e3);
            }
            times.report = report;
        }
        Ok(times)
    }
}

fn read_back(
    gpu: &Gpu,
    scene: &Scene,
    frame: Frame,
    (size, side): ([u32; 2], u32),
    times: Times,
) -> Result<Rendered, RenderError> {
    let image = Subresource::default();
    let color = gpu.texture(frame.outputs.color)?.read_color(image)?;
    let depth = gpu
        .texture(frame.outputs.depth_stencil)?
        .read_depth(image)?;
    let stencil = gpu
        .texture(frame.outputs.depth_stencil)?
        .read_stencil(image)?;
    let encoder = SrgbEncoder::new();
    let labels = times.report.passes.iter().map(|p| p.label.clone());
    let mut warnings = scene.warnings.clone();
    let samples = size.map(|s| s * side);
    warnings.extend(scene.view_warnings(samples));
    warnings.extend(frame.warnings);
    warnings.extend(event_warnings(&times.report, &frame.roles));
    let counted = times.report.shader_counts().into_iter();
    let counted = counted.map(|(name, n)| Figure {
        name: name.to_owned(),
        value: n as f64,
    });
    let mut visibility = visibility(gpu, frame.outputs.visibility, samples, &depth, &stencil)?;
    let (mut depth, mut stencil) = (depth, stencil);
    if side > 1 {
        let nearest =
            |s: &mut dyn Iterator<Item = f32>| s.fold(1.0, |a, b| if b < a { b } else { a });
        let first = |s: &mut dyn Iterator<Item = u8>| s.next().unwrap_or_default();
        visibility = each_pixel(&visibility, size, side, mean);
        depth = each_pixel(&depth, size, side, nearest);
        stencil = each_pixel(&stencil, size, side, first);
    }
    Ok(Rendered {
        size,
        srgb: pixels(color.iter().map(|t| encoder.encode(t.0)), size)?,
        color: pixels(color.iter().map(|t| [t.0[0], t.0[1], t.0[2]]), size)?,
        visibility,
        depth,
        stencil,
        build_ms: times.build,
        frame_ms: median(times.frames.clone()),
        frames_ms: times.frames,
        pass_ms: labels.zip(times.passes.into_iter().map(median)).collect(),
        report: times.report,
        roles: frame.roles,
        warnings,
        casters: frame.casters,
        figures: frame.figures.into_iter().chain(counted).collect(),
    })
}

fn visibility(
    gpu: &Gpu,
    output: VisibilityOutput,
    size: [u32; 2],
    depth: &[f32],
    stencil: &[u8],
) -> Result<Vec<f32>, RenderError> {
    let values: Vec<f32> = match output {
        VisibilityOutput::Full => pixels(depth.iter().map(|_| 1.0), size)?,
        VisibilityOutput::StencilZero => {
            let lit = |s: &u8| if *s == 0 { 1.0 } else { 0.0 };
            pixels(stencil.iter().map(lit), size)?
        }
        VisibilityOutput::Red {
            texture,
            scale,
            offset,
        } => {
            let texels = gpu.texture(texture)?.read_color(Subresource::default())?;
            let value = |t: &ColorTexel| (t.0[0] * scale + offset).clamp(0.0, 1.0);
            pixels(texels.iter().map(value), size)?
        }
        VisibilityOutput::Bytes { texture, scale } => {
            let texels = gpu.texture(texture)?.read_color(Subresource::default())?;
            let byte = |v: f32| (v * 255.0).round_ties_even();
            let whole = |t: &ColorTexel| byte(t.0[0]) * 256.0 + byte(t.0[1]);
            let value = |t: &ColorTexel| (whole(t) * scale).clamp(0.0, 1.0);
            pixels(texels.iter().map(value), size)?
        }
    };
    let at = |(&depth, value)| if depth >= 1.0 { f32::NAN } else { value };
    pixels(depth.iter().zip(values).map(at), size)
}

/// A value for each pixel, unless memory is short.
fn pixels<T>(values: impl Iterator<Item = T>, [w, h]: [u32; 2]) -> Result<Vec<T>, RenderError> {
    let n = w as usize * h as usize;
    let what = || format!("a picture of {w}x{h} pixels");
    Ok(memory::collected(values, n, what)?)
}

/// Events that changed the picture without stopping it.
fn event_warnings(report: &SubmitReport, roles: &Roles) -> Vec<Warning> {
    let mut total = gnomon_raster::Counters::default();
    report.passes.iter().for_each(|p| total.add(&p.totals()));
    let saturated = |coverage: bool| -> u64 {
        let passes = report.passes.iter().enumerate();
        passes
            .filter(|(number, _)| roles.of_pass(*number).adds_up_coverage() == coverage)
            .flat_map(|(_, p)| p.totals().events.blend_saturated)
            .sum()
    };
    let events = [
        (
            "coverage-saturated",
            saturated(true),
            "channels of coverage buffers saturated: more overlaps there than they hold; split the light or use soft-shadow-volumes with buffer=r32f",
        ),
        (
            "blend-saturated",
            saturated(false),
            "colour channels saturated while light was added; dim the lights or use color-format=rgba16f",
        ),
        (
            "negative-depth-complexity",
            counted(report, NEGATIVE_DEPTH),
            "receivers counted fewer casters than none along some line across a light; their visibility is wrong",
        ),
        (
            "nan",
            total.events.nan_canonicalised,
            "shader values were NaN and have been replaced",
        ),
        (
            "non-finite-vertices",
            total.primitives.non_finite,
            "primitives have vertices that are not finite in clip space and were dropped",
        ),
    ];
    let warning = |(code, count, what): (&'static str, u64, &str)| Warning {
        code,
        count: count as usize,
        message: format!("{count} {what}"),
    };
    events
        .into_iter()
        .filter(|(_, count, _)| *count != 0)
        .map(warning)
        .collect()
}

/// What shaders counted under that name.
fn counted(report: &SubmitReport, name: &str) -> u64 {
    let counts = report.shader_counts().into_iter();
    counts.filter(|(of, _)| *of == name).map(|(_, n)| n).sum()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

/// Encodes linear light as 8-bit sRGB (IEC 61966-2-1), rounding to nearest.
#[derive(Clone, Debug)]
pub struct SrgbEncoder {
    /// `thresholds[i]`: the least linear value that is encoded as `i + 1`.
    thresholds: Vec<f32>,
}

impl SrgbEncoder {
    /// Prepares the thresholds.
    pub fn new() -> Self {
        let linear = |i: u32| {
            let s = (f64::from(i) - 0.5) / 255.0;
            if s <= 0.04045 {
                s / 12.92
            } else {
                libm::pow((s + 0.055) / 1.055, 2.4)
            }
        };
        Self {
            thresholds: (1..256).map(|i| linear(i) as f32).collect(),
        }
    }

    /// Encodes one texel; alpha is linear. Values out of 0..=1 are limited, NaN is 0.
    pub fn encode(&self, [r, g, b, a]: [f32; 4]) -> [u8; 4] {
        let channel = |v: f32| self.thresholds.partition_point(|t| *t <= v) as u8;
        [
            channel(r),
            channel(g),
            channel(b),
            (a * 255.0).round_ties_even() as u8,
        ]
    }
}

impl Default for SrgbEncoder {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn srgb_is_the_standard_curve() {
        let e = SrgbEncoder::new();
        for i in 0..=255u8 {
            let s = f64::from(i) / 255.0;
            let linear = if s <= 0.04045 {
                s / 12.92
            } else {
                libm::pow((s + 0.055) / 1.055, 2.4)
            };
            assert_eq!(e.encode([linear as f32; 4])[..3], [i; 3]);
        }
        assert_eq!(e.encode([f32::NAN, -1.0, 7.0, 2.0]), [0, 0, 255, 255]);
        assert_eq!(e.encode([0.5, 0.18, 0.0, 0.5]), [188, 118, 0, 128]);
    }

    #[test]
    fn hashes_cover_size_and_contents() {
        let bytes = || [1u8, 2, 3, 4];
        assert_eq!(hash([1, 1], bytes()), hash([1, 1], bytes()));
        assert_ne!(hash([1, 2], bytes()), hash([2, 1], bytes()));
        assert_ne!(hash([1, 1], bytes()), hash([1, 1], [1, 2, 3, 5]));
        assert_eq!(hash([1, 1], bytes()).len(), 64);
    }
}
