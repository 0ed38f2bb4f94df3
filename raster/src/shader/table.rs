//! Shaders by name, to be made again from their identities.

use std::collections::BTreeMap;

use super::{
    FragmentShader, FragmentStage, Named, ShaderIdentity, UniformError, UniformReader, Uniforms,
    VertexShader, VertexStage,
};

/// All shaders of a program, by name: what makes a stage from a [`ShaderIdentity`].
#[derive(Clone, Default)]
pub struct ShaderTable {
    vertex: Entries<VertexStage>,
    fragment: Entries<FragmentStage>,
}

type Entries<S> = BTreeMap<&'static str, Entry<S>>;

struct Entry<S> {
    version: u32,
    build: fn(&[u8]) -> Result<S, UniformError>,
}

impl<S> Clone for Entry<S> {
    fn clone(&self) -> Self {
        Self { ..*self }
    }
}

/// Why a table has no such shader.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ShaderTableError {
    /// No shader of that name.
    #[error("no {stage} shader is called '{name}'; there are: {}", .known.join(", "))]
    Unknown {
        /// `vertex` or `fragment`.
        stage: &'static str,
        /// The name asked for.
        name: String,
        /// All names of that stage.
        known: Vec<&'static str>,
    },
    /// The shader has changed.
    #[error("{stage} shader '{name}' is version {known} here, version {given} was asked for")]
    Version {
        /// `vertex` or `fragment`.
        stage: &'static str,
        /// The shader.
        name: String,
        /// The version asked for.
        given: u32,
        /// The version of the table.
        known: u32,
    },
    /// The bytes are not its uniforms.
    #[error("uniforms of {stage} shader '{name}' {version}: {source}")]
    Uniforms {
        /// `vertex` or `fragment`.
        stage: &'static str,
        /// The shader.
        name: String,
        /// Its version.
        version: u32,
        /// What is wrong.
        source: UniformError,
    },
    /// Two shaders of one name.
    #[error("two {stage} shaders are called '{name}'; names must differ")]
    NameTaken {
        /// `vertex` or `fragment`.
        stage: &'static str,
        /// The name.
        name: &'static str,
    },
}

impl ShaderTable {
    /// Adds a vertex shader.
    ///
    /// # Errors
    /// There is one of its name.
    pub fn add_vertex<V>(&mut self) -> Result<(), ShaderTableError>
    where
        V: VertexShader + Uniforms + Named + 'static,
    {
        let build = |bytes: &[u8]| read(bytes).map(VertexStage::named::<V>);
        add::<V, _>(&mut self.vertex, "vertex", build)
    }

    /// Adds a fragment shader.
    ///
    /// # Errors
    /// There is one of its name.
    pub fn add_fragment<F>(&mut self) -> Result<(), ShaderTableError>
    where
        F: FragmentShader + Uniforms + Named + 'static,
    {
        let build = |bytes: &[u8]| read(bytes).map(FragmentStage::named::<F>);
        add::<F, _>(&mut self.fragment, "fragment", build)
    }

    /// The vertex shader of that identity.
    ///
    /// # Errors
    /// None of that name, another version, or bytes that are not its uniforms.
    pub fn vertex(&self, wanted: &ShaderIdentity) -> Result<VertexStage, ShaderTableError> {
        make(&self.vertex, "vertex", wanted)
    }

    /// The fragment shader of that identity.
    ///
    /// # Errors
    /// As [`Self::vertex`].
    pub fn fragment(&self, wanted: &ShaderIdentity) -> Result<FragmentStage, ShaderTableError> {
        make(&self.fragment, "fragment", wanted)
    }

    /// Names and versions of all vertex shaders, by name.
    pub fn vertex_shaders(&self) -> impl Iterator<Item = (&'static str, u32)> {
        self.vertex
            .iter()
            .map(|(name, entry)| (*name, entry.version))
    }

    /// Names and versions of all fragment shaders, by name.
    pub fn fragment_shaders(&self) -> impl Iterator<Item = (&'static str, u32)> {
        self.fragment
            .iter()
            .map(|(name, entry)| (*name, entry.version))
    }
}

