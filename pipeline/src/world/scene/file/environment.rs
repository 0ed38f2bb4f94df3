//! The environment of a scene file.

use super::SceneFileError;
use super::check::Source;
use super::schema::{AmbientTable, EnvironmentTable, FormTable, PlaceTable, ResidualTable};
use crate::world::environment::{
    AmbientForm, FitSettings, LightForm, LightPlace, MapSettings, ResidualRule, SKY,
};
use crate::world::files::SceneFolder;
use crate::world::scene::environment::EnvironmentRequest;

/// What `table` asks for; values out of range are refused when it is met.
pub(super) fn request(
    source: &Source<'_>,
    folder: &SceneFolder,
    table: &EnvironmentTable,
) -> Result<EnvironmentRequest, SceneFileError> {
    let (map, fit) = (MapSettings::default(), FitSettings::default());
    let number = |name, value: &Option<_>, default| match value {
        Some(value) => source.number(name, value),
        None => Ok(default),
    };
    let count = |value: &Option<super::schema::Count>, default| {
        value.as_ref().map_or(default, |n| *n.get_ref() as usize)
    };
    let name = table.map.get_ref();
    Ok(EnvironmentRequest {
        map: if name == SKY {
            name.clone()
        } else {
            folder.join(name).display().to_string()
        },
        folder: Some(folder.clone()),
        settings: MapSettings {
            side: count(&table.side, map.side),
            turn: number("turn", &table.turn, map.turn)?,
            brightness: number("brightness", &table.brightness, map.brightness)?,
        },
        fit: FitSettings {
            lights: count(&table.lights, fit.lights),
            threshold: match &table.threshold {
                Some(threshold) => Some(source.number("threshold", threshold)?),
                None => fit.threshold,
            },
            form: match table.form {
                Some(FormTable::Square) => LightForm::Square,
                Some(FormTable::Rectangle) => LightForm::Rectangle,
                None => fit.form,
            },
            residual: match table.residual {
                Some(ResidualTable::Excess) => ResidualRule::Excess,
                Some(ResidualTable::Mean) => ResidualRule::Mean,
                None => fit.residual,
            },
            place: match table.place {
                Some(PlaceTable::Texels) => LightPlace::Texels,
                Some(PlaceTable::Centroid) => LightPlace::Centroid,
                Some(PlaceTable::Moments) => LightPlace::Moments,
                None => fit.place,
            },
            ambient: match table.ambient {
                Some(AmbientTable::Even) => AmbientForm::Even,
                Some(AmbientTable::Harmonic) => AmbientForm::Harmonic,
                None => fit.ambient,
            },
        },
    })
}
