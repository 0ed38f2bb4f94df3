//! Values of accessors as f64, which holds all that glTF has.

use super::buffers::Buffers;
use super::error::{Checked, GltfProblem, element};
use super::schema::{Accessor, Root, Sparse, SparsePart};

/// Values of an accessor that has no bytes, being zeros and a few others, at most.
const MAX_WITHOUT_BYTES: u64 = 1 << 20;

/// The type of one number.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn of(code: u32) -> Option<Self> {
        Some(match code {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return None,
        })
    }

    fn bytes(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// The number of as many bytes.
    fn decode(self, b: &[u8], normalized: bool) -> f64 {
        let word = b
            .iter()
            .rev()
            .fold(0_u32, |word, b| word << 8 | u32::from(*b));
        let (value, most) = match self {
            Self::I8 => (f64::from(word as u8 as i8), 127.0),
            Self::U8 => (f64::from(word), 255.0),
            Self::I16 => (f64::from(word as u16 as i16), 32767.0),
            Self::U16 => (f64::from(word), 65535.0),
            Self::U32 => (f64::from(word), 4294967295.0),
            Self::F32 => return f64::from(f32::from_bits(word)),
        };
        if normalized {
            (value / most).max(-1.0)
        } else {
            value
        }
    }
}

/// How an accessor's values lie in bytes.
struct Form {
    component: Component,
    normalized: bool,
    /// Components of a value.
    width: usize,
}

impl Form {
    fn bytes(&self) -> u64 {
        (self.width * self.component.bytes()) as u64
    }
}

/// Values of accessor `index` with `N` components, whose `type` is `kind`; `place` asks for
/// them. At most `limit` of them.
pub(super) fn read<const N: usize>(
    root: &Root,
    buffers: &mut Buffers<'_>,
    index: usize,
    kind: &'static str,
    limit: u64,
    place: &str,
) -> Checked<Vec<[f64; N]>> {
    let accessor = element(&root.accessors, index, "accessors", place)?;
    let place = format!("accessors[{index}]");
    let component = form(accessor, kind, &place)?;
    let form = Form {
        component,
        normalized: accessor.normalized,
        width: N,
    };
    if accessor.count > limit {
        let what = "vertices or indices";
        return Err(GltfProblem::TooMuch { what, limit }.at(place));
    }
    let mut values = match accessor.buffer_view {
        Some(view) => {
            let (bytes, stride) = buffers.view(view, &place)?;
            let from = accessor.byte_offset;
            strided(bytes, from, stride, accessor.count, &form, &place)?
        }
        None => zeros(accessor, &place)?,
    };
    if let Some(sparse) = &accessor.sparse {
        overwrite(&mut values, buffers, sparse, &form, &place)?;
    }
    Ok(values)
}

fn form(accessor: &Accessor, kind: &'static str, place: &str) -> Checked<Component> {
    if accessor.kind != kind {
        let problem = GltfProblem::Bad {
            what: "type",
            value: format!("'{}'", crate::world::tally::beginning(&accessor.kind, 20)),
            valid: kind,
        };
        return Err(problem.at(place));
    }
    component(accessor.component_type, place)
}

fn component(code: u32, place: &str) -> Checked<Component> {
    Component::of(code).ok_or_else(|| {
        GltfProblem::Bad {
            what: "componentType",
            value: code.to_string(),
            valid: "5120 to 5123, 5125 or 5126",
        }
        .at(place)
    })
}

/// Values that no bytes hold.
fn zeros<const N: usize>(accessor: &Accessor, place: &str) -> Checked<Vec<[f64; N]>> {
    if accessor.sparse.is_none() {
        return Err(GltfProblem::Missing { what: "bufferView" }.at(place));
    }
    if accessor.count > MAX_WITHOUT_BYTES {
        let problem = GltfProblem::Bad {
            what: "count",
            value: accessor.count.to_string(),
            valid: "at most 1048576 without a bufferView",
        };
        return Err(problem.at(place));
    }
    Ok(vec![[0.0; N]; accessor.count as usize])
}

fn strided<const N: usize>(
    bytes: &[u8],
    from: u64,
    stride: Option<u64>,
    count: u64,
    form: &Form,
    place: &str,
) -> Checked<Vec<[f64; N]>> {
    let stride = stride.unwrap_or(form.bytes());
    let length = bytes.len() as u64;
    let last = count.saturating_sub(1).saturating_mul(stride);
    let end = from.saturating_add(last).saturating_add(form.bytes());
    if count > 0 && end > length {
        let of = "its bufferView";
        return Err(GltfProblem::TooShort { of, end, length }.at(place));
    }
    let size = form.component.bytes();
    let value = |k: u64| {
        let at = (from + k * stride) as usize;
        std::array::from_fn(|c| {
            let component = &bytes[at + c * size..][..size];
            form.component.decode(component, form.normalized)
        })
    };
    Ok((0..count).map(value).collect())
}

fn overwrite<const N: usize>(
    values: &mut [[f64; N]],
    buffers: &mut Buffers<'_>,
    sparse: &Sparse,
    form: &Form,
    place: &str,
) -> Checked<()> {
    let place = format!("{place}.sparse");
    if sparse.count > values.len() as u64 {
        let problem = GltfProblem::Bad {
            what: "count",
            value: sparse.count.to_string(),
            valid: "at most the accessor's own",
        };
        return Err(problem.at(place));
    }
    let index_form = Form {
        component: component(sparse.indices.component_type, &place)?,
        normalized: false,
        width: 1,
    };
    let count = sparse.count;
    let indices: Vec<[f64; 1]> = part(buffers, &sparse.indices, count, &index_form, &place)?;
    let others: Vec<[f64; N]> = part(buffers, &sparse.values, count, form, &place)?;
    for ([index], other) in indices.into_iter().zip(others) {
        let count = values.len();
        let slot = values.get_mut(index as usize).filter(|_| index >= 0.0);
        *slot.ok_or_else(|| {
            let (what, index) = ("values", index as usize);
            GltfProblem::NoSuch { what, index, count }.at(&place)
        })? = other;
    }
    Ok(())
}

fn part<const N: usize>(
    buffers: &mut Buffers<'_>,
    part: &SparsePart,
    count: u64,
    form: &Form,
    place: &str,
) -> Checked<Vec<[f64; N]>> {
    let (bytes, stride) = buffers.view(part.buffer_view, place)?;
    strided(bytes, part.byte_offset, stride, count, form, place)
}
