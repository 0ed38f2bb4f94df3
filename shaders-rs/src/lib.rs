//! Shaders of the shadow techniques, over lanes; one file per family.
//!
//! * [`transform`]: from world to clip space, for scene geometry and shadow
//!   volumes alike
//! * [`surface`]: ambient, Lambert and Phong shading of surfaces
//!
//! Colours are linear light. A shader is a struct of its uniforms; the frame
//! that uses it decides targets, blending and tests.

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
    transform::Points, transform::HomogeneousPoints, transform::Surfaces, transform::FullScreen);
stages!(FragmentStage:
    surface::Constant, surface::Lambert, surface::Phong, surface::AmbientWithPosition,
    surface::Shadowed<surface::Lambert>, surface::Shadowed<surface::Phong>);
