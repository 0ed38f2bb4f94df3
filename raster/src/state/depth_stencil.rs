//! Depth, depth-bounds and two-sided stencil tests.

/// Comparison of an incoming (left) with a stored (right) value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs, reason = "the names are the definition")]
pub enum CompareFunction {
    Never,
    Less,
    Equal,
    LessEqual,
    Greater,
    NotEqual,
    GreaterEqual,
    Always,
}

impl CompareFunction {
    /// All eight, in Vulkan's order.
    pub const ALL: [Self; 8] = [
        Self::Never,
        Self::Less,
        Self::Equal,
        Self::LessEqual,
        Self::Greater,
        Self::NotEqual,
        Self::GreaterEqual,
        Self::Always,
    ];

    /// `incoming FUNC stored`.
    #[must_use]
    pub fn test<T: PartialOrd>(self, incoming: T, stored: T) -> bool {
        match self {
            Self::Never => false,
            Self::Less => incoming < stored,
            Self::Equal => incoming == stored,
            Self::LessEqual => incoming <= stored,
            Self::Greater => incoming > stored,
            Self::NotEqual => incoming != stored,
            Self::GreaterEqual => incoming >= stored,
            Self::Always => true,
        }
    }

    /// Whether the outcome depends on the stored value, so that it is read.
    #[must_use]
    pub fn reads_stored(self) -> bool {
        !matches!(self, Self::Never | Self::Always)
    }
}

/// What happens to the stored stencil value (Vulkan §29.6, `VkStencilOp`).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum StencilOperation {
    /// Leave it.
    Keep,
    /// Set to 0.
    Zero,
    /// Set to the reference value.
    Replace,
    /// Flip every bit.
    Invert,
    /// Add 1, staying at 255.
    IncrementClamp,
    /// Subtract 1, staying at 0.
    DecrementClamp,
    /// Add 1 modulo 256.
    IncrementWrap,
    /// Subtract 1 modulo 256.
    DecrementWrap,
}

impl StencilOperation {
    /// All eight.
    pub const ALL: [Self; 8] = [
        Self::Keep,
        Self::Zero,
        Self::Replace,
        Self::Invert,
        Self::IncrementClamp,
        Self::DecrementClamp,
        Self::IncrementWrap,
        Self::DecrementWrap,
    ];

    /// The new value before the write mask is applied.
    #[must_use]
    pub fn apply(self, stored: u8, reference: u8) -> u8 {
        match self {
            Self::Keep => stored,
            Self::Zero => 0,
            Self::Replace => reference,
            Self::Invert => !stored,
            Self::IncrementClamp => stored.saturating_add(1),
            Self::DecrementClamp => stored.saturating_sub(1),
            Self::IncrementWrap => stored.wrapping_add(1),
            Self::DecrementWrap => stored.wrapping_sub(1),
        }
    }

    /// Whether the new value depends on the stored one.
    #[must_use]
    pub fn reads_stored(self) -> bool {
        !matches!(self, Self::Keep | Self::Zero | Self::Replace)
    }
}

/// Stencil test and operations for the primitives of one facing.
///
/// The test is `(reference & read_mask) COMPARE (stored & read_mask)`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StencilFaceState {
    /// The test.
    pub compare: CompareFunction,
    /// Operation where the stencil test fails.
    pub fail_op: StencilOperation,
    /// Operation where the stencil test passes and the depth test fails ("z-fail").
    pub depth_fail_op: StencilOperation,
    /// Operation where both pass.
    pub pass_op: StencilOperation,
    /// Bits that take part in the test.
    pub read_mask: u8,
    /// Bits that may be written.
    pub write_mask: u8,
}

impl StencilFaceState {
    /// Always passes and writes nothing.
    pub const IGNORE: Self = Self {
        compare: CompareFunction::Always,
        fail_op: StencilOperation::Keep,
        depth_fail_op: StencilOperation::Keep,
        pass_op: StencilOperation::Keep,
        read_mask: 0xff,
        write_mask: 0xff,
    };

    /// Always passes and stores the reference where depth passes too.
    pub const REPLACE: Self = Self {
        pass_op: StencilOperation::Replace,
        ..Self::IGNORE
    };
    /// Passes where the reference is stored; writes nothing.
    pub const EQUAL: Self = Self {
        compare: CompareFunction::Equal,
        ..Self::IGNORE
    };

