//! Uniforms that say how much a shader does: read from a file, they could make it work
//! for ever.

use gnomon_raster::shader::{UniformError, UniformReader};

/// Numbers that may not be larger: what they are, given, and most.
pub(crate) type Bounds<const N: usize> = [(&'static str, u64, u64); N];

/// Refuses uniforms that are beyond their bounds.
pub(crate) fn check<const N: usize>(
    bounds: Bounds<N>,
    from: &UniformReader<'_>,
) -> Result<(), UniformError> {
    match bounds.into_iter().find(|(_, given, most)| given > most) {
        None => Ok(()),
        Some((what, given, most)) => Err(from.invalid(0, what, given, format!("at most {most}"))),
    }
}

/// As `uniforms!` for a struct, with a function from the value to its [`Bounds`].
macro_rules! bounded_uniforms {
    ($name:ident { $($field:ident),+ $(,)? }: $bounds:expr) => {
        impl gnomon_raster::shader::Uniforms for $name {
            fn put(&self, to: &mut gnomon_raster::shader::UniformWriter) {
                let Self { $($field),+ } = self;
                $(gnomon_raster::shader::Uniforms::put($field, to);)+
            }

            fn take(
                from: &mut gnomon_raster::shader::UniformReader<'_>,
            ) -> Result<Self, gnomon_raster::shader::UniformError> {
                $(let $field = gnomon_raster::shader::Uniforms::take(from)?;)+
                let value = Self { $($field),+ };
                let bounds: fn(&Self) -> $crate::bounded::Bounds<_> = $bounds;
                $crate::bounded::check(bounds(&value), from)?;
                Ok(value)
            }
        }
    };
}
pub(crate) use bounded_uniforms;

#[cfg(test)]
mod tests {
    use gnomon_raster::shader::{UniformReader, UniformWriter, Uniforms};

    use crate::convolution::look_up::Mipmaps;
    use crate::shadow_maps::BoxTaps;

    fn again<T: Uniforms>(value: &T) -> Result<T, String> {
        let mut to = UniformWriter::default();
        value.put(&mut to);
        T::take(&mut UniformReader::new(&to.into_bytes())).map_err(|e| e.to_string())
    }

    #[test]
    fn what_would_take_for_ever_is_refused() {
        let mipmaps = |probes, along| Mipmaps {
            side: 8,
            lod_bias: 0.0,
            probes,
            along,
        };
        assert_eq!(again(&mipmaps(16, 1)), Ok(mipmaps(16, 1)));
        let refused = again(&mipmaps(u32::MAX, 0)).unwrap_err();
        assert!(
            refused.contains("4294967295; valid is at most 64"),
            "{refused}"
        );
        assert!(again(&mipmaps(1, 2)).is_err());
        assert_eq!(again(&BoxTaps(64)), Ok(BoxTaps(64)));
        assert!(again(&BoxTaps(257)).is_err());
    }
}
