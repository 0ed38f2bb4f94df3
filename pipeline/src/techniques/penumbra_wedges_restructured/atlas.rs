//! Where the classes of each wedge's tiles are kept, and the passes that find them.

use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState, ScissorRect};
use gnomon_raster::{
    Draw, Format, LoadOp, MAX_TEXTURE_SIZE, Recording, RenderPass, RenderPipeline,
    TextureDescriptor, TextureId,
};
use gnomon_shaders::penumbra::tiles::{TileClasses, TileLookUp, TileTest, WedgePlanes};
use gnomon_shaders::transform::FullScreen;

use crate::parts::visibility::{attachment, binding, full_screen};
use crate::technique::TechniqueError;

/// How often all tiles of the image fit side by side, either way.
const IMAGES: u32 = 8;

/// A texture that holds the classes of many wedges' tiles, each in a rectangle.
#[derive(Clone, Copy)]
pub(super) struct Atlas {
    pub(super) texture: TextureId,
    size: [u32; 2],
    shift: u32,
}

impl Atlas {
    pub(super) fn create(
        size: [u32; 2],
        shift: u32,
        recording: &mut Recording,
    ) -> Result<Self, TechniqueError> {
        let tiles = size.map(|s| s.div_ceil(1 << shift));
        let size = tiles.map(|t| (t * IMAGES).min(MAX_TEXTURE_SIZE));
        let desc = TextureDescriptor::d2("tile classes", Format::R8Unorm, size[0], size[1]);
        Ok(Self {
            texture: recording.create(&desc)?,
            size,
            shift,
        })
    }

    /// The pass that finds the classes that `draws` are for.
    pub(super) fn pass(&self, label: String, draws: Vec<Draw>) -> RenderPass {
        RenderPass {
            label,
            color: vec![attachment(self.texture, LoadOp::DontCare)],
            depth_stencil: None,
            draws,
        }
    }
}

/// Rectangles of an atlas that are taken, from the top and the left.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Shelves {
    /// Where the next rectangle of the lowest shelf goes.
    next: [u32; 2],
    /// Height of that shelf.
    height: u32,
}

impl Shelves {
    /// A place for `wanted` texels, if there is one left.
    fn place(&mut self, wanted: [u32; 2], size: [u32; 2]) -> Option<[u32; 2]> {
        if self.next[0] + wanted[0] > size[0] {
            self.next = [0, self.next[1] + self.height];
            self.height = 0;
        }
        if self.next[1] + wanted[1] > size[1] {
            return None;
        }
        let place = self.next;
        self.next[0] += wanted[0];
        self.height = self.height.max(wanted[1]);
        Some(place)
    }
}

/// A wedge's tiles in the atlas.
pub(super) struct Placed {
    /// Finds their classes.
    pub(super) draw: Draw,
    /// For the wedge's pixels.
    pub(super) look_up: TileLookUp,
}

impl Atlas {
    /// Room for the tiles under `pixels`, the inclusive ranges of columns and rows that a
    /// wedge may cover; `None` where `shelves` are full. `bounds` are zmax and zmin.
    pub(super) fn place(
        &self,
        shelves: &mut Shelves,
        pixels: [[u32; 2]; 2],
        (wedge, test): (&WedgePlanes, &TileTest),
        bounds: &[TextureId],
    ) -> Option<Placed> {
        let first = pixels.map(|[low, _]| low >> self.shift);
        let last = pixels.map(|[_, high]| high >> self.shift);
        let wanted = [0, 1].map(|k| last[k] - first[k] + 1);
        let place = shelves.place(wanted, self.size)?;
        let offset = [0, 1].map(|k| place[k] as i32 - first[k] as i32);
        let classes = TileClasses {
            wedge: *wedge,
            test: test.clone(),
            offset,
        };
        let pipeline = RenderPipeline {
            label: "tile classes".into(),
            vertex: FullScreen.stage(),
            fragment: Some(classes.stage()),
            primitive: PrimitiveState::default(),
            depth_stencil: DepthStencilState::default(),
            color_targets: vec![ColorTargetState::OPAQUE],
        };
        let draw = Draw {
            scissor: Some(ScissorRect {
                x: place[0],
                y: place[1],
                width: wanted[0],
                height: wanted[1],
            }),
            ..full_screen(pipeline, bounds.iter().map(|&t| binding(t)).collect())
        };
        let look_up = TileLookUp {
            shift: self.shift,
            offset,
        };
        Some(Placed { draw, look_up })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rectangles neither overlap nor leave the atlas; what does not fit is refused.
    #[test]
    fn shelves_hold_rectangles_side_by_side() {
        let (mut shelves, size) = (Shelves::default(), [10, 7]);
        let mut taken = [[false; 10]; 7];
        let mut placed = 0;
        for wanted in [[4, 2], [6, 3], [1, 1], [10, 2], [3, 1], [8, 1], [1, 1]] {
            let Some([x, y]) = shelves.place(wanted, size) else {
                continue;
            };
            placed += 1;
            for row in &mut taken[y as usize..(y + wanted[1]) as usize] {
                for cell in &mut row[x as usize..(x + wanted[0]) as usize] {
                    assert!(!std::mem::replace(cell, true), "{wanted:?} at {x}, {y}");
                }
            }
        }
        assert_eq!(placed, 5, "{taken:?}");
    }
}
