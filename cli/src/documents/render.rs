//! A rendered frame as JSON.

use gnomon_pipeline::measure::render::Rendered;
use gnomon_pipeline::measure::wedge_work::WedgeWork;
use gnomon_pipeline::technique::{Params, Technique, VolumeMethod, Warning};
use gnomon_raster::{
    ClientTraffic, Counters, FragmentCounters, GpuConfig, PassReport, SubmitReport, TileCounters,
    Traffic,
};
use serde::Serialize;

use super::draws::{DrawDocument, draw_documents};
use super::object::Object;
use super::sums;

/// The document of `render`, and of each render of `demo`.
#[derive(Clone, Debug, Serialize)]
pub struct RenderDocument {
    scene: String,
    technique: &'static str,
    params: Object<String>,
    size: [u32; 2],
    threads: usize,
    tile: u32,
    simd: &'static str,
    skip: bool,
    repeat: u32,
    /// Samples along a side of a pixel; only where there are several.
    #[serde(skip_serializing_if = "Option::is_none")]
    supersample: Option<u32>,
    hash: Hashes,
    time_ms: Times,
    passes: Vec<PassDocument>,
    totals: WorkDocument,
    /// Only where it was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    draws: Option<Vec<DrawDocument>>,
    /// `null` for techniques that add no coverage of wedges.
    wedge_work: Option<WedgeWorkDocument>,
    casters: Vec<CasterDocument>,
    /// Numbers that the technique chose, by name.
    figures: Object<f64>,
    warnings: Vec<WarningDocument>,
    files: Vec<FileDocument>,
}

/// What the scene and flags say about a render.
#[derive(Clone, Copy)]
pub struct RenderInputs<'a> {
    /// What was drawn.
    pub scene: &'a gnomon_pipeline::world::scene::Scene,
    /// By which technique.
    pub technique: &'static dyn Technique,
    /// Its parameters.
    pub params: &'a Params,
    /// How it was executed.
    pub gpu: GpuConfig,
    /// Frames that were timed.
    pub repeat: u32,
    /// Samples along a pixel's side.
    pub supersample: u32,
}

/// A file that was written.
#[derive(Clone, Debug, Serialize)]
pub struct FileDocument {
    /// `render`, `visibility`, `report`, or the overlay's name.
    pub kind: &'static str,
    /// Where it is.
    pub path: String,
}

/// Hashes of what a frame leaves behind.
#[derive(Clone, Debug, Serialize)]
pub struct Hashes {
    color: String,
    visibility: String,
}

impl Hashes {
    /// Those of `done`.
    pub fn of(done: &Rendered) -> Self {
        Self {
            color: done.color_hash(),
            visibility: done.visibility_hash(),
        }
    }
}

#[derive(Clone, Debug, Serialize)]
struct Times {
    build: f64,
    frame: f64,
    passes: Object<f64>,
}

#[derive(Clone, Debug, Serialize)]
struct PassDocument {
    name: String,
    /// What fragment shaders counted themselves.
    shader_counts: Object<u64>,
    #[serde(flatten)]
    work: WorkDocument,
}

/// What a pass, or a frame, counted.
#[derive(Clone, Debug, Default, Serialize)]
struct WorkDocument {
    draws: usize,
    fragments: FragmentDocument,
    fragment_shader_invocations: u64,
    tiles: TileDocument,
    primitives: PrimitiveDocument,
    events: EventDocument,
    traffic: Object<TrafficDocument>,
    /// Writes of clears, by client; not part of `traffic`.
    clear: Object<TrafficDocument>,
}

#[derive(Clone, Debug, Default, Serialize)]
pub(crate) struct FragmentDocument {
    generated: u64,
    hiz_killed: u64,
    bounds_failed: u64,
    stencil_failed: u64,
    depth_failed: u64,
    discarded: u64,
    written: u64,
}

#[derive(Clone, Debug, Default, Serialize)]
pub(crate) struct TileDocument {
    tested: u64,
    culled: u64,
    accepted: u64,
}

#[derive(Clone, Debug, Default, Serialize)]
pub(crate) struct PrimitiveDocument {
    vertex_shader_invocations: u64,
    input: u64,
    non_finite: u64,
    frustum_culled: u64,
    clipped: u64,
    degenerate: u64,
    face_culled: u64,
    rasterized: u64,
    steep_depth_planes: u64,
}

