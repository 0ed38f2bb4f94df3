//! Drawing a frame, whole or pass by pass, so that what each pass leaves can be looked at.

use gnomon_raster::{
    CommandList, Error, Gpu, GpuConfig, Recording, RenderPass, SubmitReport, Subresource, TextureId,
};
use xxhash_rust::xxh3::xxh3_128;

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

/// Hashes of what the attachments of a pass hold.
pub(crate) fn end_hashes(gpu: &Gpu, pass: &RenderPass) -> Result<Vec<u128>, Error> {
    let hash = |(texture, image): (TextureId, Subresource)| {
        Ok(xxh3_128(&gpu.texture(texture)?.read_packed(image)?))
    };
    attachments(pass).into_iter().map(hash).collect()
}

/// What `run` gives; what the GPU refuses, or a shader that panics, is an error of `frame`.
pub(crate) fn guarded<T>(
    frame: usize,
    run: impl FnOnce() -> Result<T, Error>,
) -> Result<T, TraceError> {
    guard::guarded(frame, run)?.map_err(|source| TraceError::Gpu { frame, source })
}
