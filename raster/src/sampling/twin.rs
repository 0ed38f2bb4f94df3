//! `docs/texture-rules.md` a second time, one lookup at a time and slowly, and
//! the tests that hold the lanes against it.

use super::BoundTexture;
use super::fetch::{Aspect, NO_WORDS};
use super::lod::Detail;
use super::sample::{decode_fetched, fetch_words, look_up};
use crate::format::{self, Format};
use crate::math::scalar;
use crate::simd::{F32, I32, LANES, SimdLevel, with_lanes};
use crate::state::{AddressMode, FilterMode, Sampler};
use crate::texture::{Subresource, Texture, TextureDescriptor, TextureDimension};

/// `if a > b { a } else { b }`; the facade's NaN rule, written out.
fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

fn limit(v: f32, lo: f32, hi: f32) -> f32 {
    let v = larger(v, lo);
    if v < hi { v } else { hi }
}

/// A texture, decoded.
struct Twin {
    desc: TextureDescriptor,
    /// `[mip][layer][texel]`.
    images: Vec<Vec<Vec<[f32; 4]>>>,
    sampler: Sampler,
}

impl Twin {
    fn new(t: &Texture, sampler: Sampler) -> Self {
        let image = |mip: u32, layer: u32| {
            let s = Subresource { mip, layer };
            if t.desc.format.is_depth_stencil() {
                return t
                    .read_depth(s)
                    .unwrap()
                    .into_iter()
                    .map(|d| [d, 0.0, 0.0, 1.0])
                    .collect();
            }
            t.read_color(s).unwrap().into_iter().map(|c| c.0).collect()
        };
        let layers = |mip: u32| t.planes[mip as usize].len() as u32;
        let level = |mip| (0..layers(mip)).map(|layer| image(mip, layer)).collect();
        Self {
            desc: t.desc.clone(),
            images: (0..t.desc.mip_levels).map(level).collect(),
            sampler,
        }
    }

    fn size(&self, mip: usize) -> [i32; 3] {
        self.desc.size.map(|s| (s >> mip).max(1) as i32)
    }

    fn axes(&self) -> usize {
        match self.desc.dimension {
            TextureDimension::D1 => 1,
            TextureDimension::D3 => 3,
            _ => 2,
        }
    }

    fn is_cube(&self) -> bool {
        self.desc.dimension == TextureDimension::Cube
    }

    /// §2: candidate indices along an axis (`None` outside) and the weight.
    fn axis(&self, k: usize, linear: bool, u: f32, n: i32) -> (Vec<Option<i32>>, f32) {
        let mode = if self.is_cube() {
            AddressMode::ClampToEdge
        } else {
            self.sampler.address[k]
        };
        let p = match mode {
            AddressMode::Repeat => u - u.floor(),
            AddressMode::MirrorRepeat => (u - (u * 0.5).round_ties_even() * 2.0).abs(),
            _ => u,
        };
        let scaled = if p.is_nan() { 0.0 } else { p } * n as f32;
        let (first, taps, weight) = if linear {
            let s = limit(scaled - 0.5, -2.0, n as f32 + 1.0);
            (s.floor() as i32, 2, s - s.floor())
        } else {
            (limit(scaled, -1.0, n as f32).floor() as i32, 1, 0.0)
        };
        let place = |i: i32| match mode {
            _ if self.is_cube() && linear => Some(i),
            AddressMode::ClampToBorder => (0..n).contains(&i).then_some(i),
            AddressMode::Repeat if linear => Some(i.rem_euclid(n)),
            _ => Some(i.clamp(0, n - 1)),
        };
        ((first..first + taps).map(place).collect(), weight)
    }

    /// One texel, and whether it was read.
    fn texel(&self, mip: usize, face: usize, at: [Option<i32>; 3]) -> ([f32; 4], u64) {
        let [Some(x), Some(y), Some(z)] = at else {
            let mut border = [0.0, 0.0, 0.0, 1.0];
            let n = self.desc.format.channels();
            border[..n].copy_from_slice(&self.sampler.border[..n]);
            return (border, 0);
        };
        let (layer, x, y) = if self.is_cube() {
            over_edge(face, x, y, self.size(mip)[0])
        } else {
            (z as usize, x, y)
        };
        (
            self.images[mip][layer][(y * self.size(mip)[0] + x) as usize],
            1,
        )
    }

