//! Visibility of an area light by lines across it, along which the depth complexity is
//! exact (docs/line-sampled-shadow-volumes.md); the twin in f64 is pipeline's
//! `geometry::line_sampling::walk`.
//!
//! Each receiver goes through the edges in its block's list (`contour`). Those that are
//! contours from it cross lines, which keeps *events*, and the spine, which carries the
//! count at the light's centre to the lines' feet (`events`). Then each line is swept.
//! The count at the centre is that of hard shadow volumes, in the stencil. Receivers
//! that may find themselves on the wrong side of a volume drawn on a grid of pixels, or whose own
//! plane cuts the light, count by one ray (`anchor`) to the middle of the widest gap
//! between events instead, where no rounding matters.
//!
//! # Textures
//!
//! 0. positions; w is 0 where no shadow falls, 1 on what casts none, else 2 and the number of
//!    the facet's plane
//! 1. depth and stencil
//! 2. lines: y, least and greatest x, slope of the foot; then the corners of a polygon, each
//!    with the next; then of lights with an image sums
//!    of its colours from the left, [`LightSums::steps`] and one for each line
//! 3. for each block of 8×8 pixels the first texel of its list and the number of edges
//! 4. lists, four numbers of edges a texel, counted from 1
//! 5. edges, four texels each: ends with their facets' planes by number, and those planes; then
//!    all planes
//! 6. boxes over facets, 7. facets, as in [`crate::shadow_rays`], with number of plane and
//!    whether it counts from both sides

mod anchor;
mod contour;
mod events;
mod receiver;

use gnomon_raster::shader::{Fragment, FragmentOutputs, FragmentShader};
use gnomon_raster::simd::each3;
use gnomon_raster::{F32, I32, Lanes, Mask, uniforms};

use self::events::{AT_ONCE, Events, Gap};
use self::receiver::Receiver;
use crate::coverage::outlined;
use crate::shadow_rays::Table;
use crate::soft_volumes::texel_of;

const POSITIONS: usize = 0;
const STENCIL: usize = 1;
const LINES: usize = 2;
const BLOCKS: usize = 3;
const LISTS: usize = 4;
const EDGES: usize = 5;
const NODES: usize = 6;
const FACETS: usize = 7;

/// Names of what is counted: edges that receivers tested, receivers that counted by a ray,
/// looks that lines with more events than fit needed, and receivers that found a depth
/// complexity below 0, which is an error.
pub const LINE_COUNTS: [&str; 4] = ["edge-tests", "anchor-rays", "second-looks", NEGATIVE_DEPTH];
/// Name of the count of errors.
pub const NEGATIVE_DEPTH: &str = "negative-depth-complexity";

const EDGE_TESTS: usize = 0;
const ANCHOR_RAYS: usize = 1;
const SECOND_LOOKS: usize = 2;
const NEGATIVE: usize = 3;

/// Kinds of edges are in numbers of planes, in steps of this.
pub const KIND_STEP: f32 = 4_194_304.0;
/// Most lines, most corners, and most edges of a list.
const MOST_LINES: u32 = 256;
const MOST_CORNERS: u32 = 4096;
const MOST_EDGES: u32 = 1 << 24;

/// The light as receivers need it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineSource {
    /// What edges, planes and receivers are relative to, itself relative to the view's origin.
    pub origin: [f32; 3],
    /// Of a flat light x along lines, y across, z out of its plane; of a sphere the world's.
    pub axes: [[f32; 3]; 3],
    /// The origin from the light's centre, in these coordinates.
    pub offset: [f32; 3],
    /// The light's centre, relative to the view's origin.
    pub centre: [f32; 3],
    /// The eye from the origin, in these coordinates.
    pub eye: [f32; 3],
    /// Of a sphere; 0 of a flat light.
    pub radius: f32,
}
uniforms!(LineSource {
    origin,
    axes,
    offset,
    centre,
    eye,
    radius
});

/// Sums of an image along lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LightSums {
    /// Intervals of a line; 0 of a light of one colour.
    pub steps: u32,
}
uniforms!(LightSums { steps });

/// Visibility of a light, to red of attachment 0, or red, green and blue of an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineSamples {
    /// The light.
    pub source: LineSource,
    /// Number of lines; 0 of a light without extent.
    pub lines: u32,
    /// y of the first line, and the distance of lines.
    pub spacing: [f32; 2],
    /// Sum of the lengths of all lines in the light.
    pub whole: f32,
    /// Corners of a polygon, in the light's coordinates, behind the lines; none of a round
    /// light.
    pub corners: u32,
    /// Twice the area that they enclose.
    pub double_area: f32,
    /// Whether all feet lie on one straight spine.
    pub straight: bool,
    /// The image on it.
    pub sums: LightSums,
    /// How texels of lines, lists, edges, boxes and facets lie.
    pub tables: [Table; 5],
    /// First of all planes among the texels of edges.
    pub planes: u32,
    /// Boxes; 0 where nothing casts.
    pub nodes: u32,
    /// Whether the stencil holds counts; else it is 0 in the light and anything in shadow.
    pub counted: bool,
    /// Rounding of depth, as a share of the square of the distance from the eye.
    pub depth_step: f32,
    /// First texel and number of a list of all edges, to be gone through instead of those of
    /// blocks; none where the number is 0.
    pub all: [u32; 2],
}
uniforms!(LineSamples {
    source,
    lines,
    spacing,
    whole,
    corners,
    double_area,
    straight,
    sums,
    tables,
    planes,
    nodes,
    counted,
    depth_step,
    all
});

