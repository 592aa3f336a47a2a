//! The structures there are: the one place that names them all.
//!
//! A structure is a file beside this one with its type, its records in the blob ([`Records`]) and a
//! line in the table below. Its code is a Cargo feature of the same name; sections of structures
//! that a build was compiled without are passed over.

use crate::accel::Accel;
#[cfg(feature = "all-structures")]
use crate::accel::cull::Culling;
#[cfg(feature = "all-structures")]
use crate::accel::{Leaf, StackView};
use crate::format::{BlobError, SectionKind, Sections};
#[cfg(feature = "all-structures")]
use crate::number::Number;
#[cfg(feature = "all-structures")]
use crate::observe::count::Count;
#[cfg(feature = "all-structures")]
use crate::ray::Ray;
use crate::scene::Scene;

/// What is done with a structure that is chosen while the program runs: see [`Structure::visit`].
pub trait StructureVisitor {
    /// What comes of it.
    type Output;

    /// Does it with the structure `A`.
    fn visit<A: Accel>(self) -> Self::Output;
}

/// The structure that was chosen for a scene while the program runs, by [`Scene::choose`]: what is
/// built around queries is compiled once for it, and not for every structure. Costs a branch and the
/// set-up of a culling form a query more than the structure itself.
#[cfg(feature = "all-structures")]
#[derive(Clone, Copy, Debug)]
pub enum Chosen {}