    /// §2: one level.
    fn level(&self, mip: usize, linear: bool, face: usize, at: [f32; 3]) -> ([f32; 4], u64) {
        let size = self.size(mip);
        let axis = |k: usize| {
            if k < self.axes() {
                self.axis(k, linear, at[k], size[k])
            } else {
                (vec![Some(0)], 0.0)
            }
        };
        let [(xs, wx), (ys, wy), (zs, wz)] = [axis(0), axis(1), axis(2)];
        let mut read = 0;
        let mut along_z = Vec::new();
        for z in &zs {
            let mut along_y = Vec::new();
            for y in &ys {
                let row = xs
                    .iter()
                    .map(|x| self.texel(mip, face, [*x, *y, *z]))
                    .collect::<Vec<_>>();
                read += row.iter().map(|t| t.1).sum::<u64>();
                along_y.push(mix_all(&row.iter().map(|t| t.0).collect::<Vec<_>>(), wx));
            }
            along_z.push(mix_all(&along_y, wy));
        }
        (mix_all(&along_z, wz), read)
    }

    /// §3 and §4: everything. `gradients` or the level itself.
    fn sample(&self, coord: [f32; 3], detail: Result<[[f32; 3]; 2], f32>) -> ([f32; 4], u64) {
        let (face, at) = if self.is_cube() {
            face_of(coord)
        } else {
            (0, coord)
        };
        let s = &self.sampler;
        let lod = match detail {
            Err(level) => limit(level + 0.0, s.lod[0], s.lod[1]),
            Ok(g) => {
                let squares = g.map(|d| {
                    let d = if self.is_cube() {
                        face_gradient(face, coord, d)
                    } else {
                        d
                    };
                    let texels: Vec<f32> = (0..self.axes())
                        .map(|k| d[k] * self.size(0)[k] as f32)
                        .collect();
                    texels[1..]
                        .iter()
                        .fold(texels[0] * texels[0], |sum, t| sum + t * t)
                });
                let lod = scalar::log2(larger(squares[0], squares[1])) * 0.5;
                limit(lod + s.lod_bias, s.lod[0], s.lod[1])
            }
        };
        let linear = if lod <= 0.0 { s.mag } else { s.min } == FilterMode::Linear;
        let last = (self.desc.mip_levels - 1) as f32;
        let canonical = |v: [f32; 4]| v.map(format::canonical_nan);
        if s.mip == FilterMode::Nearest {
            let (v, n) = self.level(
                limit((lod + 0.5).floor(), 0.0, last) as usize,
                linear,
                face,
                at,
            );
            return (canonical(v), n);
        }
        let level = limit(lod, 0.0, last);
        let fraction = level - level.floor();
        let (a, n) = self.level(level as usize, linear, face, at);
        if fraction == 0.0 {
            return (canonical(a), n);
        }
        let (b, m) = self.level(level as usize + 1, linear, face, at);
        (canonical(mix_all(&[a, b], fraction)), n + m)
    }
}

/// `a + t·(b − a)`, or the only value.
fn mix_all(v: &[[f32; 4]], t: f32) -> [f32; 4] {
    if v.len() == 1 {
        v[0]
    } else {
        core::array::from_fn(|c| v[0][c] + t * (v[1][c] - v[0][c]))
    }
}

/// The table of §4: a vector along s, t and outwards of a face.
fn on_face(face: usize, [x, y, z]: [f32; 3]) -> [f32; 3] {
    match face {
        0 => [-z, -y, x],
        1 => [z, -y, -x],
        2 => [x, z, y],
        3 => [x, -z, -y],
        4 => [x, -y, z],
        _ => [-x, -y, -z],
    }
}

fn face_of(d: [f32; 3]) -> (usize, [f32; 3]) {
    let [x, y, z] = d.map(f32::abs);
    let axis = if z >= x && z >= y {
        2
    } else if y >= x {
        1
    } else {
        0
    };
    let face = 2 * axis + usize::from(d[axis] < 0.0);
    let [s, t, m] = on_face(face, d);
    (face, [s / m * 0.5 + 0.5, t / m * 0.5 + 0.5, 0.0])
}

fn face_gradient(face: usize, d: [f32; 3], by: [f32; 3]) -> [f32; 3] {
    let ([s, t, m], [ds, dt, dm]) = (on_face(face, d), on_face(face, by));
    [
        (m * ds - s * dm) / (m * m) * 0.5,
        (m * dt - t * dm) / (m * m) * 0.5,
        0.0,
    ]
}

