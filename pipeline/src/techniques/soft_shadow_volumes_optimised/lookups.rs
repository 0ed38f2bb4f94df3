//! Look-up textures of a frame.

use gnomon_raster::{Recording, TextureId};
use gnomon_shaders::coverage::Image;
use gnomon_shaders::split_volumes::Tables;

use crate::parts::wedges::soft::light::SoftLight;
use crate::parts::wedges::soft::split_tables;
use crate::technique::TechniqueError;

/// Look-up textures of the lights of a frame, one set for each shape.
#[derive(Default)]
pub(super) struct Lookups(Vec<(Image, [TextureId; 3])>);

impl Lookups {
    /// Those of a light, where some are asked for.
    pub(super) fn of(
        &mut self,
        light: &SoftLight,
        tables: Tables,
        recording: &mut Recording,
    ) -> Result<Option<(Tables, [TextureId; 3])>, TechniqueError> {
        let Some(side) = light.sides.first().filter(|_| tables != Tables::default()) else {
            return Ok(None);
        };
        let shape = side.projector.image();
        if let Some((_, made)) = self.0.iter().find(|(of, _)| *of == shape) {
            return Ok(Some((tables, *made)));
        }
        let made = split_tables::create(shape, recording)?;
        self.0.push((shape, made));
        Ok(Some((tables, made)))
    }
}
