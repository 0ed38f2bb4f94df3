//! Texture look-ups of fragment shaders (`docs/texture-rules.md`).
//!
//! Everything but the gathers runs over lanes. Lanes that agree on mip level and
//! filter are looked up together, so that sizes, planes and decoding are the
//! same for all of them; in most packets there is one such group. All 16 lanes
//! are computed, helpers too, for derivatives of what a look-up gives; only
//! fragments are counted.

use super::BoundTexture;
use super::address::Axis;
use super::cube::{self, Face};
use super::fetch::{self, Aspect, NO_WORDS, Texels, gather};
use super::lod::{self, Detail, Levels};
use crate::format::lanes::{Words, decode};

use crate::math;
use crate::shader::Fragment;
use crate::simd::{F32, I32, LANES, Lanes, Mask, U32, outlined};
use crate::state::{AddressMode, Sampler};
use crate::texture::{Texture, TextureDimension};
use crate::tile::COUNT;

/// Where a texture is looked up.
#[derive(Clone, Copy)]
struct Point<L: Lanes> {
    /// Normalised coordinates.
    at: [F32<L>; 3],
    /// Cube face.
    face: I32<L>,
}

/// One look-up, and the texels that it has read.
struct LookUp<'a, L: Lanes> {
    l: L,
    texture: &'a Texture,
    sampler: &'a Sampler,
    /// Lanes whose reads are counted.
    counted: u16,
    texels: u64,
}

/// Number of axes that are filtered.
fn axes(texture: &Texture) -> usize {
    match texture.desc.dimension {
        TextureDimension::D1 => 1,
        TextureDimension::D2 | TextureDimension::Cube => 2,
        TextureDimension::D3 => 3,
    }
}

