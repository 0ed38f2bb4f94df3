//! What a debugger needs to open the real shader at one fragment of a history.

use gnomon_raster::shader::ShaderIdentity;
use gnomon_raster::{Draw, FragmentEnd, Recording};

use super::{FragmentEvent, History, HistoryError, HistoryOptions};

/// A fragment's primitive and shaders.
#[derive(Clone, Debug, PartialEq)]
pub struct Debug {
    /// The vertex shader.
    pub vertex: DebugStage,
    /// The fragment shader, if the draw has one.
    pub fragment: Option<DebugStage>,
    /// Instance of the primitive.
    pub instance: u32,
    /// Its vertices before clipping.
    pub vertices: Vec<DebugVertex>,
    /// Whether the shader is run for the fragment's packet: not where all fragments ended
    /// before it, nor where it is of one colour.
    pub is_run: bool,
    /// Commands for gdb around a program that asks for the history of this pixel: the
    /// last one stops in the fragment shader at the packet of 8×2 fragments that the
    /// fragment belongs to, or, where it is not run, where the fragment comes.
    pub commands: Vec<String>,
}

/// A shader of a draw.
#[derive(Clone, Debug, PartialEq)]
pub struct DebugStage {
    /// Its Rust type.
    pub type_name: String,
    /// Name, version and uniforms; `None` for closures.
    pub identity: Option<ShaderIdentity>,
}

/// A vertex of a primitive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DebugVertex {
    /// Its number in the vertex buffer.
    pub number: u32,
    /// Clip-space position.
    pub position: [f32; 4],
}

impl History {
    /// What there is to see at event number `event` of the history of `recording`, drawn
    /// with `options`.
    ///
    /// # Errors
    /// The event is not a fragment.
    pub fn debug(
        &self,
        recording: &Recording,
        options: &HistoryOptions,
        event: usize,
    ) -> Result<Debug, HistoryError> {
        let (e, f) = self.fragment(event)?;
        let draw = &recording.list.passes[e.pass].draws[f.draw as usize];
        let (instance, numbers) = vertices(draw, f.primitive);
        let pipeline = &draw.pipeline;
        let buffer = draw.vertices.as_deref();
        let positions = pipeline.vertex.positions(buffer, &numbers, instance)?;
        let fragment = pipeline.fragment.as_ref();
        let is_run = f.varyings.is_some();
        let level = options.config.simd.type_name();
        Ok(Debug {
            vertex: DebugStage {
                type_name: pipeline.vertex.type_name().to_owned(),
                identity: pipeline.vertex.identity(),
            },
            fragment: fragment.map(|s| DebugStage {
                type_name: s.type_name().to_owned(),
                identity: s.identity(),
            }),
            instance,
            vertices: (numbers.into_iter().zip(positions))
                .map(|(number, position)| DebugVertex { number, position })
                .collect(),
            is_run,
            commands: commands(f, is_run, level),
        })
    }
}

/// Instance of a primitive of a draw, and the numbers of its vertices.
fn vertices(draw: &Draw, primitive: u32) -> (u32, Vec<u32>) {
    let each = draw.pipeline.primitive.topology.vertices();
    let primitives = (draw.count / each).max(1);
    let first = draw.first + primitive % primitives * each;
    let number = |i: u32| match &draw.indices {
        Some(indices) => indices.indices()[i as usize],
        None => i,
    };
    (
        primitive / primitives,
        (first..first + each).map(number).collect(),
    )
}

/// Stops where the fragment comes, then in its shader: the next one that is run.
fn commands(f: &FragmentEvent, is_run: bool, level: &str) -> Vec<String> {
    let mut list = vec![
        "break reach_probed_fragment".to_owned(),
        format!("ignore 1 {}", f.number),
        "run".to_owned(),
    ];
    debug_assert!(
        is_run || f.end != FragmentEnd::Discarded,
        "only a shader discards"
    );
    if is_run {
        list.push("delete 1".to_owned());
        list.push(format!("tbreak shade<{level}>"));
        list.push(format!("ignore 2 {}", f.packets_before));
        list.push("continue".to_owned());
    }
    list
}
