//! What fuzz targets share: files of any bytes, read as a user would have them read.

use std::fs;
use std::path::{Path, PathBuf};

use gnomon_pipeline::world::files::Outside;
use gnomon_pipeline::world::model;

/// A folder of this process, in memory where the machine has such a place.
fn folder() -> PathBuf {
    let memory = Path::new("/dev/shm");
    let base = if memory.is_dir() {
        memory.to_owned()
    } else {
        std::env::temp_dir()
    };
    let folder = base.join(format!("gnomon-fuzz-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a place for files");
    folder
}

/// Writes a file for this process's targets to read.
pub fn file(name: &str, data: &[u8]) -> PathBuf {
    let path = folder().join(name);
    fs::write(&path, data).expect("room for a file");
    path
}

/// Reads `data` as a model called `name`; what is read is whole.
pub fn model(name: &str, data: &[u8]) {
    read_model(&file(name, data));
}

/// Reads a model. A mesh that was taken has indices within its vertices, and no NaN.
pub fn read_model(path: &Path) {
    let Ok(read) = model::load_given(path, Outside::Refused) else {
        return;
    };
    for piece in &read.pieces {
        let count = piece.shape.positions.len();
        let indices = piece.shape.triangles.iter().flatten();
        assert!(indices.copied().all(|i| (i as usize) < count));
        assert!(piece.shape.positions.iter().all(|p| p.is_finite()));
    }
}
