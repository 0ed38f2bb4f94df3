//! Fill-rate microbenchmarks: the cases of the peers' `gl_fill_rate.py`, with
//! counting on, and every colour format, opaque and added, of one colour and shaded.
//! Prints million fragments and triangles per second.
//!
//! `fill_rate [--threads N] [--simd LEVEL] [--tile N] [--budget SECONDS] [--case NAME|formats]
//! [--mesh large|small] [--passes N] [--json FILE]`; N passes at least (default 7), of which
//! the first two are not timed where there are more.

#![allow(clippy::print_stdout, reason = "a benchmark prints")]

use std::fmt::Write as _;
use std::sync::Arc;
use std::time::{Duration, Instant};

use gnomon_raster::shader::{
    Fragment, FragmentShader, FragmentStage, Interpolation, Vertex, VertexShader,
};
use gnomon_raster::state::{
    ColorTargetState, CompareFunction, DepthState, DepthStencilState, PrimitiveState,
    StencilFaceState, StencilOperation, StencilState,
};
use gnomon_raster::{
    ColorAttachment, CommandList, DepthStencilAttachment, Draw, F32, Format, Gpu, GpuConfig,
    IndexBuffer, Lanes, LoadOp, RenderPass, RenderPipeline, StoreOp, Subresource,
    TextureDescriptor, TextureId, VertexBuffer,
};

const SIZE: u32 = 1024;

struct Layers {
    z0: f32,
    dz: f32,
    varyings: &'static [Interpolation],
}

impl VertexShader for Layers {
    fn varyings(&self) -> &[Interpolation] {
        self.varyings
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, v: &mut Vertex<'_, L>) {
        let (x, y) = (v.attribute(0), v.attribute(1));
        let z = F32::splat(l, self.z0 + self.dz * v.instance_index() as f32);
        v.set_varying(0, x * 0.25 + y * 0.125 + 0.5);
        v.set_position([x, y, z, F32::splat(l, 1.0)]);
    }
}

struct Constant([f32; 4]);

impl FragmentShader for Constant {
    fn constant(&self) -> Option<[f32; 4]> {
        Some(self.0)
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let [r, g, b, a] = self.0;
        f.set_color(
            0,
            [
                F32::splat(l, r),
                F32::splat(l, g),
                F32::splat(l, b),
                F32::splat(l, a),
            ],
        );
    }
}

struct Sixty([f32; 2]);

impl FragmentShader for Sixty {
    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let mut v = f.varying(0);
        for _ in 0..30 {
            v = v * self.0[0] + self.0[1];
        }
        f.set_color(0, [v, v, v, F32::splat(l, 1.0)]);
    }
}

/// A colour that differs from pixel to pixel and costs next to nothing.
struct Gradient;

impl FragmentShader for Gradient {
    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let v = f.varying(0) * (1.0 / 64.0);
        f.set_color(0, [v, v, v, F32::splat(l, 0.01)]);
    }
}

/// Vertices in NDC and indices of an n×n grid of squares of `pixels` each.
fn grid(n: u32, pixels: f64) -> (VertexBuffer, IndexBuffer) {
    let at = |i: u32| (f64::from(i) * pixels * 2.0 / f64::from(SIZE) - 1.0) as f32;
    let data = (0..=n)
        .flat_map(|r| (0..=n).flat_map(move |q| [at(q), at(r)]))
        .collect();
    let mut indices = Vec::new();
    for r in 0..n {
        for q in 0..n {
            let i = r * (n + 1) + q;
            indices.extend([i, i + 1, i + n + 2, i, i + n + 2, i + n + 1]);
        }
    }
    (VertexBuffer { data, stride: 2 }, IndexBuffer::new(indices))
}

#[derive(Clone)]
struct Case {
    name: String,
    format: Format,
    clear_depth: f32,
    z0: f32,
    dz: f32,
    ds: DepthStencilState,
    target: ColorTargetState,
    fragment: Option<FragmentStage>,
    varyings: &'static [Interpolation],
}

fn depth(compare: CompareFunction, write: bool) -> DepthStencilState {
    DepthStencilState {
        depth: DepthState {
            compare,
            write,
            bounds: None,
        },
        ..DepthStencilState::default()
    }
}

fn stencil(face: StencilFaceState) -> DepthStencilState {
    DepthStencilState {
        stencil: StencilState {
            front: face,
            back: face,
        },
        ..depth(CompareFunction::Less, false)
    }
}

