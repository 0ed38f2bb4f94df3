//! A thread that draws, so that keys are heard meanwhile.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use super::event::Event;
use super::look::Look;
use super::save;
use super::studio::Studio;

/// What the thread is told to do.
enum Order {
    Draw(Look),
    Tell(Look, [u32; 2]),
    Save(Look),
}

/// The thread. It is left alone when the viewer ends.
pub(super) struct Worker {
    orders: Sender<Order>,
    events: Receiver<Event>,
    thread: JoinHandle<()>,
}

impl Worker {
    /// Starts it.
    pub(super) fn start(studio: Arc<Studio>) -> std::io::Result<Self> {
        let (orders, waiting) = channel();
        let (done, events) = channel();
        let work = move || work(&studio, &waiting, &done);
        let thread = std::thread::Builder::new().name("view".to_owned());
        Ok(Self {
            orders,
            events,
            thread: thread.spawn(work)?,
        })
    }

    /// A frame is wanted, in place of those that were not begun.
    pub(super) fn draw(&self, look: Look) {
        // Where nobody is there to draw, `next` says so.
        let _ = self.orders.send(Order::Draw(look));
    }

    /// The history of a pixel is wanted.
    pub(super) fn tell(&self, look: Look, pixel: [u32; 2]) {
        let _ = self.orders.send(Order::Tell(look, pixel));
    }

    /// A frame is to be written, whatever is wanted later.
    pub(super) fn save(&self, look: Look) {
        let _ = self.orders.send(Order::Save(look));
    }

    /// What has been done since; `Err` where the thread is no more.
    pub(super) fn next(&self) -> Result<Option<Event>, ()> {
        match self.events.try_recv() {
            Ok(event) => Ok(Some(event)),
            Err(TryRecvError::Empty) => Ok(None),
            Err(TryRecvError::Disconnected) => Err(()),
        }
    }

    /// Waits for the end of a thread that panicked, which tells of it; not for long.
    pub(super) fn wait(&self, most: Duration) {
        let start = Instant::now();
        while !self.thread.is_finished() && start.elapsed() < most {
            std::thread::sleep(most / 100);
        }
    }
}

/// Does what is asked for, until nobody asks: of frames the last one, and of histories; all
/// that is to be written.
fn work(studio: &Studio, orders: &Receiver<Order>, done: &Sender<Event>) {
    while let Ok(first) = orders.recv() {
        let (mut frame, mut pixel, mut saves) = (None, None, Vec::new());
        for order in std::iter::once(first).chain(orders.try_iter()) {
            match order {
                Order::Draw(look) => frame = Some(look),
                Order::Tell(look, at) => pixel = Some((look, at)),
                Order::Save(look) => saves.push(look),
            }
        }
        let drawn = frame.map(|look| Event::Drawn {
            result: match studio.draw(&look) {
                Ok(drawn) => Ok(Box::new(drawn)),
                Err(why) => Err(why.to_string()),
            },
            look,
        });
        let told = pixel.map(|(look, at)| {
            Event::Told(studio.history(&look, at).map_err(|why| why.to_string()))
        });
        let saved = saves
            .iter()
            .map(|look| save::event(studio, studio.draw(look)));
        for event in drawn.into_iter().chain(told).chain(saved) {
            if done.send(event).is_err() {
                return;
            }
        }
    }
}
