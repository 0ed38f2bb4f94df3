//! Tests and output of one triangle in one 8×8 block (rules, §7).

use gnomon_raster::shader::{ScalarFragment, ScalarFragmentOutput};
use gnomon_raster::state::{CompareFunction, StencilFaceState, StencilOperation};
use gnomon_raster::{BlockAccess, Counters, FragmentEnd};

use super::case::{Log, TwinDraw, TwinPass};
use super::color::Target;
use super::coverage::{ClipPlanes, DrawRect, covers};
use super::depth::{DepthPlane, Encoding, limit};
use super::image::Images;
use super::log::BlockLog;
use super::look_up::{Reads, Values, look_up_all};
use super::program::Program;
use super::setup::Triangle;
use super::stencil::{compare, effective, looks, modifies, operate};
use super::texture::Bound;
use super::varying::Varyings;

/// What all blocks of a draw share.
pub(super) struct DrawContext<'a> {
    pub(super) pass: &'a TwinPass,
    pub(super) draw: &'a TwinDraw,
    pub(super) size: [u32; 2],
    pub(super) rect: DrawRect,
    pub(super) encoding: Encoding,
    pub(super) depth_range: [f32; 2],
    pub(super) skip: bool,
    pub(super) log: Log,
    pub(super) textures: Vec<Bound>,
}

/// What all blocks of a triangle share.
pub(super) struct TriangleContext<'a> {
    pub(super) triangle: &'a Triangle,
    pub(super) depth: DepthPlane,
    pub(super) varyings: Varyings,
    pub(super) clip_planes: ClipPlanes,
}

/// A fragment on its way.
pub(super) struct Fragment {
    pub(super) x: u32,
    pub(super) y: u32,
    /// Where its pixel is in an image.
    pub(super) at: usize,
    /// Its bit in a block's masks.
    pub(super) bit: u64,
    /// Depth in stored form.
    pub(super) depth: u32,
    /// What the shader computed.
    output: Option<ScalarFragmentOutput>,
}

/// What zmin/zmax say of the block.
#[derive(Clone, Copy, PartialEq)]
enum Verdict {
    Unknown,
    Passes,
    Fails,
}

/// One (triangle, block) pair.
pub(super) struct Block<'a> {
    pub(super) ctx: &'a DrawContext<'a>,
    pub(super) tri: &'a TriangleContext<'a>,
    pub(super) images: &'a mut Images,
    pub(super) counters: &'a mut Counters,
    pub(super) access: BlockAccess,
    /// Top-left pixel.
    pub(super) x: u32,
    pub(super) y: u32,
    pub(super) log: BlockLog<'a>,
}

