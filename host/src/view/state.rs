//! The camera and the settings that are shown.

use super::keys::Action;
use super::notes::Notes;
use super::refine::Status;
use super::shot::Shot;
use crate::scene::{Camera, Lens};
use gridel_core::format::limits::MAX_SAMPLES;
use gridel_core::format::record::View;
use gridel_core::{Format, Scene, Settings, Structure};

/// Steps of an orbit by keys, to a whole turn.
const STEPS_OF_TURN: f64 = 48.0;

/// The factor of the distance for one step of a zoom.
const ZOOM: f64 = 0.8;

/// The nearest distance to the target, in multiples of the first camera's. The furthest is where coordinates end.
const NEAREST: f64 = 1e-4;

/// How often a part of a zoom is halved to come to the farthest place.
const HALVINGS: u32 = 16;

/// The view of a scene. Everything that changes it is a function without other effects.
pub struct State<'s> {
    scene: &'s Scene<'s>,
    camera: Camera,
    view: View,
    first_camera: Camera,
    format: Format,
    structure: Structure,
    settings: Settings,
    heat_map: bool,
    notes: Notes,
}

/// The remaining work after an action.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    Nothing,
    /// Draw [`State::shot`].
    Redraw,
    Save,
    Help,
    Quit,
}

impl<'s> State<'s> {
    /// Returns the scene as it is rendered with these settings.
    pub fn new(
        scene: &'s Scene<'s>,
        format: Format,
        structure: Structure,
        settings: Settings,
    ) -> Self {
        let camera = Camera::of_blob(scene);
        Self {
            scene,
            camera,
            view: *scene.view(),
            first_camera: camera,
            format,
            structure,
            settings,
            heat_map: false,
            notes: Notes::default(),
        }
    }

    /// Returns the view whose saved cameras have these notes.
    pub fn noting(mut self, notes: Notes) -> Self {
        self.notes = notes;
        self
    }

    /// Returns the scene from another camera, if that camera is valid.
    pub fn seen_from(mut self, camera: Camera) -> Self {
        self.moved(camera);
        self
    }

    /// Returns the picture to draw.
    pub fn shot(&self) -> Shot {
        Shot {
            view: self.view,
            format: self.format,
            structure: self.structure,
            settings: self.settings,
            heat_map: self.heat_map,
        }
    }

    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Returns the lens of all cameras; `None` for a pinhole.
    pub fn lens(&self) -> Option<Lens> {
        Lens::of_blob(self.scene)
    }

    pub fn notes(&self) -> &Notes {
        &self.notes
    }

    pub fn settings(&self) -> Settings {
        self.settings
    }

    /// Returns the settings that keys change, for a title or a line below the picture.
    pub fn description(&self) -> String {
        let samples = crate::table::counted(self.settings.samples.into(), "sample");
        let format = self.format.name();
        let structure = self.structure.name();
        let heat_map = if self.heat_map { ", heat map" } else { "" };
        format!("{format}, {structure}, {samples}{heat_map}")
    }

    /// Returns the line of a front end: the error, the message, or else the settings with the progress. When all is
    /// drawn, `hint` follows the settings.
    pub(super) fn status_line(&self, status: &Status, message: Option<&str>, hint: &str) -> String {
        let settings = self.description();
        match (&status.error, message) {
            (Some(error), _) => error.to_string(),
            (None, Some(message)) => message.to_owned(),
            (None, None) if status.share < 1.0 => {
                format!("{settings}, {:.0} %", 100.0 * status.share)
            }
            (None, None) => format!("{settings}{hint}"),
        }
    }

