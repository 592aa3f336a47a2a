//! Parts and instances: parts become blobs of their own, and placements become maps of integers.

mod tree;

use super::error::CompileError;
use super::motion::morph;
use super::motion::reach::Reach;
use super::requirements::Requirements;
use super::section::{Section, section};
use super::sizes::Sizes;
use crate::blob::Blob;
use crate::scene::{Image, Instance, Material, MorphTarget, Object, Part, Scene, Texture};
use crate::shape::{Lattice, exp2};
use crate::table::printable;
use glam::DVec3;
use gridel_core::Effects;
use gridel_core::format::instance::{LARGEST_CENTER, MATRIX_BITS};
use gridel_core::format::limits::{INSTANCE_EXPONENT, MAX_INSTANCES};
use gridel_core::format::record::{SECTION_ALIGNMENT, UnitBox};
use gridel_core::format::track::Joint;
use gridel_core::format::{SectionKind, instance};
use std::sync::Arc;
use tree::{Tree, build};

/// The least scale of instances, so that numbers keep their precision.
const LEAST_SCALE: f64 = 1e-250;

/// The purpose of a blob.
#[derive(Clone, Copy, Debug)]
pub enum Role<'p> {
    /// A blob to be loaded, with these parts in it.
    Whole(&'p Parts),
    /// A part of another blob, which knows its objects and materials.
    Part {
        /// Primitives of the scene and of all its parts.
        all: u64,
    },
}

/// The compiled parts of a scene.
#[derive(Debug, Default)]
pub struct Parts {
    blobs: Vec<Blob>,
    /// The largest displacement of each one's surfaces by the lattice.
    displacements: Vec<f64>,
    lattices: Vec<Lattice>,
    bounds: Vec<UnitBox>,
    /// The reach of the instances' motion.
    pub reach: Reach,
    /// For each object of all parts, its first primitive, counted from that of the first part.
    pub object_first: Vec<u32>,
    /// Parts with meshes whose vertices require effects, by name.
    pub requirements: Requirements,
    /// For each part, its first primitive, counted in the same way. The total follows.
    first_primitive: Vec<u32>,
    /// The bytes of their structures.
    pub sizes: Sizes,
}

/// Placed parts as a blob holds them.
#[derive(Debug, Default)]
pub struct CompiledInstances {
    records: Vec<instance::Instance>,
    /// The joint of each; empty where the scene has none.
    joints: Vec<u32>,
    tree: Tree,
    /// The box around all.
    bounds: Option<UnitBox>,
    /// The largest displacement of a surface by maps of integers, in scene units.
    pub displacement: f64,
}

impl Parts {
    /// Compiles all parts of a scene. `compile` returns a part's blob and the largest displacement of its surfaces, in
    /// the part's units of length.
    pub fn compile(
        scene: &Scene,
        mut compile: impl FnMut(&Scene) -> Result<(Blob, f64), CompileError>,
    ) -> Result<Self, CompileError> {
        let most = usize::from(u16::MAX);
        for (what, count, most) in [
            ("parts", scene.parts.len(), most),
            ("instances", scene.instances.len(), MAX_INSTANCES),
        ] {
            if count > most {
                return Err(CompileError::TooManyPlaced { what, count, most });
            }
        }
        let mut parts = Self::default();
        let targets = morph::with_tracks(scene);
        let mut primitives = 0_u32;
        parts.first_primitive.push(0);
        for part in &scene.parts {
            let (blob, displacement) =
                compile(&alone(part, scene, &targets)?).map_err(|error| match error {
                    CompileError::TooFar { .. } => CompileError::FarPart {
                        part: printable(&part.name),
                        source: error.into(),
                    },
                    error => error,
                })?;
            let header = *blob.header();
            parts.lattices.push(Lattice {
                bits: header.lattice_bits,
                unit_exponent: header.unit_exponent,
                origin: DVec3::from_array(header.origin),
            });
            for effect in [Effects::SMOOTH, Effects::VERTEX_COLORS] {
                if Effects(header.effects).contains(effect) {
                    let name = format!("part {}", printable(&part.name));
                    parts.requirements.add(effect, name, &part.place);
                }
            }
            parts.bounds.push(header.bounds);
            parts.blobs.push(blob);
            parts.displacements.push(displacement);
            for object in &part.objects {
                parts.object_first.push(primitives);
                primitives = primitives.saturating_add(object.shape.primitives() as u32);
            }
            parts.first_primitive.push(primitives);
        }
        let boxes = parts.lattices.iter().zip(&parts.bounds);
        let boxes = boxes.map(|(lattice, bounds)| {
            let corner = |side: usize| {
                let units = bounds.0.map(|axis| f64::from(axis[side]));
                lattice.origin + lattice.unit() * DVec3::from_array(units)
            };
            [corner(0), corner(1)]
        });
        parts.reach = Reach::of(scene, &boxes.collect::<Vec<_>>());
        Ok(parts)
    }

