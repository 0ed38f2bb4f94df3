//! A frame drawn a step at a time, so that what any draw left can be looked at.

use gnomon_raster::{CommandList, Error, Gpu, GpuConfig, LoadOp, Recording, RenderPass, StoreOp};

/// How far a frame is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Until {
    /// To its end.
    End,
    /// Through all draws of a pass; what it forgets at its end is still there.
    Pass(usize),
    /// Through a draw, pass and draw.
    Draw([usize; 2]),
}

/// A GPU that has drawn `recording` so far.
///
/// # Errors
/// What the GPU refuses.
///
/// # Panics
/// Where there is no such pass or draw.
pub fn draw_until(recording: &Recording, until: Until, config: GpuConfig) -> Result<Gpu, Error> {
    let mut walk = Walk::start(recording, config)?;
    match until {
        Until::End => walk.finish()?,
        Until::Pass(pass) => walk.reach_end(pass)?,
        Until::Draw(at) => walk.reach(at).map(|_| ())?,
    }
    Ok(walk.gpu)
}

/// A frame that is drawn as far as it was asked for.
pub(crate) struct Walk<'a> {
    pub(crate) gpu: Gpu,
    frame: &'a Recording,
    /// The pass and the draw that come next.
    next: [usize; 2],
}

impl<'a> Walk<'a> {
    pub(crate) fn start(frame: &'a Recording, config: GpuConfig) -> Result<Self, Error> {
        let mut gpu = Gpu::new(config)?;
        gpu.load(frame)?;
        let next = [0, 0];
        Ok(Self { gpu, frame, next })
    }

    /// Draws on, draw `[pass, draw]` included; draws that are done stay done. What a pass
    /// forgets at its end it forgets when the walk leaves it.
    ///
    /// # Panics
    /// Where there is no such draw.
    pub(crate) fn reach(&mut self, [pass, draw]: [usize; 2]) -> Result<&'a RenderPass, Error> {
        self.finish_passes(pass)?;
        let pass = &self.frame.list.passes[pass];
        self.draw_on(pass, draw + 1)?;
        Ok(pass)
    }

    /// Draws on, all draws of a pass included.
    fn reach_end(&mut self, pass: usize) -> Result<(), Error> {
        self.finish_passes(pass)?;
        let pass = &self.frame.list.passes[pass];
        match pass.draws.len() {
            0 => self.submit(part(pass, 0, 0, false)),
            end => self.draw_on(pass, end),
        }
    }

    fn finish(&mut self) -> Result<(), Error> {
        self.finish_passes(self.frame.list.passes.len())
    }

    /// All passes before number `end`.
    pub(crate) fn finish_passes(&mut self, end: usize) -> Result<(), Error> {
        let passes = &self.frame.list.passes;
        while self.next[0] < end {
            self.finish_pass(&passes[self.next[0]])?;
        }
        Ok(())
    }

    fn finish_pass(&mut self, pass: &RenderPass) -> Result<(), Error> {
        let first = self.next[1];
        self.submit(part(pass, first, pass.draws.len(), true))?;
        self.next = [self.next[0] + 1, 0];
        Ok(())
    }

    fn draw_on(&mut self, pass: &RenderPass, end: usize) -> Result<(), Error> {
        let first = self.next[1];
        if first < end {
            self.submit(part(pass, first, end, false))?;
            self.next[1] = end;
        }
        Ok(())
    }

    fn submit(&mut self, pass: RenderPass) -> Result<(), Error> {
        let passes = vec![pass];
        self.gpu.submit(&CommandList { passes }).map(|_| ())
    }
}

/// Draws `first..end` of a pass: behind its first it loads what is there, and only the
/// `last` part forgets what the pass does.
pub(crate) fn part(pass: &RenderPass, first: usize, end: usize, last: bool) -> RenderPass {
    let mut part = pass.clone();
    part.draws.truncate(end);
    part.draws.drain(..first);
    for attachment in &mut part.color {
        continues(&mut attachment.load, first);
        stays(&mut attachment.store, last);
    }
    if let Some(attachment) = &mut part.depth_stencil {
        continues(&mut attachment.depth_load, first);
        continues(&mut attachment.stencil_load, first);
        stays(&mut attachment.depth_store, last);
        stays(&mut attachment.stencil_store, last);
    }
    part
}