fn cases() -> Vec<Case> {
    let inc = StencilOperation::IncrementWrap;
    let zfail = StencilFaceState {
        depth_fail_op: inc,
        ..StencilFaceState::IGNORE
    };
    let zpass = StencilFaceState {
        pass_op: inc,
        ..StencilFaceState::IGNORE
    };
    let none = ColorTargetState::NONE;
    let add = ColorTargetState::ADDITIVE;
    let opaque = ColorTargetState::OPAQUE;
    let constant = || Some(Constant([0.01, 0.02, 0.03, 0.01]).into());
    let sixty = || Some(Sixty([0.97, 0.011]).into());
    let linear: &[Interpolation] = &[Interpolation::Perspective];
    let case = |name, clear_depth, z0, dz, ds, target, fragment, varyings| Case {
        name: str::to_owned(name),
        format: Format::Rgba8Unorm,
        clear_depth,
        z0,
        dz,
        ds,
        target,
        fragment,
        varyings,
    };
    use CompareFunction::{Less, LessEqual};
    vec![
        case(
            "depth_pass",
            1.0,
            0.5,
            -1.0 / 64.0,
            depth(Less, true),
            none,
            None,
            &[],
        ),
        case(
            "depth_fail",
            0.25,
            0.5,
            0.0,
            depth(Less, true),
            none,
            None,
            &[],
        ),
        case(
            "stencil_zfail",
            0.25,
            0.5,
            0.0,
            stencil(zfail),
            none,
            None,
            &[],
        ),
        case(
            "stencil_zpass",
            1.0,
            0.5,
            0.0,
            stencil(zpass),
            none,
            None,
            &[],
        ),
        case(
            "add_rgba8",
            1.0,
            0.5,
            0.0,
            DepthStencilState::default(),
            add,
            constant(),
            &[],
        ),
        case(
            "colour",
            1.0,
            0.5,
            0.0,
            depth(LessEqual, false),
            opaque,
            constant(),
            &[],
        ),
        case(
            "shader60",
            1.0,
            0.5,
            0.0,
            depth(LessEqual, false),
            opaque,
            sixty(),
            linear,
        ),
        case(
            "shader60_add",
            1.0,
            0.5,
            0.0,
            DepthStencilState::default(),
            add,
            sixty(),
            linear,
        ),
    ]
}

/// Every colour format: opaque and, where it can be, added; one colour, and shaded.
fn format_cases() -> Vec<Case> {
    let plain = Case {
        name: String::new(),
        format: Format::Rgba8Unorm,
        clear_depth: 1.0,
        z0: 0.5,
        dz: 0.0,
        ds: DepthStencilState::default(),
        target: ColorTargetState::OPAQUE,
        fragment: None,
        varyings: &[],
    };
    let mut cases = Vec::new();
    for format in Format::ALL {
        if format.is_depth_stencil() {
            continue;
        }
        let name = format!("{format:?}").to_lowercase();
        let name = name.trim_end_matches("unorm");
        for (blend, target) in [
            ("opaque", ColorTargetState::OPAQUE),
            ("add", ColorTargetState::ADDITIVE),
        ] {
            if target.blend.is_some() && !format.is_blendable() {
                continue;
            }
            cases.push(Case {
                name: format!("{name}_{blend}"),
                format,
                target,
                fragment: Some(Constant([0.01, 0.02, 0.03, 0.01]).into()),
                ..plain.clone()
            });
            cases.push(Case {
                name: format!("{name}_shaded_{blend}"),
                format,
                target,
                fragment: Some(Gradient.into()),
                varyings: &[Interpolation::Linear],
                ..plain.clone()
            });
        }
    }
    cases
}

struct Bench {
    gpu: Gpu,
    /// An image of each colour format.
    colors: Vec<(Format, TextureId)>,
    depth: TextureId,
    budget: Duration,
    /// Passes at least.
    passes: usize,
}

impl Bench {
    fn color(&self, format: Format) -> TextureId {
        let mut of = self.colors.iter().filter(|c| c.0 == format);
        of.next().expect("every colour format").1
    }

    fn pass(&self, format: Format, load: Option<f32>, draws: Vec<Draw>) -> CommandList {
        let color = match load {
            Some(_) => LoadOp::Clear([0.0; 4]),
            None => LoadOp::Load,
        };
        let attachment = ColorAttachment {
            texture: self.color(format),
            subresource: Subresource::default(),
            load: color,
            store: StoreOp::Store,
        };
        let depth_stencil = DepthStencilAttachment {
            texture: self.depth,
            subresource: Subresource::default(),
            depth_load: load.map_or(LoadOp::Load, LoadOp::Clear),
            depth_store: StoreOp::Store,
            stencil_load: load.map_or(LoadOp::Load, |_| LoadOp::Clear(0)),
            stencil_store: StoreOp::Store,
        };
        let pass = RenderPass {
            label: "fill".into(),
            color: vec![attachment],
            depth_stencil: Some(depth_stencil),
            draws,
        };
        CommandList { passes: vec![pass] }
    }

