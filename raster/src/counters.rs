//! What the emulated GPU counts: logical traffic and events, independent of any
//! hardware, execution tile, thread count or SIMD level.
//!
//! The rules are in `docs/rasterisation-rules.md`, §8. Everything is a `u64`
//! that is only ever added to, so that sums over tiles equal sums over draws
//! equal totals, in any order.

use crate::format::Format;
use crate::{MAX_COLOR_ATTACHMENTS, MAX_SHADER_COUNTS, MAX_TEXTURES};

/// What is summed field by field.
trait Sum {
    fn sum(&mut self, o: &Self);
}

impl Sum for u64 {
    fn sum(&mut self, o: &Self) {
        *self += o;
    }
}

impl<T: Sum, const N: usize> Sum for [T; N] {
    fn sum(&mut self, o: &Self) {
        self.iter_mut().zip(o).for_each(|(a, b)| a.sum(b));
    }
}

/// Sums all fields of a struct. They are taken apart without `..`: a field that is
/// left out does not compile.
macro_rules! sum_fields {
    ($name:ident { $($field:ident),+ $(,)? }) => {
        impl Sum for $name {
            fn sum(&mut self, o: &Self) {
                let Self { $($field),+ } = o;
                $( self.$field.sum($field); )+
            }
        }
    };
}
sum_fields!(Traffic {
    read_accesses,
    read_bytes,
    write_accesses,
    write_bytes
});
sum_fields!(Accesses {
    z_read,
    z_write,
    stencil_read,
    stencil_write,
    hiz_read,
    hiz_write,
    color_read,
    color_write,
    tex_fetch,
    tex_texel
});
sum_fields!(PrimitiveCounters {
    vertex_shader_invocations,
    input,
    non_finite,
    frustum_culled,
    clipped,
    degenerate,
    face_culled,
    rasterized,
    steep_depth_planes
});
sum_fields!(FragmentCounters {
    generated,
    hiz_killed,
    bounds_failed,
    stencil_failed,
    depth_failed,
    discarded,
    written
});
sum_fields!(TileCounters {
    tested,
    culled,
    accepted
});
sum_fields!(EventCounters {
    silent_z_writes,
    silent_stencil_writes,
    silent_color_writes,
    blend_saturated,
    source_clamped,
    nan_canonicalised,
    depth_clamped
});
sum_fields!(ClientTraffic {
    z,
    stencil,
    hiz,
    color,
    tex,
    tex_fetches,
    vertex,
    index,
    packed_depth_stencil
});
sum_fields!(Counters {
    primitives,
    fragments,
    fragment_shader_invocations,
    shader_counts,
    tiles,
    events,
    traffic,
    accesses
});

/// Whether counting is compiled in; the `uncounted` feature exists to measure
/// what it costs.
pub(crate) const COUNT: bool = !cfg!(feature = "uncounted");

/// Accesses and bytes of one memory client.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Traffic {
    /// Read accesses.
    pub read_accesses: u64,
    /// Bytes read.
    pub read_bytes: u64,
    /// Write accesses.
    pub write_accesses: u64,
    /// Bytes written.
    pub write_bytes: u64,
}

impl Traffic {
    fn of(reads: u64, writes: u64, bytes: u64) -> Self {
        Self {
            read_accesses: reads,
            read_bytes: reads * bytes,
            write_accesses: writes,
            write_bytes: writes * bytes,
        }
    }

    /// Bytes in both directions.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.read_bytes + self.write_bytes
    }
}

/// Access counts of the fixed-function clients, before bytes are known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Accesses {
    pub(crate) z_read: u64,
    pub(crate) z_write: u64,
    pub(crate) stencil_read: u64,
    pub(crate) stencil_write: u64,
    pub(crate) hiz_read: u64,
    pub(crate) hiz_write: u64,
    pub(crate) color_read: [u64; MAX_COLOR_ATTACHMENTS],
    pub(crate) color_write: [u64; MAX_COLOR_ATTACHMENTS],
    pub(crate) tex_fetch: [u64; MAX_TEXTURES],
    pub(crate) tex_texel: [u64; MAX_TEXTURES],
}