/// A block's edges.
#[derive(Clone, Copy)]
struct List {
    first: u32,
    count: u32,
}

impl LineSamples {
    fn table(&self, slot: usize) -> Table {
        match slot {
            LINES => self.tables[0],
            LISTS => self.tables[1],
            EDGES => self.tables[2],
            NODES => self.tables[3],
            _ => self.tables[4],
        }
    }

    /// One texel for all lanes.
    #[inline(always)]
    fn one<L: Lanes>(&self, f: &mut Fragment<'_, L>, slot: usize, number: u32) -> [f32; 4] {
        let log = self.table(slot).log_width.min(31);
        f.fetch_same_texel(slot, [number & ((1 << log) - 1), number >> log])
    }

    /// The list of the block that the packet lies in.
    #[inline(always)]
    fn list<L: Lanes>(&self, f: &mut Fragment<'_, L>) -> List {
        let [x, y] = f.block();
        let [first, count, ..] = f.fetch_same_texel(BLOCKS, [x, y]);
        List {
            first: first as u32,
            count: (count as u32).min(MOST_EDGES),
        }
    }

    /// All lines, some at a time; the share that is seen.
    #[inline(always)]
    fn visible<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        receiver: &mut Receiver<L>,
        wanted: Mask<L>,
    ) -> [F32<L>; 3] {
        let list = self.list(f);
        let zero = F32::splat(l, 0.0);
        let mut visible = [zero; 3];
        let mut negative = Mask::splat(l, false);
        let mut gap = Gap::new(l);
        // Receivers that do not know D at the anchor look at all lines before any is swept.
        let mut searching = true;
        let count = self.lines.min(MOST_LINES);
        let mut first = 0;
        'groups: while first < count {
            let some = (count - first).min(AT_ONCE as u32);
            let mut events = Events::new(l);
            outlined(
                l,
                #[inline(always)]
                || self.place_lines(l, f, receiver, &mut events, [first, some]),
            );
            let mut look = 0;
            loop {
                outlined(
                    l,
                    #[inline(always)]
                    || self.collect(l, f, receiver, &mut events, list, look, wanted),
                );
                if searching && (receiver.uncounted & wanted).any() {
                    outlined(
                        l,
                        #[inline(always)]
                        || self.widen(f, receiver, &events, &mut gap),
                    );
                    if first + some < count {
                        first += some;
                        continue 'groups;
                    }
                    outlined(
                        l,
                        #[inline(always)]
                        || self.count_at_anchor(l, f, receiver, &gap, wanted),
                    );
                    searching = false;
                    if first > 0 {
                        first = 0;
                        continue 'groups;
                    }
                }
                searching = false;
                outlined(
                    l,
                    #[inline(always)]
                    || {
                        self.sweep(
                            l,
                            f,
                            receiver.base,
                            &mut events,
                            &mut visible,
                            &mut negative,
                        )
                    },
                );
                let more = events.overflown & wanted;
                if !more.any() {
                    break;
                }
                f.count(SECOND_LOOKS, more);
                look += 1;
            }
            outlined(
                l,
                #[inline(always)]
                || {
                    self.finish(
                        l,
                        f,
                        receiver.base,
                        &mut events,
                        &mut visible,
                        &mut negative,
                    )
                },
            );
            first += some;
        }
        f.count(NEGATIVE, negative & wanted);
        each3(
            #[inline(always)]
            |c| (visible[c] / receiver.whole).clamp(0.0, 1.0),
        )
    }
}

impl FragmentShader for LineSamples {
    fn outputs(&self) -> FragmentOutputs {
        FragmentOutputs {
            discards: true,
            textures: 8,
            counts: &LINE_COUNTS,
            ..FragmentOutputs::default()
        }
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let (zero, one) = (F32::splat(l, 0.0), F32::splat(l, 1.0));
        let own = [f.column(), f.row(), I32::splat(l, 0)];
        let texel = texel_of(l, f, POSITIONS, own);
        let receives = texel[3].gt(zero);
        f.discard(!receives);
        let wanted = receives & f.live();
        if !wanted.any() {
            return;
        }
        let count = f.fetch_stencil(STENCIL, own, 0).to_i32().to_f32();
        if self.lines == 0 {
            let lit = count.eq(zero).select_f32(one, zero);
            f.set_color(0, [lit, zero, zero, zero]);
            return;
        }
        let mut receiver = outlined(
            l,
            #[inline(always)]
            || self.receiver(l, f, texel, count),
        );
        let seen = self.visible(l, f, &mut receiver, wanted);
        let [r, g, b] = each3(
            #[inline(always)]
            |c| receiver.inside.select_f32(one, seen[c]),
        );
        f.set_color(0, [r, g, b, zero]);
    }
}
