//! The state of a worker, and the answers.

use crate::drawing::Drawing;
use crate::loaded::Loaded;
use crate::problem::Problem;
use crate::request::{Compile, Memory, Move, Request, ShotOf};
use crate::{Answer, pictures};
use gridel_core::format::limits::MAX_RAY_DEPTH;
use gridel_core::{Effects, Format, Scene as Checked, Settings, Structure};
use gridel_host::blob::Blob;
use gridel_host::compile::{Compiled, LATTICE_BITS, Names, Options, Supplied, compile};
use gridel_host::explain::{Shown, Subject, explain};
use gridel_host::measure::board::{BOARDS, Board, Fit, MemoryReport, Rendering, Target};
use gridel_host::scene::{self, Camera, Files, ImportOptions, Imported, Scene, shown_without};
use gridel_host::view::{State, saved, summary};
use serde_json::{Value, json};

/// Places for blobs: that of the picture, and that of the reference.
const SLOTS: usize = 2;

#[derive(Default)]
pub struct Session {
    files: Files,
    /// The scene that was read last, and the file's name.
    imported: Option<(String, Imported)>,
    loaded: [Option<Loaded>; SLOTS],
    drawing: Option<Drawing>,
}

impl Session {
    /// Answers a request.
    pub fn answer(&mut self, request: Request, bytes: &[u8]) -> Answer {
        match request {
            Request::About => Ok((about(), Vec::new())),
            Request::ClearFiles => {
                (self.files, self.imported) = (Files::new(), None);
                Ok((json!({}), Vec::new()))
            }
            Request::AddFile { path } => {
                self.files.insert(path, bytes.to_vec());
                self.imported = None;
                Ok((json!({}), Vec::new()))
            }
            Request::Compile(how) => self.compile(&how),
            Request::Load { slot, name } => self.load(slot, name.as_deref(), bytes),
            Request::Move(how) => self.moved(how),
            Request::Begin(begin) => {
                let shot = self.loaded(begin.shot.slot)?.shot(&begin.shot)?;
                self.drawing = Some(Drawing::new(begin.shot.slot, shot, begin.share));
                Ok((json!({}), Vec::new()))
            }
            Request::Step { blocks } => self.step(blocks),
            Request::Errors => pictures::errors(bytes),
            Request::Difference => pictures::difference(bytes),
            Request::HeatMap => pictures::heat_map(bytes),
            Request::Explain {
                shot,
                pixel,
                compile,
            } => self.explain(&shot, pixel, compile.as_ref()),
            Request::Memory(of) => self.memory(&of),
            Request::Png { width, height } => {
                pictures::png(self.loaded(0)?, [width, height], bytes)
            }
        }
    }

    fn loaded(&self, slot: usize) -> Result<&Loaded, Problem> {
        let loaded = self.loaded.get(slot).and_then(Option::as_ref);
        loaded.ok_or_else(|| Problem::fault("no scene is loaded"))
    }

    /// Returns the scene of a file, which is read unless it was read before.
    fn imported(&mut self, name: &str) -> Result<&Imported, Problem> {
        let (_, imported) = match self.imported.take() {
            Some(read) if read.0 == name => self.imported.insert(read),
            _ => {
                let options = ImportOptions::default();
                let read = scene::read_among(name.as_ref(), &self.files, &options);
                let imported = read.map_err(Problem::of)?;
                self.imported.insert((name.to_owned(), imported))
            }
        };
        Ok(imported)
    }

    /// The scene of a file, without the effects that are left out.
    fn scene(&mut self, how: &Compile) -> Result<Scene, Problem> {
        let mut scene = self.imported(&how.name)?.scene.clone();
        let without = how.without.iter();
        without.for_each(|effect| scene.remove_effects(effect.0));
        Ok(scene)
    }

    /// Compiles a scene file.
    fn compile(&mut self, how: &Compile) -> Answer {
        let Compiled { blob, report } = self.compiled(how)?;
        let imported = self.imported(&how.name)?;
        let mut warnings = imported.warnings.clone();
        let sentences = report.warnings(how.lattice_bits);
        warnings.extend(sentences.iter().map(|it| format!("{}: {it}", how.name)));
        // It depends on the camera, and the program places it by the camera that it is given.
        let mut supplied = report.supplied.iter();
        let has_own_light = !supplied.any(|it| matches!(it, Supplied::Light(_)));
        let answer = json!({"warnings": warnings, "hasOwnLight": has_own_light});
        Ok((answer, blob.bytes().to_vec()))
    }

    fn compiled(&mut self, how: &Compile) -> Result<Compiled, Problem> {
        let scene = self.scene(how)?;
        let options = Options {
            structures: vec![how.structure.0],
            lattice_bits: how.lattice_bits,
            names: true,
            ..Options::default()
        };
        let cannot = format!("{} cannot be compiled", how.name);
        compile(&scene, &options).map_err(|error| Problem::about(cannot, error))
    }

    fn load(&mut self, slot: usize, name: Option<&str>, bytes: &[u8]) -> Answer {
        let place = self.loaded.get_mut(slot);
        let place = place.ok_or_else(|| Problem::fault("no such place"))?;
        if self.drawing.as_ref().is_some_and(|it| it.slot == slot) {
            self.drawing = None;
        }
        // The blob before goes first: there may be no room for both.
        *place = None;
        let loaded = place.insert(Loaded::new(Blob::new(bytes), name)?);
        Ok((loaded.json(), Vec::new()))
    }