fn add<N: Named, S>(
    entries: &mut Entries<S>,
    stage: &'static str,
    build: fn(&[u8]) -> Result<S, UniformError>,
) -> Result<(), ShaderTableError> {
    let name = N::NAME;
    if entries.contains_key(name) {
        return Err(ShaderTableError::NameTaken { stage, name });
    }
    let version = N::VERSION;
    entries.insert(name, Entry { version, build });
    Ok(())
}

fn make<S>(
    entries: &Entries<S>,
    stage: &'static str,
    wanted: &ShaderIdentity,
) -> Result<S, ShaderTableError> {
    let name = || wanted.name.clone();
    let Some(entry) = entries.get(wanted.name.as_str()) else {
        return Err(ShaderTableError::Unknown {
            stage,
            name: name(),
            known: entries.keys().copied().collect(),
        });
    };
    if entry.version != wanted.version {
        return Err(ShaderTableError::Version {
            stage,
            name: name(),
            given: wanted.version,
            known: entry.version,
        });
    }
    (entry.build)(&wanted.uniforms).map_err(|source| ShaderTableError::Uniforms {
        stage,
        name: name(),
        version: wanted.version,
        source,
    })
}

/// The value that all of `bytes` are.
fn read<T: Uniforms>(bytes: &[u8]) -> Result<T, UniformError> {
    let mut from = UniformReader::new(bytes);
    let value = T::take(&mut from)?;
    from.finish()?;
    Ok(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::{Fragment, FragmentOutputs, ScalarFragmentOutput, per_fragment};
    use crate::simd::{F32, Lanes};
    use crate::uniforms;

    struct Grey {
        level: f32,
    }

    impl FragmentShader for Grey {
        fn constant(&self) -> Option<[f32; 4]> {
            Some([self.level; 4])
        }

        #[inline(always)]
        fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
            f.set_color(0, [F32::splat(l, self.level); 4]);
        }
    }
    uniforms!(Grey { level });

    impl Named for Grey {
        const NAME: &'static str = "grey";
        const VERSION: u32 = 3;
    }

    fn table() -> ShaderTable {
        let mut table = ShaderTable::default();
        table.add_fragment::<Grey>().unwrap();
        table
    }

    #[test]
    fn a_shader_is_made_again() {
        let identity = FragmentStage::named(Grey { level: 0.25 }).identity();
        let again = table().fragment(&identity.clone().unwrap()).unwrap();
        assert_eq!(again.identity(), identity);
        assert_eq!(again.0.constant(), Some([0.25; 4]));
    }

    #[test]
    fn closures_and_unnamed_shaders_have_no_identity() {
        let closure = per_fragment(FragmentOutputs::default(), |_| {
            ScalarFragmentOutput::default()
        });
        let unnamed: FragmentStage = Grey { level: 0.0 }.into();
        assert!(closure.identity().is_none() && unnamed.identity().is_none());
    }

    #[test]
    fn what_the_table_does_not_have_is_said() {
        let known = FragmentStage::named(Grey { level: 0.25 })
            .identity()
            .unwrap();
        let refused = |change: fn(&mut ShaderIdentity)| {
            let mut wanted = known.clone();
            change(&mut wanted);
            table().fragment(&wanted).err().unwrap().to_string()
        };
        assert_eq!(
            refused(|i| i.name = "gray".into()),
            "no fragment shader is called 'gray'; there are: grey"
        );
        assert_eq!(
            refused(|i| i.version = 2),
            "fragment shader 'grey' is version 3 here, version 2 was asked for"
        );
        assert_eq!(
            refused(|i| i.uniforms.push(0)),
            "uniforms of fragment shader 'grey' 3: the uniforms end at byte 4, 1 bytes are left over"
        );
        assert_eq!(
            refused(|i| i.uniforms.truncate(1)),
            "uniforms of fragment shader 'grey' 3: 4 bytes are wanted at byte 0, 1 are left"
        );
        assert!(table().vertex(&known).is_err());
        let twice = table().add_fragment::<Grey>().unwrap_err();
        assert!(twice.to_string().contains("names must differ"));
    }
}
