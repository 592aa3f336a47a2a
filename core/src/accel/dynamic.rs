//! Structures that are chosen while the program runs.

use crate::accel::cull::Culling;
use crate::accel::number::Number;
use crate::accel::registry::{Accel, StructureViews, StructureVisitor};
use crate::accel::scene_geometry::SceneGeometry;
use crate::accel::stack::StackView;
use crate::accel::traverse::Traverse;
use crate::format::structure::structures;
use crate::format::{Leaf, Structure};
use crate::observe::count::Observer;
use crate::ray::Ray;

/// A structure that a program chooses for a scene at run time, with [`Scene::choose`](crate::Scene::choose). Code
/// around queries is compiled once for it, and not for every structure. A query costs a branch and the set-up of a
/// culling form more than with the structure itself.
#[derive(Clone, Copy, Debug)]
pub enum DynAccel {}

impl Accel for DynAccel {
    fn views<'s, 'a>(views: &'s StructureViews<'a>) -> &'s StructureViews<'a> {
        views
    }
}

macro_rules! dynamic {
    ($(
        $(#[doc = $doc:literal])*
        $variant:ident = $number:literal, $name:literal, $field:ident in $($module:ident)::+,
            if $feature:meta;
    )*) => {
        impl Structure {
            /// Passes the structure to a visitor as a type.
            ///
            /// ```
            /// use gridel_core::accel::Accel;
            /// use gridel_core::{Structure, StructureVisitor};
            ///
            /// struct NameOfType;
            ///
            /// impl StructureVisitor for NameOfType {
            ///     type Output = &'static str;
            ///
            ///     fn visit<A: Accel>(self) -> &'static str {
            ///         std::any::type_name::<A>()
            ///     }
            /// }
            ///
            /// assert!(Structure::Grid.visit(NameOfType).ends_with("Grid"));
            /// ```
            pub fn visit<V: StructureVisitor>(self, visitor: V) -> V::Output {
                match self {
                    $(Structure::$variant => visitor.visit::<super::$variant>(),)*
                }
            }
        }

        impl Traverse for DynAccel {
            const STRUCTURE: Structure = Structure::List;
            const HAS_CLUSTERS: bool = cfg!(feature = "wide");
            // All walks are in each copy.
            const ONE_COPY: bool = true;
            type Cull<N: Number> = N::Cull;
            type Views<'a> = StructureViews<'a>;

            fn needs(geometry: &SceneGeometry<'_>) -> Structure {
                geometry.chosen()
            }

            fn walk<N: Number, C: Observer>(
                geometry: &SceneGeometry<'_>,
                views: &StructureViews<'_>,
                ray: &Ray<N>,
                _: &N::Cull,
                stack: &mut StackView,
                count: &mut C,
                leaf: impl FnMut(Leaf, &mut C) -> Option<N>,
            ) {
                match geometry.chosen() {
                    $(Structure::$variant => {
                        let cull = <super::$variant as Traverse>::Cull::<N>::new(ray);
                        let views = <super::$variant as Accel>::views(views);
                        super::$variant::walk(geometry, views, ray, &cull, stack, count, leaf);
                    })*
                }
            }
        }
    };
}

structures!(dynamic);
