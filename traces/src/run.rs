//! Drawing a frame, whole or pass by pass, so that what each pass leaves can be looked at.

use gnomon_raster::{
    CommandList, Error, Gpu, GpuConfig, LoadOp, Recording, RenderPass, RenderPipeline, StoreOp,
    SubmitReport, Subresource, TextureId,
};
use xxhash_rust::xxh3::Xxh3Default;

use crate::error::TraceError;
use crate::guard;

/// A new GPU with the textures of `recording`, after `list`.
pub(crate) fn draw(
    recording: &Recording,
    list: &CommandList,
    config: GpuConfig,
) -> Result<(Gpu, SubmitReport), Error> {
    let mut gpu = Gpu::new(config)?;
    gpu.load(recording)?;
    let report = gpu.submit(list)?;
    Ok((gpu, report))
}

/// Loads `recording` and draws its passes; `after` is called behind each.
pub(crate) fn draw_passes(
    gpu: &mut Gpu,
    recording: &Recording,
    mut after: impl FnMut(&Gpu, usize, &RenderPass) -> Result<(), Error>,
) -> Result<SubmitReport, Error> {
    gpu.load(recording)?;
    let mut report = SubmitReport::default();
    for (number, pass) in recording.list.passes.iter().enumerate() {
        let list = CommandList {
            passes: vec![pass.clone()],
        };
        report.passes.extend(gpu.submit(&list)?.passes);
        after(gpu, number, pass)?;
    }
    Ok(report)
}

/// The images of a pass's attachments: colours, then depth and stencil.
pub(crate) fn attachments(pass: &RenderPass) -> Vec<(TextureId, Subresource)> {
    let color = pass.color.iter().map(|a| (a.texture, a.subresource));
    let depth = pass.depth_stencil.iter();
    color
        .chain(depth.map(|a| (a.texture, a.subresource)))
        .collect()
}

/// Hashes of what attachments hold when passes end.
#[derive(Default)]
pub(crate) struct EndHashes {
    /// The last of each image.
    known: Vec<((TextureId, Subresource), u128)>,
}

impl EndHashes {
    /// Those of `pass`, which has just been drawn. What it cannot have written to has the
    /// hash that it had.
    pub(crate) fn of(&mut self, gpu: &Gpu, pass: &RenderPass) -> Result<Vec<u128>, Error> {
        let mut hashes = Vec::new();
        for (number, image) in attachments(pass).into_iter().enumerate() {
            let known = self.known.iter().position(|(k, _)| *k == image);
            let hash = match known {
                Some(at) if !may_write(pass, number) => self.known[at].1,
                _ => hash(gpu, image)?,
            };
            hashes.push(hash);
            match known {
                Some(at) => self.known[at].1 = hash,
                None => self.known.push((image, hash)),
            }
        }
        Ok(hashes)
    }
}

fn hash(gpu: &Gpu, (texture, image): (TextureId, Subresource)) -> Result<u128, Error> {
    let mut hasher = Xxh3Default::new();
    let rows = gpu.texture(texture)?;
    rows.visit_packed(image, |row| hasher.update(row))?;
    Ok(hasher.digest128())
}

/// Whether the commands of a pass are such that attachment number `attachment` can be
/// another afterwards.
fn may_write(pass: &RenderPass, attachment: usize) -> bool {
    let draws = || pass.draws.iter().map(|d| &d.pipeline);
    if let Some(a) = pass.color.get(attachment) {
        let masks = |p: &RenderPipeline| p.color_targets.get(attachment).map(|t| t.write_mask);
        return a.load != LoadOp::Load
            || a.store != StoreOp::Store
            || draws().any(|p| p.fragment.is_some() && masks(p).is_none_or(|m| m.0 != 0));
    }
    let writes = |p: &RenderPipeline| {
        let s = &p.depth_stencil;
        s.depth.write || s.stencil.front.writes() || s.stencil.back.writes()
    };
    pass.depth_stencil.as_ref().is_none_or(|a| {
        (a.depth_load, a.stencil_load) != (LoadOp::Load, LoadOp::Load)
            || (a.depth_store, a.stencil_store) != (StoreOp::Store, StoreOp::Store)
            || draws().any(|p| writes(p))
    })
}

/// What `run` gives; what the GPU refuses, or a shader that panics, is an error of `frame`.
pub(crate) fn guarded<T>(
    frame: usize,
    run: impl FnOnce() -> Result<T, Error>,
) -> Result<T, TraceError> {
    guard::guarded(frame, run)?.map_err(|source| TraceError::Gpu { frame, source })
}
