//! Blending and colour write masks.
//!
//! Unorm formats blend in integers. With 8-bit operands s, d and 8-bit factors
//! F, G (One = 255), the value before the operation's clamp is a single rounding
//! of the exact sum:
//!
//! * `Add`: `round(min(s·F + d·G, 255·255) / 255)`
//! * `Subtract`: `round(max(s·F − d·G, 0) / 255)`
//! * `ReverseSubtract`: `round(max(d·G − s·F, 0) / 255)`
//! * `Min`, `Max`: of s and d, without factors
//!
//! where `round(t / 255) = (t' + (t' >> 8)) >> 8`, `t' = t + 128`, exact for all
//! t in 0..=65025 (halves cannot occur, 255 being odd). With factors One this
//! is the plain saturating integer arithmetic of the peers.

/// Multiplier of a blend operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs, reason = "WebGPU's names are the definition")]
pub enum BlendFactor {
    Zero,
    One,
    Src,
    OneMinusSrc,
    SrcAlpha,
    OneMinusSrcAlpha,
    Dst,
    OneMinusDst,
    DstAlpha,
    OneMinusDstAlpha,
    SrcAlphaSaturated,
    Constant,
    OneMinusConstant,
}

impl BlendFactor {
    /// All of them.
    pub const ALL: [Self; 13] = [
        Self::Zero,
        Self::One,
        Self::Src,
        Self::OneMinusSrc,
        Self::SrcAlpha,
        Self::OneMinusSrcAlpha,
        Self::Dst,
        Self::OneMinusDst,
        Self::DstAlpha,
        Self::OneMinusDstAlpha,
        Self::SrcAlphaSaturated,
        Self::Constant,
        Self::OneMinusConstant,
    ];

    /// Whether the factor's value depends on the destination.
    #[must_use]
    pub fn reads_dst(self) -> bool {
        matches!(
            self,
            Self::Dst
                | Self::OneMinusDst
                | Self::DstAlpha
                | Self::OneMinusDstAlpha
                | Self::SrcAlphaSaturated
        )
    }
}

/// How the two weighted operands combine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BlendOperation {
    /// src·F + dst·G.
    Add,
    /// src·F − dst·G.
    Subtract,
    /// dst·G − src·F.
    ReverseSubtract,
    /// min(src, dst); factors are ignored.
    Min,
    /// max(src, dst); factors are ignored.
    Max,
}

impl BlendOperation {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Add,
        Self::Subtract,
        Self::ReverseSubtract,
        Self::Min,
        Self::Max,
    ];
}

/// Blending of the colour channels, or of alpha.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BlendComponent {
    /// F, the source's factor.
    pub src_factor: BlendFactor,
    /// G, the destination's factor.
    pub dst_factor: BlendFactor,
    /// The operation.
    pub operation: BlendOperation,
}

impl BlendComponent {
    /// The source replaces the destination.
    pub const REPLACE: Self = Self {
        src_factor: BlendFactor::One,
        dst_factor: BlendFactor::Zero,
        operation: BlendOperation::Add,
    };

    /// Plain sum.
    pub const ADD: Self = Self {
        src_factor: BlendFactor::One,
        dst_factor: BlendFactor::One,
        operation: BlendOperation::Add,
    };
}

impl BlendComponent {
    /// The operation takes an operand as it is, whatever the factors.
    #[inline(always)]
    pub(crate) fn is_extreme(&self) -> bool {
        matches!(self.operation, BlendOperation::Min | BlendOperation::Max)
    }

    /// No operand is changed by its factor.
    #[inline(always)]
    pub(crate) fn is_plain(&self) -> bool {
        let ones = self.src_factor == BlendFactor::One && self.dst_factor == BlendFactor::One;
        self.is_extreme() || ones
    }
}

/// Blending of one colour attachment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BlendState {
    /// Red, green, blue.
    pub color: BlendComponent,
    /// Alpha.
    pub alpha: BlendComponent,
}

impl BlendState {
    /// The operation, where it is the same for all channels and needs no factors.
    #[inline(always)]
    pub(crate) fn bytewise(&self) -> Option<BlendOperation> {
        let plain = self.color.is_plain() && self.alpha.is_plain();
        (plain && self.color.operation == self.alpha.operation).then_some(self.color.operation)
    }

    /// What applies to channel `c` (3 is alpha).
    #[inline(always)]
    pub(crate) fn component(&self, c: usize) -> &BlendComponent {
        if c < 3 { &self.color } else { &self.alpha }
    }

    /// dst + src, saturating.
    pub const ADDITIVE: Self = Self {
        color: BlendComponent::ADD,
        alpha: BlendComponent::ADD,
    };

    /// dst − src, saturating.
    pub const SUBTRACTIVE: Self = {
        let c = BlendComponent {
            operation: BlendOperation::ReverseSubtract,
            ..BlendComponent::ADD
        };
        Self { color: c, alpha: c }
    };

    /// min(dst, src).
    pub const MIN: Self = {
        let c = BlendComponent {
            operation: BlendOperation::Min,
            ..BlendComponent::ADD
        };
        Self { color: c, alpha: c }
    };

    /// Non-premultiplied "over".
    pub const ALPHA: Self = Self {
        color: BlendComponent {
            src_factor: BlendFactor::SrcAlpha,
            dst_factor: BlendFactor::OneMinusSrcAlpha,
            operation: BlendOperation::Add,
        },
        alpha: BlendComponent {
            src_factor: BlendFactor::One,
            dst_factor: BlendFactor::OneMinusSrcAlpha,
            operation: BlendOperation::Add,
        },
    };
}

/// Which channels may be written: bit 0 red … bit 3 alpha.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ColorWrites(pub u8);

impl ColorWrites {
    /// No channel.
    pub const NONE: Self = Self(0);
    /// All four.
    pub const ALL: Self = Self(0xf);

    /// Whether channel `c` (0 = red) may be written.
    #[must_use]
    pub fn contains(self, c: usize) -> bool {
        self.0 >> c & 1 != 0
    }
}

/// State of one colour attachment in a render pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ColorTargetState {
    /// `None`: the source replaces the destination.
    pub blend: Option<BlendState>,
    /// Channels that may be written.
    pub write_mask: ColorWrites,
}

impl ColorTargetState {
    /// Writes every channel without blending.
    pub const OPAQUE: Self = Self {
        blend: None,
        write_mask: ColorWrites::ALL,
    };
    /// Adds to every channel.
    pub const ADDITIVE: Self = Self {
        blend: Some(BlendState::ADDITIVE),
        write_mask: ColorWrites::ALL,
    };
    /// Writes nothing.
    pub const NONE: Self = Self {
        blend: None,
        write_mask: ColorWrites::NONE,
    };
}

impl Default for ColorTargetState {
    fn default() -> Self {
        Self::OPAQUE
    }
}
