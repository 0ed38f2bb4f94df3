//! From the command line to a trace.

use gnomon_pipeline::technique::{Params, Technique, Warning};
use gnomon_pipeline::techniques::Registry;
use gnomon_pipeline::world::scene::{Scene, SceneSource};
use gnomon_traces::{Meta, RecordOptions, Recorder, Trace};

use super::args::RecordArgs;
use crate::documents::TraceDocument;
use crate::error::CliError;
use crate::output::files::{Batch, check_extension};
use crate::output::progress::Progress;
use crate::output::{self, numbers, warnings};
use crate::verbs::info::contents;

/// Records what was asked for; the file appears whole or not at all.
pub(crate) fn run(args: &RecordArgs, registry: &Registry) -> Result<(), CliError> {
    check_extension("--out", &args.out, "gnt")?;
    let technique = args.frame.technique.find(registry)?;
    let params = args.frame.params(technique)?;
    args.frame.check_light_fps(&params)?;
    let mut source = args.frame.source()?;
    let (trace, warnings) = record(args, technique, &params, &mut source)?;
    let mut batch = Batch::default();
    batch.stage(&args.out, trace.to_bytes())?;
    batch.commit()?;
    let document = TraceDocument::new(&args.out, &trace)?;
    if args.json {
        output::print_json(&document)?;
    }
    let mut text = summarise(args, &document);
    for line in warnings::lines(&warnings) {
        text += &format!("warning: {line}\n");
    }
    output::print_summary(&text, args.json)
}

fn record(
    args: &RecordArgs,
    technique: &dyn Technique,
    params: &Params,
    source: &mut SceneSource,
) -> Result<(Trace, Vec<Warning>), CliError> {
    let count = args.frame.frames.unwrap_or(1);
    args.frame.check_times(count)?;
    let progress = Progress::new(u64::from(count));
    let (mut recorder, mut warnings) = (None, Vec::new());
    for frame in 0..count {
        progress.doing(format!("frame {frame}"));
        let scene = source.at(args.frame.time_of(frame))?;
        let size = args.frame.size_of(&scene);
        let params = args.frame.params_of(params, frame);
        warnings.extend(args.frame.prepare(technique, &params, &scene, &progress)?);
        let drawn = technique.frame(&scene, size, &params)?;
        recorder
            .get_or_insert_with(|| start(args, technique, &params, &scene, size))
            .add(&drawn.recording)?;
        progress.step();
    }
    let recorder = recorder.expect("at least one frame is asked for");
    Ok((recorder.finish()?, warnings))
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
        fps: args.frame.frames.map(|_| args.frame.rate()),
        time: args.frame.time,
        ..Meta::default()
    };
    let options = RecordOptions {
        gpu: args.frame.gpu.config(),
        traffic: !args.no_traffic,
        frozen: args.frozen,
    };
    Recorder::new(meta, options)
}

fn summarise(args: &RecordArgs, document: &TraceDocument) -> String {
    format!(
        "{}  {}  {}  id {}  {}\n",
        args.out.display(),
        contents(document),
        numbers::bytes(document.bytes),
        document.id,
        if args.frozen { "frozen" } else { "live" },
    )
}