    /// Number of primitives of all parts.
    pub fn primitives(&self) -> u32 {
        self.first_primitive.last().copied().unwrap_or(0)
    }

    /// Entries of the traversal stack that the deepest part needs.
    pub fn stack_depth(&self) -> u16 {
        let depths = self.blobs.iter().map(|blob| blob.header().stack_depth);
        depths.max().unwrap_or(0)
    }

    /// Places all instances of a scene on its lattice; `None` where one reaches beyond it. Those of parts without
    /// primitives are left out: there is nothing of them.
    pub fn place(
        &self,
        scene: &Scene,
        lattice: &Lattice,
    ) -> Result<Option<CompiledInstances>, CompileError> {
        let mut records = Vec::with_capacity(scene.instances.len());
        let mut boxes = Vec::with_capacity(scene.instances.len());
        let mut displacement = 0_f64;
        let all = scene.instances.iter().zip(&self.reach.scales);
        let placed: Vec<_> = all.filter(|(it, _)| scene.is_placed(it)).collect();
        for &(instance, scales) in &placed {
            let part = &self.lattices[instance.part];
            let record = instance::Instance {
                number: records.len() as u32,
                ..self.map(instance, lattice, *scales)?
            };
            if !record.is_rotation() {
                return Err(CompileError::Instance {
                    instance: instance_name(instance),
                });
            }
            let Some(bounds) = record.around(&self.bounds[instance.part]) else {
                return Ok(None);
            };
            records.push(record);
            boxes.push(bounds);
            if self.is_point(instance.part) {
                continue;
            }
            // At rest or at a time of its tracks.
            let greatest = instance.placement.scale * scales[1].max(1.0);
            let reach = part.unit() * greatest * exp2(16);
            let rounded = lattice.unit() / 256.0 + reach * exp2(2 - MATRIX_BITS as i32);
            let moved = self.displacements[instance.part] * greatest;
            displacement = displacement.max(rounded + moved);
        }
        let tree = build(&boxes);
        let records = tree.order.iter().map(|&number| records[number as usize]);
        let joint = |&number: &u32| {
            let (instance, _) = placed[number as usize];
            let joint = instance.joint;
            joint.map_or(Joint::NONE, |joint| joint as u32)
        };
        let joints = tree.order.iter().filter(|_| !scene.joints.is_empty());
        Ok(Some(CompiledInstances {
            records: records.collect(),
            joints: joints.map(joint).collect(),
            tree,
            bounds: boxes.into_iter().reduce(|a, b| a.union(&b)),
            displacement,
        }))
    }

    /// Returns true if the lattice has left everything of a part out, so that no scale of it counts.
    fn is_point(&self, part: usize) -> bool {
        let UnitBox(bounds) = self.bounds[part];
        bounds.iter().all(|[low, high]| low == high)
    }