#[derive(Clone, Debug, Default, Serialize)]
pub(crate) struct EventDocument {
    silent_z_writes: u64,
    silent_stencil_writes: u64,
    silent_color_writes: u64,
    blend_saturated: u64,
    source_clamped: u64,
    nan_canonicalised: u64,
    depth_clamped: u64,
}

#[derive(Clone, Debug, Default, Serialize)]
pub(crate) struct TrafficDocument {
    read_accesses: u64,
    read_bytes: u64,
    write_accesses: u64,
    write_bytes: u64,
}

/// How much of the penumbra shader's work was in penumbrae.
#[derive(Clone, Debug, Serialize)]
pub struct WedgeWorkDocument {
    shaded: u64,
    covering: u64,
    /// `null` where nothing is covered.
    ratio: Option<f64>,
}

impl WedgeWorkDocument {
    /// That of `done`; `None` where no coverage of wedges is added.
    pub fn of(done: &Rendered) -> Option<Self> {
        WedgeWork::of(&done.report, &done.roles).map(|work| Self {
            shaded: work.shaded,
            covering: work.covering,
            ratio: Some(work.ratio()).filter(|r| r.is_finite()),
        })
    }
}

#[derive(Clone, Debug, Serialize)]
struct CasterDocument {
    object: String,
    light: usize,
    method: &'static str,
    light_cap_triangles: usize,
    dark_cap_triangles: usize,
    side_triangles: usize,
}

/// Something amiss that did not stop the work.
#[derive(Clone, Debug, Serialize)]
pub struct WarningDocument {
    code: &'static str,
    count: usize,
    message: String,
}

impl RenderDocument {
    /// Describes a finished render.
    pub fn new(job: RenderInputs<'_>, done: &Rendered, files: Vec<FileDocument>) -> Self {
        let params = job.params.iter().map(|(k, v)| (k.to_owned(), v.to_owned()));
        Self {
            scene: job.scene.name.clone(),
            technique: job.technique.name(),
            params: Object(params.collect()),
            size: done.size,
            threads: worker_threads(job.gpu.threads),
            tile: job.gpu.tile,
            simd: job.gpu.simd.name(),
            skip: job.gpu.skip,
            repeat: job.repeat,
            supersample: (job.supersample > 1).then_some(job.supersample),
            hash: Hashes::of(done),
            time_ms: Times {
                build: done.build_ms,
                frame: done.frame_ms,
                passes: merged(&done.pass_ms),
            },
            passes: done.report.passes.iter().map(PassDocument::new).collect(),
            totals: WorkDocument::total(&done.report),
            draws: None,
            wedge_work: WedgeWorkDocument::of(done),
            casters: casters(job.scene, done),
            figures: figures(done),
            warnings: done.warnings.iter().map(WarningDocument::new).collect(),
            files,
        }
    }

    /// The same with what each draw counted.
    #[must_use]
    pub fn with_draws(self, report: &SubmitReport) -> Self {
        Self {
            draws: Some(draw_documents(report)),
            ..self
        }
    }
}

fn figures(done: &Rendered) -> Object<f64> {
    let figures = done.figures.iter();
    Object(figures.map(|f| (f.name.clone(), f.value)).collect())
}

/// How many threads `--threads N` stands for.
pub(crate) fn worker_threads(asked: usize) -> usize {
    match asked {
        0 => std::thread::available_parallelism().map_or(1, usize::from),
        n => n,
    }
}

/// Passes of one name as one entry, since keys are unique.
fn merged(times: &[(String, f64)]) -> Object<f64> {
    let mut out: Vec<(String, f64)> = Vec::new();
    for (name, ms) in times {
        match out.iter_mut().find(|(n, _)| n == name) {
            Some((_, sum)) => *sum += ms,
            None => out.push((name.clone(), *ms)),
        }
    }
    Object(out)
}

fn casters(scene: &gnomon_pipeline::world::scene::Scene, done: &Rendered) -> Vec<CasterDocument> {
    let describe = |c: &gnomon_pipeline::technique::CasterUse| CasterDocument {
        object: scene.objects[c.object].name.clone(),
        light: c.light,
        method: method_name(c.method),
        light_cap_triangles: c.triangles[0],
        dark_cap_triangles: c.triangles[1],
        side_triangles: c.triangles[2],
    };
    done.casters.iter().map(describe).collect()
}

