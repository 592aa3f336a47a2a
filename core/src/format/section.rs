//! The kinds of sections.

use crate::format::kind::shapes;

macro_rules! kinds {
    ($(
        $(#[$doc:meta])*
        $kind:ident = $number:literal, $name:literal, $record:literal of $owner:literal;
    )*) => {
        /// The content of a section. The order of the numbers is the order of the sections in a blob.
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

            /// The name of one of its records, and of the structure or array that it belongs to.
            /// The first is empty where there is only one record, the second where it belongs to the scene.
            pub const fn record_name(self) -> (&'static str, &'static str) {
                match self {
                    $(SectionKind::$kind => ($record, $owner),)*
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
            View = 1, "view", "" of "";
            /// [`Light`](crate::format::record::Light)s.
            Lights = 2, "lights", "light" of "";
            /// [`Material`](crate::format::record::Material)s.
            Materials = 3, "materials", "material" of "";
            /// For each object, the number of its first primitive (2 to 4 bytes). Absent where every
            /// object is one primitive, or all primitives are one object.
            ObjectFirst = 4, "object-first", "object" of "";
            /// For each object, its material (1 to 4 bytes). Absent where there is one material.
            ObjectMaterial = 5, "object-material", "object" of "";
            /// For each slot, the primitive that lies in it, counted in scene-file order (2 to 4 bytes).
            /// Absent where slots and primitives agree.
            Order = 6, "order", "slot" of "";
            /// [`Vertex16`](crate::format::record::Vertex16) or [`Vertex24`](crate::format::record::Vertex24).
            Vertices = 7, "vertices", "vertex" of "";
            /// Three vertex indices each, `u16` or `u32`.
            Triangles = 8, "triangles", "triangle" of "";
            /// [`Sphere16`](crate::format::record::Sphere16) or [`Sphere24`](crate::format::record::Sphere24).
            Spheres = 9, "spheres", "sphere" of "";
            /// [`Leaf`](crate::format::Leaf)s, `u32` each.
            Leaves = 13, "leaves", "leaf" of "";
            /// [`Pair`](crate::format::record::Pair)s of the ordinary hierarchy.
            Pairs = 14, "pairs", "pair" of "bvh";
            /// [`FlaggedPair`](crate::format::record::FlaggedPair)s.
            FlaggedPairs = 15, "flagged-pairs", "pair" of "flagged";
            /// [`DualNode`](crate::format::record::DualNode)s.
            DualNodes = 16, "dual-nodes", "node" of "dual-split";
            /// One [`Gridels`](crate::format::record::Gridels): the partition of the cylinder cube.
            CylinderGridels = 17, "cylinder-gridels", "" of "cylinder-cube";
            /// For each pair of gridels, its list (1 to 4 bytes).
            CylinderCells = 18, "cylinder-cells", "cell" of "cylinder-cube";
            /// For each list, its first entry; then the number of entries (1 to 4 bytes).
            CylinderStarts = 19, "cylinder-starts", "list" of "cylinder-cube";
            /// The slots of all lists (1 to 3 bytes).
            CylinderEntries = 20, "cylinder-entries", "entry" of "cylinder-cube";
            /// One [`Gridels`](crate::format::record::Gridels): the partition of the tight cylinder cube.
            TightGridels = 21, "tight-gridels", "" of "cylinder-cube-tight";
            /// For each pair of gridels, its list (1 to 4 bytes).
            TightCells = 22, "tight-cells", "cell" of "cylinder-cube-tight";
            /// For each list, its first entry; then the number of entries (1 to 4 bytes).
            TightStarts = 23, "tight-starts", "list" of "cylinder-cube-tight";
            /// The slots of all lists (1 to 3 bytes).
            TightEntries = 24, "tight-entries", "entry" of "cylinder-cube-tight";
            /// For each entry, between which levels it and its neighbors lie (1 byte).
            TightKeys = 25, "tight-keys", "key" of "cylinder-cube-tight";
            /// [`ApexPoint`](crate::format::record::ApexPoint)s.
            ApexPoints = 26, "apex-points", "point" of "apex";
            /// [`ApexWindow`](crate::format::record::ApexWindow)s.
            ApexWindows = 27, "apex-windows", "window" of "apex";
            /// For each cell of all windows, its list (1 to 4 bytes).
            ApexCells = 28, "apex-cells", "cell" of "apex";
            /// For each list, its first entry; then the number of entries (1 to 4 bytes).
            ApexStarts = 29, "apex-starts", "list" of "apex";
            /// The slots of all lists (1 to 3 bytes).
            ApexEntries = 30, "apex-entries", "entry" of "apex";
            /// For each entry, the level at which it can begin (1 byte).
            ApexKeys = 31, "apex-keys", "key" of "apex";
            /// One [`Gridels`](crate::format::record::Gridels): the partition of the cube of entry nodes.
            EntryGridels = 32, "entry-gridels", "" of "cylinder-cube-entry";
            /// For each pair of gridels, its list (1 to 4 bytes).
            EntryCells = 33, "entry-cells", "cell" of "cylinder-cube-entry";
            /// For each list, its first entry; then the number of entries (1 to 4 bytes).
            EntryStarts = 34, "entry-starts", "list" of "cylinder-cube-entry";
            /// The nodes of all lists: numbers of pairs, and behind the last one of leaves (1 to 4 bytes).
            EntryNodes = 35, "entry-nodes", "entry" of "cylinder-cube-entry";
            /// For each entry, between which levels it and its neighbors lie (1 byte).
            EntryKeys = 36, "entry-keys", "key" of "cylinder-cube-entry";
            /// [`ClassNode`](crate::format::ClassNode)s, `u32` each.
            ClassNodes = 37, "class-nodes", "node" of "ray-classes";
            /// For each class with a list, its list (1 to 4 bytes).
            ClassCells = 38, "class-cells", "cell" of "ray-classes";
            /// For each list, its first entry; then the number of entries (1 to 4 bytes).
            ClassStarts = 39, "class-starts", "list" of "ray-classes";
            /// The slots of all lists (1 to 3 bytes).
            ClassEntries = 40, "class-entries", "entry" of "ray-classes";
            /// For each entry, the level at which it can begin (1 byte).
            ClassKeys = 41, "class-keys", "key" of "ray-classes";
            /// [`WideNode`](crate::format::record::WideNode)s.
            WideNodes = 42, "wide-nodes", "node" of "wide";
            /// [`Strip16`](crate::format::cluster::Strip16)s or [`Strip24`](crate::format::cluster::Strip24)s.
            Strips = 43, "strips", "strip" of "wide";
            /// [`Pack16`](crate::format::cluster::Pack16)s or [`Pack24`](crate::format::cluster::Pack24)s.
            Packs = 44, "packs", "pack" of "wide";
            /// For each [member](crate::format::cluster) of the strips and packs, its primitive (2 to 4 bytes).
            Members = 45, "members", "member" of "wide";
            /// For each slot, where the primitive lies in the eight-wide hierarchy: `u32` each. Only where
            /// the blob has other structures.
            SlotLocations = 46, "slot-locations", "slot location" of "wide";
            /// The planes of the root of slabs, a word per direction.
            SlabRoot = 47, "slab-root", "direction" of "slabs";
            /// Pairs of slabs: see [`slabs`](crate::accel::hierarchy::slabs).
            SlabPairs = 48, "slab-pairs", "pair" of "slabs";
            /// The planes of the root of flagged slabs, a word per direction.
            FlaggedSlabRoot = 49, "flagged-slab-root", "direction" of "flagged-slabs";
            /// Flagged pairs of slabs.
            FlaggedSlabPairs = 50, "flagged-slab-pairs", "pair" of "flagged-slabs";
            /// [`SpherePair`](crate::format::record::SpherePair)s.
            SpherePairs = 51, "sphere-pairs", "pair" of "spheres";
            /// One [`GridShape`](crate::format::record::GridShape).
            GridShape = 52, "grid-shape", "" of "grid";
            /// For each cell of the grid, where its list begins; then where the last one ends (1 to 4 bytes).
            GridStarts = 53, "grid-starts", "list" of "grid";
            /// The slots in the cells of the grid (1 to 4 bytes).
            GridSlots = 54, "grid-slots", "entry" of "grid";
            /// [`OctreeNode`](crate::format::OctreeNode)s.
            OctreeNodes = 55, "octree-nodes", "node" of "octree";
            /// For each list of the octree, where it begins; then where the last one ends (1 to 4 bytes).
            OctreeStarts = 56, "octree-starts", "list" of "octree";
            /// The slots in the leaves of the octree (1 to 4 bytes).
            OctreeSlots = 57, "octree-slots", "entry" of "octree";
            /// [`ApexDirection`](crate::format::record::ApexDirection)s.
            ApexDirections = 58, "apex-directions", "direction" of "apex";
            /// Windows of [radii](crate::format::cluster) in 1/256 unit, `i32` each. Only for packs of 24 bits.
            Radii = 59, "radii", "radius" of "wide";
            /// For each object, then each material, then each light, where its name begins in the text;
            /// then the length of the text (1 to 4 bytes). Absent where nothing has a name.
            NameStarts = 61, "name-starts", "name" of "name-starts";
            /// The names, UTF-8, one behind the other.
            NameText = 62, "name-text", "byte" of "name-text";
            /// One [`Timeline`](crate::format::track::Timeline): the times of tracks.
            Timeline = 64, "timeline", "" of "";
            /// [`Track`](crate::format::track::Track)s.
            Tracks = 65, "tracks", "track" of "";
            /// The times of the keys of all tracks in ticks, `i32` each.
            TrackTimes = 66, "track-times", "key" of "tracks";
            /// The [values](crate::format::track) of the keys of all tracks, `i32` each.
            TrackWords = 67, "track-words", "word" of "tracks";
            $(
                #[doc = concat!(
                    "[`", stringify!($record), "`](crate::geometry::", stringify!($module),
                    "::", stringify!($record), ")s.",
                )]
                $kind = $number, $name, $feature of "";
            )*
        }
    };
}

shapes!(sections);
