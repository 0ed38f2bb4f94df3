//! The JSON document; `docs/json.md` describes it. Keys are only ever added.

use serde::Serialize;

use super::advice::{self, LIMITS};
use super::exact::Exact;
use super::front::{Cost, along, points};
use super::results::{Group, Results, Row};
use super::stored::{Cell, Found, Measured, Outcome, Time};
use crate::documents::Object;

#[derive(Serialize)]
pub(super) struct BenchDocument<'a> {
    suite: &'a str,
    version: &'a str,
    build: &'a str,
    repeat: u32,
    light: usize,
    reference: &'a str,
    missing: usize,
    cells: Vec<CellDocument<'a>>,
    fronts: Vec<FrontDocument<'a>>,
    advice: Vec<AdviceDocument>,
}

#[derive(Serialize)]
struct CellDocument<'a> {
    scene: &'a str,
    technique: &'a str,
    settings: Object<&'a str>,
    params: Object<&'a str>,
    size: [u32; 2],
    threads: usize,
    key: &'a str,
    /// `measured`, `refused` or `missing`.
    status: &'static str,
    /// Why it was refused.
    reason: Option<&'a str>,
    /// `null` unless it was measured, as are the following.
    error: Option<ErrorDocument>,
    time_ms: Option<TimeDocument>,
    bytes: Option<u64>,
    clients: Option<Object<ClientDocument>>,
    shaded_fragments: Option<u64>,
    hash: Option<HashDocument<'a>>,
    warnings: Option<Object<usize>>,
}

/// Errors; what is of no pixel is `null`.
#[derive(Serialize)]
struct ErrorDocument {
    rmse: Option<f64>,
    max: Option<f64>,
    p99: Option<f64>,
    mean: Option<f64>,
    rmse_umbra: Option<f64>,
    rmse_penumbra: Option<f64>,
    rmse_lit: Option<f64>,
    banding_p99: f64,
    /// `null` for equal pictures: it is infinite.
    psnr: Option<f64>,
    ssim: Option<f64>,
    flip: f64,
    pixels: usize,
    left_out: usize,
}

#[derive(Serialize)]
struct TimeDocument {
    frame: f64,
    build: f64,
    frames: Vec<f64>,
    builds: Vec<f64>,
    load: Option<f64>,
    cores: usize,
    simd: String,
}

#[derive(Serialize)]
struct ClientDocument {
    read_bytes: u64,
    write_bytes: u64,
}

#[derive(Serialize)]
struct HashDocument<'a> {
    color: &'a str,
    visibility: &'a str,
}

/// What nothing beats in error and a cost.
#[derive(Serialize)]
struct FrontDocument<'a> {
    scene: &'a str,
    size: [u32; 2],
    threads: usize,
    /// `time` (build and frame), `frame` or `bytes`.
    cost: &'static str,
    points: Vec<PointDocument>,
}

#[derive(Serialize)]
struct PointDocument {
    label: String,
    cost: f64,
    rmse: f64,
}

/// The cheapest over all scenes whose largest RMSE is at most `rmse`.
#[derive(Serialize)]
struct AdviceDocument {
    size: [u32; 2],
    threads: usize,
    cost: &'static str,
    rmse: f64,
    /// `null` where nothing is that good on all scenes.
    best: Option<BestDocument>,
}

#[derive(Serialize)]
struct BestDocument {
    label: String,
    worst_rmse: f64,
    total_cost: f64,
}

impl<'a> BenchDocument<'a> {
    pub(super) fn new(results: &'a Results) -> Self {
        let plan = &results.plan;
        let groups = results.groups();
        let fronts = groups
            .iter()
            .flat_map(|g| Cost::ALL.map(|c| FrontDocument::new(g, c)));
        Self {
            suite: &plan.suite,
            version: &plan.version,
            build: &plan.build,
            repeat: plan.repeat,
            light: plan.light,
            reference: &plan.reference,
            missing: results.missing(),
            cells: results
                .cells()
                .map(|(c, o)| CellDocument::new(c, o))
                .collect(),
            fronts: fronts.collect(),
            advice: advice::families(results)
                .iter()
                .flat_map(|f| advise(f))
                .collect(),
        }
    }
}