    /// Performs the action of a key.
    pub fn apply(&mut self, action: Action) -> Effect {
        match action {
            Action::Orbit(steps) => {
                let angle = std::f64::consts::TAU / STEPS_OF_TURN;
                self.orbit(steps.map(|steps| f64::from(steps) * angle))
            }
            Action::ZoomIn => self.zoom(1.0),
            Action::ZoomOut => self.zoom(-1.0),
            Action::Home => {
                self.camera = self.first_camera;
                self.view = *self.scene.view();
                Effect::Redraw
            }
            Action::NextFormat => {
                self.format = next(&Format::ALL, self.format);
                Effect::Redraw
            }
            Action::NextStructure => {
                let held: Vec<_> = self.scene.structures().collect();
                self.structure = next(&held, self.structure);
                Effect::Redraw
            }
            Action::MoreSamples => self.sample(self.settings.samples.saturating_mul(2)),
            Action::FewerSamples => self.sample(self.settings.samples / 2),
            Action::HeatMap => {
                self.heat_map = !self.heat_map;
                Effect::Redraw
            }
            Action::Save => Effect::Save,
            Action::Help => Effect::Help,
            Action::Quit => Effect::Quit,
        }
    }

    /// Turns the camera around its target, in radians: to the right of the scene, and upwards.
    pub fn orbit(&mut self, [right, up]: [f64; 2]) -> Effect {
        self.moved(self.camera.orbited(right, up))
    }

    /// Turns the camera as a mouse drags the scene, in pixels: by half a turn over the picture's height.
    pub fn drag(&mut self, by: [f64; 2]) -> Effect {
        let [right, down] = by.map(|pixels| std::f64::consts::PI * self.heights(pixels));
        self.orbit([-right, down])
    }

    /// Moves the camera so that the scene's middle follows a mouse, in pixels.
    pub fn pan(&mut self, by: [f64; 2]) -> Effect {
        let [right, down] = by.map(|pixels| self.heights(pixels));
        self.moved(self.camera.panned(-right, down))
    }

    /// Moves the camera nearer by a number of steps, or further away: as far as it can go.
    pub fn zoom(&mut self, steps: f64) -> Effect {
        let mut effect = Effect::Nothing;
        let (mut left, mut part) = (steps, steps);
        for _ in 0..HALVINGS {
            if left.abs() >= part.abs() && self.zoom_at_once(part) == Effect::Redraw {
                effect = Effect::Redraw;
                left -= part;
            }
            part /= 2.0;
        }
        effect
    }

    fn zoom_at_once(&mut self, steps: f64) -> Effect {
        let [first, now] = [self.first_camera, self.camera].map(|it| it.eye.distance(it.target));
        let wanted = (now * libm::pow(ZOOM, steps)).max(NEAREST * first);
        self.moved(self.camera.zoomed(wanted / now))
    }

    /// Shows a picture of another size.
    pub fn resize(&mut self, [width, height]: [u16; 2]) -> Effect {
        if [self.settings.width, self.settings.height] == [width, height] {
            return Effect::Nothing;
        }
        (self.settings.width, self.settings.height) = (width, height);
        Effect::Redraw
    }

    fn sample(&mut self, samples: u16) -> Effect {
        self.settings.samples = samples.clamp(1, MAX_SAMPLES);
        Effect::Redraw
    }

    /// Takes another camera, unless it is invalid for the scene.
    fn moved(&mut self, camera: Camera) -> Effect {
        if camera.is_along_up() {
            return Effect::Nothing;
        }
        // The bits of a saved camera, which has its target in focus.
        let placed = camera.focused(self.lens()).in_blob(self.scene);
        let Some(view) = placed
            .ok()
            .filter(|view| self.scene.with_view(view).is_ok())
        else {
            return Effect::Nothing;
        };
        (self.camera, self.view) = (camera, view);
        Effect::Redraw
    }

    fn heights(&self, pixels: f64) -> f64 {
        pixels / f64::from(self.settings.height.max(1))
    }
}

