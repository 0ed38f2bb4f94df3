//! From the command line to a trace.

use gnomon_pipeline::technique::{Params, Technique};
use gnomon_pipeline::techniques::Registry;
use gnomon_pipeline::world::scene::{Scene, SceneSource};
use gnomon_traces::{Meta, RecordOptions, Recorder, Trace};

use super::args::RecordArgs;
use crate::error::CliError;
use crate::output::files::{Batch, check_extension};
use crate::output::progress::Progress;
use crate::output::{self, numbers};
use crate::verbs::info::TraceDocument;
use crate::verbs::render::{DEFAULT_SIZE, RATE};

/// Records what was asked for; the file appears whole or not at all.
pub(crate) fn run(args: &RecordArgs, registry: &Registry) -> Result<(), CliError> {
    check_extension("--out", &args.out, "gnt")?;
    let technique = registry.find(&args.technique)?;
    let params = crate::verbs::parameters(technique, &args.settings, args.gpu.no_skip)?;
    let request = args.environment.request(args.lights);
    let mut source = args.scene.open()?.with_environment(request);
    let trace = record(args, technique, &params, &mut source)?;
    let mut batch = Batch::default();
    batch.stage(&args.out, trace.to_bytes())?;
    batch.commit()?;
    let document = TraceDocument::new(&args.out, &trace)?;
    if args.json {
        output::print_json(&document)?;
    }
    output::print_summary(&summarise(args, &document), args.json)
}

fn record(
    args: &RecordArgs,
    technique: &dyn Technique,
    params: &Params,
    source: &mut SceneSource,
) -> Result<Trace, CliError> {
    let count = args.frames.unwrap_or(1);
    let rate = args.fps.unwrap_or(RATE);
    let progress = Progress::new(u64::from(count));
    let mut recorder = None;
    for frame in 0..count {
        progress.doing(format!("frame {frame}"));
        let time = args.time + f64::from(frame) / rate;
        if !time.is_finite() {
            return Err(CliError::Flag {
                flag: "--fps",
                value: rate.to_string(),
                valid: format!(
                    "the time of frame {frame} is not finite: give more frames per second"
                ),
            });
        }
        let scene = source.at(time)?;
        let size = args.size.or(scene.size).unwrap_or(DEFAULT_SIZE);
        let drawn = technique.frame(&scene, size, params)?;
        recorder
            .get_or_insert_with(|| start(args, technique, params, &scene, size))
            .add(&drawn.recording)?;
        progress.step();
    }
    let recorder = recorder.expect("at least one frame is asked for");
    Ok(recorder.finish()?)
}

fn start(
    args: &RecordArgs,
    technique: &dyn Technique,
    params: &Params,
    scene: &Scene,
    size: [u32; 2],
) -> Recorder {
    let given = params.iter().map(|(k, v)| (k.to_owned(), v.to_owned()));
    let meta = Meta {
        producer: format!("gnomon {}", env!("CARGO_PKG_VERSION")),
        scene: scene.name.clone(),
        technique: technique.name().to_owned(),
        params: given.collect(),
        size,
        fps: args.frames.map(|_| args.fps.unwrap_or(RATE)),
        time: args.time,
        ..Meta::default()
    };
    let options = RecordOptions {
        gpu: args.gpu.config(),
        traffic: !args.no_traffic,
        frozen: args.frozen,
    };
    Recorder::new(meta, options)
}

fn summarise(args: &RecordArgs, document: &TraceDocument) -> String {
    format!(
        "{}  {}  {}  id {}  {}\n",
        args.out.display(),
        document.contents(),
        numbers::bytes(document.bytes),
        document.id,
        if args.frozen { "frozen" } else { "live" },
    )
}
