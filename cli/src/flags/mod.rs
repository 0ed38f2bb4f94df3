//! Flags that several verbs take, and the values that flags take.

mod environment;
mod execution;
mod frame;
mod listing;
mod scene;
mod settings;
mod technique;
mod values;
mod view;

pub(crate) use environment::EnvArgs;
pub(crate) use execution::GpuArgs;
pub(crate) use frame::{DEFAULT_SIZE, FrameArgs};
pub(crate) use listing::ListArgs;
pub(crate) use scene::SceneArgs;
pub(crate) use settings::parameters;
pub(crate) use technique::{EntryArg, expand_all, parse_entry};
pub(crate) use values::{parse_rate, parse_setting, parse_size, parse_time};
pub(crate) use view::ViewArgs;
