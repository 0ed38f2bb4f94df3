//! Look-up textures of a frame.

use gnomon_raster::{Recording, TextureId};
use gnomon_shaders::coverage::Image;
use gnomon_shaders::split_volumes::Tables;

use super::settings::OptimisedSettings;
use crate::parts::wedges::soft::covering::{Covering, Coverings};
use crate::parts::wedges::soft::light::SoftLight;
use crate::parts::wedges::soft::split_tables;
use crate::technique::TechniqueError;

/// Look-up textures of the lights of a frame, one set for each shape.
#[derive(Default)]
pub(super) struct Lookups {
    made: Vec<(Image, [TextureId; 3])>,
    coverings: Coverings,
}

/// How coverage is found for a light.
#[derive(Clone, Copy)]
pub(super) enum Covered {
    /// By arithmetic, or from paper IV's textures.
    Split(Option<(Tables, [TextureId; 3])>),
    /// From paper III's.
    Textured(Covering),
}

impl Lookups {
    /// For light number `number`.
    pub(super) fn of(
        &mut self,
        technique: &'static str,
        light: &SoftLight,
        number: usize,
        settings: &OptimisedSettings,
        recording: &mut Recording,
    ) -> Result<Covered, TechniqueError> {
        let covering = &settings.covering;
        let covering = self
            .coverings
            .of(technique, light, number, covering, recording)?;
        Ok(match covering {
            Covering::Exact => Covered::Split(self.tables(light, settings.tables, recording)?),
            textured => Covered::Textured(textured),
        })
    }

    /// Paper IV's textures, where some are asked for.
    fn tables(
        &mut self,
        light: &SoftLight,
        tables: Tables,
        recording: &mut Recording,
    ) -> Result<Option<(Tables, [TextureId; 3])>, TechniqueError> {
        let Some(side) = light.sides.first().filter(|_| tables != Tables::default()) else {
            return Ok(None);
        };
        let shape = side.projector.image();
        if let Some((_, made)) = self.made.iter().find(|(of, _)| *of == shape) {
            return Ok(Some((tables, *made)));
        }
        let made = split_tables::create(shape, recording)?;
        self.made.push((shape, made));
        Ok(Some((tables, made)))
    }
}
