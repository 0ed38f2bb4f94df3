//! Which passes of a frame draw onto the frame's own pixels.
//!
//! Blocks of other passes, such as light views, filters of them and tables with a
//! texel for each tile, are no places of the picture, whatever their size. What tells
//! them apart is what they are attached to and read, beginning with the frame's
//! outputs; neither labels nor sizes alone would.

use gnomon_raster::{Gpu, RenderPass, Subresource, TextureId};

use crate::measure::render::RenderError;
use crate::technique::Frame;

/// For each pass whether its pixels are those of the frame.
pub(super) fn screen_passes(gpu: &Gpu, frame: &Frame) -> Result<Vec<bool>, RenderError> {
    let passes = &frame.recording.list.passes;
    let mut screen = Screen::of(gpu, frame)?;
    let mut on_screen = vec![false; passes.len()];
    // A buffer may be known only by what a later pass does with it.
    loop {
        let known = screen.images.len();
        for (found, pass) in on_screen.iter_mut().zip(passes) {
            *found = *found || screen.is_drawn_on_by(pass)?;
            if *found {
                screen.add(pass);
            }
        }
        if screen.images.len() == known {
            return Ok(on_screen);
        }
    }
}

/// Images with a pixel for each of the frame's.
struct Screen<'a> {
    gpu: &'a Gpu,
    size: [u32; 2],
    images: Vec<Image>,
}

type Image = (TextureId, Subresource);

impl<'a> Screen<'a> {
    fn of(gpu: &'a Gpu, frame: &Frame) -> Result<Self, RenderError> {
        let outputs = &frame.outputs;
        let mut textures = vec![outputs.color, outputs.depth_stencil];
        textures.extend(outputs.visibility.texture());
        let whole = |texture| (texture, Subresource::default());
        Ok(Self {
            gpu,
            size: size_of(gpu, whole(outputs.color))?,
            images: textures.into_iter().map(whole).collect(),
        })
    }

    /// Whether a pass is attached to one of the images, or computes an image of the
    /// frame's size from them.
    fn is_drawn_on_by(&self, pass: &RenderPass) -> Result<bool, RenderError> {
        if attached(pass).any(|image| self.images.contains(&image)) {
            return Ok(true);
        }
        let mut read = pass.draws.iter().flat_map(|d| &d.textures);
        if !read.any(|binding| self.holds(binding.texture)) {
            return Ok(false);
        }
        for image in attached(pass) {
            if size_of(self.gpu, image)? != self.size {
                return Ok(false);
            }
        }
        Ok(true)
    }

    fn holds(&self, texture: TextureId) -> bool {
        self.images.iter().any(|(held, _)| *held == texture)
    }

    fn add(&mut self, pass: &RenderPass) {
        for image in attached(pass) {
            if !self.images.contains(&image) {
                self.images.push(image);
            }
        }
    }
}

/// What a pass draws into.
fn attached(pass: &RenderPass) -> impl Iterator<Item = Image> {
    let color = pass.color.iter().map(|a| (a.texture, a.subresource));
    let depth = pass.depth_stencil.iter();
    color.chain(depth.map(|a| (a.texture, a.subresource)))
}

/// Width and height in pixels.
fn size_of(gpu: &Gpu, (texture, image): Image) -> Result<[u32; 2], RenderError> {
    let [width, height, _] = gpu.texture(texture)?.descriptor().size;
    Ok([width, height].map(|side| (side >> image.mip).max(1)))
}
