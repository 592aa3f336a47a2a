//! Compiles a scene into a blob: lattice, primitives, hierarchy, effects, bytes.
//!
//! | folder | what it holds |
//! |---|---|
//! | `geometry/` | the extent, the lattice, and shapes as primitives on it |
//! | `view/` | the camera, and integer coordinates |
//! | `shading/` | lights, materials, textures and the environment as records |
//! | `motion/` | tracks, joints and morph targets, and the room that they take |
//! | `instances/` | parts as blobs of their own, and where they are placed |
//! | `hierarchy/`, `wide/`, `cells/`, `candidates/` | the builders of a family of structures, as in `core/src/accel` |
//! | `structures/` | the sections of each structure |
//!
//! Files beside them hold what all steps share: options, checks, the report with its warnings, and sections up to
//! the bytes of the blob, which `writer.rs` writes.

mod advice;
mod candidates;
mod cells;
mod error;
mod geometry;
mod hierarchy;
mod instances;
mod motion;
mod names;
mod options;
mod references;
mod reflections;
mod report;
mod requirements;
mod section;
mod shading;
mod sizes;
mod structures;
mod view;
mod warnings;
mod wide;
mod writer;

pub use advice::MOST_COPIED;
pub use candidates::census::{Census, CubeCensus};
pub use candidates::lists::Figures;
pub use error::CompileError;
pub use geometry::lattice::BITS as LATTICE_BITS;
pub use geometry::primitives::LeftOut;
pub use hierarchy::builder::Builder;
pub use motion::morph::at_rest;
pub use names::{KeptNames, Names};
pub use options::{LARGEST_LEAF, OnProgress, Options};
pub use reflections::dim_reflections;
pub use report::Report;
pub use requirements::RequiringPart;
pub(crate) use shading::light_record;
pub use shading::{EnvironmentFigures, Shoulder, Supplied, TextureFigures, Unstated, radiance};
pub use structures::layout::TableStats;
pub use structures::{takes_hierarchy, usual_budget};
pub(crate) use view::camera::place;
pub use view::framing::{BACKGROUND, framing};
pub use wide::Quality;

pub use crate::scene::TICKS_PER_SECOND;

use crate::blob::Blob;
use crate::scene::{Object, Scene};
use crate::shape::Lattice;
use crate::table::printable;
use advice::{advice, may_copy};
use candidates::target::Targets;
use cells::octree;
use geometry::extent::Shapes;
use geometry::primitives::Primitives;
use glam::DVec3;
use gridel_core::Structure;
use gridel_core::format::Leaf;
use gridel_core::format::record::{Gridels, UnitBox};
use hierarchy::node::Primitive;
use hierarchy::pairs;
use hierarchy::sah::{self, Splits};
use instances::{CompiledInstances, Parts, Role};
use motion::room::Swept;
use motion::{joints, morph, room};
use requirements::Requirements;
use shading::{ShadingData, coordinate_step};
use sizes::Sizes;
use std::time::{Duration, Instant};
use structures::context::BuildContext;
use structures::hierarchies::Hierarchies;
use structures::lay_out;

/// A blob, and a report about its compilation.
#[derive(Clone, Debug)]
pub struct Compiled {
    pub blob: Blob,
    pub report: Report,
}

/// Compiles a scene.
///
/// A scene and its options give the same bytes on every machine and with any number of threads.
///
/// # Errors
/// If the scene does not fit a lattice, a count does not fit the format, or the blob is larger than
/// the options allow.
///
/// ```
/// # use gridel_host::compile::{Options, compile};
/// # let file = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'";
/// # let imported = gridel_host::scene::read("ball.toml".as_ref(), file.into(), &Default::default())?;
/// let compiled = compile(&imported.scene, &Options::default())?;
/// assert_eq!(compiled.report.bytes, compiled.blob.bytes().len());
/// assert!(compiled.report.largest_displacement < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn compile(scene: &Scene, options: &Options) -> Result<Compiled, CompileError> {
    compile_with_progress(scene, options, &|_, _, _| ())
}

