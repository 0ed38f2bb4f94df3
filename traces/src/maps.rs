//! Where on the picture the work was: numbers for each pixel.

use gnomon_raster::{
    AccessBatch, AccessObserver, BlockAccess, Error, Gpu, GpuConfig, MAX_COLOR_ATTACHMENTS,
    PassReport, Recording, RenderPass, SubmitReport, Subresource, TextureId, Wants,
};

/// What a map counts at each pixel, clears left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum MapKind {
    /// Fragments generated.
    Overdraw,
    /// Reads and writes of the stencil.
    StencilOperations,
    /// Fragments thrown away by zmin/zmax of their block.
    HizKills,
    /// Logical bytes of depth, stencil and colour. Entries of zmin/zmax belong to blocks
    /// and are left out, as are textures and vertices.
    Bytes,
}

impl MapKind {
    /// All of them.
    pub const ALL: [Self; 4] = [
        Self::Overdraw,
        Self::StencilOperations,
        Self::HizKills,
        Self::Bytes,
    ];
}

/// Maps of a frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Maps {
    /// Width and height.
    pub size: [u32; 2],
    /// By [`MapKind`], rows from the top.
    values: [Vec<u32>; 4],
    /// Fragments of passes that draw to other images, which have no place on the picture.
    pub elsewhere: u64,
}

impl Maps {
    /// The values of one map.
    #[must_use]
    pub fn of(&self, kind: MapKind) -> &[u32] {
        &self.values[kind as usize]
    }

    /// Their sum.
    #[must_use]
    pub fn sum(&self, kind: MapKind) -> u64 {
        self.of(kind).iter().map(|v| u64::from(*v)).sum()
    }
}

/// Draws `recording` and maps what its passes do at the pixels of `image`, and of the
/// images that are attached beside it in any pass.
///
/// # Errors
/// The frame cannot be drawn.
pub fn observe(
    recording: &Recording,
    image: TextureId,
    config: GpuConfig,
) -> Result<(Maps, SubmitReport), Error> {
    let mut gpu = Gpu::new(config)?;
    gpu.load(recording)?;
    let [width, height, _] = recording.texture(image)?.descriptor().size;
    let pixels = width as usize * height as usize;
    let mut mapper = Mapper {
        maps: Maps {
            size: [width, height],
            values: std::array::from_fn(|_| vec![0; pixels]),
            elsewhere: 0,
        },
        targets: targets(recording, image)?,
    };
    let report = gpu.submit_observed(&recording.list, Wants::default(), &mut mapper)?;
    Ok((mapper.maps, report))
}

/// What a pass draws into: whether onto the picture, and what an access costs.
struct Targets {
    on_picture: bool,
    depth_bytes: u32,
    color_bytes: [u32; MAX_COLOR_ATTACHMENTS],
}

fn targets(recording: &Recording, image: TextureId) -> Result<Vec<Targets>, Error> {
    let mut images = vec![(image, Subresource::default())];
    let passes = &recording.list.passes;
    // Each round adds what is attached beside the images so far.
    let mut known = 0;
    while known < images.len() {
        known = images.len();
        for pass in passes {
            if on_any(pass, &images) {
                let new: Vec<_> = attached(pass).filter(|i| !images.contains(i)).collect();
                images.extend(new);
            }
        }
    }
    let target = |pass: &RenderPass| Targets::new(recording, pass, on_any(pass, &images));
    passes.iter().map(target).collect()
}

type Image = (TextureId, Subresource);

fn on_any(pass: &RenderPass, images: &[Image]) -> bool {
    attached(pass).any(|i| images.contains(&i))
}

fn attached(pass: &RenderPass) -> impl Iterator<Item = Image> {
    let color = pass.color.iter().map(|a| (a.texture, a.subresource));
    let depth = pass.depth_stencil.iter();
    color.chain(depth.map(|a| (a.texture, a.subresource)))
}

impl Targets {
    fn new(recording: &Recording, pass: &RenderPass, on_picture: bool) -> Result<Self, Error> {
        let bytes = |id: TextureId| {
            let format = recording.texture(id)?.descriptor().format;
            Ok::<u32, Error>(format.bytes() as u32)
        };
        let mut color_bytes = [0; MAX_COLOR_ATTACHMENTS];
        for (to, attachment) in color_bytes.iter_mut().zip(&pass.color) {
            *to = bytes(attachment.texture)?;
        }
        let depth = pass.depth_stencil.as_ref();
        Ok(Self {
            on_picture,
            depth_bytes: depth.map_or(Ok(0), |a| bytes(a.texture))?,
            color_bytes,
        })
    }

    /// Accesses by pixel and what each costs.
    fn costs(&self, a: &BlockAccess) -> impl Iterator<Item = (u64, u32)> {
        let depth = [(a.z_read, self.depth_bytes), (a.z_write, self.depth_bytes)];
        let stencil = [(a.stencil_read, 1), (a.stencil_write, 1)];
        let all = (a.color_read.into_iter().zip(self.color_bytes))
            .chain(a.color_write.into_iter().zip(self.color_bytes));
        depth.into_iter().chain(stencil).chain(all)
    }
}

/// Adds up accesses.
struct Mapper {
    maps: Maps,
    targets: Vec<Targets>,
}

impl AccessObserver for Mapper {
    fn batch(&mut self, pass: usize, batch: &AccessBatch<'_>) {
        let target = &self.targets[pass];
        for access in batch.blocks {
            if target.on_picture {
                self.maps.add(access, target);
            } else {
                self.maps.elsewhere += u64::from(access.covered.count_ones());
            }
        }
    }

    fn end(&mut self, _: usize, _: &PassReport) {}
}

impl Maps {
    fn add(&mut self, a: &BlockAccess, target: &Targets) {
        self.add_to(MapKind::Overdraw, a.block, a.covered, 1);
        self.add_to(MapKind::StencilOperations, a.block, a.stencil_read, 1);
        self.add_to(MapKind::StencilOperations, a.block, a.stencil_write, 1);
        if a.ended.hiz {
            self.add_to(MapKind::HizKills, a.block, a.covered, 1);
        }
        for (mask, bytes) in target.costs(a) {
            self.add_to(MapKind::Bytes, a.block, mask, bytes);
        }
    }

    fn add_to(&mut self, kind: MapKind, block: [u16; 2], mask: u64, amount: u32) {
        let [column, row] = block.map(usize::from);
        let values = &mut self.values[kind as usize];
        let mut left = mask;
        while left != 0 {
            let bit = left.trailing_zeros() as usize;
            let (x, y) = (8 * column + bit % 8, 8 * row + bit / 8);
            values[y * self.size[0] as usize + x] += amount;
            left &= left - 1;
        }
    }
}
