//! The kinds of sections.

use crate::format::kind::shapes;

macro_rules! kinds {
    ($($(#[$doc:meta])* $kind:ident = $number:literal, $name:literal;)*) => {
        /// What a section holds. The order of the numbers is the order of the sections in a blob.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        #[repr(u16)]
        pub enum SectionKind {
            $($(#[$doc])* $kind = $number,)*
        }

        impl SectionKind {
            /// All kinds, in order.
            pub const ALL: [SectionKind; [$($number),*].len()] = {
                let mut all = [SectionKind::View; [$($number),*].len()];
                $(all[$number - 1] = SectionKind::$kind;)*
                all
            };

            /// The name that errors and memory maps use.
            pub const fn name(self) -> &'static str {
                match self {
                    $(SectionKind::$kind => $name,)*
                }
            }
        }
    };
}

macro_rules! sections {
    (
        forms { $($form:tt)* }
        records { $(
            $(#[doc = $doc:literal])* $shape:ident = $shape_number:literal, $feature:literal,
            [$field:ident: $module:ident::$record:ident], [$kind:ident = $number:literal, $name:literal];
        )* }
    ) => {
        kinds! {
            /// One [`View`](crate::format::record::View).
            View = 1, "view";
            /// [`Light`](crate::format::record::Light)s.
            Lights = 2, "lights";
            /// [`Material`](crate::format::record::Material)s.
            Materials = 3, "materials";
            /// For each object, the number of its first primitive (2 to 4 bytes). Absent where every
            /// object is one primitive, or all primitives are one object.
            ObjectFirst = 4, "object-first";
            /// For each object, its material (1 to 4 bytes). Absent where there is one material.
            ObjectMaterial = 5, "object-material";
            /// For each slot, the primitive that lies in it, counted in scene-file order (2 to 4 bytes).
            /// Absent where slots and primitives agree.
            Order = 6, "order";
            /// [`Vertex16`](crate::format::record::Vertex16) or [`Vertex24`](crate::format::record::Vertex24).
            Vertices = 7, "vertices";
            /// Three vertex indices each, `u16` or `u32`.
            Triangles = 8, "triangles";
            /// [`Sphere16`](crate::format::record::Sphere16) or [`Sphere24`](crate::format::record::Sphere24).
            Spheres = 9, "spheres";
            /// [`Leaf`](crate::format::Leaf)s, `u32` each.
            Leaves = 13, "leaves";
            /// [`Pair`](crate::format::record::Pair)s of the ordinary hierarchy.
            Pairs = 14, "pairs";
            /// [`FlaggedPair`](crate::format::record::FlaggedPair)s.
            FlaggedPairs = 15, "flagged-pairs";
            /// [`DualNode`](crate::format::record::DualNode)s.
            DualNodes = 16, "dual-nodes";
            /// One [`Gridels`](crate::format::record::Gridels): the partition of the cylinder cube.
            CylinderGridels = 17, "cylinder-gridels";
            /// For each pair of gridels, its list (1 to 4 bytes).
            CylinderCells = 18, "cylinder-cells";
            /// For each list, its first entry; then the number of entries (1 to 4 bytes).
            CylinderStarts = 19, "cylinder-starts";
            /// The slots of all lists (1 to 3 bytes).
            CylinderEntries = 20, "cylinder-entries";
            /// One [`Gridels`](crate::format::record::Gridels): the partition of the tight cylinder cube.
            TightGridels = 21, "tight-gridels";
            /// For each pair of gridels, its list (1 to 4 bytes).
            TightCells = 22, "tight-cells";
            /// For each list, its first entry; then the number of entries (1 to 4 bytes).
            TightStarts = 23, "tight-starts";
            /// The slots of all lists (1 to 3 bytes).
            TightEntries = 24, "tight-entries";
            /// For each entry, between which levels it and its neighbours lie (1 byte).
            TightKeys = 25, "tight-keys";
            /// [`ApexPoint`](crate::format::record::ApexPoint)s.
            ApexPoints = 26, "apex-points";
            /// [`ApexWindow`](crate::format::record::ApexWindow)s.
            ApexWindows = 27, "apex-windows";
            /// For each cell of all windows, its list (1 to 4 bytes).
            ApexCells = 28, "apex-cells";
            /// For each list, its first entry; then the number of entries (1 to 4 bytes).
            ApexStarts = 29, "apex-starts";
            /// The slots of all lists (1 to 3 bytes).
            ApexEntries = 30, "apex-entries";
            /// For each entry, the level at which it can begin (1 byte).
            ApexKeys = 31, "apex-keys";
            /// One [`Gridels`](crate::format::record::Gridels): the partition of the cube of entry nodes.
            EntryGridels = 32, "entry-gridels";
            /// For each pair of gridels, its list (1 to 4 bytes).
            EntryCells = 33, "entry-cells";
            /// For each list, its first entry; then the number of entries (1 to 4 bytes).
            EntryStarts = 34, "entry-starts";
            /// The nodes of all lists: numbers of pairs, and behind the last one of leaves (1 to 4 bytes).
            EntryNodes = 35, "entry-nodes";
            /// For each entry, between which levels it and its neighbours lie (1 byte).
            EntryKeys = 36, "entry-keys";
            /// [`ClassNode`](crate::format::ClassNode)s, `u32` each.
            ClassNodes = 37, "class-nodes";
            /// For each class with a list, its list (1 to 4 bytes).
            ClassCells = 38, "class-cells";
            /// For each list, its first entry; then the number of entries (1 to 4 bytes).
            ClassStarts = 39, "class-starts";
            /// The slots of all lists (1 to 3 bytes).
            ClassEntries = 40, "class-entries";
            /// For each entry, the level at which it can begin (1 byte).
            ClassKeys = 41, "class-keys";
            /// [`WideNode`](crate::format::record::WideNode)s.
            WideNodes = 42, "wide-nodes";
            /// [`Strip16`](crate::format::cluster::Strip16)s or [`Strip24`](crate::format::cluster::Strip24)s.
            Strips = 43, "strips";
            /// [`Pack16`](crate::format::cluster::Pack16)s or [`Pack24`](crate::format::cluster::Pack24)s.
            Packs = 44, "packs";
            /// For each [member](crate::format::cluster) of the strips and packs, its primitive (2 to 4 bytes).
            Members = 45, "members";
            /// For each slot, where the primitive lies in the eight-wide hierarchy: `u32` each. Only where
            /// the blob has other structures.
            Homes = 46, "homes";
            /// The planes of the root of slabs, a word a direction.
            SlabRoot = 47, "slab-root";
            /// Pairs of slabs: see [`slabs`](crate::accel::hierarchy::slabs).
            SlabPairs = 48, "slab-pairs";
            /// The planes of the root of flagged slabs, a word a direction.
            FlaggedSlabRoot = 49, "flagged-slab-root";
            /// Flagged pairs of slabs.
            FlaggedSlabPairs = 50, "flagged-slab-pairs";
            /// [`SpherePair`](crate::format::record::SpherePair)s.
            BallPairs = 51, "ball-pairs";
            /// One [`GridShape`](crate::format::record::GridShape).
            GridShape = 52, "grid-shape";
            /// For each cell of the grid, where its list begins; then where the last one ends (1 to 4 bytes).
            GridStarts = 53, "grid-starts";
            /// The slots in the cells of the grid (1 to 4 bytes).
            GridSlots = 54, "grid-slots";
            /// [`OctreeNode`](crate::format::OctreeNode)s.
            OctreeNodes = 55, "octree-nodes";
            /// For each list of the octree, where it begins; then where the last one ends (1 to 4 bytes).
            OctreeStarts = 56, "octree-starts";
            /// The slots in the leaves of the octree (1 to 4 bytes).
            OctreeSlots = 57, "octree-slots";
            /// [`ApexDirection`](crate::format::record::ApexDirection)s.
            ApexDirections = 58, "apex-directions";
            /// Windows of [radii](crate::format::cluster) in 1/256 unit, `i32` each. Only for packs of 24 bits.
            Radii = 59, "radii";
            $(
                #[doc = concat!(
                    "[`", stringify!($record), "`](crate::geometry::", stringify!($module),
                    "::", stringify!($record), ")s.",
                )]
                $kind = $number, $name;
            )*
        }
    };
}

shapes!(sections);
