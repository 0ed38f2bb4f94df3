//! Shaders of the shadow techniques, over lanes; one file per family.
//!
//! * [`transform`]: from world to clip space, for scene geometry and shadow
//!   volumes alike
//! * [`backprojection`]: texels of light views projected on the light
//! * [`cones`]: shadows of spheres from the patches of a light view
//! * [`coverage`], [`coverage_table`]: how much of an area light an edge covers
//! * [`deferred`]: light of vertices under an environment, less what occlusion maps take
//! * [`light_view`]: pictures of the casters from a light, and positions in them
//! * [`convolution`]: shadow maps that are filtered before they are compared
//! * [`line_samples`]: depth complexity of lights along lines
//! * [`moments`]: shadow maps filtered as means of functions of depth
//! * [`penumbra`]: penumbra wedges of papers I and II
//! * [`planar_shadows`]: counts of hidden points over planes
//! * [`shadow_maps`]: shadows looked up in light views
//! * [`shadow_rays`]: rays to points of the light
//! * [`smoothies`]: geometry that softens the edges of shadow maps
//! * [`soft_volumes`]: soft shadow volumes on a float visibility buffer
//! * [`split_volumes`]: the same split over 8-bit buffers, and silhouettes combined
//! * [`visibility_buffers`]: paper III's float buffer without blending, and its 8-bit one
//! * [`surface`]: ambient, Lambert and Phong shading of surfaces
//!
//! Colours are linear light. A shader is a struct of its uniforms; the frame
//! that uses it decides targets, blending and tests.
//!
//! To add one: the struct with its `uniforms!` line and its implementation in the file
//! of its family, and a line with name and version in `stages!` below. Raise the
//! version when what it computes changes.

pub mod backprojection;
mod bounded;
pub mod cones;
pub mod convolution;
pub mod coverage;
pub mod coverage_table;
pub mod deferred;
pub mod light_view;
pub mod line_samples;
pub mod moments;
pub mod penumbra;
pub mod planar_shadows;
pub mod shadow_maps;
pub mod shadow_rays;
pub mod smoothies;
pub mod soft_volumes;
pub mod split_volumes;
pub mod surface;
pub mod transform;
mod vector;
pub mod visibility_buffers;

use gnomon_raster::shader::{FragmentStage, Named, ShaderTable, ShaderTableError, VertexStage};

/// Gives shaders their names and versions, a method that compiles them here and not in
/// every user's crate, and a place in [`table`].
macro_rules! stages {
    (
        vertex { $($vertex:ty: $vertex_name:literal $vertex_version:literal),+ $(,)? }
        fragment { $($fragment:ty: $fragment_name:literal $fragment_version:literal),+ $(,)? }
    ) => {
        $(stages!(@one VertexStage $vertex: $vertex_name $vertex_version);)+
        $(stages!(@one FragmentStage $fragment: $fragment_name $fragment_version);)+

        fn all() -> Result<ShaderTable, ShaderTableError> {
            let mut table = ShaderTable::default();
            $(table.add_vertex::<$vertex>()?;)+
            $(table.add_fragment::<$fragment>()?;)+
            Ok(table)
        }
    };
    (@one $stage:ident $shader:ty: $name:literal $version:literal) => {
        impl Named for $shader {
            const NAME: &'static str = $name;
            const VERSION: u32 = $version;
        }

        impl $shader {
            /// The shader, ready for a render pipeline.
            #[must_use]
            pub fn stage(self) -> $stage {
                $stage::named(self)
            }
        }
    };
}

/// All shaders of this crate, by name.
///
/// # Panics
/// Two shaders have one name, which a test rules out.
#[must_use]
pub fn table() -> ShaderTable {
    all().expect("a test holds names apart")
}