/// The neighbour's texel by geometry in f64: bend the point around the edge.
fn over_edge(face: usize, i: i32, j: i32, n: i32) -> (usize, i32, i32) {
    let outside = |v: i32| !(0..n).contains(&v);
    if outside(i) == outside(j) {
        return (face, i.clamp(0, n - 1), j.clamp(0, n - 1));
    }
    let centre = |v: i32| f64::from(2 * v + 1 - n) / f64::from(n);
    let bent = [i, j].map(|v| centre(v).clamp(-1.0, 1.0));
    let local = [bent[0], bent[1], 1.0 - 1.0 / f64::from(n)];
    // The directions of the face's axes are the rows of `on_face`, an orthogonal matrix.
    let unit = |k: usize| core::array::from_fn(|c| if c == k { 1.0 } else { 0.0 });
    let world: [f64; 3] = core::array::from_fn(|k| {
        let column = on_face(face, unit(k));
        (0..3).map(|c| local[c] * f64::from(column[c])).sum()
    });
    let (face, [s, t, _]) = face_of(world.map(|v| v as f32));
    let index = |v: f32| ((v * n as f32).floor() as i32).clamp(0, n - 1);
    (face, index(s), index(t))
}

/// SplitMix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) as u32
    }

    fn below(&mut self, n: u32) -> u32 {
        self.next() % n
    }

    fn unit(&mut self) -> f32 {
        self.below(1 << 24) as f32 / 16_777_216.0
    }

    fn pick<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.below(of.len() as u32) as usize]
    }

    /// Mostly near the image, sometimes absurd.
    fn coordinate(&mut self) -> f32 {
        match self.below(12) {
            0 => f32::from_bits(self.next()),
            1 => self.pick(&[
                f32::NAN,
                f32::INFINITY,
                f32::NEG_INFINITY,
                -0.0,
                1.0,
                -1e-10,
                f32::MAX,
                0.5,
            ]),
            2 => (self.unit() - 0.5) * 1e6,
            3 | 4 => self.below(9) as f32 * 0.25 - 0.5,
            _ => self.unit() * 3.0 - 1.0,
        }
    }

    fn filter(&mut self) -> FilterMode {
        self.pick(&[FilterMode::Nearest, FilterMode::Linear])
    }

    fn sampler(&mut self) -> Sampler {
        let modes = [
            AddressMode::ClampToEdge,
            AddressMode::ClampToBorder,
            AddressMode::Repeat,
            AddressMode::MirrorRepeat,
        ];
        Sampler {
            address: core::array::from_fn(|_| self.pick(&modes)),
            mag: self.filter(),
            min: self.filter(),
            mip: self.filter(),
            lod: self.pick(&[
                [0.0, 1000.0],
                [0.0, 1000.0],
                [-3.0, 1.5],
                [0.75, 0.25],
                [f32::NAN, f32::NAN],
            ]),
            lod_bias: self.pick(&[0.0, 0.0, 0.7, -1.5, f32::NAN]),
            border: [0.25, -2.0, self.unit(), 0.5],
        }
    }

    fn texture(&mut self) -> Texture {
        use TextureDimension::{Cube, D1, D2, D3};
        let format = self.pick(&Format::ALL);
        let dimension = self.pick(if format.is_depth_stencil() {
            &[D1, D2, Cube][..]
        } else {
            &[D1, D2, D3, Cube][..]
        });
        let mut size: [u32; 3] =
            core::array::from_fn(|_| self.pick(&[1, 2, 3, 4, 7, 8, 13, 16, 21]));
        match dimension {
            D1 => (size[1], size[2]) = (1, 1),
            D2 => size[2] = 1,
            Cube => size = [size[0], size[0], 1],
            D3 => {}
        }
        let most = 32 - size.into_iter().max().unwrap().leading_zeros();
        let mip_levels = 1 + self.below(most);
        let mut t = Texture::new(&TextureDescriptor {
            label: "r".into(),
            dimension,
            format,
            size,
            mip_levels,
        })
        .unwrap();
        for mip in 0..mip_levels {
            for layer in 0..t.planes[mip as usize].len() as u32 {
                self.fill(&mut t, Subresource { mip, layer });
            }
        }
        t
    }

    fn fill(&mut self, t: &mut Texture, s: Subresource) {
        let [w, h, _] = t.mip_size(s.mip);
        let n = (w * h) as usize;
        if t.desc.format.is_depth_stencil() {
            let depth: Vec<f32> = (0..n).map(|_| self.unit()).collect();
            let stencil: Vec<u8> = (0..n).map(|_| self.next() as u8).collect();
            t.write_depth_stencil(s, &depth, &stencil).unwrap();
        } else if self.below(4) == 0 {
            // Any bits, NaN and infinities among them.
            let mask = match t.desc.format.bytes() / t.desc.format.channels() as u64 {
                1 => 0xff,
                2 => 0xffff,
                _ => u32::MAX,
            };
            let channels = t.desc.format.channels();
            let mut texel =
                || core::array::from_fn(|c| if c < channels { self.next() & mask } else { 0 });
            let raw: Vec<[u32; 4]> = (0..n).map(|_| texel()).collect();
            t.write_raw(s, &raw).unwrap();
        } else {
            let texels: Vec<[f32; 4]> = (0..n)
                .map(|_| core::array::from_fn(|_| self.unit() * 4.0 - 1.0))
                .collect();
            t.write_color(s, &texels).unwrap();
        }
    }

    /// A coordinate a lane: scattered, or a smooth field as a surface gives.
    fn coordinates(&mut self) -> [[f32; LANES]; 3] {
        if self.below(2) == 0 {
            return core::array::from_fn(|_| core::array::from_fn(|_| self.coordinate()));
        }
        let scale = self.pick(&[0.01, 0.1, 0.5]);
        core::array::from_fn(|_| {
            let (base, gx, gy) = (
                self.unit() * 2.0 - 0.5,
                self.unit() * scale,
                self.unit() * scale,
            );
            core::array::from_fn(|i| base + gx * (i % 8) as f32 + gy * (i / 8) as f32)
        })
    }
}