impl<L: Lanes> LookUp<'_, L> {
    /// The filtered value.
    #[inline(always)]
    fn sample(&mut self, coord: [F32<L>; 3], detail: &Detail<L>) -> [F32<L>; 4] {
        let mut point = Point {
            at: coord,
            face: I32::splat(self.l, 0),
        };
        let mut face = None;
        if self.texture.desc.dimension == TextureDimension::Cube {
            let f = Face::of(coord);
            point = Point {
                at: f.coordinate(coord),
                face: f.number,
            };
            face = Some(f);
        }
        let lod = self.lod(coord, face, detail);
        let levels = Levels::select(self.sampler, lod, self.texture.desc.mip_levels);
        let mut value = self.sample_levels(&point, &levels);
        for c in &mut value {
            *c = c.canonical_nan();
        }
        value
    }

    /// The level of detail within the sampler's limits.
    #[inline(always)]
    fn lod(&self, coord: [F32<L>; 3], face: Option<Face<L>>, detail: &Detail<L>) -> F32<L> {
        if self.texture.desc.mip_levels == 1 && self.sampler.mag == self.sampler.min {
            return F32::splat(self.l, 0.0);
        }
        let mut gradients = match detail {
            Detail::Level(lod) => return lod::limited(self.sampler, *lod, 0.0),
            Detail::Gradients(g) => *g,
            Detail::Quads => quad_changes(&coord),
        };
        if let Some(f) = face {
            gradients = [
                f.gradient(coord, gradients[0]),
                f.gradient(coord, gradients[1]),
            ];
        }
        let lod = lod::from_gradients(self.texture.desc.size, axes(self.texture), gradients);
        lod::limited(self.sampler, lod, self.sampler.lod_bias)
    }

    /// Both levels of each lane, and their mixture.
    #[inline(always)]
    fn sample_levels(&mut self, point: &Point<L>, levels: &Levels<L>) -> [F32<L>; 4] {
        let zero = F32::splat(self.l, 0.0);
        let between = levels.fraction.gt(zero);
        let mut values = [[zero; 4]; 2];
        for (k, value) in values.iter_mut().enumerate() {
            let lanes = if k == 0 { u16::MAX } else { between.bits() };
            *value = self.sample_groups(point, levels, k as i32, lanes);
        }
        let [a, b] = values;
        let mut out = a;
        for c in 0..4 {
            out[c] = between.select_f32(math::mix(a[c], b[c], levels.fraction), a[c]);
        }
        out
    }

    /// `lanes` at their level plus `step`, group after group; others give 0.
    #[inline(always)]
    fn sample_groups(
        &mut self,
        point: &Point<L>,
        levels: &Levels<L>,
        step: i32,
        lanes: u16,
    ) -> [F32<L>; 4] {
        let level = levels.first + I32::splat(self.l, step);
        let numbers = level.to_array();
        let linear = levels.linear.bits();
        let mut values = [F32::splat(self.l, 0.0); 4];
        let mut rest = lanes;
        while rest != 0 {
            let lane = rest.trailing_zeros();
            let alike = if linear >> lane & 1 != 0 {
                linear
            } else {
                !linear
            };
            let same = level.eq(I32::splat(self.l, numbers[lane as usize])).bits() & alike & rest;
            let v = self.sample_level(point, numbers[lane as usize] as u32, alike == linear, same);
            let mask = Mask::from_bits(self.l, same);
            for c in 0..4 {
                values[c] = mask.select_f32(v[c], values[c]);
            }
            rest &= !same;
        }
        values
    }

    /// One level with one filter; meaningful in `lanes`.
    #[inline(always)]
    fn sample_level(
        &mut self,
        point: &Point<L>,
        level: u32,
        linear: bool,
        lanes: u16,
    ) -> [F32<L>; 4] {
        let count = axes(self.texture);
        let on = self.axes_at(point, level, linear);
        let mut values = [[F32::splat(self.l, 0.0); 4]; 8];
        let taps = if linear { 1 << count } else { 1 };
        for (tap, value) in values.iter_mut().enumerate().take(taps) {
            *value = self.tap(point, &on, level, tap, lanes);
        }
        if linear {
            for (k, axis) in on.iter().enumerate().take(count) {
                for j in 0..taps >> (k + 1) {
                    for c in 0..4 {
                        values[j][c] =
                            math::mix(values[2 * j][c], values[2 * j + 1][c], axis.weight);
                    }
                }
            }
        }
        values[0]
    }

    #[inline(always)]
    fn axes_at(&self, point: &Point<L>, level: u32, linear: bool) -> [Axis<L>; 3] {
        let size = self.texture.mip_size(level);
        let mut on = [Axis::none(self.l); 3];
        for (k, axis) in on.iter_mut().enumerate().take(axes(self.texture)) {
            *axis = axis_of(self, k, linear, &point.at[k], size[k]);
        }
        on
    }

    /// Texel `tap` of up to eight: bit k of `tap` chooses along axis k.
    #[inline(always)]
    fn tap(
        &mut self,
        point: &Point<L>,
        on: &[Axis<L>; 3],
        level: u32,
        tap: usize,
        lanes: u16,
    ) -> [F32<L>; 4] {
        let [i, j, k] = [tap & 1, tap >> 1 & 1, tap >> 2];
        let inside = on[0].inside[i] & on[1].inside[j] & on[2].inside[k];
        let read = inside.bits() & lanes;
        if COUNT {
            self.texels += u64::from((read & self.counted).count_ones());
        }
        let (mut x, mut y) = (on[0].index[i], on[1].index[j]);
        let mut layer = on[2].index[k].to_array();
        if self.texture.desc.dimension == TextureDimension::Cube {
            layer = point.face.to_array();
            let (mut columns, mut rows) = (x.to_array(), y.to_array());
            let size = self.texture.mip_size(level)[0];
            fold_lanes(&mut layer, &mut columns, &mut rows, size);
            (x, y) = (
                I32::from_array(self.l, &columns),
                I32::from_array(self.l, &rows),
            );
        }
        let t = Texels {
            mip: level,
            layer: &layer,
            at: &self.texture.layouts[level as usize]
                .locate_lanes(x, y)
                .to_array(),
            lanes: read,
        };
        self.bordered(read_texels(self.l, self.texture, &t), inside)
    }

    /// The border colour where a texel is not inside; channels that the format
    /// lacks stay 0, alpha 1.
    #[inline(always)]
    fn bordered(&self, mut value: [F32<L>; 4], inside: Mask<L>) -> [F32<L>; 4] {
        if self.sampler.address.contains(&AddressMode::ClampToBorder) && !inside.all() {
            for (c, v) in value
                .iter_mut()
                .enumerate()
                .take(self.texture.desc.format.channels())
            {
                *v = inside.select_f32(*v, F32::splat(self.l, self.sampler.border[c]));
            }
        }
        value
    }
}

