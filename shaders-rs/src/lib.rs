//! Shaders of the shadow techniques, over lanes; one file per family.
//!
//! * [`transform`]: from world to clip space, for scene geometry and shadow
//!   volumes alike
//! * [`coverage`], [`coverage_table`]: how much of an area light an edge covers
//! * [`light_view`]: pictures of the casters from a light, and positions in them
//! * [`convolution`]: shadow maps that are filtered before they are compared
//! * [`penumbra`]: penumbra wedges of papers I and II
//! * [`shadow_maps`]: shadows looked up in light views
//! * [`soft_volumes`]: soft shadow volumes on a float visibility buffer
//! * [`split_volumes`]: the same split over 8-bit buffers, and silhouettes combined
//! * [`surface`]: ambient, Lambert and Phong shading of surfaces
//!
//! Colours are linear light. A shader is a struct of its uniforms; the frame
//! that uses it decides targets, blending and tests.

pub mod convolution;
pub mod coverage;
pub mod coverage_table;
pub mod light_view;
pub mod penumbra;
pub mod shadow_maps;
pub mod soft_volumes;
pub mod split_volumes;
pub mod surface;
pub mod transform;
mod vector;

use gnomon_raster::shader::{FragmentStage, VertexStage};

/// Gives shaders a method that compiles them here and not in every user's crate.
macro_rules! stages {
    ($stage:ident: $($shader:ty),+) => { $(
        impl $shader {
            /// The shader, ready for a render pipeline.
            #[must_use]
            pub fn stage(self) -> $stage {
                self.into()
            }
        }
    )+ };
}
stages!(VertexStage:
    transform::Points, transform::HomogeneousPoints, transform::Surfaces, transform::FullScreen,
    transform::Facets, soft_volumes::HardQuads, soft_volumes::EyeCount);
stages!(FragmentStage:
    surface::Constant, surface::Lambert, surface::Phong, surface::AmbientWithPosition,
    surface::FacetValue,
    surface::Shadowed<surface::Lambert>, surface::Shadowed<surface::Phong>,
    soft_volumes::HardCount, soft_volumes::Resolve,
    split_volumes::SplitPenumbra, split_volumes::CombineGroups, split_volumes::AddVisibility,
    soft_volumes::Penumbra<soft_volumes::ExactCoverage>,
    soft_volumes::Penumbra<coverage_table::CoverageTable>);
stages!(FragmentStage:
    penumbra::crossing::WedgeCrossing, penumbra::inside::WedgeInside,
    penumbra::buffers::TileDepths, penumbra::buffers::Boundary,
    penumbra::buffers::StencilCounts);
stages!(FragmentStage:
    convolution::basis::BasisImages, convolution::basis::DepthImage,
    convolution::prefilter::Halve, convolution::prefilter::CopyLevel,
    convolution::prefilter::LessMean, convolution::prefilter::SumStep,
    convolution::visibility::ConvolutionShadow<convolution::look_up::Mipmaps>,
    convolution::visibility::ConvolutionShadow<convolution::look_up::FloatTables>,
    convolution::visibility::ConvolutionShadow<convolution::look_up::IntegerTables>);
stages!(FragmentStage:
    light_view::PlanarDepth,
    shadow_maps::Shadow<shadow_maps::BoxTaps>, shadow_maps::Shadow<shadow_maps::CubicTaps>,
    shadow_maps::Shadow<shadow_maps::SampledKernel>,
    shadow_maps::Shadow<shadow_maps::WholeKernel>);
