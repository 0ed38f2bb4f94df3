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