/// Compiles a scene, and reports the progress of tables, which take long.
///
/// # Errors
/// As [`compile`].
///
/// ```
/// # let file = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'";
/// # let imported = gridel_host::scene::read("ball.toml".as_ref(), file.into(), &Default::default())?;
/// use gridel_core::Structure;
/// use gridel_host::compile::{Options, compile_with_progress};
///
/// let options = Options {
///     structures: vec![Structure::CylinderCube],
///     gridels: Some(4),
///     ..Options::default()
/// };
/// let compiled = compile_with_progress(&imported.scene, &options, &|structure, done, of| {
///     eprintln!("{}: {done} of {of} cells", structure.name());
/// })?;
/// assert!(compiled.blob.scene()?.holds(Structure::CylinderCube));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn compile_with_progress(
    scene: &Scene,
    options: &Options,
    on_progress: OnProgress<'_>,
) -> Result<Compiled, CompileError> {
    check(scene, options)?;
    let scene_warnings = warnings::scene_warnings(scene);
    let scene = &*scene.with_emitters();
    let has_targets = !scene.morph_targets.is_empty();
    let still = (has_targets && !morph::can_move(&options.structures)).then(|| at_rest(scene));
    let scene = still.as_deref().unwrap_or(scene);
    let (parts, reports) = compile_parts(scene, options, on_progress)?;
    let (mut compiled, _) = compile_as(Role::Whole(&parts), scene, options, on_progress)?;
    reports
        .iter()
        .for_each(|part| compiled.report.add_part(part));
    compiled.report.keeps_rest = still.is_some();
    compiled.report.scene_warnings = scene_warnings;
    Ok(compiled)
}

/// Compiles the parts of a scene.
fn compile_parts(
    scene: &Scene,
    options: &Options,
    on_progress: OnProgress<'_>,
) -> Result<(Parts, Vec<Report>), CompileError> {
    let of_parts = Options {
        names: false,
        max_bytes: None,
        ..options.clone()
    };
    let mut reports = Vec::new();
    let all = scene.all_objects().map(|it| it.shape.primitives());
    let role = Role::Part {
        all: all.sum::<usize>() as u64,
    };
    let mut sizes = Sizes::default();
    let mut parts = Parts::compile(scene, |part| {
        let (compiled, of_part) = compile_as(role, part, &of_parts, on_progress)?;
        let Compiled { blob, report } = compiled;
        let moved = report.largest_displacement;
        reports.push(report);
        sizes.add(&of_part);
        Ok((blob, moved))
    })?;
    parts.sizes = sizes;
    Ok((parts, reports))
}