    fn moved(&self, how: Move) -> Answer {
        let scene = self.loaded(how.slot)?.scene();
        // Panning counts heights of the picture.
        let settings = Settings {
            width: 1,
            height: 1,
            ..Settings::of(scene)
        };
        let mut state = State::new(scene, Format::F32, Structure::List, settings);
        if let Some(camera) = how.camera {
            state = state.seen_from(camera.into());
        }
        let before = state.shot().view;
        if how.orbit != [0.0; 2] {
            state.orbit(how.orbit);
        }
        if how.pan != [0.0; 2] {
            state.pan(how.pan);
        }
        if how.zoom != 0.0 {
            state.zoom(how.zoom);
        }
        // At a limit the camera stays where it is.
        let moved = state.shot().view != before;
        let Camera {
            eye,
            target,
            up,
            fov_degrees,
        } = state.camera();
        let [e, t, u] = [eye, target, up].map(|it| it.to_array());
        let camera = [&e[..], &t, &u, &[*fov_degrees]].concat();
        Ok((
            json!({"camera": camera, "toml": saved(&state), "moved": moved}),
            Vec::new(),
        ))
    }

    fn step(&mut self, blocks: usize) -> Answer {
        let Some(drawing) = &mut self.drawing else {
            return Err(Problem::fault("no picture was begun"));
        };
        let loaded = self.loaded.get(drawing.slot).and_then(Option::as_ref);
        let loaded = loaded.ok_or_else(|| Problem::fault("no scene is loaded"))?;
        let words = drawing.step(loaded, blocks)?;
        let is_done = words.is_empty();
        if is_done {
            drawing.is_seen = true;
        }
        Ok((json!({"done": is_done, "seen": drawing.is_seen}), words))
    }

    fn explain(&mut self, of: &ShotOf, pixel: [u16; 2], file: Option<&Compile>) -> Answer {
        // A blob has no names of instances.
        let own = match file {
            Some(how) if how.without.is_empty() => {
                Some(Names::of_scene(&self.imported(&how.name)?.scene))
            }
            // Objects can go with an effect.
            Some(how) => Some(Names::of_scene(&self.scene(how)?)),
            None => None,
        };
        let loaded = self.loaded(of.slot)?;
        let shot = loaded.shot(of)?;
        let scene = loaded
            .scene()
            .with_view(&shot.view)
            .map_err(Problem::fault)?;
        let subject = Subject::Pixel(pixel);
        let explained = explain(&scene, shot.format, shot.structure, shot.settings, subject);
        let explanation = explained.map_err(Problem::of)?;
        let names = own.as_ref().unwrap_or(&loaded.names);
        let shown = Shown {
            explanation: &explanation,
            names,
            all_walks: false,
        };
        let summary = summary(&explanation, names);
        Ok((
            json!({"summary": summary, "text": shown.to_string()}),
            Vec::new(),
        ))
    }

    fn memory(&mut self, of: &Memory) -> Answer {
        let unknown = || Problem::fault(format!("there is no board `{}`", of.board));
        let board = Board::named(&of.board).ok_or_else(unknown)?;
        let target = Target {
            board,
            flash: board.flash,
            ram: board.ram,
        };
        let own = match &of.compile {
            Some(how) => Some(Loaded::new(self.compiled(how)?.blob, None)?),
            None => None,
        };
        let loaded = match &own {
            Some(own) => own,
            None => self.loaded(0)?,
        };
        let format = of.format.map_or_else(|| board.format(), |it| it.0);
        let scene = loaded.scene();
        let rendering = Rendering {
            format,
            structure: on_boards(scene, of.structure.0),
            width: scene.view().width,
        };
        let report = MemoryReport::of(scene, loaded.bytes(), &target, &rendering);
        let report = report.map_err(|error| Problem::new(error, &error.remedy()))?;
        let (fits, why) = match report.fit() {
            Fit::Fits => (true, String::new()),
            Fit::Short(why) | Fit::Undecided(why) => (false, why),
        };
        let text = report.to_string();
        Ok((
            json!({"report": report, "text": text, "fits": fits, "why": why}),
            Vec::new(),
        ))
    }
}

/// The structure of a scene on boards: the chosen one if it was measured there, else dual-split, else the best one.
fn on_boards(scene: &Checked<'_>, chosen: Structure) -> Structure {
    let is_measured = |it: &Structure| {
        MemoryReport::STRUCTURES.contains(it) && scene.structures().any(|held| held == *it)
    };
    let mut likely = [chosen, Structure::DualSplit]
        .into_iter()
        .chain(scene.structures());
    likely
        .find(is_measured)
        .unwrap_or_else(|| scene.best_structure())
}

/// Returns the choices.
fn about() -> Value {
    let boards: Vec<_> = BOARDS
        .iter()
        .map(|board| {
            let formats: Vec<_> = board.formats.iter().map(|it| it.name()).collect();
            json!({"name": board.name, "core": board.core, "formats": formats})
        })
        .collect();
    let effects: Vec<_> = Effects::NAMED
        .iter()
        .map(|(effect, name)| json!({"name": name, "without": shown_without(*effect)}))
        .collect();
    let structures: Vec<_> = Structure::ALL.iter().map(|it| it.name()).collect();
    let formats: Vec<_> = Format::ALL.iter().map(|it| it.name()).collect();
    let importers = scene::IMPORTERS.iter();
    let extensions: Vec<_> = importers.flat_map(|it| it.extensions).collect();
    json!({
        "version": env!("CARGO_PKG_VERSION"),
        "formats": formats,
        "structures": structures,
        "effects": effects,
        "boards": boards,
        "boardStructures": MemoryReport::STRUCTURES.map(Structure::name),
        "extensions": extensions,
        "images": scene::IMAGE_EXTENSIONS,
        "maxDepth": MAX_RAY_DEPTH,
        "latticeBits": [LATTICE_BITS.start(), LATTICE_BITS.end()],
    })
}
