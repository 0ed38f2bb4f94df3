//! Pictures that a scene file lays on its objects.

use super::SceneFileError;
use super::check::Source;
use super::schema::ObjectTable;
use super::shapes::Read;
use crate::world::files::SceneFolder;
use crate::world::texture::{Gallery, MAX_PICTURE_BYTES, SurfaceTexture};

/// The picture of an object's material, out of the scene's; coordinates of `read` are repeated as it asks.
pub(super) fn paint(
    source: &Source<'_>,
    folder: &SceneFolder,
    gallery: &mut Gallery,
    table: &ObjectTable,
    read: &mut Read,
) -> Result<Option<SurfaceTexture>, SceneFileError> {
    let Some(material) = &table.material else {
        return Ok(None);
    };
    let Some(name) = &material.texture else {
        return match &material.texture_repeat {
            None => Ok(None),
            Some(repeat) => {
                let message = "texture-repeat without texture; add one, or remove it";
                Err(source.error(repeat.span(), message.to_owned()))
            }
        };
    };
    if read.coordinates.is_empty() {
        let message = format!(
            "mesh.{} has no texture coordinates; valid with a texture are plane, terrain, box, \
             and models that have some",
            table.mesh.kind()
        );
        return Err(source.error(name.span(), message));
    }
    if let Some(repeat) = &material.texture_repeat {
        let times = source.positive("texture-repeat", repeat)?;
        let all = read.coordinates.as_flattened_mut().as_flattened_mut();
        all.iter_mut()
            .for_each(|c| *c = (f64::from(*c) * times) as f32);
    }
    let path = folder.join(name.get_ref());
    let refuse = |why: String| source.error(name.span(), format!("{}: {why}", path.display()));
    let bytes = folder.read(&path, MAX_PICTURE_BYTES);
    let bytes = bytes.map_err(|e| refuse(e.to_string()))?;
    let picture = gallery.picture(&bytes).map_err(|e| refuse(e.to_string()))?;
    Ok(Some(SurfaceTexture::repeated(picture)))
}