stages! {
    vertex {
        transform::Points: "transform.points" 1,
        transform::HomogeneousPoints: "transform.homogeneous-points" 1,
        transform::Surfaces: "transform.surfaces" 1,
        transform::FullScreen: "transform.full-screen" 1,
        transform::Facets: "transform.facets" 1,
        transform::NumberedFacets: "transform.numbered-facets" 1,
        smoothies::SmoothieVertices: "smoothies.vertices" 1,
        soft_volumes::HardQuads: "soft-volumes.hard-quads" 1,
        soft_volumes::EyeCount: "soft-volumes.eye-count" 1,
        deferred::radiance::VertexRadiance: "deferred.vertex-radiance" 1,
        deferred::radiance::Reflections: "deferred.reflections" 1,
        deferred::radiance::Corners: "deferred.corners" 1,
        deferred::obscured::Transported: "deferred.transported" 1,
    }
    fragment {
        surface::Constant: "surface.constant" 1,
        surface::Lambert: "surface.lambert" 1,
        surface::Phong: "surface.phong" 1,
        surface::AmbientWithPosition: "surface.ambient-with-position" 1,
        surface::LeaningAmbient: "surface.leaning-ambient" 1,
        surface::AmbientWithNumber: "surface.ambient-with-number" 1,
        surface::FacetValue: "surface.facet-value" 1,
        surface::Shadowed<surface::Lambert>: "surface.shadowed-lambert" 1,
        surface::Shadowed<surface::Phong>: "surface.shadowed-phong" 1,
        surface::ShadowedByBytes<surface::Lambert>: "surface.shadowed-by-bytes-lambert" 1,
        surface::ShadowedByBytes<surface::Phong>: "surface.shadowed-by-bytes-phong" 1,
        soft_volumes::HardCount: "soft-volumes.hard-count" 1,
        soft_volumes::Resolve: "soft-volumes.resolve" 1,
        visibility_buffers::QuadCount: "visibility-buffers.quad-count" 1,
        visibility_buffers::ResolveRedGreen: "visibility-buffers.resolve-red-green" 1,
        soft_volumes::Penumbra<soft_volumes::ExactCoverage>: "soft-volumes.penumbra-exact" 1,
        soft_volumes::Penumbra<coverage_table::CoverageTable>: "soft-volumes.penumbra-table" 2,
        soft_volumes::Penumbra<coverage_table::BlendedTables>: "soft-volumes.penumbra-blended" 1,
        split_volumes::SplitPenumbra: "split-volumes.penumbra" 1,
        split_volumes::textured::SplitTextured<coverage_table::CoverageTable>:
            "split-volumes.textured-table" 1,
        split_volumes::textured::SplitTextured<coverage_table::BlendedTables>:
            "split-volumes.textured-blended" 1,
        split_volumes::resolve::ResolveSplit: "split-volumes.resolve" 1,
        penumbra::face::WedgeFace: "penumbra.wedge-face" 2,
        penumbra::crossing::WedgeCrossing: "penumbra.wedge-crossing" 3,
        penumbra::inside::WedgeInside: "penumbra.wedge-inside" 2,
        penumbra::tiles::TileClasses: "penumbra.tile-classes" 1,
        penumbra::buffers::DepthCopy: "penumbra.depth-copy" 1,
        penumbra::buffers::TileDepths: "penumbra.tile-depths" 1,
        penumbra::buffers::Boundary: "penumbra.boundary" 1,
        penumbra::buffers::StencilCounts: "penumbra.stencil-counts" 1,
        convolution::basis::BasisImages: "convolution.basis-images" 1,
        convolution::basis::DepthImage: "convolution.depth-image" 1,
        convolution::prefilter::Halve: "convolution.halve" 1,
        convolution::prefilter::CopyLevel: "convolution.copy-level" 1,
        convolution::prefilter::LessMean: "convolution.less-mean" 1,
        convolution::prefilter::SumStep: "convolution.sum-step" 1,
        convolution::visibility::ConvolutionShadow<convolution::look_up::Mipmaps>:
            "convolution.shadow-mipmaps" 2,
        convolution::visibility::ConvolutionShadow<convolution::look_up::FloatTables>:
            "convolution.shadow-float-tables" 2,
        convolution::visibility::ConvolutionShadow<convolution::look_up::IntegerTables>:
            "convolution.shadow-integer-tables" 2,
        cones::patches::PatchPicture: "cones.patch-picture" 1,
        cones::bounds::PatchBounds: "cones.patch-bounds" 1,
        cones::ConeShadow<cones::DiscSamples>: "cones.shadow-disc-samples" 1,
        cones::ConeShadow<cones::PatchTree>: "cones.shadow-patch-tree" 1,
        cones::ConeShadow<cones::AllPatches>: "cones.shadow-all-patches" 1,
        smoothies::SmoothieDepth: "smoothies.depth" 1,
        smoothies::SmoothieAlpha: "smoothies.alpha" 1,
        smoothies::SmoothieShadow: "smoothies.shadow" 1,
        light_view::PlanarDepth: "light-view.planar-depth" 1,
        shadow_maps::Shadow<shadow_maps::BoxTaps>: "shadow-maps.box-taps" 1,
        shadow_maps::Shadow<shadow_maps::CubicTaps>: "shadow-maps.cubic-taps" 1,
        shadow_maps::Shadow<shadow_maps::SampledKernel>: "shadow-maps.sampled-kernel" 1,
        shadow_maps::Shadow<shadow_maps::WholeKernel>: "shadow-maps.whole-kernel" 1,
        deferred::radiance::Carried: "deferred.carried" 1,
        deferred::radiance::GlossyRadiance: "deferred.glossy-radiance" 1,
        deferred::radiance::SurfaceRadiance: "deferred.surface-radiance" 1,
        deferred::maps::BoxAlong: "deferred.box-along" 1,
        deferred::obscured::ObscuredRadiance: "deferred.obscured-radiance" 1,
        deferred::obscured::DistantVisibility: "deferred.distant-visibility" 1,
        deferred::lit::LessObscured: "deferred.less-obscured" 1,
        backprojection::region::LeastOfFour: "backprojection.least-of-four" 1,
        shadow_maps::Shadow<backprojection::Backprojection<backprojection::cover::AreaSum>>:
            "backprojection.area-sum" 1,
        shadow_maps::Shadow<backprojection::Backprojection<backprojection::cover::BitField>>:
            "backprojection.bit-field" 1,
        shadow_maps::Shadow<backprojection::Backprojection<backprojection::turned::TurnedBits>>:
            "backprojection.turned-bits" 1,
        shadow_rays::ShadowRays: "shadow-rays" 1,
        line_samples::LineSamples: "line-samples" 1,
        planar_shadows::PlanarShadow: "planar-shadows" 1,
        shadow_maps::Shadow<moments::occluder_plane::OccluderPlane>: "moments.occluder-plane" 1,
        moments::image::MomentImage: "moments.image" 1,
        shadow_maps::Shadow<moments::filter::FixedKernel>: "moments.fixed-kernel" 1,
        shadow_maps::Shadow<moments::filter::LightKernel>: "moments.light-kernel" 1,
        shadow_maps::Shadow<moments::variance_soft::VarianceSoft>: "moments.variance-soft" 1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_shader_has_a_name_of_its_own() {
        let table = all().unwrap();
        assert_eq!(table.vertex_shaders().count(), 13);
        assert_eq!(table.fragment_shaders().count(), 71);
    }
}