/// Right minus left and lower minus upper of the quad that lane `i` is in.
fn quad(v: &[[f32; LANES]; 3], i: usize) -> [[f32; 3]; 2] {
    [
        v.map(|v| v[i | 1] - v[i & !1]),
        v.map(|v| v[i % 8 + 8] - v[i % 8]),
    ]
}

fn bits(v: [f32; 4]) -> [u32; 4] {
    v.map(f32::to_bits)
}

/// Values by lane, and the texels counted.
type Packet = ([[f32; 4]; LANES], u64);

fn by_lane(v: [[f32; LANES]; 4]) -> [[f32; 4]; LANES] {
    core::array::from_fn(|i| v.map(|c| c[i]))
}

/// The lanes' answer. `level`: the level of detail, or quads' derivatives.
fn lanes(
    simd: SimdLevel,
    bound: &BoundTexture<'_>,
    v: &[[f32; LANES]; 3],
    level: Option<f32>,
    counted: u16,
) -> Packet {
    with_lanes!(simd, l => {
        let coord = v.map(|v| F32::from_array(l, &v));
        let detail = match level {
            Some(lod) => Detail::Level(F32::splat(l, lod)),
            None => Detail::Quads,
        };
        let (value, texels) = look_up(l, bound, counted, &coord, &detail);
        (by_lane(value.map(F32::to_array)), texels)
    })
}

fn twin_packet(twin: &Twin, v: &[[f32; LANES]; 3], level: Option<f32>, counted: u16) -> Packet {
    let mut texels = 0;
    let values = core::array::from_fn(|i| {
        let detail = level.map_or_else(|| Ok(quad(v, i)), Err);
        let (value, read) = twin.sample(v.map(|v| v[i]), detail);
        texels += if counted >> i & 1 != 0 { read } else { 0 };
        value
    });
    (values, texels)
}

fn check(seed: u64) {
    let mut r = Random(seed);
    let texture = r.texture();
    let sampler = r.sampler();
    let bound = BoundTexture {
        texture: &texture,
        sampler,
    };
    let twin = Twin::new(&texture, sampler);
    for _ in 0..4 {
        let v = r.coordinates();
        let counted = r.next() as u16;
        let level = (r.below(3) == 0).then(|| r.pick(&[0.0, 1.0, 1.5, 0.25, -4.0, 99.0, f32::NAN]));
        let want = twin_packet(&twin, &v, level, counted);
        for simd in SimdLevel::available() {
            let got = lanes(simd, &bound, &v, level, counted);
            for i in 0..LANES {
                let at = v.map(|v| v[i]);
                assert_eq!(
                    bits(got.0[i]),
                    bits(want.0[i]),
                    "{seed} {simd} lane {i} {at:?} {level:?} {sampler:?} {:?}",
                    texture.desc
                );
            }
            assert_eq!(
                got.1, want.1,
                "{seed} {simd} {sampler:?} {:?}",
                texture.desc
            );
        }
    }
}

