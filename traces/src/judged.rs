//! A frame under profiles of hardware, in the form in which a report shows it.

use gnomon_raster::{
    AccessBatch, AccessObserver, Error, Gpu, GpuConfig, PassReport, Recording, Wants,
};

use crate::profile::{
    Client, Judge, JudgeOptions, Levels, Order, Profile, ProfileError, Traffic, TrafficRow,
};
use crate::report::{ClientBytes, DrawRow, FrameReport, PassRow};
use crate::{FrameShape, Witness};

/// Behind the name of a profile whose tiles passes share.
pub const MERGED: &str = " (passes merged)";

/// A frame under a profile.
#[derive(Clone, Debug, PartialEq)]
pub struct Judged {
    /// The profile's name.
    pub profile: String,
    /// The frame with bytes between caches and memory instead of logical ones, and with
    /// the profile's reasons against HiZ; behind its passes the end of the frame, where
    /// that moves anything.
    pub frame: FrameReport,
}

/// Draws `recording` once, with skipping off, and judges it under each of `profiles`:
/// one that cannot do what the frame does has an error instead. Behind a tiler follows the
/// same with passes merged, where some can be: its name says so.
///
/// # Errors
/// The frame cannot be drawn.
pub fn judge(
    recording: &Recording,
    frame: &FrameReport,
    profiles: &[Profile],
    config: GpuConfig,
) -> Result<Vec<Result<Judged, ProfileError>>, Error> {
    if profiles.is_empty() {
        return Ok(Vec::new());
    }
    let shape = FrameShape::of(recording);
    let mut judges = Judges(
        profiles
            .iter()
            .flat_map(|p| of_profile(p, &shape))
            .collect(),
    );
    let mut gpu = Gpu::new(GpuConfig {
        skip: false,
        ..config
    })?;
    gpu.load(recording)?;
    let wants = Wants {
        depth_ranges: true,
        texels: true,
        witness: Some(&Witness),
        ..Wants::default()
    };
    gpu.submit_observed(&recording.list, wants, &mut judges)?;
    let finished = judges.0.into_iter();
    Ok(finished
        .map(|j| j.map(|judge| Judged::new(frame, &name_merged(judge.finish()))))
        .collect())
}

/// Judges by `profile`: of a tiler one with its passes as they are, and one with them merged
/// where that says anything else.
fn of_profile(profile: &Profile, shape: &FrameShape) -> Vec<Result<Judge, ProfileError>> {
    let judge = |merged| {
        let options = JudgeOptions {
            merged,
            ..JudgeOptions::default()
        };
        Judge::with_options(profile, shape, options)
    };
    let merged = (profile.order == Order::Tiled).then(|| judge(true));
    let merged = merged.filter(|j| j.as_ref().is_ok_and(Judge::merges_any));
    [judge(false)].into_iter().chain(merged).collect()
}

fn name_merged(mut traffic: Traffic) -> Traffic {
    if !traffic.merges.is_empty() {
        traffic.profile += MERGED;
    }
    traffic
}

/// Every one of them hears everything.
struct Judges(Vec<Result<Judge, ProfileError>>);

impl AccessObserver for Judges {
    fn batch(&mut self, pass: usize, batch: &AccessBatch<'_>) {
        let judges = self.0.iter_mut().flatten();
        judges.for_each(|j| j.batch(pass, batch));
    }

    fn end(&mut self, pass: usize, report: &PassReport) {
        let judges = self.0.iter_mut().flatten();
        judges.for_each(|j| j.end(pass, report));
    }
}

impl Judged {
    /// `frame` with the bytes of `traffic`.
    #[must_use]
    pub fn new(frame: &FrameReport, traffic: &Traffic) -> Self {
        let of = |pass: usize| traffic.rows.iter().filter(move |r| r.pass == Some(pass));
        let passes = frame.passes.iter().enumerate().map(|(i, p)| PassRow {
            clients: clients(of(i)),
            ..p.clone()
        });
        let draws = frame.draws.iter().map(|d| {
            let row = of(d.pass).find(|r| r.draw == Some(d.draw));
            DrawRow {
                clients: clients(row.into_iter()),
                hiz_disabled: row.and_then(|r| r.disabled).map(|r| r.to_string()),
                ..d.clone()
            }
        });
        let end = clients(traffic.rows.iter().filter(|r| r.pass.is_none()));
        let end = PassRow {
            label: "end of the frame".to_owned(),
            counters: gnomon_raster::Counters::default(),
            clients: end,
        };
        let end = Some(end).filter(|e| e.bytes() > 0);
        Self {
            profile: traffic.profile.clone(),
            frame: FrameReport {
                passes: passes.chain(end).collect(),
                draws: draws.collect(),
            },
        }
    }
}

/// Bytes to and from memory of some rows, clients without any left out.
fn clients<'a>(rows: impl Iterator<Item = &'a TrafficRow>) -> Vec<ClientBytes> {
    let rows: Vec<&TrafficRow> = rows.collect();
    let of = |client: Client| {
        let mut sum = Levels::default();
        rows.iter().for_each(|r| sum.add(&r.client(client)));
        ClientBytes {
            client: client.to_string(),
            read: sum.dram.read_bytes,
            write: sum.dram.write_bytes,
        }
    };
    Client::all().map(of).filter(|c| c.total() > 0).collect()
}