fn compile_as(
    role: Role<'_>,
    scene: &Scene,
    options: &Options,
    on_progress: OnProgress<'_>,
) -> Result<(Compiled, Sizes), CompileError> {
    let shapes = Shapes::of(scene);
    let swept = morph::swept(scene);
    let extent = extent(role, &shapes, &swept, options);
    let (lattice, snapped, placed) = snap(role, scene, extent, options)?;
    let requirements = requirements(role, &snapped);
    let budget = options.texture_bytes;
    let shading = ShadingData::of(&shapes, &lattice, extent, requirements, budget)?;
    let structures = held(&options.structures);
    // WebAssembly without a system has no clock, and asking for the time would panic.
    let has_clock = !cfg!(all(target_family = "wasm", target_os = "unknown"));
    let started = has_clock.then(Instant::now);
    let hierarchies = Hierarchies::build(scene, &snapped, &structures, options)?;
    let order = &hierarchies.order;
    let space = (&lattice, shading.coordinates.step());
    let parts_with = |options: &Options| Ok(compile_parts(scene, options, &|_, _, _| ())?.0);
    let context = BuildContext {
        scene,
        lattice: &lattice,
        root: hierarchies.root.as_ref(),
        flat: &hierarchies.flat,
        wide: &hierarchies.wide,
        order,
        primitives: &snapped,
        bounds: bounds(role, order, &placed, &swept, space, options),
        shading: &shading,
        role,
        placed: &placed,
        parts_with: &parts_with,
        options,
        on_progress,
    };
    let layouts = structures.iter().map(|&it| lay_out(it, &context));
    let layouts = layouts.collect::<Result<Vec<_>, _>>()?;
    let setup = started.map_or(Duration::ZERO, |started| started.elapsed());
    let mut sizes = Sizes::of(&layouts, hierarchies.flat.leaves.len() * size_of::<Leaf>());
    if let Role::Whole(parts) = role {
        sizes.add(&parts.sizes);
    }
    let mut report = Report::of(&context, &layouts, setup);
    let mut contents = writer::contents(&context, layouts);
    if options.names && !scene.unnamed {
        report.names = contents.add_names(&Names::of_scene(scene), options.max_bytes);
    }
    // A table may fill what memory there is; all that it was built from makes room for the blob.
    drop(hierarchies);
    let blob = writer::write(contents)?;
    check_bytes(&blob, scene, options, &sizes)?;
    report.bytes = blob.bytes().len();
    Ok((Compiled { blob, report }, sizes))
}

/// Returns the extent of a scene, with the room of what moves.
fn extent(role: Role<'_>, shapes: &Shapes<'_>, swept: &Swept, options: &Options) -> (DVec3, DVec3) {
    let bits = options.lattice_bits;
    let extent = swept.extent(room::widened(shapes.extent(), options.room), bits);
    let Role::Whole(parts) = role else {
        return extent;
    };
    let step = |lattice: &_, corners| coordinate_step(shapes, lattice, corners);
    parts.reach.extent(extent, bits, step)
}

/// Returns the objects whose vertices require effects, those of parts included.
fn requirements(role: Role<'_>, snapped: &Primitives) -> Requirements {
    let mut requirements = snapped.requirements.clone();
    if let Role::Whole(parts) = role {
        requirements.extend(&parts.requirements);
    }
    requirements
}

/// Returns the box around all primitives and instances, wherever they move. `space` is the lattice, and the length of a
/// coordinate step.
fn bounds(
    role: Role<'_>,
    order: &[Primitive],
    placed: &CompiledInstances,
    swept: &Swept,
    space: (&Lattice, f64),
    options: &Options,
) -> UnitBox {
    let (lattice, step) = space;
    let own = room::around(order, options.room / lattice.unit());
    let own = own.into_iter().chain(swept.on_lattice(lattice));
    let own = own.reduce(|a, b| a.union(&b));
    let bounds = placed.around(own).unwrap_or(UnitBox([[0; 2]; 3]));
    let Role::Whole(parts) = role else {
        return bounds;
    };
    let bounds = parts.reach.around(bounds, lattice, step);
    // Where rays start in a part depends on its box, so that is the same through all structures.
    if !options.structures.contains(&Structure::Octree) {
        return bounds;
    }
    let boxes: Vec<_> = order.iter().map(|primitive| primitive.bounds).collect();
    octree::bounds(&bounds, &boxes)
}

/// Returns an error with advice if a scene's blob is larger than the options allow.
fn check_bytes(
    blob: &Blob,
    scene: &Scene,
    options: &Options,
    sizes: &Sizes,
) -> Result<(), CompileError> {
    let bytes = blob.bytes().len() as u64;
    let Some(most) = options.max_bytes.filter(|&most| bytes > most) else {
        return Ok(());
    };
    let bytes_of = |scene: &Scene, other: &Options| {
        let unnamed = Options {
            names: false,
            max_bytes: None,
            ..other.clone()
        };
        Some(compile(scene, &unnamed).ok()?.report.bytes)
    };
    let copied = may_copy(scene).then(|| scene.flattened().ok()).flatten();
    let as_copies = copied.and_then(|scene| bytes_of(&scene, options));
    let bytes_with = |other: &Options| bytes_of(scene, other);
    Err(CompileError::TooLarge {
        bytes,
        over: bytes - most,
        advice: advice(options, blob, sizes, &bytes_with, as_copies),
    })
}