#[test]
fn lanes_sample_like_the_twin() {
    (0..3000).for_each(check);
}

#[test]
#[ignore = "a million cases: minutes in a release build"]
fn lanes_sample_like_the_twin_at_length() {
    use rayon::prelude::*;
    (3000..1_000_000u64).into_par_iter().for_each(check);
}

#[test]
fn fetches_find_every_texel_and_nothing_outside() {
    for seed in 0..300 {
        let mut r = Random(seed);
        let t = r.texture();
        let twin = Twin::new(&t, Sampler::default());
        let mip = r.below(t.desc.mip_levels + 1);
        let at: [[i32; LANES]; 3] = core::array::from_fn(|_| {
            core::array::from_fn(|_| r.pick(&[-1, 0, 1, 2, 5, 7, 20, i32::MIN, i32::MAX]))
        });
        for simd in SimdLevel::available() {
            let (got, inside) = with_lanes!(simd, l => {
                let (mut words, at) = (NO_WORDS, at.map(|a| I32::from_array(l, &a)));
                let inside = fetch_words(&t, Aspect::Main, at, mip, &mut words);
                let texels = decode_fetched(l, &t, &words, inside);
                (by_lane(texels.map(F32::to_array)), inside)
            });
            for i in 0..LANES {
                let want = fetched(&twin, at.map(|a| a[i]), mip);
                assert_eq!(bits(got[i]), bits(want.unwrap_or([0.0; 4])), "{seed}");
                assert_eq!(inside >> i & 1 != 0, want.is_some());
            }
        }
    }
}

fn fetched(twin: &Twin, [x, y, z]: [i32; 3], mip: u32) -> Option<[f32; 4]> {
    let level = twin.images.get(mip as usize)?;
    let size = twin.size(mip as usize);
    let (y, z) = match twin.desc.dimension {
        TextureDimension::D1 => (0, 0),
        TextureDimension::D2 => (y, 0),
        _ => (y, z),
    };
    let inside = (0..size[0]).contains(&x) && (0..size[1]).contains(&y);
    let texel = level.get(usize::try_from(z).ok()?).filter(|_| inside)?[(y * size[0] + x) as usize];
    Some(texel.map(format::canonical_nan))
}

/// A 2D texture of one channel from a function.
fn ramp(width: u32, height: u32, f: impl Fn(u32, u32) -> f32) -> Texture {
    let mut t = Texture::new(&TextureDescriptor::d2(
        "ramp",
        Format::R32Float,
        width,
        height,
    ))
    .unwrap();
    let texels: Vec<_> = (0..width * height)
        .map(|i| [f(i % width, i / width), 0.0, 0.0, 0.0])
        .collect();
    t.write_color(Subresource::default(), &texels).unwrap();
    t
}

#[test]
fn a_linear_ramp_is_reproduced_exactly() {
    let texture = ramp(16, 16, |x, y| x as f32 + 4.0 * y as f32);
    let bound = BoundTexture {
        texture: &texture,
        sampler: Sampler::bilinear(),
    };
    let u: [f32; LANES] = core::array::from_fn(|i| (0.5 + 0.875 * i as f32) / 16.0);
    let v: [f32; LANES] = core::array::from_fn(|i| (12.5 - 0.75 * i as f32) / 16.0);
    for simd in SimdLevel::available() {
        let (got, texels) = lanes(simd, &bound, &[u, v, [0.0; LANES]], Some(0.0), 0x00ff);
        assert_eq!(texels, 4 * 8);
        for i in 0..LANES {
            let want = 0.875 * i as f32 + 4.0 * (12.0 - 0.75 * i as f32);
            assert_eq!(got[i], [want, 0.0, 0.0, 1.0]);
        }
    }
}

#[test]
fn trilinear_at_whole_levels_is_bilinear_and_reads_as_much() {
    let mut r = Random(7);
    let mut texture = Texture::new(&TextureDescriptor {
        mip_levels: 5,
        ..TextureDescriptor::d2("mips", Format::Rgba8Unorm, 16, 16)
    })
    .unwrap();
    r.fill(&mut texture, Subresource::default());
    texture.generate_mipmaps().unwrap();
    let v = r.coordinates();
    for (lod, taps) in [(0.0, 4), (1.0, 4), (3.0, 4), (4.0, 4), (9.0, 4), (2.5, 8)] {
        let tri = BoundTexture {
            texture: &texture,
            sampler: Sampler::trilinear(),
        };
        let bi = BoundTexture {
            texture: &texture,
            sampler: Sampler::bilinear(),
        };
        for simd in SimdLevel::available() {
            let (a, texels) = lanes(simd, &tri, &v, Some(lod), u16::MAX);
            assert_eq!(texels, 16 * taps);
            if lod.fract() == 0.0 {
                let (b, _) = lanes(simd, &bi, &v, Some(lod), u16::MAX);
                assert_eq!(a.map(bits), b.map(bits));
            }
        }
    }
}

