//! The command line: verbs, each with its own flags.

use clap::{Parser, Subcommand};
use gnomon_pipeline::techniques::Registry;

use crate::error::CliError;
use crate::flags::ListArgs;
use crate::verbs;
use crate::verbs::bench::BenchArgs;
use crate::verbs::bisect::BisectArgs;
use crate::verbs::compare::CompareArgs;
use crate::verbs::completions::CompletionsArgs;
use crate::verbs::debug::DebugArgs;
use crate::verbs::demo::DemoArgs;
use crate::verbs::diff::DiffArgs;
use crate::verbs::dump::DumpArgs;
use crate::verbs::export::ExportArgs;
use crate::verbs::info::InfoArgs;
use crate::verbs::light::LightArgs;
use crate::verbs::man::ManArgs;
use crate::verbs::pixel::PixelArgs;
use crate::verbs::profiles::ProfilesArgs;
use crate::verbs::record::RecordArgs;
use crate::verbs::render::RenderArgs;
use crate::verbs::replay::ReplayArgs;
use crate::verbs::report::ReportArgs;
use crate::verbs::reproduce::ReproduceArgs;
use crate::verbs::stress::StressArgs;
use crate::verbs::techniques::TechniquesArgs;
use crate::verbs::traffic::TrafficArgs;
use crate::verbs::trim::TrimArgs;
use crate::verbs::tune::TuneArgs;
use crate::verbs::view::ViewerArgs;
use crate::verbs::wedge::WedgeArgs;

/// A deterministic software GPU for shadow algorithms that counts memory traffic.
#[derive(Debug, Parser)]
#[command(name = "gnomon", version, propagate_version = true)]
#[command(after_help = "Exit codes: 0 fine, 1 differs or check failed, 2 bad input.")]
pub(crate) struct Cli {
    /// Print errors and what was asked for alone: no progress, no summary
    #[arg(short, long, global = true)]
    pub(crate) quiet: bool,
    /// What to do.
    #[command(subcommand)]
    pub(crate) verb: Verb,
}

/// The verbs.
#[derive(Debug, Subcommand)]
pub(crate) enum Verb {
    /// Render the default scene with the principal techniques and show what each cost
    Demo(DemoArgs),
    /// Render one frame of a scene
    Render(Box<RenderArgs>),
    /// Go round a scene on the terminal, switch techniques and look into pixels
    View(Box<ViewerArgs>),
    /// Measure techniques against the exact soft shadow
    Compare(Box<CompareArgs>),
    /// Measure error, time and bytes over scenes, techniques and their parameters
    Bench(Box<BenchArgs>),
    /// Find the technique and parameters that keep a budget of error, time or bytes
    Tune(Box<TuneArgs>),
    /// Push a scene ever further and say where techniques break down
    Stress(Box<StressArgs>),
    /// Show where a frame's work and bytes go, as one page to look at
    Report(Box<ReportArgs>),
    /// Record frames of a scene in a trace, to be replayed and looked into
    Record(Box<RecordArgs>),
    /// Draw a frame of a trace again and verify that it is what it was
    Replay(ReplayArgs),
    /// Say what is in a trace; no shader is needed
    Info(InfoArgs),
    /// Print the commands of a trace, a JSON document a line
    Dump(DumpArgs),
    /// Cut frames, passes or draws out of a trace
    Trim(TrimArgs),
    /// Measure the papers' quantitative claims again, theirs beside ours
    Reproduce(Box<ReproduceArgs>),
    /// Say what two traces differ in: state, the first draw and pixel, counters
    Diff(DiffArgs),
    /// Find the change of state that makes two traces differ
    Bisect(BisectArgs),
    /// Show everything that happened to a pixel of a recorded frame
    Pixel(Box<PixelArgs>),
    /// Show a fragment's uniforms and varyings, and open its shader in a debugger
    Debug(Box<DebugArgs>),
    /// Say what a recorded frame moves under profiles of hardware
    Traffic(TrafficArgs),
    /// List the profiles of hardware, or show where their values are from
    Profiles(ProfilesArgs),
    /// Show a light as a pixel's surface sees it, and the edges that add up to its visibility
    Light(LightArgs),
    /// Show the penumbra wedge of one silhouette edge, and what the edge covers
    Wedge(WedgeArgs),
    /// Write a scene as glTF and OBJ, with camera, lights and matrices, for other programs
    Export(ExportArgs),
    /// List the built-in scenes
    Scenes(ListArgs),
    /// List the techniques and their parameters, or those of one
    Techniques(TechniquesArgs),
    /// Print what makes a shell complete verbs, flags and names
    Completions(CompletionsArgs),
    /// Write a page of `man` for each verb
    Man(ManArgs),
}

impl Verb {
    /// Does it, with the techniques of `registry`.
    pub(crate) fn run(&self, registry: &Registry) -> Result<(), CliError> {
        match self {
            Self::Compare(args) => verbs::compare::run(args, registry),
            Self::Bench(args) => verbs::bench::run(args, registry),
            Self::Bisect(args) => verbs::bisect::run(args),
            Self::Demo(args) => verbs::demo::run(args),
            Self::Diff(args) => verbs::diff::run(args),
            Self::Debug(args) => verbs::debug::run(args),
            Self::Pixel(args) => verbs::pixel::run(args),
            Self::Profiles(args) => verbs::profiles::run(args),
            Self::Render(args) => verbs::render::run(args, registry),
            Self::Report(args) => verbs::report::run(args, registry),
            Self::Record(args) => verbs::record::run(args, registry),
            Self::Replay(args) => verbs::replay::run(args),
            Self::Info(args) => verbs::info::run(args),
            Self::Light(args) => verbs::light::run(args),
            Self::Wedge(args) => verbs::wedge::run(args),
            Self::Dump(args) => verbs::dump::run(args),
            Self::Export(args) => verbs::export::run(args),
            Self::Trim(args) => verbs::trim::run(args),
            Self::Reproduce(args) => verbs::reproduce::run(args),
            Self::Stress(args) => verbs::stress::run(args, registry),
            Self::Scenes(args) => verbs::scenes::run(args),
            Self::Techniques(args) => verbs::techniques::run(args, registry),
            Self::Tune(args) => verbs::tune::run(args, registry),
            Self::Traffic(args) => verbs::traffic::run(args),
            Self::View(args) => verbs::view::run(args, registry),
            Self::Completions(args) => verbs::completions::run(args),
            Self::Man(args) => verbs::man::run(args),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        use clap::CommandFactory;
        Cli::command().debug_assert();
    }
}
