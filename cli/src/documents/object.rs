//! Objects as they are written.

use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

/// A JSON object whose keys keep their order.
#[derive(Clone, Debug, Default)]
pub struct Object<T>(pub Vec<(String, T)>);

impl<T: Serialize> Serialize for Object<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (key, value) in &self.0 {
            map.serialize_entry(key, value)?;
        }
        map.end()
    }
}