fn continues<T>(load: &mut LoadOp<T>, first: usize) {
    if first > 0 {
        *load = LoadOp::Load;
    }
}

fn stays(store: &mut StoreOp, last: bool) {
    if !last {
        *store = StoreOp::Store;
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use gnomon_raster::shader::{
        ScalarFragmentOutput, ScalarVertexOutput, per_fragment, per_vertex,
    };
    use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
    use gnomon_raster::{
        ColorAttachment, Draw, Format, RenderPipeline, Subresource, TextureDescriptor, TextureId,
    };

    use super::*;

    /// Adds `value` everywhere.
    fn adds(value: f32) -> Draw {
        let pipeline = RenderPipeline {
            label: "adds".into(),
            vertex: per_vertex(&[], |v| {
                let [x, y] = [[-1.0, 3.0], [-1.0, -1.0], [3.0, -1.0]][v.vertex_index as usize];
                ScalarVertexOutput {
                    position: [x, y, 0.5, 1.0],
                    ..Default::default()
                }
            }),
            fragment: Some(per_fragment(Default::default(), move |_| {
                ScalarFragmentOutput::color([value, 0.0, 0.0, 0.0])
            })),
            primitive: PrimitiveState::default(),
            depth_stencil: DepthStencilState::default(),
            color_targets: vec![ColorTargetState::ADDITIVE],
        };
        Draw::vertices_only("adds", &Arc::new(pipeline), 3)
    }

    /// Two passes on one image: 1, 2 and 4 over a clear of 100; then 8 and 16 over that.
    fn recording() -> (Recording, TextureId) {
        let mut r = Recording::default();
        let image = TextureDescriptor::d2("sum", Format::R32Float, 4, 4);
        let texture = r.create(&image).unwrap();
        let pass = |label: &str, load, values: &[f32]| RenderPass {
            label: label.into(),
            color: vec![ColorAttachment {
                texture,
                subresource: Subresource::default(),
                load,
                store: StoreOp::Store,
            }],
            depth_stencil: None,
            draws: values.iter().map(|v| adds(*v)).collect(),
        };
        let clear = LoadOp::Clear([100.0, 0.0, 0.0, 0.0]);
        r.list.passes = vec![
            pass("first", clear, &[1.0, 2.0, 4.0]),
            pass("second", LoadOp::Load, &[8.0, 16.0]),
        ];
        (r, texture)
    }

    fn sum(gpu: &Gpu, texture: TextureId) -> f32 {
        let texels = gpu.texture(texture).unwrap();
        let texels = texels.read_color(Subresource::default()).unwrap();
        assert!(texels.iter().all(|t| t.0[0] == texels[0].0[0]));
        texels[0].0[0]
    }

    /// One walk from draw to draw: each is drawn once, on what was there.
    #[test]
    fn each_draw_is_drawn_once_on_what_was_there() {
        let (recording, texture) = recording();
        let mut walk = Walk::start(&recording, GpuConfig::default()).unwrap();
        let places = [[0, 0], [0, 1], [0, 2], [1, 0], [1, 1]];
        let sums = places.map(|at| {
            walk.reach(at).unwrap();
            sum(&walk.gpu, texture)
        });
        assert_eq!(sums, [101.0, 103.0, 107.0, 115.0, 131.0]);
        for (at, wanted) in places.into_iter().zip(sums) {
            let gpu = draw_until(&recording, Until::Draw(at), GpuConfig::default()).unwrap();
            assert_eq!(sum(&gpu, texture), wanted, "{at:?}");
        }
        for (until, wanted) in [
            (Until::Pass(0), 107.0),
            (Until::Pass(1), 131.0),
            (Until::End, 131.0),
        ] {
            let gpu = draw_until(&recording, until, GpuConfig::default()).unwrap();
            assert_eq!(sum(&gpu, texture), wanted, "{until:?}");
        }
        let mut walk = Walk::start(&recording, GpuConfig::default()).unwrap();
        walk.reach([0, 1]).unwrap();
        walk.finish().unwrap();
        assert_eq!(sum(&walk.gpu, texture), 131.0);
    }
}
