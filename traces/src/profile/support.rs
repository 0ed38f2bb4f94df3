//! What a profile's hardware cannot do.

use gnomon_raster::Format;

use super::ProfileError;
use super::hiz::{DisabledReason, DrawHiz};
use super::model::Profile;
use crate::shape::{FrameShape, PassShape};

/// Whether the hardware can draw the frame at all.
pub(super) fn check(profile: &Profile, shape: &FrameShape) -> Result<(), ProfileError> {
    if profile.blends_half {
        return Ok(());
    }
    shape
        .passes
        .iter()
        .try_for_each(|pass| check_pass(profile, shape, pass))
}

fn check_pass(profile: &Profile, shape: &FrameShape, pass: &PassShape) -> Result<(), ProfileError> {
    for draw in &pass.draws {
        for (attachment, target) in pass.color.iter().zip(&draw.color_targets) {
            let format = shape.textures[attachment.texture.index()].format;
            if target.blend.is_some() && is_wide(format) {
                return Err(ProfileError::Unsupported {
                    profile: profile.name.clone(),
                    pass: pass.label.clone(),
                    draw: draw.label.clone(),
                    format: format!("{format:?}"),
                });
            }
        }
    }
    Ok(())
}

fn is_wide(format: Format) -> bool {
    matches!(
        format,
        Format::R16Float | Format::Rgba16Float | Format::R32Float | Format::Rgba32Float
    )
}

/// HiZ without room for its entries.
pub(super) fn within(hiz: DrawHiz, fits: bool) -> DrawHiz {
    match (fits, hiz.test) {
        (false, Ok(_)) => DrawHiz {
            test: Err(DisabledReason::NoMemory),
            updates: false,
        },
        _ => hiz,
    }
}
