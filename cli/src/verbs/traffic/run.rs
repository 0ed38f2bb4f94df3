//! Judges a recorded frame.

use std::fs;
use std::path::Path;

use gnomon_traces::FrameShape;
use gnomon_traces::judged::MERGED;
use gnomon_traces::profile::{Judge, JudgeOptions, Order, Profile, ProfileError, profile};
use gnomon_traces::profile::{PROFILES, Traffic};

use super::args::TrafficArgs;
use super::files::{Kind, array, csv, kind};
use super::table;
use crate::documents::{By, TrafficDocument};
use crate::error::CliError;
use crate::output;
use crate::output::files::Batch;
use crate::traces_of_frames::TraceFile;

/// Judges, writes and prints.
pub(crate) fn run(args: &TrafficArgs) -> Result<(), CliError> {
    let profiles = args.profile.iter().map(|p| find_profile(p));
    let profiles: Vec<Profile> = profiles.collect::<Result<_, _>>()?;
    let runs = runs(args, &profiles);
    let out = args.out.as_ref();
    let to_stdout = out.is_some_and(|path| output::is_stdout(path));
    check_stdout(args, to_stdout)?;
    let file_out = out.filter(|_| !to_stdout);
    let kind = file_out
        .map(|path| kind(path, args.by, runs.len()))
        .transpose()?;
    let file = TraceFile::open(&args.trace)?;
    let shape = file.shape(args.frame)?;
    let judged = runs.iter().map(|(p, o)| judge(args, &file, &shape, p, *o));
    let judged: Vec<Traffic> = judged.collect::<Result<_, _>>()?;
    let name = args.trace.display().to_string();
    let documents = judged.iter().zip(&runs);
    let documents = documents.map(|(t, (_, o))| TrafficDocument::new(&name, t, args.by, o.merged));
    let documents: Vec<TrafficDocument> = documents.collect();
    if let (Some(path), Some(kind)) = (out, kind) {
        let mut batch = Batch::default();
        match kind {
            Kind::Csv => batch.stage(path, csv(&documents).as_bytes())?,
            Kind::Npy => batch.stage(path, &array(&judged[0], args.by))?,
        }
        batch.commit()?;
    }
    if to_stdout {
        return output::write_stdout(csv(&documents).as_bytes());
    }
    print(args, &documents)
}

/// Stdout has room for one document.
fn check_stdout(args: &TrafficArgs, to_stdout: bool) -> Result<(), CliError> {
    if !(to_stdout && args.json) {
        return Ok(());
    }
    Err(CliError::Flag {
        flag: "--out",
        value: "-".to_owned(),
        valid: "stdout is for the document of --json; give a file, or leave --json out".to_owned(),
    })
}

fn print(args: &TrafficArgs, documents: &[TrafficDocument]) -> Result<(), CliError> {
    match (args.json, documents) {
        (true, [one]) => output::print_json(one),
        (true, several) => output::print_json(&several),
        (false, all) => {
            let texts: Vec<String> = all.iter().map(table::text).collect();
            output::print(&texts.join("\n"))
        }
    }
}

/// Each profile, tilers with passes merged behind.
fn runs<'a>(args: &TrafficArgs, profiles: &'a [Profile]) -> Vec<(&'a Profile, JudgeOptions)> {
    let mut runs = Vec::new();
    for profile in profiles {
        let options = JudgeOptions {
            pixels: args.by == By::Pixel,
            merged: false,
        };
        runs.push((profile, options));
        if args.per_pass_merged && profile.order == Order::Tiled {
            let merged = true;
            runs.push((profile, JudgeOptions { merged, ..options }));
        }
    }
    runs
}

fn judge(
    args: &TrafficArgs,
    file: &TraceFile<'_>,
    shape: &FrameShape,
    profile: &Profile,
    options: JudgeOptions,
) -> Result<Traffic, CliError> {
    let mut judge = Judge::with_options(profile, shape, options)?;
    file.named(file.trace().events(args.frame, &mut judge))?;
    let mut traffic = judge.finish();
    if options.merged {
        traffic.profile += MERGED;
    }
    Ok(traffic)
}

/// A profile by name, or from a file of the user's.
pub(crate) fn find_profile(name: &str) -> Result<Profile, CliError> {
    let path = Path::new(name);
    if PROFILES.iter().any(|(known, _)| *known == name) || path.extension().is_none() {
        return Ok(profile(name)?);
    }
    let text = fs::read_to_string(path).map_err(|e| ProfileError::Syntax {
        file: name.to_owned(),
        error: format!("cannot be read: {e}"),
    })?;
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    Ok(Profile::parse(&stem, name, &text)?)
}