    /// The map of an instance without its number, given its least and its greatest scale relative to that at rest.
    fn map(
        &self,
        instance: &Instance,
        lattice: &Lattice,
        scales: [f64; 2],
    ) -> Result<instance::Instance, CompileError> {
        let part = &self.lattices[instance.part];
        let placement = &instance.placement;
        if placement.scale < LEAST_SCALE {
            return Err(CompileError::TinyInstance {
                instance: instance_name(instance),
                scale: placement.scale,
                least: LEAST_SCALE,
            });
        }
        let stretch = match self.is_point(instance.part) {
            true => 1.0,
            false => lattice.unit() / (placement.scale * part.unit()),
        };
        let exponent = libm::ceil(libm::log2(stretch)) as i64;
        let [least, most] = INSTANCE_EXPONENT;
        let [smallest, largest] = scales.map(libm::log2);
        let [lowest, highest] = [exponent as f64 - largest, exponent as f64 - smallest];
        if highest > most as f64 && exponent <= most {
            return Err(CompileError::ShrinkingInstance {
                instance: instance_name(instance),
                shrinks: scales[0],
                least: exp2((exponent - most) as i32),
            });
        }
        if highest > most as f64 {
            return Err(CompileError::SmallInstance {
                instance: instance_name(instance),
                size: lattice.unit() * exp2(16),
                scale: placement.scale,
                least: rounded_up(least_scale(stretch * placement.scale, smallest)),
            });
        }
        let large = |cause| CompileError::LargeInstance {
            instance: instance_name(instance),
            cause,
        };
        if lowest < least as f64 {
            return Err(large("is too large for its part's lattice"));
        }
        let factor = stretch * exp2(MATRIX_BITS as i32 - exponent as i32);
        // The columns of a rotation are the rows of its inverse.
        let rotation = glam::DMat3::from_quat(placement.rotation.normalize());
        let row = |column: DVec3| (column * factor).round().to_array().map(|x| x as i32);
        let middle = placement.point(part.origin);
        let center = (lattice.in_fine(middle)).round();
        if center.abs().max_element() > LARGEST_CENTER as f64 || !center.is_finite() {
            return Err(large("lies beyond the scene's lattice"));
        }
        Ok(instance::Instance {
            matrix: [
                row(rotation.x_axis),
                row(rotation.y_axis),
                row(rotation.z_axis),
            ],
            center: center.to_array().map(|x| x as i32),
            exponent: exponent as i16,
            part: instance.part as u16,
            number: 0,
        })
    }

    /// Returns the sections of parts, whose primitives come after the scene's own `own_primitives`.
    pub fn sections(&self, own_primitives: u32) -> Vec<Section> {
        let (mut start, mut words) = (0, Vec::new());
        let mut directory = Vec::with_capacity(self.blobs.len());
        for (blob, first) in self.blobs.iter().zip(&self.first_primitive) {
            words.extend_from_slice(blob.bytes());
            words.resize(words.len().next_multiple_of(SECTION_ALIGNMENT), 0);
            let end = (words.len() / SECTION_ALIGNMENT) as u32;
            directory.push(instance::Part {
                start,
                length: end - start,
                first_primitive: own_primitives + first,
                spare: 0,
            });
            start = end;
        }
        let blobs = Section {
            kind: SectionKind::PartBlobs,
            stride: SECTION_ALIGNMENT,
            bytes: words,
        };
        vec![section(SectionKind::Parts, &directory), blobs]
    }
}

impl CompiledInstances {
    /// Returns the sections of instances.
    pub fn sections(&self) -> Vec<Section> {
        vec![
            section(SectionKind::Instances, &self.records),
            section(SectionKind::InstancePairs, &self.tree.pairs),
            section(SectionKind::InstanceJoints, &self.joints),
        ]
    }

    /// Returns the box around a box and all instances; that of the instances alone without one.
    pub fn around(&self, own: Option<UnitBox>) -> Option<UnitBox> {
        own.into_iter()
            .chain(self.bounds)
            .reduce(|a, b| a.union(&b))
    }
}

/// A scene of a part's objects, in which all have one material and light comes from everywhere.
fn alone(part: &Part, scene: &Scene, morph_targets: &[MorphTarget]) -> Result<Scene, CompileError> {
    let unbounded = part.objects.iter().find(|it| !it.shape.is_bounded());
    if let Some(object) = unbounded {
        return Err(CompileError::UnboundedPart {
            object: format!("{} ({})", printable(&object.name), object.place),
            part: printable(&part.name),
        });
    }
    let plain = |object: &Object| {
        let texture = scene.materials[object.material].placing();
        Object {
            // A material that is on coordinates already has no transform.
            material: usize::from(texture.is_some()),
            attributes: object.attributes.placed_on(texture),
            ..object.clone()
        }
    };
    let mut materials = vec![Material::default()];
    let mut all = part.objects.iter();
    if all.any(|it| scene.materials[it.material].placing().is_some()) {
        materials.push(Material {
            texture: Some(Texture::of(Arc::new(Image::blank()))),
            ..Material::default()
        });
    }
    Ok(Scene {
        ambient: [1.0; 3],
        materials,
        objects: part.objects.iter().map(plain).collect(),
        morph_targets: morph_targets.to_vec(),
        ..Scene::default()
    })
}

