//! The command line of `gnomon view`.

use clap::Args;

use crate::flags::FrameArgs;

/// Flags of `view`: those of `render` that make the picture.
#[derive(Debug, Args)]
#[command(
    mut_arg("frames", |a| a.hide(true)),
    mut_arg("fps", |a| a.hide(true)),
    mut_arg("light_fps", |a| a.hide(true)),
    after_help = "Keys: arrows or h j k l go round, or drag the mouse; + - closer and farther;\n\
t T technique; L light; o O overlay; p or Tab a pixel and what it holds, Enter its\n\
history; s write the picture and print the `gnomon render` that makes it; 0 the\n\
scene's own eye; ? help; q quit. Pictures are of half blocks, as large as the\n\
terminal without --size, in 24-bit color where COLORTERM is truecolor, or else 256."
)]
pub(crate) struct ViewerArgs {
    /// What to draw.
    #[command(flatten)]
    pub(crate) frame: FrameArgs,
}
