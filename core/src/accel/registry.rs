//! Every structure of this build, by name and as a type. [`structures!`] lists them.

use crate::accel::records::Records;
use crate::accel::scene_geometry::SceneGeometry;
use crate::accel::traverse::Traverse;
#[cfg(all(feature = "bvh", feature = "triangle"))]
use crate::format::record::Pair;
use crate::format::structure::structures;
use crate::format::{BlobError, Sections, Structure};

/// A structure of this build, as a type. Structures that a program does not name are not in its code. Queries through
/// one need a blob that [holds](crate::Scene::holds) it.
#[diagnostic::on_unimplemented(
    message = "the code of the structure `{Self}` is not in this build",
    note = "enable the Cargo feature of gridel-core with the structure's name"
)]
pub trait Accel: Traverse {
    /// Returns the structure's own records among those of a scene.
    fn views<'s, 'a>(views: &'s StructureViews<'a>) -> &'s Self::Views<'a>;
}

/// Runs code for a structure that is chosen at run time: see [`Structure::visit`].
pub trait StructureVisitor {
    /// The result of the code.
    type Output;

    /// Runs the code for the structure `A`.
    fn visit<A: Accel>(self) -> Self::Output;
}

macro_rules! registry {
    ($(
        $(#[doc = $doc:literal])*
        $variant:ident = $number:literal, $name:literal, $field:ident in $($module:ident)::+,
            if $feature:meta;
    )*) => {
        $(
            #[cfg($feature)]
            impl Accel for super::$variant {
                #[inline(always)]
                fn views<'s, 'a>(views: &'s StructureViews<'a>) -> &'s Self::Views<'a> {
                    &views.$field
                }
            }
        )*

        /// The records of every structure of a scene.
        #[derive(Clone, Copy, Debug)]
        pub struct StructureViews<'a> {
            $(#[cfg($feature)] $field: super::$($module)::+::Views<'a>,)*
        }

        impl<'a> StructureViews<'a> {
            /// Finds the records.
            pub(crate) fn read(sections: &Sections<'a>) -> Result<Self, BlobError> {
                Ok(Self {
                    $(#[cfg($feature)] $field: Records::read(sections)?,)*
                })
            }

            /// Returns true if a structure of the scene uses the shared leaves. A structure without code in this build
            /// counts as using them if there are any.
            pub(crate) fn uses_leaves(geometry: &SceneGeometry<'_>) -> bool {
                let uses = |structure| match structure {
                    $(
                        #[cfg($feature)]
                        Structure::$variant => <super::$($module)::+::Views<'a> as Records>::USES_LEAVES,
                    )*
                    #[cfg(not(feature = "all-structures"))]
                    _ => !geometry.leaves.is_empty(),
                };
                Structure::ALL.into_iter().any(|it| geometry.holds(it) && uses(it))
            }

            /// Proves that primitives have records of their own where a structure leads to these.
            fn check_records(geometry: &SceneGeometry<'a>) -> Result<(), BlobError> {
                let clusters = Structure::List.bit() | Structure::Wide.bit();
                if geometry.header.structures & !clusters == 0 {
                    return Ok(());
                }
                crate::accel::wide::check_records(geometry)
            }

            /// Proves every structure whose code is here. Returns the deepest stack that one needs,
            /// and whether all that the scene holds were proved.
            pub(crate) fn check(&self, geometry: &SceneGeometry<'a>, sections: &Sections<'a>)
                -> Result<(usize, bool), BlobError>
            {
                let (mut depth, mut proved) = (0, 0);
                Self::check_records(geometry)?;
                $(
                    #[cfg($feature)]
                    {
                        proved |= Structure::$variant.bit();
                        depth = depth.max(check_one(
                            &self.$field, Structure::$variant, geometry, sections,
                        )?);
                    }
                )*
                Ok((depth, geometry.header.structures & !proved == 0))
            }
        }
    };
}

structures!(registry);

#[cfg(all(feature = "bvh", feature = "triangle"))]
impl<'a> StructureViews<'a> {
    /// The pairs of [`Bvh`](super::Bvh).
    pub(crate) fn pairs(&self) -> &'a [Pair] {
        self.bvh.0
    }

    /// Replaces the pairs of [`Bvh`](super::Bvh).
    pub(crate) fn replace_pairs(&mut self, pairs: &'a [Pair]) {
        self.bvh.0 = pairs;
    }
}

/// Proves one structure, or that the blob has no sections of it.
fn check_one<'a, R: Records<'a>>(
    records: &R,
    structure: Structure,
    geometry: &SceneGeometry<'a>,
    sections: &Sections<'a>,
) -> Result<usize, BlobError> {
    if geometry.holds(structure) {
        return records.check(geometry);
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