// The functions below are never inlined: a shader may hold many look-ups,
// and one body for all of them keeps its code, and the time to compile it, small.
// Inside each, `outlined` brings the level's instruction set back.

/// One filtered look-up: its value and the texels counted.
#[inline(never)]
pub(super) fn look_up<L: Lanes>(
    l: L,
    bound: &BoundTexture<'_>,
    counted: u16,
    coord: &[F32<L>; 3],
    detail: &Detail<L>,
) -> ([F32<L>; 4], u64) {
    outlined(
        l,
        #[inline(always)]
        || {
            let mut look_up = LookUp {
                l,
                texture: bound.texture,
                sampler: &bound.sampler,
                counted,
                texels: 0,
            };
            (look_up.sample(*coord, detail), look_up.texels)
        },
    )
}

/// The change of a coordinate over each lane's quad, in x and in y.
#[inline(never)]
fn quad_changes<L: Lanes>(coord: &[F32<L>; 3]) -> [[F32<L>; 3]; 2] {
    outlined(
        coord[0].lanes(),
        #[inline(always)]
        || {
            let mut changes = [*coord; 2];
            for (k, v) in coord.iter().enumerate() {
                changes[0][k] = v.quad_ddx();
                changes[1][k] = v.quad_ddy();
            }
            changes
        },
    )
}

/// Axis `k` of a look-up at `u`, in a level of `size` texels.
#[inline(never)]
fn axis_of<L: Lanes>(
    look_up: &LookUp<'_, L>,
    k: usize,
    linear: bool,
    u: &F32<L>,
    size: u32,
) -> Axis<L> {
    outlined(
        look_up.l,
        #[inline(always)]
        || {
            if look_up.texture.desc.dimension == TextureDimension::Cube {
                Axis::on_face(linear, *u, size)
            } else {
                Axis::new(look_up.sampler.address[k], linear, *u, size)
            }
        },
    )
}

/// Decoded texels.
#[inline(never)]
fn read_texels<L: Lanes>(l: L, texture: &Texture, t: &Texels<'_>) -> [F32<L>; 4] {
    let mut words = NO_WORDS;
    gather(texture, Aspect::Main, t, &mut words);
    outlined(
        l,
        #[inline(always)]
        || decode(l, texture.desc.format, &words),
    )
}

/// Moves texels beyond the edges of their cube face to the neighbouring face.
fn fold_lanes(layer: &mut [i32; LANES], x: &mut [i32; LANES], y: &mut [i32; LANES], size: u32) {
    let n = size as i32;
    for lane in 0..LANES {
        if x[lane].min(y[lane]) < 0 || x[lane].max(y[lane]) >= n {
            let (face, i, j) = cube::fold(layer[lane] as usize, x[lane], y[lane], n);
            (layer[lane], x[lane], y[lane]) = (face as i32, i, j);
        }
    }
}