impl Block<'_> {
    /// Runs all steps; the accesses, unless the triangle has no fragment here.
    pub(super) fn run(mut self) -> Option<BlockAccess> {
        let fragments = self.generated();
        if fragments.is_empty() {
            return None;
        }
        self.begin_record(&fragments);
        self.process(fragments);
        self.end_record();
        self.see_block();
        self.log.end();
        Some(self.access)
    }

    fn process(&mut self, mut fragments: Vec<Fragment>) {
        self.counters.fragments.generated += fragments.len() as u64;
        if let Some([span, stored]) = self.depth_ranges() {
            (self.access.span, self.access.stored) = (span, stored);
        }
        let verdict = self.zmin_zmax();
        if verdict == Verdict::Fails && !self.fails_with_effect() {
            self.counters.tiles.culled += 1;
            self.counters.fragments.hiz_killed += fragments.len() as u64;
            self.access.ended.hiz = true;
            fragments
                .iter()
                .for_each(|f| self.log.ended(f, FragmentEnd::Hiz));
            return;
        }
        self.counters.tiles.accepted += u64::from(verdict != Verdict::Unknown);
        let late = self.is_late();
        if late {
            fragments = self.shade(fragments);
        }
        if self.ctx.pass.depth.is_some() {
            fragments = self.bounds_test(fragments);
            fragments = self.stencil_test(fragments);
            fragments = self.depth_test(fragments, verdict);
        }
        if !late {
            fragments = self.shade(fragments);
        }
        self.counters.fragments.written += fragments.len() as u64;
        self.write_colors(&fragments);
    }

    pub(super) fn pixels(&self) -> Vec<(u32, u32)> {
        (0..64).map(|k| (self.x + k % 8, self.y + k / 8)).collect()
    }

    pub(super) fn in_image(&self, (x, y): (u32, u32)) -> bool {
        x < self.ctx.size[0] && y < self.ctx.size[1]
    }

    fn generated(&mut self) -> Vec<Fragment> {
        let clamp = self.ctx.draw.primitive.depth_clamp;
        let reaches_far = self
            .tri
            .triangle
            .corners
            .iter()
            .any(|c| c.vertex.position[2] > c.vertex.position[3]);
        let mut list = Vec::new();
        for (k, (x, y)) in self.pixels().into_iter().enumerate() {
            let inside = self.in_image((x, y)) && self.ctx.rect.contains(x, y);
            if !inside || !covers(self.tri.triangle.xy(), x, y) || !self.tri.clip_planes.keep(x, y)
            {
                continue;
            }
            let (depth, beyond_far) = self.tri.depth.at(x, y);
            if clamp || !reaches_far || !beyond_far {
                self.access.covered |= 1 << k;
                list.push(Fragment {
                    x,
                    y,
                    at: self.place(x, y),
                    bit: 1 << k,
                    depth,
                    output: None,
                });
            }
        }
        list
    }

    pub(super) fn place(&self, x: u32, y: u32) -> usize {
        y as usize * self.ctx.size[0] as usize + x as usize
    }

    fn face(&self) -> &StencilFaceState {
        let s = &self.ctx.draw.depth_stencil.stencil;
        if self.tri.triangle.front {
            &s.front
        } else {
            &s.back
        }
    }

    fn reference(&self) -> u8 {
        self.ctx.draw.stencil_reference[usize::from(!self.tri.triangle.front)]
    }

    fn fails_with_effect(&self) -> bool {
        let f = self.face();
        effective(f.fail_op, f) || effective(f.depth_fail_op, f)
    }

    fn is_late(&self) -> bool {
        let f = self.face();
        let attached = self.ctx.pass.depth.is_some();
        let ops = [f.fail_op, f.depth_fail_op, f.pass_op]
            .iter()
            .any(|&o| effective(o, f));
        let writes = attached && (self.ctx.draw.depth_stencil.depth.write || ops);
        self.ctx
            .draw
            .program
            .as_ref()
            .is_some_and(|p| p.depth.is_some() || (p.discard.is_some() && writes))
    }

    /// Step 1.
    fn zmin_zmax(&mut self) -> Verdict {
        let state = &self.ctx.draw.depth_stencil.depth;
        let writes_depth = self
            .ctx
            .draw
            .program
            .as_ref()
            .is_some_and(|p| p.depth.is_some());
        let used = self.ctx.skip && looks(state.compare) && state.bounds.is_none() && !writes_depth;
        let Some([span, stored]) = self.depth_ranges().filter(|_| used) else {
            return Verdict::Unknown;
        };
        self.counters.tiles.tested += 1;
        self.access.hiz_read = true;
        verdict(state.compare, span, stored)
    }

    /// Ends of the triangle's depths over the whole block, and of what is stored in the
    /// part of it inside the image; none without depth attachment.
    fn depth_ranges(&self) -> Option<[[u32; 2]; 2]> {
        let image = self.images.depth.as_ref();
        let depth = image.filter(|_| self.ctx.pass.depth.is_some())?;
        let pixels = self.pixels();
        let new: Vec<_> = pixels
            .iter()
            .map(|&(x, y)| self.tri.depth.at(x, y).0)
            .collect();
        let inside = pixels.into_iter().filter(|&p| self.in_image(p));
        let old: Vec<_> = inside.map(|(x, y)| depth.depth[self.place(x, y)]).collect();
        Some([ends(&new), ends(&old)])
    }

    /// Steps 2 and 6.
    fn shade(&mut self, fragments: Vec<Fragment>) -> Vec<Fragment> {
        let Some(program) = &self.ctx.draw.program else {
            return fragments;
        };
        let mut left = Vec::new();
        for mut f in fragments {
            self.counters.fragment_shader_invocations += 1;
            self.counters.shader_counts[0] += u64::from(f.x % 2);
            let (looked_up, reads) = self.look_ups(program, &f);
            let out = program.shade(&self.shaded(f.x, f.y), &looked_up);
            if !(out.discard && program.discards_first) {
                reads.count(&self.ctx.textures, self.counters);
                self.log.texels(&reads);
            }
            self.shaded_record(&f, &out);
            if out.discard {
                self.log.ended(&f, FragmentEnd::Discarded);
                self.counters.fragments.discarded += 1;
                self.access.ended.discarded |= f.bit;
                self.counters.shader_counts[1] += 1;
                continue;
            }
            if program.depth.is_some() {
                f.depth = self.shader_depth(out.depth);
                self.depth_record(&f);
            }
            f.output = Some(out);
            left.push(f);
        }
        left
    }

    /// A pixel as the shader sees it, whether it is a fragment or a helper.
    fn shaded(&self, x: u32, y: u32) -> ScalarFragment {
        ScalarFragment {
            varyings: self.tri.varyings.at(x, y),
            x,
            y,
            depth: self.ctx.encoding.decode(self.tri.depth.at(x, y).0),
            w: self.tri.varyings.w(x, y),
            front_facing: self.tri.triangle.front,
            primitive_index: self.tri.triangle.primitive,
        }
    }

    fn look_ups(&self, program: &Program, f: &Fragment) -> (Values, Reads) {
        if program.look_ups.is_empty() {
            return (Values::default(), Reads::default());
        }
        let (x, y) = (f.x - f.x % 2, f.y - f.y % 2);
        let quad = [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)];
        let own = (f.x % 2 + 2 * (f.y % 2)) as usize;
        let pixels = quad.map(|(x, y)| self.shaded(x, y));
        look_up_all(&program.look_ups, &self.ctx.textures, &pixels, own)
    }

    fn shader_depth(&mut self, z: f32) -> u32 {
        let e = &mut self.counters.events;
        e.nan_canonicalised += u64::from(z.is_nan());
        let z = if z.is_nan() { 0.0 } else { z };
        e.depth_clamped += u64::from(!(0.0..=1.0).contains(&z));
        self.ctx.encoding.encode(limit(z, self.ctx.depth_range))
    }

    /// Step 3.
    fn bounds_test(&mut self, mut fragments: Vec<Fragment>) -> Vec<Fragment> {
        let Some(bounds) = self.ctx.draw.depth_stencil.depth.bounds else {
            return fragments;
        };
        let [lo, hi] = bounds.map(|b| self.ctx.encoding.encode(b));
        let before = fragments.len();
        let stored = &self.images.depth.as_ref().expect("attached").depth;
        for f in &fragments {
            self.access.z_read |= f.bit;
        }
        for f in &fragments {
            if !(lo..=hi).contains(&stored[f.at]) {
                self.access.ended.bounds |= f.bit;
                self.log.ended(f, FragmentEnd::Bounds);
            }
        }
        fragments.retain(|f| (lo..=hi).contains(&stored[f.at]));
        self.counters.fragments.bounds_failed += (before - fragments.len()) as u64;
        fragments
    }

    /// Step 4.
    fn stencil_test(&mut self, fragments: Vec<Fragment>) -> Vec<Fragment> {
        let face = *self.face();
        let reference = u32::from(self.reference() & face.read_mask);
        let mut left = Vec::new();
        for f in fragments {
            if looks(face.compare) {
                self.access.stencil_read |= f.bit;
            }
            let stored = self.images.depth.as_ref().expect("attached").stencil[f.at];
            if compare(face.compare, reference, u32::from(stored & face.read_mask)) {
                left.push(f);
            } else {
                self.counters.fragments.stencil_failed += 1;
                self.access.ended.stencil |= f.bit;
                self.log.ended(&f, FragmentEnd::Stencil);
                self.stencil_operation(face.fail_op, &f);
            }
        }
        left
    }

    fn stencil_operation(&mut self, op: StencilOperation, f: &Fragment) {
        let (face, reference) = (*self.face(), self.reference());
        self.log.operated(f, op);
        if modifies(op, &face) {
            self.access.stencil_read |= f.bit;
        }
        if effective(op, &face) {
            self.access.stencil_write |= f.bit;
            let stored = &mut self.images.depth.as_mut().expect("attached").stencil[f.at];
            let new = operate(op, &face, *stored, reference);
            self.counters.events.silent_stencil_writes += u64::from(new == *stored);
            *stored = new;
        }
    }

    /// Step 5.
    fn depth_test(&mut self, fragments: Vec<Fragment>, verdict: Verdict) -> Vec<Fragment> {
        let face = *self.face();
        let state = self.ctx.draw.depth_stencil.depth;
        let mut left = Vec::new();
        for f in fragments {
            if looks(state.compare) && verdict == Verdict::Unknown {
                self.access.z_read |= f.bit;
            }
            let stored = self.images.depth.as_ref().expect("attached").depth[f.at];
            let passes = compare(state.compare, f.depth, stored);
            assert!(
                verdict
                    != if passes {
                        Verdict::Fails
                    } else {
                        Verdict::Passes
                    },
                "zmin/zmax lied"
            );
            if passes {
                self.stencil_operation(face.pass_op, &f);
                self.write_depth(&f, state.write);
                left.push(f);
            } else {
                self.counters.fragments.depth_failed += 1;
                self.access.ended.depth |= f.bit;
                self.log.ended(&f, FragmentEnd::Depth);
                self.stencil_operation(face.depth_fail_op, &f);
            }
        }
        left
    }

    fn write_depth(&mut self, f: &Fragment, write: bool) {
        if write {
            self.access.z_write |= f.bit;
            self.access.hiz_write = true;
            let stored = &mut self.images.depth.as_mut().expect("attached").depth[f.at];
            self.counters.events.silent_z_writes += u64::from(*stored == f.depth);
            *stored = f.depth;
        }
    }

    /// Step 7.
    fn write_colors(&mut self, fragments: &[Fragment]) {
        if self.ctx.draw.program.is_none() {
            return;
        }
        for (attachment, (used, state)) in self
            .ctx
            .pass
            .color
            .iter()
            .zip(&self.ctx.draw.targets)
            .enumerate()
        {
            let image = &mut self.images.color[used.image];
            let constant = self.ctx.draw.blend_constant;
            let target = Target {
                attachment,
                format: image.format,
                state,
                constant,
            };
            if target.is_skipped() {
                continue;
            }
            for f in fragments {
                let output = f.output.as_ref().expect("shaded");
                let (src, integer) = (output.color[attachment], output.integer[attachment]);
                let old = image.texels[f.at];
                let new = target.output(old, src, integer, &mut self.counters.events);
                self.counters.events.silent_color_writes[attachment] += u64::from(new == old);
                image.texels[f.at] = new;
                self.access.color_write[attachment] |= f.bit;
                if target.reads() {
                    self.access.color_read[attachment] |= f.bit;
                }
            }
        }
    }
}

fn ends(v: &[u32]) -> [u32; 2] {
    let smallest = v.iter().copied().min().expect("a block has pixels");
    let largest = v.iter().copied().max().expect("a block has pixels");
    [smallest, largest]
}

/// What follows from the ranges [a, b] of new and [min, max] of stored depth.
fn verdict(f: CompareFunction, [a, b]: [u32; 2], [min, max]: [u32; 2]) -> Verdict {
    let same = a == b && b == min && min == max;
    let apart = b < min || a > max;
    let (passes, fails) = match f {
        CompareFunction::Less => (b < min, a >= max),
        CompareFunction::LessEqual => (b <= min, a > max),
        CompareFunction::Greater => (a > max, b <= min),
        CompareFunction::GreaterEqual => (a >= max, b < min),
        CompareFunction::Equal => (same, apart),
        CompareFunction::NotEqual => (apart, same),
        CompareFunction::Never | CompareFunction::Always => (false, false),
    };
    match (passes, fails) {
        (true, _) => Verdict::Passes,
        (_, true) => Verdict::Fails,
        _ => Verdict::Unknown,
    }
}
