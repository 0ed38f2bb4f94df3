//! What can be wrong with a profile.

/// What is wrong with a profile, or with a frame under it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ProfileError {
    /// It is no TOML.
    #[error("{file}: {error}")]
    Syntax {
        /// The profile's file.
        file: String,
        /// What the parser says.
        error: String,
    },
    /// A value, or where it is from, is not valid.
    #[error("{file}: `{key}` is {given}; valid is {valid}")]
    Value {
        /// The profile's file.
        file: String,
        /// Table and key.
        key: String,
        /// What is there.
        given: String,
        /// What may be there.
        valid: String,
    },
    /// A key is missing.
    #[error("{file}: `{key}` is missing; valid is {valid}")]
    Missing {
        /// The profile's file.
        file: String,
        /// Table and key.
        key: String,
        /// What may be there.
        valid: String,
    },
    /// A key means nothing.
    #[error("{file}: `{key}` is unknown; valid are {valid}")]
    Unknown {
        /// The profile's file.
        file: String,
        /// Table and key.
        key: String,
        /// The keys that there are.
        valid: String,
    },
    /// There is no such profile.
    #[error("there is no profile `{name}`; valid are {valid}, or the path of a .toml file")]
    NoSuchProfile {
        /// What was asked for.
        name: String,
        /// What there is.
        valid: String,
    },
    /// The hardware cannot do what the frame does.
    #[error(
        "profile `{profile}`: draw `{draw}` of pass `{pass}` blends into {format}, which this \
         hardware cannot{}",
        if .format == "Rgba16Float" { "; use --set color-format=rgba8" } else { "" }
    )]
    Unsupported {
        /// The profile.
        profile: String,
        /// The pass's label.
        pass: String,
        /// The draw's label.
        draw: String,
        /// The format.
        format: String,
    },
}