/// Puts the stored bits at integer coordinates of level `mip` into `words`, which hold
/// zeros; gives the lanes whose texel exists.
#[inline(always)]
pub(super) fn fetch_words<L: Lanes>(
    texture: &Texture,
    aspect: Aspect,
    at: [I32<L>; 3],
    mip: u32,
    words: &mut Words,
) -> u16 {
    let has_aspect = aspect == Aspect::Main || texture.desc.format.is_depth_stencil();
    if mip >= texture.desc.mip_levels || !has_aspect {
        return 0;
    }
    let [w, h, _] = texture.mip_size(mip);
    let layers = texture.planes[mip as usize].len() as u32;
    let mut inside = fetch::inside(at[0], w);
    let (x, mut y, mut layer) = (at[0], at[1], at[2].to_array());
    match texture.desc.dimension {
        TextureDimension::D1 => (y, layer) = (I32::splat(x.l, 0), [0; LANES]),
        TextureDimension::D2 => {
            inside &= fetch::inside(at[1], h);
            layer = [0; LANES];
        }
        TextureDimension::D3 | TextureDimension::Cube => {
            inside &= fetch::inside(at[1], h) & fetch::inside(at[2], layers);
        }
    }
    let t = Texels {
        mip,
        layer: &layer,
        at: &texture.layouts[mip as usize].locate_lanes(x, y).to_array(),
        lanes: inside,
    };
    gather(texture, aspect, &t, words);
    inside
}

/// Decoded texels; zero in all channels outside.
#[inline(always)]
pub(super) fn decode_fetched<L: Lanes>(
    l: L,
    texture: &Texture,
    words: &Words,
    inside: u16,
) -> [F32<L>; 4] {
    let inside = Mask::from_bits(l, inside);
    let zero = F32::splat(l, 0.0);
    let mut v = decode(l, texture.desc.format, words);
    for c in &mut v {
        *c = inside.select_f32(c.canonical_nan(), zero);
    }
    v
}