impl<'a> CellDocument<'a> {
    fn new(cell: &'a Cell, outcome: Option<&'a Outcome>) -> Self {
        let (status, reason, measured) = match outcome {
            None => ("missing", None, None),
            Some(Outcome::Refused(why)) => ("refused", Some(why.as_str()), None),
            Some(Outcome::Measured(m)) => ("measured", None, Some(m.as_ref())),
        };
        let found = measured.map(|m: &Measured| &m.found);
        Self {
            scene: &cell.scene,
            technique: &cell.technique,
            settings: pairs(&cell.settings),
            params: pairs(&cell.params),
            size: cell.size,
            threads: cell.threads,
            key: &cell.key,
            status,
            reason,
            error: found.map(ErrorDocument::new),
            time_ms: measured.map(|m| TimeDocument::new(&m.time)),
            bytes: found.map(|f| f.bytes),
            clients: found.map(clients),
            shaded_fragments: found.map(|f| f.shaded_fragments),
            hash: found.map(|f| HashDocument {
                color: &f.color_hash,
                visibility: &f.visibility_hash,
            }),
            warnings: found.map(|f| Object(f.warnings.clone())),
        }
    }
}

fn pairs(pairs: &[(String, String)]) -> Object<&str> {
    Object(pairs.iter().map(|(k, v)| (k.clone(), v.as_str())).collect())
}

fn clients(found: &Found) -> Object<ClientDocument> {
    let document = |[read_bytes, write_bytes]: [u64; 2]| ClientDocument {
        read_bytes,
        write_bytes,
    };
    let clients = found.clients.iter();
    Object(
        clients
            .map(|(name, bytes)| (name.clone(), document(*bytes)))
            .collect(),
    )
}

impl ErrorDocument {
    fn new(found: &Found) -> Self {
        let number = |e: Option<Exact>| e.map(|e| e.0);
        Self {
            rmse: number(found.rmse),
            max: number(found.max),
            p99: number(found.p99),
            mean: number(found.mean),
            rmse_umbra: number(found.rmse_umbra),
            rmse_penumbra: number(found.rmse_penumbra),
            rmse_lit: number(found.rmse_lit),
            banding_p99: found.banding_p99.0,
            psnr: Some(found.psnr.0).filter(|p| p.is_finite()),
            ssim: number(found.ssim),
            flip: found.flip.0,
            pixels: found.pixels_compared,
            left_out: found.pixels_left_out,
        }
    }
}

impl TimeDocument {
    fn new(time: &Time) -> Self {
        let numbers = |all: &[Exact]| all.iter().map(|t| t.0).collect();
        Self {
            frame: time.frame(),
            build: time.build(),
            frames: numbers(&time.frames),
            builds: numbers(&time.builds),
            load: time.load.map(|l| l.0),
            cores: time.cores,
            simd: time.simd.clone(),
        }
    }
}

impl<'a> FrontDocument<'a> {
    fn new(group: &Group<'a>, cost: Cost) -> Self {
        let points = points(group, cost);
        let point = |k: usize| {
            let row: &Row<'_> = &group.rows[k];
            let [cost, rmse] = points[k]?;
            let label = row.cell.label();
            Some(PointDocument { label, cost, rmse })
        };
        Self {
            scene: group.scene,
            size: group.size,
            threads: group.threads,
            cost: cost.name(),
            points: along(&points).into_iter().filter_map(point).collect(),
        }
    }
}

fn advise(family: &[Group<'_>]) -> Vec<AdviceDocument> {
    let Some(first) = family.first() else {
        return Vec::new();
    };
    let mut all = Vec::new();
    for cost in Cost::ALL {
        let overall = advice::overall(family, cost);
        all.extend(LIMITS.map(|rmse| AdviceDocument {
            size: first.size,
            threads: first.threads,
            cost: cost.name(),
            rmse,
            best: advice::best(&overall, rmse).map(|best| BestDocument {
                label: best.label.clone(),
                worst_rmse: best.worst,
                total_cost: best.cost,
            }),
        }));
    }
    all
}
