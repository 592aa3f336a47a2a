//! Pictures from coarse to fine, drawn by threads of their own.
//!
//! Threads take blocks in the core's order ([`CoarseToFine`]) and draw them. A new picture replaces the current one as
//! soon as the current one's coarsest blocks are all drawn. So a camera that moves all the time is seen moving. It also
//! replaces it after [`PATIENCE`], so that a slow scene keeps nobody waiting.

use super::blocks::{Brush, with_brush};
use super::frame::{Frame, packed};
use super::shot::{Shot, ViewError};
use gridel_core::render::{Block, CoarseToFine, Pixel};
use gridel_core::{Rgb888, Scene};
use std::ops::ControlFlow;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// Longest time for which coarse blocks may keep the next picture waiting.
const PATIENCE: Duration = Duration::from_millis(250);

/// Time that a thread draws before it delivers its pixels and looks for a newer picture.
const TURN: Duration = Duration::from_millis(2);

/// Draws pictures of a scene, one after the other, from coarse to fine.
pub struct Refiner<'s> {
    scene: &'s Scene<'s>,
    state: Mutex<Progress>,
    /// Signals that there is something to draw, or that drawing ends.
    changed: Condvar,
}

/// The progress of the drawing.
struct Progress {
    /// The picture that is drawn, and its number.
    shot: Option<Shot>,
    number: u64,
    begun: Instant,
    /// The order of the blocks that are not taken yet, and how many were taken and are not drawn.
    order: CoarseToFine,
    taken: usize,
    drawn: usize,
    /// Number of blocks of the coarsest size.
    coarsest: usize,
    frame: Frame,
    error: Option<ViewError>,
    /// The picture to draw next.
    next: Option<Shot>,
    /// True if the frame changed since it was last read.
    is_new: bool,
    stopped: bool,
}

/// The status that a front end shows with the frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Status {
    /// The share of pixels that are drawn, 0 to 1.
    pub share: f64,
    pub error: Option<ViewError>,
}

impl<'s> Refiner<'s> {
    /// Draws nothing yet.
    pub fn new(scene: &'s Scene<'s>) -> Self {
        Self {
            scene,
            state: Mutex::new(Progress {
                shot: None,
                number: 0,
                begun: Instant::now(),
                order: CoarseToFine::new([0, 0], [0, 0]),
                taken: 0,
                drawn: 0,
                coarsest: 0,
                frame: Frame::default(),
                error: None,
                next: None,
                is_new: false,
                stopped: false,
            }),
            changed: Condvar::new(),
        }
    }

    /// Draws with one thread for each core while `front` runs, and returns the result of `front`. Calls `wake` from any
    /// thread when there is a new frame, and not again before it was read.
    pub fn run<R>(&self, wake: &(dyn Fn() + Sync), front: impl FnOnce() -> R) -> R {
        let threads = thread::available_parallelism().map_or(1, usize::from);
        thread::scope(|scope| {
            for _ in 0..threads {
                scope.spawn(|| self.work(wake));
            }
            // Threads end even if the front end panics.
            let _stop = Stop(self);
            front()
        })
    }

    /// Requests a picture, in place of the one that is drawn and of any that waits.
    pub fn show(&self, shot: Shot) {
        self.lock().next = Some(shot);
        self.changed.notify_all();
    }

    /// Looks at the pixels so far.
    pub fn look<R>(&self, with: impl FnOnce(&Frame, &Status) -> R) -> R {
        let mut state = self.lock();
        state.is_new = false;
        let pixels = usize::from(state.frame.width) * usize::from(state.frame.height);
        let status = Status {
            share: state.drawn as f64 / pixels.max(1) as f64,
            error: state.error.clone(),
        };
        with(&state.frame, &status)
    }

    /// Waits until the last requested picture is complete, or cannot be.
    pub fn wait(&self) {
        let is_busy = |state: &mut Progress| state.next.is_some() || !state.is_done();
        let state = self.lock();
        drop(self.changed.wait_while(state, is_busy));
    }

    /// Takes part in the drawing until it ends.
    fn work(&self, wake: &(dyn Fn() + Sync)) {
        while let Some((number, shot)) = self.next_shot() {
            let Err(error) = self.draw(number, &shot, wake) else {
                continue;
            };
            let mut state = self.lock();
            if state.number == number {
                state.fail(error);
                state.is_new = true;
                self.changed.notify_all();
                drop(state);
                wake();
            }
        }
    }

