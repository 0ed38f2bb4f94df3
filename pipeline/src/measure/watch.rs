//! Telling those who wait for a long frame which pass is drawn.
//!
//! Who listens is known to the thread that renders and to no interface: nothing else of a
//! frame changes by it, neither bits nor counters. Its passes are submitted one by one then,
//! so frames that are timed again and again are not watched while they are timed.

use std::cell::RefCell;
use std::rc::Rc;

use gnomon_raster::{CommandList, Error, Gpu, SubmitReport};

/// A pass that is about to be drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Upcoming<'a> {
    /// Its number.
    pub pass: usize,
    /// Passes of the frame.
    pub passes: usize,
    /// Its label; with several lights it says which.
    pub label: &'a str,
}

type Listener = Rc<dyn Fn(Upcoming<'_>)>;

thread_local! {
    static LISTENER: RefCell<Option<Listener>> = const { RefCell::new(None) };
}

/// Restores who listened before, also where `work` panics.
struct Before(Option<Listener>);

impl Drop for Before {
    fn drop(&mut self) {
        let before = self.0.take();
        LISTENER.with_borrow_mut(|listener| *listener = before);
    }
}

/// What `work` gives; `listen` is told of each pass that it renders on this thread, before it
/// is drawn.
///
/// ```
/// use gnomon_pipeline::measure::render::{RenderSettings, render};
/// use gnomon_pipeline::measure::watch::watched;
/// use gnomon_pipeline::{technique::Params, techniques, world::scene};
///
/// let scene = scene::open("cylinder")?;
/// let technique = techniques::find("shadow-volumes")?;
/// let settings = RenderSettings { size: [32, 24], ..RenderSettings::default() };
/// let listen = |next: gnomon_pipeline::measure::watch::Upcoming<'_>| {
///     eprintln!("{} of {}: {}", next.pass + 1, next.passes, next.label);
/// };
/// watched(listen, || render(&scene, technique, &Params::defaults(technique), &settings))?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn watched<T>(listen: impl Fn(Upcoming<'_>) + 'static, work: impl FnOnce() -> T) -> T {
    let listen: Listener = Rc::new(listen);
    let _before = Before(LISTENER.with_borrow_mut(|listener| listener.replace(listen)));
    work()
}

/// Submits `list`; pass by pass where somebody listens.
pub(super) fn submit(gpu: &mut Gpu, list: &CommandList) -> Result<SubmitReport, Error> {
    let Some(listen) = LISTENER.with_borrow(Clone::clone) else {
        return gpu.submit(list);
    };
    let mut report = SubmitReport::default();
    for (number, pass) in list.passes.iter().enumerate() {
        listen(Upcoming {
            pass: number,
            passes: list.passes.len(),
            label: &pass.label,
        });
        let alone = CommandList {
            passes: vec![pass.clone()],
        };
        report.passes.extend(gpu.submit(&alone)?.passes);
    }
    Ok(report)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::render::{RenderSettings, Rendered, render};
    use crate::technique::Params;
    use crate::techniques;
    use crate::world::scene::builtin;

    fn rendered(technique: &str, repeat: u32) -> Rendered {
        let scene = builtin::build("cylinder").unwrap();
        let technique = techniques::find(technique).unwrap();
        let settings = RenderSettings {
            size: [40, 30],
            repeat,
            ..RenderSettings::default()
        };
        render(&scene, technique, &Params::defaults(technique), &settings).unwrap()
    }

    fn watching(technique: &str, repeat: u32) -> (Rendered, Vec<(usize, usize, String)>) {
        let told = Rc::new(RefCell::new(Vec::new()));
        let heard = told.clone();
        let listen = move |next: Upcoming<'_>| {
            let all = (next.pass, next.passes, next.label.to_owned());
            heard.borrow_mut().push(all);
        };
        let done = watched(listen, || rendered(technique, repeat));
        (done, told.take())
    }

    #[test]
    fn every_pass_is_told_of_and_nothing_else_changes() {
        for technique in ["shadow-volumes", "pcss", "soft-shadow-volumes"] {
            let (done, told) = watching(technique, 1);
            let plain = rendered(technique, 1);
            assert_eq!(done.color_hash(), plain.color_hash());
            assert_eq!(done.visibility_hash(), plain.visibility_hash());
            let counters = |r: &Rendered| {
                let passes = r.report.passes.iter();
                passes.map(|p| (p.totals(), p.clear)).collect::<Vec<_>>()
            };
            assert_eq!(counters(&done), counters(&plain), "{technique}");
            let labels = plain.report.passes.iter().enumerate();
            let wanted: Vec<_> = labels
                .map(|(n, p)| (n, plain.report.passes.len(), p.label.clone()))
                .collect();
            assert_eq!(told, wanted, "{technique}");
        }
    }

    #[test]
    fn frames_that_are_timed_again_are_told_of_once() {
        let (_, once) = watching("shadow-volumes", 1);
        let (done, told) = watching("shadow-volumes", 3);
        assert_eq!((told, done.frames_ms.len()), (once, 3));
    }

    #[test]
    fn whoever_listened_before_does_so_again() {
        let outer = Rc::new(RefCell::new(0));
        let heard = outer.clone();
        let count = move |_: Upcoming<'_>| *heard.borrow_mut() += 1;
        watched(count, || {
            watching("shadow-volumes", 1);
            let panicked = std::panic::catch_unwind(|| watched(|_| (), || panic!("in work")));
            assert!(panicked.is_err());
            assert_eq!(*outer.borrow(), 0);
            rendered("shadow-volumes", 1);
            assert_eq!(*outer.borrow(), 3);
        });
        rendered("shadow-volumes", 1);
        assert_eq!(*outer.borrow(), 3);
    }
}