#[test]
fn the_level_follows_the_texels_per_pixel() {
    let mut texture = Texture::new(&TextureDescriptor {
        mip_levels: 7,
        ..TextureDescriptor::d2("levels", Format::R32Float, 64, 64)
    })
    .unwrap();
    for mip in 0..7 {
        let n = (64usize >> mip).pow(2);
        texture
            .write_color(Subresource { mip, layer: 0 }, &vec![[mip as f32; 4]; n])
            .unwrap();
    }
    let bound = BoundTexture {
        texture: &texture,
        sampler: Sampler::trilinear(),
    };
    for (texels_per_pixel, want) in [
        (0.5, 0.0),
        (1.0, 0.0),
        (2.0, 1.0),
        (4.0, 2.0),
        (64.0, 6.0),
        (1e6, 6.0),
    ] {
        let u = core::array::from_fn(|i| (i % 8) as f32 * texels_per_pixel / 64.0);
        let v = core::array::from_fn(|i| (i / 8) as f32 * texels_per_pixel / 128.0);
        let (got, _) = lanes(SimdLevel::detect(), &bound, &[u, v, [0.0; LANES]], None, 0);
        assert_eq!(got[3][0], want, "{texels_per_pixel}");
    }
}

#[test]
fn cube_faces_and_their_seams() {
    let mut texture = Texture::new(&TextureDescriptor {
        dimension: TextureDimension::Cube,
        ..TextureDescriptor::d2("cube", Format::R32Float, 4, 4)
    })
    .unwrap();
    for layer in 0..6 {
        texture
            .write_color(Subresource { mip: 0, layer }, &[[layer as f32; 4]; 16])
            .unwrap();
    }
    let nearest = BoundTexture {
        texture: &texture,
        sampler: Sampler::default(),
    };
    let linear = BoundTexture {
        texture: &texture,
        sampler: Sampler::bilinear(),
    };
    let axes: [[f32; 3]; 6] = [
        [2., 0., 0.],
        [-1., 0., 0.],
        [0., 3., 0.],
        [0., -1., 0.],
        [0., 0., 1.],
        [0., 0., -9.],
    ];
    for (face, d) in axes.into_iter().enumerate() {
        for bound in [&nearest, &linear] {
            let (got, _) = lanes(
                SimdLevel::detect(),
                bound,
                &d.map(|v| [v; LANES]),
                Some(0.0),
                0,
            );
            assert_eq!(got[0][0], face as f32);
        }
    }
    // On the edge of +x and +z both weigh the same, from either side.
    for d in [[1.0, 0.1, 0.999_999_9], [0.999_999_9, 0.1, 1.0]] {
        let (got, texels) = lanes(
            SimdLevel::detect(),
            &linear,
            &d.map(|v| [v; LANES]),
            Some(0.0),
            1,
        );
        assert!((got[0][0] - 2.0).abs() < 1e-5, "{got:?}");
        assert_eq!(texels, 4);
    }
}

#[test]
fn stencil_is_fetched_as_integers() {
    let mut t = Texture::new(&TextureDescriptor::d2("ds", Format::Depth24Stencil8, 4, 4)).unwrap();
    let stencil: Vec<u8> = (0..16).map(|i| 250 - i).collect();
    t.write_depth_stencil(Subresource::default(), &[0.5; 16], &stencil)
        .unwrap();
    let x = core::array::from_fn(|i| i as i32 % 8);
    let y = core::array::from_fn(|i| i as i32 / 8);
    let mut words = NO_WORDS;
    let inside = with_lanes!(SimdLevel::detect(), l => {
        let at = [I32::from_array(l, &x), I32::from_array(l, &y), I32::splat(l, 9)];
        fetch_words(&t, Aspect::Stencil, at, 0, &mut words)
    });
    assert_eq!(inside, 0x0f0f);
    assert_eq!(&words[0][..5], [250, 249, 248, 247, 0]);
    assert_eq!(&words[0][8..12], [246, 245, 244, 243]);
}
