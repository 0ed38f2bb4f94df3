//! A frame with parts of another one put into it.

use gnomon_raster::{CommandList, Error, Recording, RenderPass};

use super::align::Pair;
use super::facet::FACETS;
use super::state::{Alignment, Place, StateDifference, compare_states};

/// Two frames of the same textures, and what they differ in.
pub(super) struct Mixture<'a> {
    frames: [&'a Recording; 2],
    alignment: Alignment,
    pub(super) differences: Vec<StateDifference>,
}

/// Which of a draw's parts come from the second frame.
struct Chosen<'a> {
    differences: &'a [StateDifference],
    part: &'a [usize],
}

impl Chosen<'_> {
    fn has(&self, wanted: impl Fn(&StateDifference) -> bool) -> bool {
        self.part.iter().any(|i| wanted(&self.differences[*i]))
    }

    fn texture(&self, wanted: usize) -> bool {
        self.has(|d| matches!(d.place, Place::Texture { id, .. } if id == wanted))
    }

    fn pass(&self, wanted: [Option<usize>; 2]) -> bool {
        self.has(|d| matches!(&d.place, Place::Pass { numbers, .. } if *numbers == wanted))
    }

    fn pass_field(&self, wanted: [usize; 2], field: &str) -> bool {
        let wanted = wanted.map(Some);
        self.has(|d| {
            d.field == field
                && matches!(&d.place, Place::Pass { numbers, .. } if *numbers == wanted)
        })
    }

    fn draw(&self, pass: [usize; 2], draw: [Option<usize>; 2], field: &str) -> bool {
        self.has(|d| {
            let here = |p: &Place| matches!(p, Place::Draw { passes, numbers, .. } if *passes == pass && *numbers == draw);
            d.field == field && here(&d.place)
        })
    }
}

impl<'a> Mixture<'a> {
    pub(super) fn of(a: &'a Recording, b: &'a Recording) -> Self {
        Self {
            frames: [a, b],
            alignment: Alignment::of(a, b),
            differences: compare_states(a, b),
        }
    }

    /// The first frame, but for the differences of `part`, in which it is the second.
    pub(super) fn with(&self, part: &[usize]) -> Result<Recording, Error> {
        let chosen = Chosen {
            differences: &self.differences,
            part,
        };
        let mut mixed = Recording::default();
        for (id, texture) in self.frames[0].textures().iter().enumerate() {
            let made = mixed.create(texture.descriptor())?;
            let from = &self.frames[usize::from(chosen.texture(id))].textures()[id];
            for (image, bytes) in from.contents() {
                mixed.write_packed(made, image, bytes.clone())?;
            }
        }
        let passes = self.alignment.passes.iter();
        let passes = passes.filter_map(|(pair, draws)| self.pass(&chosen, *pair, draws));
        mixed.list = CommandList {
            passes: passes.collect(),
        };
        for (name, id) in self.frames[0].outputs() {
            mixed.name_output(name, id)?;
        }
        Ok(mixed)
    }

    fn pass(&self, chosen: &Chosen<'_>, pair: Pair, draws: &[Pair]) -> Option<RenderPass> {
        let [a, b] = self.frames.map(|f| &f.list.passes);
        match pair {
            Pair::First(i) => (!chosen.pass([Some(i), None])).then(|| a[i].clone()),
            Pair::Second(j) => chosen.pass([None, Some(j)]).then(|| b[j].clone()),
            Pair::Both(i, j) => Some(mixed_pass(chosen, [&a[i], &b[j]], [i, j], draws)),
        }
    }
}

fn mixed_pass(
    chosen: &Chosen<'_>,
    [a, b]: [&RenderPass; 2],
    numbers: [usize; 2],
    draws: &[Pair],
) -> RenderPass {
    let mut mixed = RenderPass {
        draws: Vec::new(),
        ..a.clone()
    };
    for (i, (to, from)) in mixed.color.iter_mut().zip(&b.color).enumerate() {
        if chosen.pass_field(numbers, &format!("color[{i}]")) {
            to.clone_from(from);
        }
    }
    if chosen.pass_field(numbers, "depth_stencil") {
        mixed.depth_stencil.clone_from(&b.depth_stencil);
    }
    for pair in draws {
        match *pair {
            Pair::First(k) if chosen.draw(numbers, [Some(k), None], "draw") => {}
            Pair::First(k) => mixed.draws.push(a.draws[k].clone()),
            Pair::Second(l) if chosen.draw(numbers, [None, Some(l)], "draw") => {
                mixed.draws.push(b.draws[l].clone());
            }
            Pair::Second(_) => {}
            Pair::Both(k, l) => {
                let mut draw = a.draws[k].clone();
                let place = [Some(k), Some(l)];
                for facet in FACETS
                    .iter()
                    .filter(|f| chosen.draw(numbers, place, f.name))
                {
                    facet.put(&mut draw, &b.draws[l]);
                }
                mixed.draws.push(draw);
            }
        }
    }
    mixed
}