/// Texture look-ups, by slot of the draw. All give 0 for a slot without texture
/// (which validation refuses). The arithmetic is in `docs/texture-rules.md`.
impl<L: Lanes> Fragment<'_, L> {
    /// Filtered by the slot's sampler, the level of detail from the change of
    /// `coord` over the 2×2 quad. 1D textures use `coord[0]`, 2D ones two
    /// components, 3D ones three, all 0..=1 over the image; cube maps take a
    /// direction of any length.
    #[inline(always)]
    pub fn sample(&mut self, slot: usize, coord: [F32<L>; 3]) -> [F32<L>; 4] {
        self.look_up(slot, coord, &Detail::Quads)
    }

    /// As [`Fragment::sample`], with the change of `coord` to the next pixel in
    /// x and y given.
    #[inline(always)]
    pub fn sample_grad(
        &mut self,
        slot: usize,
        coord: [F32<L>; 3],
        dx: [F32<L>; 3],
        dy: [F32<L>; 3],
    ) -> [F32<L>; 4] {
        self.look_up(slot, coord, &Detail::Gradients([dx, dy]))
    }

    /// Filtered at the level of detail given, to which the sampler's bias is not
    /// added.
    #[inline(always)]
    pub fn sample_level(&mut self, slot: usize, coord: [F32<L>; 3], lod: F32<L>) -> [F32<L>; 4] {
        self.look_up(slot, coord, &Detail::Level(lod))
    }

    /// The texel at integer coordinates of level `mip`, unfiltered: column, row,
    /// and slice or cube face. Zero outside the texture.
    #[inline(always)]
    pub fn fetch_texel(&mut self, slot: usize, at: [I32<L>; 3], mip: u32) -> [F32<L>; 4] {
        let l = self.lanes();
        let mut words = NO_WORDS;
        match self.fetch(slot, Aspect::Main, at, mip, &mut words) {
            Some((texture, inside)) => decode_fetched(l, texture, &words, inside),
            None => [F32::splat(l, 0.0); 4],
        }
    }

    /// The stored bits of the first channel of a texel: the integer of
    /// `R32Uint`, the float's bits of `R32Float`, the packed bytes of `Rgba8Unorm`
    /// (red low), the stored depth. Zero outside.
    #[inline(always)]
    pub fn fetch_texel_bits(&mut self, slot: usize, at: [I32<L>; 3], mip: u32) -> U32<L> {
        let l = self.lanes();
        let mut words = NO_WORDS;
        self.fetch(slot, Aspect::Main, at, mip, &mut words);
        U32::from_array(l, &words[0])
    }

    /// The stencil value of a texel of a depth-stencil texture. Zero outside and
    /// for colour.
    #[inline(always)]
    pub fn fetch_stencil(&mut self, slot: usize, at: [I32<L>; 3], mip: u32) -> U32<L> {
        let l = self.lanes();
        let mut words = NO_WORDS;
        self.fetch(slot, Aspect::Stencil, at, mip, &mut words);
        U32::from_array(l, &words[0])
    }

    /// Width, height and depth of level `mip` in texels; zeros without one.
    #[inline(always)]
    pub fn texture_size(&self, slot: usize, mip: u32) -> [u32; 3] {
        match self.textures.get(slot) {
            Some(b) if mip < b.texture.desc.mip_levels => b.texture.mip_size(mip),
            _ => [0; 3],
        }
    }

    #[inline(always)]
    fn look_up(&mut self, slot: usize, coord: [F32<L>; 3], detail: &Detail<L>) -> [F32<L>; 4] {
        let l = self.lanes();
        let Some(bound) = self.textures.get(slot) else {
            return [F32::splat(l, 0.0); 4];
        };
        let counted = self.counted_lanes();
        let (value, texels) = look_up(l, bound, counted, &coord, detail);
        self.count_fetches(slot, texels);
        value
    }

    #[inline(always)]
    fn fetch(
        &mut self,
        slot: usize,
        aspect: Aspect,
        at: [I32<L>; 3],
        mip: u32,
        words: &mut Words,
    ) -> Option<(&Texture, u16)> {
        let texture = self.textures.get(slot)?.texture;
        let inside = fetch_words(texture, aspect, at, mip, words);
        let texels = u64::from((inside & self.counted_lanes()).count_ones());
        self.count_fetches(slot, texels);
        Some((texture, inside))
    }

    /// One fetch a fragment, and the texels that these read.
    #[inline(always)]
    fn count_fetches(&mut self, slot: usize, texels: u64) {
        if !COUNT {
            return;
        }
        let fetches = u64::from(self.counted_lanes().count_ones());
        if let (Some(f), Some(t)) = (
            self.events.fetches.get_mut(slot),
            self.events.texels.get_mut(slot),
        ) {
            *f += fetches;
            *t += texels;
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use crate::shader::{
        Fragment, FragmentOutputs, FragmentShader, ScalarVertexOutput, per_vertex,
    };
    use crate::simd::{F32, Lanes, SimdLevel};
    use crate::state::{ColorTargetState, DepthStencilState, PrimitiveState, ScissorRect};
    use crate::texture::ColorTexel;
    use crate::{
        ColorAttachment, CommandList, Counters, Draw, Format, Gpu, GpuConfig, LoadOp, RenderPass,
        RenderPipeline, Sampler, StoreOp, Subresource, TextureBinding, TextureDescriptor,
    };

    /// Slot 0 filtered, plus the stored bits of the pixel's own texel of slot 1.
    struct Both;

    impl FragmentShader for Both {
        fn outputs(&self) -> FragmentOutputs {
            FragmentOutputs {
                textures: 2,
                ..FragmentOutputs::default()
            }
        }

        #[inline(always)]
        fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
            let zero = F32::splat(l, 0.0);
            assert_eq!(f.texture_size(0, 1), [4, 4, 1]);
            assert_eq!(f.texture_size(7, 0), [0; 3]);
            let a = f.sample(0, [f.x() / 4.0, f.y() / 4.0, zero])[0];
            let b = f
                .fetch_texel_bits(1, [f.column(), f.row(), f.row()], 0)
                .to_i32()
                .to_f32();
            let none = f.sample_level(5, [zero; 3], zero)[3] + f.fetch_texel(5, [f.row(); 3], 0)[3];
            f.set_color(0, [a, b, none, zero]);
        }
    }

    fn image(label: &str, format: Format, side: u32, mip_levels: u32) -> TextureDescriptor {
        TextureDescriptor {
            mip_levels,
            ..TextureDescriptor::d2(label, format, side, side)
        }
    }

    /// Three columns of a 4×4 image: 12 fragments.
    fn render(simd: SimdLevel) -> (Vec<ColorTexel>, Counters) {
        let mut gpu = Gpu::new(GpuConfig {
            threads: 1,
            simd,
            ..GpuConfig::default()
        })
        .unwrap();
        let target = gpu
            .create_texture(&image("target", Format::Rgba32Float, 4, 1))
            .unwrap();
        let mips = gpu
            .create_texture(&image("mips", Format::R8Unorm, 8, 4))
            .unwrap();
        let bits = gpu
            .create_texture(&image("bits", Format::R32Uint, 4, 1))
            .unwrap();
        let s = Subresource::default();
        for (mip, value) in [1.0, 0.2, 0.0, 0.0].into_iter().enumerate() {
            let s = Subresource {
                mip: mip as u32,
                layer: 0,
            };
            gpu.texture_mut(mips)
                .unwrap()
                .write_color(s, &vec![[value; 4]; (8usize >> mip).pow(2)])
                .unwrap();
        }
        let numbers: Vec<[u32; 4]> = (0..16).map(|i| [100 + i, 0, 0, 0]).collect();
        gpu.texture_mut(bits)
            .unwrap()
            .write_raw(s, &numbers)
            .unwrap();
        let pipeline = Arc::new(RenderPipeline {
            label: "both".into(),
            vertex: per_vertex(&[], |v| {
                let [x, y] = [[-1.0, 3.0], [-1.0, -1.0], [3.0, -1.0]][v.vertex_index as usize];
                ScalarVertexOutput {
                    position: [x, y, 0.5, 1.0],
                    ..Default::default()
                }
            }),
            fragment: Some(Both.into()),
            primitive: PrimitiveState::default(),
            depth_stencil: DepthStencilState::default(),
            color_targets: vec![ColorTargetState::OPAQUE],
        });
        let bind = |texture, sampler| TextureBinding { texture, sampler };
        let draw = Draw {
            textures: vec![
                bind(mips, Sampler::trilinear()),
                bind(bits, Sampler::default()),
            ],
            scissor: Some(ScissorRect {
                x: 0,
                y: 0,
                width: 3,
                height: 4,
            }),
            ..Draw::vertices_only("both", &pipeline, 3)
        };
        let color = ColorAttachment {
            texture: target,
            subresource: s,
            load: LoadOp::DontCare,
            store: StoreOp::Store,
        };
        let pass = RenderPass {
            label: "p".into(),
            color: vec![color],
            depth_stencil: None,
            draws: vec![draw],
        };
        let report = gpu.submit(&CommandList { passes: vec![pass] }).unwrap();
        let texels = gpu.texture(target).unwrap().read_color(s).unwrap();
        (texels, report.passes[0].draws[0].counters)
    }

    #[test]
    fn a_shader_samples_and_its_fragments_are_counted() {
        for simd in SimdLevel::available() {
            let (texels, counters) = render(simd);
            // Two texels of level 0 a pixel: level 1.
            assert_eq!(texels[12].0, [51.0 / 255.0, 112.0, 0.0, 0.0]);
            assert_eq!(texels[3].0, [0.0; 4], "not covered");
            assert_eq!(counters.fragments.written, 12);
            let t = counters.traffic;
            assert_eq!(t.tex_fetches[..3], [12, 12, 0]);
            assert_eq!((t.tex[0].read_accesses, t.tex[0].read_bytes), (48, 48));
            assert_eq!((t.tex[1].read_accesses, t.tex[1].read_bytes), (12, 48));
        }
    }
}