/// The value behind another one, from the last to the first.
fn next<T: Copy + PartialEq>(all: &[T], current: T) -> T {
    let place = all.iter().position(|it| *it == current);
    let after = place.map_or(0, |place| place + 1);
    all.get(after).or(all.first()).copied().unwrap_or(current)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::test_scene::quick;

    fn with_state(test: impl FnOnce(State<'_>)) {
        let blob = quick();
        let scene = blob.scene().unwrap();
        let settings = Settings::of(&scene);
        test(State::new(
            &scene,
            Format::F32,
            Structure::DualSplit,
            settings,
        ));
    }

    #[test]
    fn view_is_the_scenes_own_until_the_camera_moves_and_after_its_return() {
        with_state(|mut state| {
            let own = *state.scene.view();
            assert_eq!(state.shot().view, own);
            assert_eq!(state.apply(Action::Orbit([1, 0])), Effect::Redraw);
            assert_ne!(state.shot().view, own);
            let placed = state.camera().in_blob(state.scene).unwrap();
            assert_eq!(state.shot().view, placed);
            assert_eq!(state.apply(Action::Home), Effect::Redraw);
            assert_eq!(state.shot().view, own);
        });
    }

    #[test]
    fn keys_go_through_formats_structures_and_samples_and_come_back() {
        with_state(|mut state| {
            let first = state.shot();
            for format in ["f64", "fixed", "f32"] {
                state.apply(Action::NextFormat);
                assert!(state.description().starts_with(format), "{format}");
            }
            let held: Vec<_> = state.scene.structures().collect();
            for _ in 0..held.len() {
                state.apply(Action::NextStructure);
                assert!(held.contains(&state.shot().structure));
            }
            state.apply(Action::HeatMap);
            assert!(state.shot().heat_map && state.description().ends_with("heat map"));
            state.apply(Action::HeatMap);
            assert_eq!(state.shot(), first);
            for _ in 0..12 {
                state.apply(Action::FewerSamples);
            }
            assert_eq!(state.settings().samples, 1);
            for samples in [2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 4096] {
                state.apply(Action::MoreSamples);
                assert_eq!(state.settings().samples, samples);
            }
        });
    }

    #[test]
    fn zoom_stops_at_its_limits_and_comes_back() {
        with_state(|mut state| {
            let distance = |state: &State<'_>| state.camera.eye.distance(state.camera.target);
            let first = distance(&state);
            state.zoom(1.0);
            assert!((distance(&state) / first - ZOOM).abs() < 1e-12);
            state.zoom(1000.0);
            assert!((distance(&state) / first / NEAREST - 1.0).abs() < 1e-9);
            let steps = (0..1000).take_while(|_| state.zoom(-1.0) == Effect::Redraw);
            assert!(steps.count() < 100);
            let furthest = distance(&state);
            assert!(furthest > 2.0 * first && state.camera.in_blob(state.scene).is_ok());
            assert_eq!(state.zoom(1.0), Effect::Redraw);
            assert!(distance(&state) < furthest);
            // At once, too.
            state.apply(Action::Home);
            assert_eq!(state.zoom(-1000.0), Effect::Redraw);
            assert!((distance(&state) / furthest - 1.0).abs() < ZOOM.recip() - 1.0);
        });
    }

    #[test]
    fn drag_over_the_picture_turns_by_half_a_turn_and_pan_follows_the_mouse() {
        with_state(|mut state| {
            let first = state.camera;
            let height = f64::from(state.settings().height);
            state.drag([height, 0.0]);
            let turned = first.orbited(-std::f64::consts::PI, 0.0);
            assert!(state.camera.eye.distance(turned.eye) < 1e-9);
            state.apply(Action::Home);
            state.pan([height, 0.0]);
            let across = state.camera.target.distance(first.target);
            let seen = 2.0 * libm::tan((first.fov_degrees / 2.0).to_radians());
            let expected = seen * first.eye.distance(first.target);
            assert!((across / expected - 1.0).abs() < 1e-9);
            // To the right of the mouse, so the camera goes to the left.
            let right = (first.target - first.eye).cross(first.up);
            assert!((state.camera.eye - first.eye).dot(right) < 0.0);
        });
    }

    #[test]
    fn camera_beyond_the_scenes_coordinates_stays_where_it_was() {
        with_state(|mut state| {
            state.pan([1e15, 0.0]);
            assert_eq!(state.camera, state.first_camera);
            assert_eq!(state.shot().view, *state.scene.view());
        });
    }

    #[test]
    fn only_another_size_is_drawn_anew() {
        with_state(|mut state| {
            let Settings { width, height, .. } = state.settings();
            assert_eq!(state.resize([width, height]), Effect::Nothing);
            assert_eq!(state.resize([height, width]), Effect::Redraw);
            assert_eq!(state.settings().width, height);
        });
    }
}