/// The least scale at rest with which an instance fits: `stretch` is that of a scale of 1, and `smallest` the logarithm
/// of the least scale that its joints give it.
fn least_scale(stretch: f64, smallest: f64) -> f64 {
    let [_, most] = INSTANCE_EXPONENT;
    stretch * libm::exp2(-(most as f64 + smallest).floor())
}

/// A number with two digits that is not below another.
fn rounded_up(number: f64) -> f64 {
    let digit = libm::exp10(libm::floor(libm::log10(number)) - 1.0);
    let up = (number / digit).ceil();
    // The quotient may be rounded down.
    if up * digit >= number {
        up * digit
    } else {
        (up + 1.0) * digit
    }
}

fn instance_name(instance: &Instance) -> String {
    format!("{} ({})", printable(&instance.name), instance.place)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile::{Options, compile};
    use crate::scene::read;

    fn scene(file: &str) -> Scene {
        read("a.toml".as_ref(), file.into(), &Default::default())
            .unwrap()
            .scene
    }

    const PART: &str =
        "[[part]]\nname = 'p'\nobject = [{ kind = 'sphere', center = [0, 0, 0], radius = 1 }]\n";

    #[test]
    fn scales_that_no_lattice_holds_are_rejected_as_such() {
        let scene = scene(&format!("{PART}[[instance]]\npart = 'p'\nscale = 1e-310\n"));
        let error = compile(&scene, &Options::default()).unwrap_err();
        assert!(
            matches!(error, CompileError::TinyInstance { .. }),
            "{error}"
        );
    }

    #[test]
    fn error_of_a_small_instance_names_the_least_scale_that_works() {
        let with_scale = |scale: f64| {
            let instance = format!("[[instance]]\npart = 'p'\nscale = {scale:e}\n");
            let far = "[[object]]\nkind = 'sphere'\ncenter = [1000, 0, 0]\nradius = 300\n";
            compile(
                &scene(&format!("{far}{PART}{instance}")),
                &Options::default(),
            )
        };
        let error = with_scale(1e-9).unwrap_err();
        let CompileError::SmallInstance {
            size, scale, least, ..
        } = error
        else {
            panic!("{error}");
        };
        assert!(scale == 1e-9 && size >= 1300.0, "{size}");
        assert!(with_scale(least).is_ok(), "{least:e}");
        assert!(with_scale(0.9 * least).is_err(), "{least:e}");
        let help = miette::Diagnostic::help(&error).unwrap().to_string();
        assert!(help.contains(&format!("at least {least:.1e}")), "{help}");
    }

    #[test]
    fn displacements_are_those_of_the_largest_scale_of_a_track() {
        let displacement = |rest: f64, values: &str| {
            // The same lattice for all.
            let far = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1000\n";
            let part = "[[part]]\nname = 'p'\nobject = [{ kind = 'sphere', center = [0.1237, 0.0571, 0.0893], \
                        radius = 0.3337 }]\n";
            let scaled = format!(
                "{far}{part}[[instance]]\npart = 'p'\njoint = 'j'\nscale = {rest}\n[[joint]]\nname = 'j'\n\
                 [[track]]\ntarget = 'joint.j.scale'\ntimes = [0, 1]\nvalues = {values}\n"
            );
            let options = Options {
                lattice_bits: 12,
                ..Options::default()
            };
            compile(&scene(&scaled), &options)
                .unwrap()
                .report
                .largest_displacement
        };
        let still = displacement(1.0, "[1, 1]");
        let growing = displacement(1.0, "[1, 60]");
        assert!(growing > 10.0 * still, "{still:e} {growing:e}");
        let large = displacement(60.0, "[1, 1]");
        assert!(
            (growing - large).abs() < 0.1 * large,
            "{growing:e} {large:e}"
        );
        let shrinking = displacement(1.0, "[1, 0.5]");
        assert!(shrinking < 1.1 * still, "{still:e} {shrinking:e}");
    }

    #[test]
    fn too_many_parts_are_rejected_with_a_remedy() {
        let mut scene = scene(&format!("{PART}[[instance]]\npart = 'p'\n"));
        scene.parts[0].objects.clear();
        let part = scene.parts[0].clone();
        scene.parts.resize(65_536, part);
        let error = Parts::compile(&scene, |_| unreachable!()).unwrap_err();
        let help = miette::Diagnostic::help(&error).unwrap().to_string();
        assert!(help.contains("--instances flatten"), "{help}");
    }
}