    /// Waits for blocks that are not taken yet.
    fn next_shot(&self) -> Option<(u64, Shot)> {
        let mut state = self.lock();
        loop {
            if state.stopped {
                return None;
            }
            if state.is_superseded() {
                state.begin();
                self.changed.notify_all();
            }
            if let Some(shot) = state.shot.as_ref().filter(|_| state.order.side() > 0) {
                return Some((state.number, shot.clone()));
            }
            let woken = self.changed.wait(state);
            state = woken.unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Draws blocks until none is left or another picture is drawn.
    fn draw(&self, number: u64, shot: &Shot, wake: &(dyn Fn() + Sync)) -> Result<(), ViewError> {
        with_brush(self.scene, shot, |brush| self.paint(number, brush, wake))
    }

    fn paint(&self, number: u64, brush: &Brush<'_>, wake: &(dyn Fn() + Sync)) {
        let (mut blocks, mut values) = (Vec::new(), Vec::new());
        let mut size = 1;
        while self.take(number, size, &mut blocks).is_continue() {
            let begun = Instant::now();
            values.clear();
            values.extend(blocks.iter().map(|&block| {
                let drawn = brush(block);
                let color = || packed(Rgb888::encode(drawn.linear, None));
                drawn.work.unwrap_or_else(color)
            }));
            if begun.elapsed() < TURN / 2 {
                size *= 2;
            } else if begun.elapsed() > TURN {
                size = (size / 2).max(1);
            }
            self.put(number, &blocks, &values, wake);
        }
    }

    /// Takes blocks to draw.
    fn take(&self, number: u64, size: usize, blocks: &mut Vec<Block>) -> ControlFlow<()> {
        blocks.clear();
        let mut state = self.lock();
        if state.stopped || state.number != number || state.is_superseded() {
            return ControlFlow::Break(());
        }
        blocks.extend(state.order.by_ref().take(size));
        state.taken += blocks.len();
        match blocks.is_empty() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }

    /// Fills blocks, unless another picture is drawn by now.
    fn put(&self, number: u64, blocks: &[Block], values: &[u32], wake: &(dyn Fn() + Sync)) {
        let mut state = self.lock();
        if state.number != number {
            return;
        }
        for (&block, &value) in blocks.iter().zip(values) {
            state.frame.fill(block, value);
        }
        state.taken -= blocks.len();
        state.drawn += blocks.len();
        let was_new = std::mem::replace(&mut state.is_new, true);
        if state.is_done() {
            self.changed.notify_all();
        }
        drop(state);
        if !was_new {
            wake();
        }
    }

    fn lock(&self) -> MutexGuard<'_, Progress> {
        // A thread that panics while it holds the lock leaves at worst a block that is not filled.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Progress {
    /// Returns whether all blocks are drawn.
    fn is_done(&self) -> bool {
        self.order.side() == 0 && self.taken == 0
    }

    /// Returns whether the next picture may begin.
    fn is_superseded(&self) -> bool {
        let is_seen = self.drawn >= self.coarsest;
        self.next.is_some() && (is_seen || self.begun.elapsed() > PATIENCE)
    }

    /// Begins the next picture.
    fn begin(&mut self) {
        let Some(shot) = self.next.take() else { return };
        let size = [shot.settings.width, shot.settings.height];
        self.frame.prepare(size, shot.heat_map);
        self.order = CoarseToFine::new([0, 0], size);
        (self.taken, self.drawn) = (0, 0);
        let side = self.order.side().max(1);
        self.coarsest = size.map(|it| it.div_ceil(side).into()).iter().product();
        self.error = None;
        self.begun = Instant::now();
        self.number += 1;
        self.shot = Some(shot);
    }

    /// Gives the picture up.
    fn fail(&mut self, error: ViewError) {
        self.order = CoarseToFine::new([0, 0], [0, 0]);
        (self.taken, self.coarsest) = (0, 0);
        self.number += 1;
        self.error = Some(error);
    }
}

/// Ends the threads when it is dropped.
struct Stop<'r, 's>(&'r Refiner<'s>);

impl Drop for Stop<'_, '_> {
    fn drop(&mut self) {
        self.0.lock().stopped = true;
        self.0.changed.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::{Job, Picture, render};
    use crate::report::work_color;
    use crate::scene::Camera;
    use crate::view::test_scene::quick;
    use gridel_core::format::record::View;
    use gridel_core::render::RenderError;
    use gridel_core::{Format, Settings, Structure};
    use std::sync::atomic::{AtomicUsize, Ordering};

    fn shot(scene: &Scene<'_>, view: View) -> Shot {
        Shot {
            view,
            format: Format::F32,
            structure: Structure::DualSplit,
            settings: Settings {
                width: 45,
                height: 33,
                samples: 2,
                ..Settings::of(scene)
            },
            heat_map: false,
        }
    }

    /// The picture that `render` makes.
    fn rendered(scene: &Scene<'_>, shot: &Shot) -> Picture {
        let job = Job {
            count: shot.heat_map,
            ..Job::whole(shot.format, shot.structure, shot.settings)
        };
        render(&scene.with_view(&shot.view).unwrap(), &job, &|| ()).unwrap()
    }

    fn shown(refiner: &Refiner<'_>) -> Vec<u32> {
        refiner.look(|frame, status| {
            assert_eq!((status.share, &status.error), (1.0, &None));
            frame.colors().collect()
        })
    }

    #[test]
    fn frame_has_the_bytes_of_render() {
        let blob = quick();
        let scene = blob.scene().unwrap();
        let refiner = Refiner::new(&scene);
        let turned = Camera::of_blob(&scene).orbited(0.4, 0.2);
        let turned = turned.in_blob(&scene).unwrap();
        let wakes = AtomicUsize::new(0);
        let wake = || {
            wakes.fetch_add(1, Ordering::Relaxed);
        };
        refiner.run(&wake, || {
            let mut pictures = Vec::new();
            for view in [*scene.view(), turned] {
                for format in Format::ALL {
                    for structure in [Structure::DualSplit, Structure::Bvh] {
                        let shot = Shot {
                            format,
                            structure,
                            ..shot(&scene, view)
                        };
                        refiner.show(shot.clone());
                        refiner.wait();
                        let pixels = rendered(&scene, &shot).pixels;
                        let encode = |linear| packed(Rgb888::encode(linear, None));
                        let expected: Vec<u32> = pixels.into_iter().map(encode).collect();
                        assert!(shown(&refiner) == expected, "{format:?} {structure:?}");
                        pictures.push(expected);
                    }
                }
            }
            assert_ne!(pictures[0], pictures[6], "the camera moved");
        });
        assert!(wakes.into_inner() >= 12);
    }

    #[test]
    fn heat_map_has_the_colors_of_renders() {
        let blob = quick();
        let scene = blob.scene().unwrap();
        let refiner = Refiner::new(&scene);
        let shot = Shot {
            heat_map: true,
            ..shot(&scene, *scene.view())
        };
        let work = rendered(&scene, &shot).work;
        let maximum = work.iter().copied().max().unwrap();
        let color = |work| packed(work_color(work, maximum));
        let expected: Vec<u32> = work.into_iter().map(color).collect();
        refiner.run(&|| (), || {
            refiner.show(shot);
            refiner.wait();
            assert!(shown(&refiner) == expected);
        });
    }

    #[test]
    fn last_picture_asked_for_is_the_one_that_is_there() {
        let blob = quick();
        let scene = blob.scene().unwrap();
        let refiner = Refiner::new(&scene);
        let camera = Camera::of_blob(&scene);
        refiner.run(&|| (), || {
            let mut last = shot(&scene, *scene.view());
            for step in 0..200 {
                let turned = camera.orbited(f64::from(step) * 0.03, 0.1);
                last = shot(&scene, turned.in_blob(&scene).unwrap());
                last.settings.width = 40 + step % 7;
                refiner.show(last.clone());
                if step % 16 == 0 {
                    thread::sleep(Duration::from_millis(1));
                }
            }
            refiner.wait();
            let pixels = rendered(&scene, &last).pixels;
            let encode = |linear| packed(Rgb888::encode(linear, None));
            assert!(shown(&refiner) == pixels.into_iter().map(encode).collect::<Vec<_>>());
        });
    }

    #[test]
    fn picture_that_cannot_be_says_why_and_the_next_one_is_drawn() {
        let blob = quick();
        let scene = blob.scene().unwrap();
        let refiner = Refiner::new(&scene);
        refiner.run(&|| (), || {
            let wide = Shot {
                structure: Structure::Wide,
                ..shot(&scene, *scene.view())
            };
            refiner.show(wide);
            refiner.wait();
            let error = refiner.look(|_, status| status.error.clone());
            let expected = RenderError::Structure(Structure::Wide);
            assert_eq!(error, Some(ViewError::Render(expected)));
            refiner.show(shot(&scene, *scene.view()));
            refiner.wait();
            shown(&refiner);
        });
    }

    #[test]
    fn threads_end_while_a_picture_is_drawn() {
        let blob = quick();
        let scene = blob.scene().unwrap();
        let refiner = Refiner::new(&scene);
        let mut slow = shot(&scene, *scene.view());
        slow.settings = Settings {
            width: 4000,
            height: 4000,
            samples: 256,
            ..slow.settings
        };
        let begun = Instant::now();
        refiner.run(&|| (), || {
            refiner.show(slow);
            thread::sleep(Duration::from_millis(20));
        });
        assert!(begun.elapsed() < Duration::from_secs(20));
    }
}