    /// Whether any operation can change a stored value.
    #[must_use]
    pub fn writes(&self) -> bool {
        self.write_mask != 0
            && [self.fail_op, self.depth_fail_op, self.pass_op]
                .iter()
                .any(|&o| o != StencilOperation::Keep)
    }
}

impl Default for StencilFaceState {
    fn default() -> Self {
        Self::IGNORE
    }
}

/// Two-sided stencil state; the reference value is part of the draw.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StencilState {
    /// For front-facing primitives, lines and points.
    pub front: StencilFaceState,
    /// For back-facing primitives.
    pub back: StencilFaceState,
}

impl StencilState {
    /// Whether the stage can be left out.
    #[must_use]
    pub fn is_disabled(&self) -> bool {
        let off = |f: &StencilFaceState| f.compare == CompareFunction::Always && !f.writes();
        off(&self.front) && off(&self.back)
    }
}

/// Depth offset: `constant·r + slope·max(|∂z/∂x|, |∂z/∂y|)`, limited to `clamp`
/// where that is not zero (Vulkan §28.10.3). `r` is 2⁻²⁴ for D24 and
/// 2^(e−23) for D32F, e being the exponent of the primitive's largest |z|.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DepthBias {
    /// Multiples of the format's smallest resolvable step.
    pub constant: f32,
    /// Multiples of the primitive's steepest slope.
    pub slope: f32,
    /// Largest (or, negative, smallest) offset; 0 for none.
    pub clamp: f32,
}

/// Depth test and write.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthState {
    /// `fragment COMPARE stored`.
    pub compare: CompareFunction,
    /// Store the fragment's depth where both tests pass.
    pub write: bool,
    /// Pass only where the *stored* depth lies in `[min, max]`.
    pub bounds: Option<[f32; 2]>,
}

impl DepthState {
    /// Always passes, writes nothing.
    pub const DISABLED: Self = Self {
        compare: CompareFunction::Always,
        write: false,
        bounds: None,
    };

    /// The ordinary opaque test, `Less` with writes.
    pub const LESS_WRITE: Self = Self {
        compare: CompareFunction::Less,
        write: true,
        bounds: None,
    };
}

impl Default for DepthState {
    fn default() -> Self {
        Self::DISABLED
    }
}

/// All of the depth-stencil stage.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DepthStencilState {
    /// Depth test.
    pub depth: DepthState,
    /// Stencil test.
    pub stencil: StencilState,
    /// Depth offset.
    pub bias: DepthBias,
}

impl DepthStencilState {
    /// Opaque geometry: depth `Less`, written; no stencil.
    #[must_use]
    pub fn opaque() -> Self {
        Self {
            depth: DepthState::LESS_WRITE,
            ..Self::default()
        }
    }

    /// A second pass over geometry that is already in the depth buffer, where
    /// the stencil equals the reference: the lit pass of shadow volumes.
    #[must_use]
    pub fn equal_where_stencil_matches() -> Self {
        let face = StencilFaceState {
            compare: CompareFunction::Equal,
            ..StencilFaceState::IGNORE
        };
        Self {
            depth: DepthState {
                compare: CompareFunction::Equal,
                write: false,
                bounds: None,
            },
            stencil: StencilState {
                front: face,
                back: face,
            },
            ..Self::default()
        }
    }

    /// Shadow volumes counted where they pass the depth test: front faces +1,
    /// back faces −1 (Heidmann; docs/papers.md, hard shadow volumes).
    #[must_use]
    pub fn z_pass_volumes() -> Self {
        let face = |op| StencilFaceState {
            pass_op: op,
            ..StencilFaceState::IGNORE
        };
        Self {
            depth: DepthState {
                compare: CompareFunction::Less,
                write: false,
                bounds: None,
            },
            stencil: StencilState {
                front: face(StencilOperation::IncrementWrap),
                back: face(StencilOperation::DecrementWrap),
            },
            ..Self::default()
        }
    }

    /// Shadow volumes counted where they fail the depth test: back faces +1,
    /// front faces −1 ("z-fail", Carmack's reverse; docs/papers.md, hard shadow volumes).
    #[must_use]
    pub fn z_fail_volumes() -> Self {
        let face = |op| StencilFaceState {
            depth_fail_op: op,
            ..StencilFaceState::IGNORE
        };
        Self {
            depth: DepthState {
                compare: CompareFunction::Less,
                write: false,
                bounds: None,
            },
            stencil: StencilState {
                front: face(StencilOperation::DecrementWrap),
                back: face(StencilOperation::IncrementWrap),
            },
            ..Self::default()
        }
    }
}