/// Primitives on their way to the rasteriser.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PrimitiveCounters {
    /// Vertices shaded (each referenced vertex once an instance).
    pub vertex_shader_invocations: u64,
    /// Primitives assembled.
    pub input: u64,
    /// Rejected for a position that is not finite.
    pub non_finite: u64,
    /// Entirely outside the view volume or guard band.
    pub frustum_culled: u64,
    /// Primitives that had to be clipped.
    pub clipped: u64,
    /// Triangles of no area after snapping.
    pub degenerate: u64,
    /// Triangles thrown away by their facing.
    pub face_culled: u64,
    /// Triangles set up for rasterisation.
    pub rasterized: u64,
    /// Triangles whose D24 slope exceeds the fixed-point range, so that their depth
    /// is computed in doubles.
    pub steep_depth_planes: u64,
}

/// Fragments, by the stage that ended them. `generated` is the sum of all others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FragmentCounters {
    /// Covered pixels, after scissor and clip planes.
    pub generated: u64,
    /// In blocks that were thrown away whole by zmin/zmax.
    pub hiz_killed: u64,
    /// Failed the depth-bounds test.
    pub bounds_failed: u64,
    /// Failed the stencil test.
    pub stencil_failed: u64,
    /// Failed the depth test.
    pub depth_failed: u64,
    /// Discarded by the fragment shader.
    pub discarded: u64,
    /// Passed everything.
    pub written: u64,
}

/// zmin/zmax tests of (primitive, 8×8 block) pairs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TileCounters {
    /// Pairs that were tested.
    pub tested: u64,
    /// Pairs thrown away whole.
    pub culled: u64,
    /// Pairs whose depth test was decided without reading depth, but not thrown away.
    pub accepted: u64,
}

/// Events that would otherwise be silent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EventCounters {
    /// Depth writes that stored what was there.
    pub silent_z_writes: u64,
    /// Stencil writes that stored what was there.
    pub silent_stencil_writes: u64,
    /// Colour writes (whole texels) that stored what was there, by attachment.
    pub silent_color_writes: [u64; MAX_COLOR_ATTACHMENTS],
    /// Channels whose blended value was limited to the format's range.
    pub blend_saturated: [u64; MAX_COLOR_ATTACHMENTS],
    /// Channels whose source value was limited to the format's range, NaN included.
    pub source_clamped: [u64; MAX_COLOR_ATTACHMENTS],
    /// NaN replaced before a store, in colour channels or shader depth.
    pub nan_canonicalised: u64,
    /// Shader depth outside 0..=1.
    pub depth_clamped: u64,
}

/// Everything counted for one draw, or a sum over draws.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Primitives.
    pub primitives: PrimitiveCounters,
    /// Fragments.
    pub fragments: FragmentCounters,
    /// Fragment shader invocations, helper lanes left out.
    pub fragment_shader_invocations: u64,
    /// What the fragment shader counted itself, in the order in which it declared
    /// [`FragmentOutputs::counts`](crate::shader::FragmentOutputs::counts). In a sum
    /// over draws only what shaders agree on means anything:
    /// [`PassReport::shader_counts`](crate::PassReport::shader_counts) goes by name.
    pub shader_counts: [u64; MAX_SHADER_COUNTS],
    /// zmin/zmax tests.
    pub tiles: TileCounters,
    /// Saturation, silent writes, NaN.
    pub events: EventCounters,
    /// Traffic by client.
    pub traffic: ClientTraffic,
    pub(crate) accesses: Accesses,
}

