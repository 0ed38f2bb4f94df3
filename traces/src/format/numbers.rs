//! Enums as numbers: a value's place in a list to which new ones are only appended.

use gnomon_raster::state::{
    BlendFactor, BlendOperation, CompareFunction, CullMode, FrontFace, PrimitiveTopology,
    StencilOperation,
};
use gnomon_raster::{AddressMode, FilterMode, Format, TextureDimension};

/// A value that is written as a number.
pub(crate) trait Numbered: Copy + PartialEq + 'static {
    /// What it is called in errors.
    const WHAT: &'static str;
    /// Number by number.
    const LIST: &'static [Self];

    /// Its number.
    fn number(self) -> u8 {
        let place = Self::LIST.iter().position(|v| *v == self);
        place.expect("a test holds lists complete") as u8
    }

    /// The value of a number.
    fn numbered(n: u8) -> Result<Self, String> {
        let found = Self::LIST.get(usize::from(n)).copied();
        found.ok_or_else(|| {
            let last = Self::LIST.len() - 1;
            format!("{} is {n}; valid is 0 to {last}", Self::WHAT)
        })
    }
}

macro_rules! numbered {
    ($($name:ident $what:literal: $list:expr;)+) => {
        $(impl Numbered for $name {
            const WHAT: &'static str = $what;
            const LIST: &'static [Self] = &$list;
        })+
    };
}
numbered! {
    Format "a format": Format::ALL;
    CompareFunction "a comparison": CompareFunction::ALL;
    StencilOperation "a stencil operation": StencilOperation::ALL;
    BlendFactor "a blend factor": BlendFactor::ALL;
    BlendOperation "a blend operation": BlendOperation::ALL;
    TextureDimension "a texture's dimension": [
        TextureDimension::D1, TextureDimension::D2, TextureDimension::D3, TextureDimension::Cube,
    ];
    PrimitiveTopology "a topology": [
        PrimitiveTopology::TriangleList, PrimitiveTopology::LineList, PrimitiveTopology::PointList,
    ];
    FrontFace "a front face": [FrontFace::Ccw, FrontFace::Cw];
    CullMode "a cull mode": [CullMode::None, CullMode::Front, CullMode::Back];
    AddressMode "an address mode": [
        AddressMode::ClampToEdge, AddressMode::ClampToBorder, AddressMode::Repeat,
        AddressMode::MirrorRepeat,
    ];
    FilterMode "a filter": [FilterMode::Nearest, FilterMode::Linear];
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers in files of the past mean what they meant.
    #[test]
    fn numbers_stay_what_they_are() {
        assert_eq!(Format::Rgba8Unorm.number(), 2);
        assert_eq!(Format::Depth32FloatStencil8.number(), 10);
        assert_eq!(CompareFunction::Always.number(), 7);
        assert_eq!(StencilOperation::DecrementWrap.number(), 7);
        assert_eq!(BlendFactor::OneMinusConstant.number(), 12);
        assert_eq!(BlendOperation::Max.number(), 4);
        assert_eq!(TextureDimension::Cube.number(), 3);
        assert_eq!(PrimitiveTopology::PointList.number(), 2);
        assert_eq!(AddressMode::MirrorRepeat.number(), 3);
        assert_eq!(CullMode::numbered(2), Ok(CullMode::Back));
        let refused = FilterMode::numbered(2).unwrap_err();
        assert_eq!(refused, "a filter is 2; valid is 0 to 1");
    }
}