    /// Median seconds of a pass, and fragments and triangles of one.
    fn measure(
        &mut self,
        case: &Case,
        mesh: &(Arc<VertexBuffer>, Arc<IndexBuffer>),
        layers: u32,
    ) -> (f64, u64, u64) {
        let pipeline = Arc::new(RenderPipeline {
            label: case.name.clone(),
            vertex: Layers {
                z0: case.z0,
                dz: case.dz,
                varyings: case.varyings,
            }
            .into(),
            fragment: case.fragment.clone(),
            primitive: PrimitiveState::default(),
            depth_stencil: case.ds,
            color_targets: vec![case.target],
        });
        let mut draw = Draw::indexed(&case.name, &pipeline, &mesh.0, &mesh.1);
        draw.instances = layers;
        let clear = self.pass(case.format, Some(case.clear_depth), vec![]);
        let fill = self.pass(case.format, None, vec![draw]);
        let mut times = Vec::new();
        let end = Instant::now() + self.budget;
        let mut counted = (0, 0);
        while times.len() < self.passes || (Instant::now() < end && times.len() < 100) {
            self.gpu.submit(&clear).expect("valid");
            let start = Instant::now();
            let report = self.gpu.submit(&fill).expect("valid");
            times.push(start.elapsed().as_secs_f64());
            let t = report.passes[0].totals();
            counted = (t.fragments.generated, t.primitives.rasterized);
        }
        times.drain(..2.min(times.len() - 1));
        times.sort_by(f64::total_cmp);
        (times[times.len() / 2], counted.0, counted.1)
    }
}

fn main() {
    let mut config = GpuConfig::default();
    let mut budget = 0.5;
    let mut passes = 7;
    let (mut only, mut only_mesh) = (String::new(), String::new());
    let mut json = None;
    let args: Vec<String> = std::env::args().skip(1).collect();
    for pair in args.chunks(2) {
        let [key, value] = pair else {
            panic!("{} needs a value", pair[0])
        };
        match key.as_str() {
            "--threads" => config.threads = value.parse().expect("a number"),
            "--tile" => config.tile = value.parse().expect("a number"),
            "--simd" => config.simd = value.parse().expect("a level"),
            "--budget" => budget = value.parse().expect("seconds"),
            "--passes" => passes = value.parse().expect("a number from 1"),
            "--case" => only.clone_from(value),
            "--mesh" => only_mesh.clone_from(value),
            "--json" => json = Some(value.clone()),
            _ => panic!("unknown option {key}"),
        }
    }
    let mut gpu = Gpu::new(config).expect("valid");
    let mut colors = Vec::new();
    for format in Format::ALL {
        if !format.is_depth_stencil() {
            let image = TextureDescriptor::d2("colour", format, SIZE, SIZE);
            colors.push((format, gpu.create_texture(&image).expect("valid")));
        }
    }
    let depth = TextureDescriptor::d2("depth", Format::Depth24Stencil8, SIZE, SIZE);
    let depth = gpu.create_texture(&depth).expect("valid");
    println!(
        "gnomon | simd {} | threads {} | tile {}",
        config.simd,
        gpu.threads(),
        config.tile
    );
    let mut bench = Bench {
        gpu,
        colors,
        depth,
        budget: Duration::from_secs_f64(budget),
        passes: passes.max(1),
    };
    let meshes = [
        ("large", grid(1, f64::from(SIZE)), 16),
        ("small", grid(224, 4.5), 4),
    ];
    let meshes = meshes.map(|(n, (v, i), layers)| (n, (Arc::new(v), Arc::new(i)), layers));
    let mut rows = String::new();
    let chosen: Vec<Case> = match only.as_str() {
        "" => [cases(), format_cases()].concat(),
        "formats" => format_cases(),
        name => {
            let all = [cases(), format_cases()].concat();
            all.into_iter().filter(|c| c.name == name).collect()
        }
    };
    for case in &chosen {
        for (name, mesh, layers) in meshes
            .iter()
            .filter(|m| only_mesh.is_empty() || only_mesh == m.0)
        {
            let (seconds, fragments, triangles) = bench.measure(case, mesh, *layers);
            let (mf, mt) = (
                fragments as f64 / seconds / 1e6,
                triangles as f64 / seconds / 1e6,
            );
            println!(
                "{:<24} {name:<5} {mf:9.1} Mfragment/s  {mt:8.3} Mtriangle/s  {:8.3} ms",
                case.name,
                seconds * 1e3
            );
            let sep = if rows.is_empty() { "" } else { ",\n" };
            write!(
                rows,
                r#"{sep}{{"case":"{}","mesh":"{name}","ms":{},"fragments":{fragments},"triangles":{triangles},"mfrag_s":{mf},"mtri_s":{mt}}}"#,
                case.name,
                seconds * 1e3
            )
            .expect("a string takes everything");
        }
    }
    if let Some(path) = json {
        std::fs::write(&path, format!("[{rows}]\n")).expect("writable");
    }
}