/// Snaps a scene of some extent to the finest lattice that holds it once it is snapped.
fn snap(
    role: Role<'_>,
    scene: &Scene,
    (lowest, highest): (DVec3, DVec3),
    options: &Options,
) -> Result<(Lattice, Primitives, CompiledInstances), CompileError> {
    let mut coarser = 0;
    loop {
        let lattice = Lattice::around([lowest, highest], options.lattice_bits, coarser)?;
        let primitives = Primitives::snap(scene, &lattice, options.flat_meshes)?;
        let placed = match role {
            Role::Part { .. } => Some(CompiledInstances::default()),
            Role::Whole(parts) => parts.place(scene, &lattice)?,
        };
        if let Some(placed) = placed.filter(|_| !primitives.needs_room) {
            return Ok((lattice, primitives, placed));
        }
        // A power of two makes as much room as the scene takes; no surface is moved that far.
        coarser += 1;
    }
}

/// Checks that coordinates are finite, that references are valid, and that the lattice bits are in range.
fn check(scene: &Scene, options: &Options) -> Result<(), CompileError> {
    if !LATTICE_BITS.contains(&options.lattice_bits) {
        return Err(CompileError::LatticeBits {
            bits: options.lattice_bits,
        });
    }
    let room = options.room;
    if !(room.is_finite() && room >= 0.0) {
        return Err(CompileError::Room { room });
    }
    references::check(scene)?;
    let bad = |object: &&Object| !object.shape.is_finite();
    let is_valid = |part: usize| part < scene.parts.len();
    let mut instances = scene.instances.iter();
    if let Some(instance) = instances.find(|it| !is_valid(it.part) || !it.placement.is_valid()) {
        return Err(CompileError::Instance {
            instance: printable(&instance.name),
        });
    }
    joints::check(scene)?;
    if let Some(object) = scene.all_objects().find(bad) {
        return Err(CompileError::NotFinite {
            object: printable(&object.name),
        });
    }
    Ok(())
}

/// Returns the requested structures, and those that they need.
fn held(asked: &[Structure]) -> Vec<Structure> {
    let mut structures = asked.to_vec();
    structures.extend(asked.iter().filter_map(|&it| structures::leads_to(it)));
    structures.sort();
    structures.dedup();
    structures
}

/// Counts the size of a scene's cylinder cube, with a number of gridels per side (1 to 64); instances are flattened.
/// Builds nothing, so it takes time and no memory.
///
/// # Errors
/// If the scene does not fit a lattice, or its instances are too many to be flattened.
///
/// ```
/// # use gridel_host::compile::{Options, compile};
/// # let file = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'";
/// # let imported = gridel_host::scene::read("ball.toml".as_ref(), file.into(), &Default::default())?;
/// let census = gridel_host::compile::cube_census(&imported.scene, 4)?;
/// println!("{census:?}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn cube_census(scene: &Scene, gridels: u32) -> Result<CubeCensus, CompileError> {
    let scene = &*scene.flattened()?;
    let options = Options::default();
    let (_, snapped, _) = snap(
        Role::Part { all: 0 },
        scene,
        Shapes::of(scene).extent(),
        &options,
    )?;
    let mut order: Vec<Primitive> = snapped.boxes();
    let root = sah::build(&mut order, Splits::Swept, options.leaf_size);
    let flat = root.as_ref().map(|root| pairs::flatten(root, &order));
    let bounds = root.map_or(UnitBox([[0; 2]; 3]), |root| *root.bounds());
    let flat = flat.unwrap_or_default();
    let targets = Targets::new(&snapped, &flat, bounds);
    Ok(CubeCensus::of(&targets, gridels.clamp(1, Gridels::MOST)))
}