/// What a structure keeps in a blob, and the proof that it is sound.
pub(crate) trait Records<'a>: Copy {
    /// The sections that are this structure's alone.
    const SECTIONS: &'static [SectionKind];
    /// Whether the structure leads to the leaves that hierarchies share.
    const USES_LEAVES: bool;

    /// Finds the records.
    fn read(sections: &Sections<'a>) -> Result<Self, BlobError>;

    /// Proves all that a walk relies on, in linear time, and returns the entries that its stack
    /// needs. Everything else in the scene is proved already.
    fn check(&self, scene: &Scene<'a>) -> Result<usize, BlobError>;
}

macro_rules! structures {
    ($(
        $(#[doc = $doc:literal])*
        $variant:ident = $number:literal, $name:literal, $module:ident in $($family:ident)::+,
            if $feature:meta;
    )*) => {
        /// The name of a structure.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[repr(u32)]
        pub enum Structure {
            $($(#[doc = $doc])* $variant = $number,)*
        }

        impl Structure {
            /// All structures, compiled in or not.
            pub const ALL: [Structure; [$($number),*].len()] = [$(Structure::$variant),*];

            /// The name that command lines and tables use.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Structure::$variant => $name,)*
                }
            }

            /// Hands the structure to a visitor as a type.
            #[cfg(feature = "all-structures")]
            pub fn visit<V: StructureVisitor>(self, visitor: V) -> V::Output {
                match self {
                    $(Structure::$variant => visitor.visit::<super::$variant>(),)*
                }
            }
        }

        #[cfg(feature = "all-structures")]
        impl Accel for Chosen {
            const STRUCTURE: Structure = Structure::List;
            const HAS_CLUSTERS: bool = cfg!(feature = "wide");
            // All walks are in each copy.
            const ONE_COPY: bool = true;
            type Cull<N: Number> = N::Cull;

            fn needs(scene: &Scene<'_>) -> Structure {
                scene.chosen
            }

            fn walk<N: Number, C: Count>(
                scene: &Scene<'_>,
                ray: &Ray<N>,
                _: &N::Cull,
                stack: &mut StackView,
                count: &mut C,
                leaf: impl FnMut(Leaf, &mut C) -> Option<N>,
            ) {
                match scene.chosen {
                    $(Structure::$variant => {
                        let cull = <super::$variant as Accel>::Cull::<N>::new(ray);
                        super::$variant::walk(scene, ray, &cull, stack, count, leaf);
                    })*
                }
            }
        }

        /// The records of every structure in a scene.
        #[derive(Clone, Copy, Debug)]
        pub(crate) struct Held<'a> {
            $(#[cfg($feature)] pub(crate) $module: super::$($family)::+::Held<'a>,)*
        }

        impl<'a> Held<'a> {
            /// Finds the records.
            pub(crate) fn read(sections: &Sections<'a>) -> Result<Self, BlobError> {
                Ok(Self {
                    $(#[cfg($feature)] $module: Records::read(sections)?,)*
                })
            }

            /// Whether a structure of the scene leads to the shared leaves. A structure whose code
            /// is not here is taken to.
            pub(crate) fn uses_leaves(scene: &Scene<'_>) -> bool {
                let uses = |structure| match structure {
                    $(
                        #[cfg($feature)]
                        Structure::$variant => <super::$($family)::+::Held<'a> as Records>::USES_LEAVES,
                    )*
                    #[cfg(not(feature = "all-structures"))]
                    _ => true,
                };
                Structure::ALL.into_iter().any(|it| scene.holds(it) && uses(it))
            }

            /// Proves that primitives have records of their own where a structure leads to these.
            #[cfg(feature = "wide")]
            fn check_records(scene: &Scene<'a>) -> Result<(), BlobError> {
                let clusters = Structure::List.bit() | Structure::Wide.bit();
                if scene.header.structures & !clusters == 0 {
                    return Ok(());
                }
                crate::accel::wide::check_records(scene)
            }

            /// Proves every structure whose code is here. Returns the deepest stack that one needs,
            /// and whether all that the scene holds were proved.
            pub(crate) fn check(scene: &Scene<'a>, sections: &Sections<'a>)
                -> Result<(usize, bool), BlobError>
            {
                let (mut depth, mut proved) = (0, 0);
                #[cfg(feature = "wide")]
                Self::check_records(scene)?;
                $(
                    #[cfg($feature)]
                    {
                        proved |= Structure::$variant.bit();
                        depth = depth.max(check_one(
                            &scene.held.$module, Structure::$variant, scene, sections,
                        )?);
                    }
                )*
                Ok((depth, scene.header.structures & !proved == 0))
            }
        }
    };
}

structures! {
    /// Every primitive, one after the other.
    List = 0, "list", list in list, if all();
    /// A bounding volume hierarchy of pairs, 32 bytes each, traversed in the ordinary way.
    Bvh = 1, "bvh", bvh in hierarchy::bvh, if feature = "bvh";
    /// The same hierarchy without the sides that coincide with the parent's, 16 bytes a pair.
    Flagged = 2, "flagged", flagged in hierarchy::flagged, if feature = "flagged";
    /// A hierarchy of nodes with a split and at most two carves, 16 bytes each.
    DualSplit = 3, "dual-split", dual_split in hierarchy::dual_split, if feature = "dual-split";
    /// The paper's cylinder cube: for every pair of gridels what the cylinder between them meets.
    CylinderCube = 4, "cylinder-cube", cylinder_cube in candidates::cylinder_cube, if feature = "cylinder-cube";
    /// The cylinder cube with tight lists, sorted along the way from one gridel to the other.
    CylinderCubeTight = 5, "cylinder-cube-tight", cylinder_cube_tight in candidates::cylinder_cube_tight,
        if feature = "cylinder-cube-tight";
    /// Lists for the rays of the camera and of lights; other rays walk `bvh`.
    Apex = 6, "apex", apex in candidates::apex, if feature = "apex";
    /// The cylinder cube whose lists hold nodes of `bvh`, at which a ray enters it.
    CylinderCubeEntry = 7, "cylinder-cube-entry", cylinder_cube_entry in candidates::cylinder_cube_entry,
        if feature = "cylinder-cube-entry";
    /// Lists for classes of rays by origin and direction; rays without one walk `bvh`.
    RayClasses = 8, "ray-classes", ray_classes in candidates::ray_classes, if feature = "ray-classes";
    /// A hierarchy of eight children a node over strips of triangles and packs of spheres, for
    /// machines with SIMD registers.
    Wide = 9, "wide", wide in wide, if feature = "wide";
    /// A hierarchy of volumes between planes of 3, 7 or 13 directions, with all planes.
    Slabs = 10, "slabs", slabs in hierarchy::slabs, if feature = "slabs";
    /// The same hierarchy without the planes that coincide with the parent's.
    FlaggedSlabs = 11, "flagged-slabs", flagged_slabs in hierarchy::flagged_slabs, if feature = "flagged-slabs";
    /// A hierarchy of bounding spheres.
    Spheres = 12, "spheres", spheres in hierarchy::spheres, if feature = "spheres";
    /// A regular grid, walked cell by cell.
    Grid = 13, "grid", grid in cells::grid, if feature = "grid";
    /// An octree, walked on integer coordinates.
    Octree = 14, "octree", octree in cells::octree, if feature = "octree";
}

impl Structure {
    /// The structure's bit in the header.
    pub const fn bit(self) -> u32 {
        1 << self as u32
    }

    /// Whether loading a blob proves that this structure answers as the list does. That lists of
    /// candidates lack nothing cannot be seen in linear time: whoever compiled the blob answers for
    /// it. A walk through them ends all the same, and hits only what is there.
    pub const fn is_proved(self) -> bool {
        !matches!(
            self,
            Structure::CylinderCube
                | Structure::CylinderCubeTight
                | Structure::CylinderCubeEntry
                | Structure::Apex
                | Structure::RayClasses
        )
    }

    /// Proves that a scene holds this structure, to which another one leads.
    pub(super) fn needed_by(self, other: Self, scene: &Scene<'_>) -> Result<(), BlobError> {
        if scene.holds(self) {
            return Ok(());
        }
        Err(BlobError::MissingStructure {
            missing: self,
            needed_by: other,
        })
    }
}

/// Proves one structure, or that the blob has no sections of it.
fn check_one<'a, R: Records<'a>>(
    records: &R,
    structure: Structure,
    scene: &Scene<'a>,
    sections: &Sections<'a>,
) -> Result<usize, BlobError> {
    if scene.holds(structure) {
        return records.check(scene);
    }
    for &section in R::SECTIONS {
        let found = sections.len(section);
        if found > 0 {
            return Err(BlobError::Count {
                section,
                found,
                expected: 0,
            });
        }
    }
    Ok(0)
}
