//! Every structure of this build, by name and as a type. [`structures!`] lists them.

#[cfg(feature = "all-structures")]
use crate::accel::cull::Culling;
#[cfg(feature = "all-structures")]
use crate::accel::number::Number;
use crate::accel::records::Records;
use crate::accel::space::Space;
#[cfg(feature = "all-structures")]
use crate::accel::stack::StackView;
use crate::accel::traverse::Traverse;
#[cfg(feature = "all-structures")]
use crate::format::Leaf;
use crate::format::structure::structures;
use crate::format::{BlobError, Sections, Structure};
#[cfg(feature = "all-structures")]
use crate::observe::count::Observer;
#[cfg(feature = "all-structures")]
use crate::ray::Ray;

/// A structure of this build, as a type: the code of those that are not named is not in the program.
pub trait Accel: Traverse {
    /// The structure's own records among those of a scene.
    fn views<'s, 'a>(views: &'s StructureViews<'a>) -> &'s Self::Views<'a>;
}

/// What is done with a structure that is chosen while the program runs: see [`Structure::visit`].
pub trait StructureVisitor {
    /// What comes of it.
    type Output;

    /// Does it with the structure `A`.
    fn visit<A: Accel>(self) -> Self::Output;
}

/// The structure that was chosen for a scene while the program runs, by [`Scene::choose`](crate::Scene::choose): what is
/// built around queries is compiled once for it, and not for every structure. Costs a branch and the
/// set-up of a culling form a query more than the structure itself.
#[cfg(feature = "all-structures")]
#[derive(Clone, Copy, Debug)]
pub enum DynAccel {}

#[cfg(feature = "all-structures")]
impl Accel for DynAccel {
    fn views<'s, 'a>(views: &'s StructureViews<'a>) -> &'s StructureViews<'a> {
        views
    }
}

macro_rules! registry {
    ($(
        $(#[doc = $doc:literal])*
        $variant:ident = $number:literal, $name:literal, $field:ident in $($module:ident)::+,
            if $feature:meta;
    )*) => {
        impl Structure {
            /// Hands the structure to a visitor as a type.
            #[cfg(feature = "all-structures")]
            pub fn visit<V: StructureVisitor>(self, visitor: V) -> V::Output {
                match self {
                    $(Structure::$variant => visitor.visit::<super::$variant>(),)*
                }
            }
        }

        #[cfg(feature = "all-structures")]
        impl Traverse for DynAccel {
            const STRUCTURE: Structure = Structure::List;
            const HAS_CLUSTERS: bool = cfg!(feature = "wide");
            // All walks are in each copy.
            const ONE_COPY: bool = true;
            type Cull<N: Number> = N::Cull;
            type Views<'a> = StructureViews<'a>;

            fn needs(space: &Space<'_>) -> Structure {
                space.chosen
            }

            fn walk<N: Number, C: Observer>(
                space: &Space<'_>,
                views: &StructureViews<'_>,
                ray: &Ray<N>,
                _: &N::Cull,
                stack: &mut StackView,
                count: &mut C,
                leaf: impl FnMut(Leaf, &mut C) -> Option<N>,
            ) {
                match space.chosen {
                    $(Structure::$variant => {
                        let cull = <super::$variant as Traverse>::Cull::<N>::new(ray);
                        super::$variant::walk(space, &views.$field, ray, &cull, stack, count, leaf);
                    })*
                }
            }
        }

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

            /// Whether a structure of the scene leads to the shared leaves. A structure whose code
            /// is not here is taken to.
            pub(crate) fn uses_leaves(space: &Space<'_>) -> bool {
                let uses = |structure| match structure {
                    $(
                        #[cfg($feature)]
                        Structure::$variant => <super::$($module)::+::Views<'a> as Records>::USES_LEAVES,
                    )*
                    #[cfg(not(feature = "all-structures"))]
                    _ => true,
                };
                Structure::ALL.into_iter().any(|it| space.holds(it) && uses(it))
            }

            /// Proves that primitives have records of their own where a structure leads to these.
            #[cfg(feature = "wide")]
            fn check_records(space: &Space<'a>) -> Result<(), BlobError> {
                let clusters = Structure::List.bit() | Structure::Wide.bit();
                if space.header.structures & !clusters == 0 {
                    return Ok(());
                }
                crate::accel::wide::check_records(space)
            }

            /// Proves every structure whose code is here. Returns the deepest stack that one needs,
            /// and whether all that the scene holds were proved.
            pub(crate) fn check(&self, space: &Space<'a>, sections: &Sections<'a>)
                -> Result<(usize, bool), BlobError>
            {
                let (mut depth, mut proved) = (0, 0);
                #[cfg(feature = "wide")]
                Self::check_records(space)?;
                $(
                    #[cfg($feature)]
                    {
                        proved |= Structure::$variant.bit();
                        depth = depth.max(check_one(
                            &self.$field, Structure::$variant, space, sections,
                        )?);
                    }
                )*
                Ok((depth, space.header.structures & !proved == 0))
            }
        }
    };
}

structures!(registry);

/// Proves one structure, or that the blob has no sections of it.
fn check_one<'a, R: Records<'a>>(
    records: &R,
    structure: Structure,
    space: &Space<'a>,
    sections: &Sections<'a>,
) -> Result<usize, BlobError> {
    if space.holds(structure) {
        return records.check(space);
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