/// Stable names of how casters were counted.
fn method_name(method: VolumeMethod) -> &'static str {
    match method {
        VolumeMethod::DepthPass => "zpass",
        VolumeMethod::DepthFail => "zfail",
        VolumeMethod::Skipped => "skipped",
    }
}

impl PassDocument {
    fn new(pass: &PassReport) -> Self {
        Self {
            name: pass.label.clone(),
            shader_counts: Object(named_counts(pass)),
            work: WorkDocument::new(pass.draws.len(), &pass.totals(), &pass.clear),
        }
    }
}

fn named_counts(pass: &PassReport) -> Vec<(String, u64)> {
    let counts = pass.shader_counts().into_iter();
    counts.map(|(name, n)| (name.to_owned(), n)).collect()
}

impl WorkDocument {
    fn new(draws: usize, c: &Counters, clear: &ClientTraffic) -> Self {
        Self {
            draws,
            fragments: (&c.fragments).into(),
            fragment_shader_invocations: c.fragment_shader_invocations,
            tiles: (&c.tiles).into(),
            primitives: (&c.primitives).into(),
            events: (&c.events).into(),
            traffic: traffic(c.traffic.named()),
            clear: traffic(clear.named()),
        }
    }

    fn total(report: &SubmitReport) -> Self {
        let sum = sums::frame_counters(report);
        let clear = sums::clears(report);
        let draws = report.passes.iter().map(|p| p.draws.len()).sum();
        Self::new(draws, &sum, &clear.traffic)
    }
}

pub(super) fn traffic(named: Vec<(String, Traffic)>) -> Object<TrafficDocument> {
    Object(
        named
            .into_iter()
            .map(|(name, t)| (name, (&t).into()))
            .collect(),
    )
}

impl WarningDocument {
    /// Describes a warning.
    pub fn new(warning: &Warning) -> Self {
        Self {
            code: warning.code,
            count: warning.count,
            message: warning.message.clone(),
        }
    }
}

impl From<&Traffic> for TrafficDocument {
    fn from(t: &Traffic) -> Self {
        let Traffic {
            read_accesses,
            read_bytes,
            write_accesses,
            write_bytes,
        } = *t;
        Self {
            read_accesses,
            read_bytes,
            write_accesses,
            write_bytes,
        }
    }
}

impl From<&TileCounters> for TileDocument {
    fn from(t: &TileCounters) -> Self {
        let TileCounters {
            tested,
            culled,
            accepted,
        } = *t;
        Self {
            tested,
            culled,
            accepted,
        }
    }
}

impl From<&FragmentCounters> for FragmentDocument {
    fn from(f: &FragmentCounters) -> Self {
        let FragmentCounters {
            generated,
            hiz_killed,
            bounds_failed,
            stencil_failed,
            depth_failed,
            discarded,
            written,
        } = *f;
        Self {
            generated,
            hiz_killed,
            bounds_failed,
            stencil_failed,
            depth_failed,
            discarded,
            written,
        }
    }
}

impl From<&gnomon_raster::PrimitiveCounters> for PrimitiveDocument {
    fn from(p: &gnomon_raster::PrimitiveCounters) -> Self {
        Self {
            vertex_shader_invocations: p.vertex_shader_invocations,
            input: p.input,
            non_finite: p.non_finite,
            frustum_culled: p.frustum_culled,
            clipped: p.clipped,
            degenerate: p.degenerate,
            face_culled: p.face_culled,
            rasterized: p.rasterized,
            steep_depth_planes: p.steep_depth_planes,
        }
    }
}

impl From<&gnomon_raster::EventCounters> for EventDocument {
    fn from(e: &gnomon_raster::EventCounters) -> Self {
        Self {
            silent_z_writes: e.silent_z_writes,
            silent_stencil_writes: e.silent_stencil_writes,
            silent_color_writes: e.silent_color_writes.iter().sum(),
            blend_saturated: e.blend_saturated.iter().sum(),
            source_clamped: e.source_clamped.iter().sum(),
            nan_canonicalised: e.nan_canonicalised,
            depth_clamped: e.depth_clamped,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn objects_keep_their_order_and_names_are_unique() {
        let times = [
            ("b".to_owned(), 1.0),
            ("a".to_owned(), 2.0),
            ("b".to_owned(), 4.0),
        ];
        let text = serde_json::to_string(&merged(&times)).unwrap();
        assert_eq!(text, r#"{"b":5.0,"a":2.0}"#);
    }
}