/// Logical traffic by client.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ClientTraffic {
    /// Depth (aspect bytes: D24 = 3, D32F = 4).
    pub z: Traffic,
    /// Stencil (1 byte).
    pub stencil: Traffic,
    /// zmin/zmax entries (8 bytes).
    pub hiz: Traffic,
    /// Colour attachments.
    pub color: [Traffic; MAX_COLOR_ATTACHMENTS],
    /// Textures by slot: accesses are texels touched.
    pub tex: [Traffic; MAX_TEXTURES],
    /// API-level texture fetches by slot.
    pub tex_fetches: [u64; MAX_TEXTURES],
    /// Vertex data.
    pub vertex: Traffic,
    /// Indices (4 bytes).
    pub index: Traffic,
    /// Depth and stencil again, as accesses to the packed word that holds both
    /// (D24S8: 4 bytes; D32F with S8: 8). Not part of [`ClientTraffic::total_bytes`].
    pub packed_depth_stencil: Traffic,
}

impl ClientTraffic {
    /// Client names and traffic, in a fixed order, clients without traffic left out.
    #[must_use]
    pub fn named(&self) -> Vec<(String, Traffic)> {
        // Counts of fetches are no traffic; depth and stencil are not counted twice.
        let Self {
            z,
            stencil,
            hiz,
            color,
            tex,
            tex_fetches: _,
            vertex,
            index,
            packed_depth_stencil: _,
        } = self;
        let mut all = vec![("z".to_owned(), *z), ("stencil".to_owned(), *stencil)];
        all.extend(
            color
                .iter()
                .enumerate()
                .map(|(i, t)| (format!("color[{i}]"), *t)),
        );
        all.extend(
            tex.iter()
                .enumerate()
                .map(|(i, t)| (format!("tex[{i}]"), *t)),
        );
        all.push(("vertex".to_owned(), *vertex));
        all.push(("index".to_owned(), *index));
        all.push(("hiz".to_owned(), *hiz));
        all.retain(|(_, t)| *t != Traffic::default());
        all
    }

    /// Bytes of all clients in both directions.
    #[must_use]
    pub fn total_bytes(&self) -> u64 {
        self.named().iter().map(|(_, t)| t.bytes()).sum()
    }
}

/// Sizes that turn accesses into bytes.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct AccessSizes {
    pub(crate) depth: Option<Format>,
    pub(crate) color: [Option<Format>; MAX_COLOR_ATTACHMENTS],
    pub(crate) tex: [Option<Format>; MAX_TEXTURES],
}

/// Bytes of a zmin/zmax entry.
pub(crate) const HIZ_BYTES: u64 = 8;

/// Bytes of the word that holds depth and stencil together.
pub(crate) fn packed_word_bytes(f: Format) -> u64 {
    if f == Format::Depth32FloatStencil8 {
        8
    } else {
        4
    }
}

impl Counters {
    /// Adds another draw's.
    pub fn add(&mut self, o: &Self) {
        self.sum(o);
    }

    /// Turns access counts into traffic; vertex and index traffic are added by
    /// the geometry stage.
    pub(crate) fn settle(&mut self, sizes: &AccessSizes) {
        let a = self.accesses;
        let t = &mut self.traffic;
        let depth_bytes = sizes.depth.map_or(0, Format::bytes);
        t.z = Traffic::of(a.z_read, a.z_write, depth_bytes);
        t.stencil = Traffic::of(a.stencil_read, a.stencil_write, 1);
        t.hiz = Traffic::of(a.hiz_read, a.hiz_write, HIZ_BYTES);
        let word = sizes.depth.map_or(0, packed_word_bytes);
        t.packed_depth_stencil =
            Traffic::of(a.z_read + a.stencil_read, a.z_write + a.stencil_write, word);
        for (i, f) in sizes.color.iter().enumerate() {
            t.color[i] = Traffic::of(
                a.color_read[i],
                a.color_write[i],
                f.map_or(0, Format::bytes),
            );
        }
        for (i, f) in sizes.tex.iter().enumerate() {
            t.tex[i] = Traffic::of(a.tex_texel[i], 0, f.map_or(0, Format::bytes));
            t.tex_fetches[i] = a.tex_fetch[i];
        }
        self.accesses = Accesses::default();
    }
}
