//! The bits of a NaN that arithmetic makes differ from machine to machine; what is
//! stored does not. Integers are stored to the bit, those that look like a NaN too.

use std::sync::Arc;

use gnomon_raster::shader::{
    Fragment, FragmentOutputs, FragmentShader, FragmentStage, ScalarFragmentOutput,
    ScalarVertexOutput, per_fragment, per_vertex,
};
use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
use gnomon_raster::{
    ColorAttachment, CommandList, Draw, F32, Format, Gpu, GpuConfig, Lanes, LoadOp, RenderPass,
    RenderPipeline, SimdLevel, StoreOp, Subresource, TextureDescriptor, U32,
};

const CANONICAL: u32 = 0x7fc0_0000;
/// A NaN as x86 makes it, with a payload besides.
const FOREIGN: u32 = 0xffc0_1234;

/// What a fragment shader stores, computed from a uniform.
#[derive(Clone, Copy, Debug)]
enum Store {
    /// The uniform less itself, as a colour.
    Color,
    /// The bits of the same, as an integer.
    Bits,
    /// The uniform as a colour.
    Uniform,
    /// The uniform's bits as an integer.
    Integer,
}

struct Lane(Store, f32);

impl FragmentShader for Lane {
    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let v = F32::splat(l, self.1);
        match self.0 {
            Store::Color => f.set_color(0, [v + -v; 4]),
            Store::Bits => f.set_color_uint(0, (v + -v).to_bits()),
            Store::Uniform => f.set_color(0, [v; 4]),
            Store::Integer => f.set_color_uint(0, U32::splat(l, self.1.to_bits())),
        }
    }
}

/// One colour, which need not be computed.
struct Constant(f32);

impl FragmentShader for Constant {
    fn constant(&self) -> Option<[f32; 4]> {
        Some([self.0; 4])
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        f.set_color(0, [F32::splat(l, self.0); 4]);
    }
}

fn closure(store: Store, v: f32) -> FragmentStage {
    per_fragment(FragmentOutputs::default(), move |_| match store {
        Store::Color | Store::Bits => ScalarFragmentOutput::color([v + -v; 4]),
        Store::Uniform => ScalarFragmentOutput::color([v; 4]),
        Store::Integer => {
            let mut out = ScalarFragmentOutput::default();
            out.set_uint(0, v.to_bits());
            out
        }
    })
}

/// The texel that `fragment` leaves in an image of 1×1, and how many NaN were counted.
fn stored(simd: SimdLevel, format: Format, fragment: FragmentStage) -> (u32, u64) {
    let config = GpuConfig {
        threads: 1,
        simd,
        ..GpuConfig::default()
    };
    let mut gpu = Gpu::new(config).unwrap();
    let image = TextureDescriptor::d2("image", format, 1, 1);
    let image = gpu.create_texture(&image).unwrap();
    let pipeline = Arc::new(RenderPipeline {
        label: "nan".into(),
        vertex: per_vertex(&[], |v| {
            let [x, y] = [[-1.0, 3.0], [-1.0, -1.0], [3.0, -1.0]][v.vertex_index as usize];
            ScalarVertexOutput {
                position: [x, y, 0.5, 1.0],
                ..Default::default()
            }
        }),
        fragment: Some(fragment),
        primitive: PrimitiveState::default(),
        depth_stencil: DepthStencilState::default(),
        color_targets: vec![ColorTargetState::OPAQUE],
    });
    let pass = RenderPass {
        label: "nan".into(),
        color: vec![ColorAttachment {
            texture: image,
            subresource: Subresource::default(),
            load: LoadOp::Clear([0.0; 4]),
            store: StoreOp::Store,
        }],
        depth_stencil: None,
        draws: vec![Draw::vertices_only("nan", &pipeline, 3)],
    };
    let report = gpu.submit(&CommandList { passes: vec![pass] }).unwrap();
    let texels = gpu.texture(image).unwrap();
    let texels = texels.read_raw(Subresource::default()).unwrap();
    let counted = report.passes[0].totals().events.nan_canonicalised;
    (texels[0][0], counted)
}

#[test]
fn no_format_shows_how_a_nan_came_about() {
    let infinity = std::hint::black_box(f32::INFINITY);
    for simd in SimdLevel::available() {
        for (format, expected) in [
            (Format::R32Uint, CANONICAL),
            (Format::R32Float, CANONICAL),
            (Format::R16Float, 0x7e00),
            (Format::R16Sint, 0),
            (Format::R8Unorm, 0),
        ] {
            let lane = Lane(Store::Color, infinity).into();
            assert_eq!(stored(simd, format, lane).0, expected, "{simd} {format:?}");
            let scalar = closure(Store::Color, infinity);
            assert_eq!(
                stored(simd, format, scalar).0,
                expected,
                "{simd} {format:?}"
            );
        }
    }
}

#[test]
fn bits_taken_from_lanes_are_canonical() {
    let infinity = std::hint::black_box(f32::INFINITY);
    for simd in SimdLevel::available() {
        let bits = Lane(Store::Bits, infinity).into();
        // Nothing is left to be replaced.
        assert_eq!(
            stored(simd, Format::R32Uint, bits),
            (CANONICAL, 0),
            "{simd}"
        );
        // Bits of other floats are what they are.
        let zero = Lane(Store::Bits, -1.5).into();
        assert_eq!(stored(simd, Format::R32Uint, zero), (0, 0), "{simd}");
    }
}

#[test]
fn a_colour_that_is_nan_is_counted_and_an_integer_is_not_touched() {
    let foreign = f32::from_bits(FOREIGN);
    for simd in SimdLevel::available() {
        let of = |stage| stored(simd, Format::R32Uint, stage);
        for (color, integer) in [
            (
                FragmentStage::from(Lane(Store::Uniform, foreign)),
                FragmentStage::from(Lane(Store::Integer, foreign)),
            ),
            (
                closure(Store::Uniform, foreign),
                closure(Store::Integer, foreign),
            ),
        ] {
            assert_eq!(of(color), (CANONICAL, 1), "{simd}");
            assert_eq!(of(integer), (FOREIGN, 0), "{simd}");
        }
        assert_eq!(of(Constant(foreign).into()), (CANONICAL, 1), "{simd}");
        assert_eq!(
            of(Lane(Store::Uniform, -2.5).into()),
            ((-2.5f32).to_bits(), 0)
        );
    }
}
