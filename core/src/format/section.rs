//! The kinds of sections.

use crate::format::kind::shapes;

macro_rules! kinds {
    ($(
        $(#[doc = $doc:expr])*
        $kind:ident = $number:literal, $name:literal, [$($form:ty),*], $record:literal of $owner:literal;
    )*) => {
        /// The content of a section. The order of the numbers is the order of the sections in a blob.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        #[cfg_attr(feature = "defmt", derive(defmt::Format))]
        #[repr(u16)]
        pub enum SectionKind {
            $($(#[doc = $doc])* $kind = $number,)*
        }

        impl SectionKind {
            /// All kinds, in order.
            pub const ALL: [SectionKind; [$($number),*].len()] = {
                let mut all = [$(SectionKind::$kind),*];
                // Those of shapes come last in the table above, and not by their numbers.
                let mut sorted = 1;
                while sorted < all.len() {
                    let mut place = sorted;
                    while place > 0 && all[place - 1] as u16 > all[place] as u16 {
                        all.swap(place - 1, place);
                        place -= 1;
                    }
                    sorted += 1;
                }
                all
            };

            /// A bit for every number that a kind has.
            pub(crate) const KNOWN: [u32; 4] = {
                let mut known = [0; 4];
                $(known[$number / 32] |= 1 << ($number % 32);)*
                known
            };

            /// Returns the kind with a number.
            pub fn of_number(number: u16) -> Option<Self> {
                Self::ALL.into_iter().find(|&kind| kind as u16 == number)
            }

            /// Returns the name that errors and memory maps use.
            pub const fn name(self) -> &'static str {
                match self {
                    $(SectionKind::$kind => $name,)*
                }
            }

            /// Returns the name of one of its records, and of the structure or array that it belongs to.
            /// The first is empty where there is only one record, the second where it belongs to the scene.
            pub const fn record_name(self) -> (&'static str, &'static str) {
                match self {
                    $(SectionKind::$kind => ($record, $owner),)*
                }
            }
        }
    };
}

/// Passes the table of sections to a macro, given that of shapes. A line states the number, the name, the possible
/// forms of a record, and the result of [`record_name`](SectionKind::record_name).
macro_rules! sections {
    (
        $macro:ident
        forms { $($form:tt)* }
        records { $(
            $(#[doc = $doc:literal])* $shape:ident = $shape_number:literal, $feature:literal,
            [$field:ident: $module:ident::$record:ident], [$kind:ident = $number:literal, $name:literal];
        )* }
    ) => {
        $macro! {
            /// One [`View`](crate::format::record::View).
            View = 1, "view", [record::View], "" of "";
            /// [`Light`](crate::format::record::Light)s.
            Lights = 2, "lights", [record::Light], "light" of "";
            /// [`Material`](crate::format::record::Material)s.
            Materials = 3, "materials", [record::Material], "material" of "";
            /// For each object, the number of its first primitive. Absent where every
            /// object is one primitive, or all primitives are one object.
            ObjectFirst = 4, "object-first", [u16, [u8; 3], u32], "object" of "";
            /// For each object, its material. Absent where there is one material.
            ObjectMaterial = 5, "object-material", [u8, u16, [u8; 3], u32], "object" of "";
            /// For each slot, the primitive that lies in it, counted in scene-file order.
            /// Absent where slots and primitives agree.
            Order = 6, "order", [u16, [u8; 3], u32], "slot" of "";
            /// [`Vertex16`](crate::format::record::Vertex16) or [`Vertex24`](crate::format::record::Vertex24).
            Vertices = 7, "vertices", [record::Vertex16, record::Vertex24], "vertex" of "";
            /// Three vertex indices each, `u16` or `u32`.
            Triangles = 8, "triangles", [[u16; 3], [u32; 3]], "triangle" of "";
            /// [`Sphere16`](crate::format::record::Sphere16) or [`Sphere24`](crate::format::record::Sphere24).
            Spheres = 9, "spheres", [record::Sphere16, record::Sphere24], "sphere" of "";
            /// [`Leaf`](crate::format::Leaf)s, `u32` each.
            Leaves = 13, "leaves", [u32], "leaf" of "";
            /// [`Pair`](crate::format::record::Pair)s of the ordinary hierarchy.
            Pairs = 14, "pairs", [record::Pair], "pair" of "bvh";
            /// [`FlaggedPair`](crate::format::record::FlaggedPair)s.
            FlaggedPairs = 15, "flagged-pairs", [record::FlaggedPair], "pair" of "flagged";
            /// [`DualNode`](crate::format::record::DualNode)s.
            DualNodes = 16, "dual-nodes", [record::DualNode], "node" of "dual-split";
            /// One [`Gridels`](crate::format::record::Gridels): the partition of the cylinder cube.
            CylinderGridels = 17, "cylinder-gridels", [record::Gridels], "" of "cylinder-cube";
            /// For each pair of gridels, its list.
            CylinderCells = 18, "cylinder-cells", [u8, u16, [u8; 3], u32], "cell" of "cylinder-cube";
            /// For each list, its first entry; then the number of entries.
            CylinderStarts = 19, "cylinder-starts", [u8, u16, [u8; 3], u32], "list" of "cylinder-cube";
            /// The slots of all lists.
            CylinderEntries = 20, "cylinder-entries", [u8, u16, [u8; 3], u32], "entry" of "cylinder-cube";
            /// One [`Gridels`](crate::format::record::Gridels): the partition of the tight cylinder cube.
            TightGridels = 21, "tight-gridels", [record::Gridels], "" of "cylinder-cube-tight";
            /// For each pair of gridels, its list.
            TightCells = 22, "tight-cells", [u8, u16, [u8; 3], u32], "cell" of "cylinder-cube-tight";
            /// For each list, its first entry; then the number of entries.
            TightStarts = 23, "tight-starts", [u8, u16, [u8; 3], u32], "list" of "cylinder-cube-tight";
            /// The slots of all lists.
            TightEntries = 24, "tight-entries", [u8, u16, [u8; 3], u32], "entry" of "cylinder-cube-tight";
            /// For each entry, between which levels it and its neighbors lie.
            TightKeys = 25, "tight-keys", [u8], "key" of "cylinder-cube-tight";
            /// [`ApexPoint`](crate::format::record::ApexPoint)s.
            ApexPoints = 26, "apex-points", [record::ApexPoint], "point" of "apex";
            /// [`ApexWindow`](crate::format::record::ApexWindow)s.
            ApexWindows = 27, "apex-windows", [record::ApexWindow], "window" of "apex";
            /// For each cell of all windows, its list.
            ApexCells = 28, "apex-cells", [u8, u16, [u8; 3], u32], "cell" of "apex";
            /// For each list, its first entry; then the number of entries.
            ApexStarts = 29, "apex-starts", [u8, u16, [u8; 3], u32], "list" of "apex";
            /// The slots of all lists.
            ApexEntries = 30, "apex-entries", [u8, u16, [u8; 3], u32], "entry" of "apex";
            /// For each entry, the level at which it can begin.
            ApexKeys = 31, "apex-keys", [u8], "key" of "apex";
            /// One [`Gridels`](crate::format::record::Gridels): the partition of the cube of entry nodes.
            EntryGridels = 32, "entry-gridels", [record::Gridels], "" of "cylinder-cube-entry";
            /// For each pair of gridels, its list.
            EntryCells = 33, "entry-cells", [u8, u16, [u8; 3], u32], "cell" of "cylinder-cube-entry";
            /// For each list, its first entry; then the number of entries.
            EntryStarts = 34, "entry-starts", [u8, u16, [u8; 3], u32], "list" of "cylinder-cube-entry";
            /// The nodes of all lists: numbers of pairs, and behind the last one of leaves.
            EntryNodes = 35, "entry-nodes", [u8, u16, [u8; 3], u32], "entry" of "cylinder-cube-entry";
            /// For each entry, between which levels it and its neighbors lie.
            EntryKeys = 36, "entry-keys", [u8], "key" of "cylinder-cube-entry";
            /// [`ClassNode`](crate::format::ClassNode)s, `u32` each.
            ClassNodes = 37, "class-nodes", [u32], "node" of "ray-classes";
            /// For each class with a list, its list.
            ClassCells = 38, "class-cells", [u8, u16, [u8; 3], u32], "cell" of "ray-classes";
            /// For each list, its first entry; then the number of entries.
            ClassStarts = 39, "class-starts", [u8, u16, [u8; 3], u32], "list" of "ray-classes";
            /// The slots of all lists.
            ClassEntries = 40, "class-entries", [u8, u16, [u8; 3], u32], "entry" of "ray-classes";
            /// For each entry, the level at which it can begin.
            ClassKeys = 41, "class-keys", [u8], "key" of "ray-classes";
            /// [`WideNode`](crate::format::record::WideNode)s.
            WideNodes = 42, "wide-nodes", [record::WideNode], "node" of "wide";
            /// [`Strip16`](crate::format::cluster::Strip16)s or [`Strip24`](crate::format::cluster::Strip24)s.
            Strips = 43, "strips", [cluster::Strip16, cluster::Strip24], "strip" of "wide";
            /// [`Pack16`](crate::format::cluster::Pack16)s or [`Pack24`](crate::format::cluster::Pack24)s.
            Packs = 44, "packs", [cluster::Pack16, cluster::Pack24], "pack" of "wide";
            /// For each [member](crate::format::cluster) of the strips and packs, its primitive.
            Members = 45, "members", [u16, [u8; 3], u32], "member" of "wide";
            /// For each slot, where the primitive lies in the eight-wide hierarchy: `u32` each. Only where
            /// the blob has other structures.
            SlotLocations = 46, "slot-locations", [u32], "slot location" of "wide";
            /// The planes of the root of slabs, a word per direction.
            SlabRoot = 47, "slab-root", [[i16; 2]], "direction" of "slabs";
            /// Pairs of [slabs](crate::accel::hierarchy::slabs).
            SlabPairs = 48, "slab-pairs", [[u32; 8], [u32; 16], [u32; 28]], "pair" of "slabs";
            /// The planes of the root of flagged slabs, a word per direction.
            FlaggedSlabRoot = 49, "flagged-slab-root", [[i16; 2]], "direction" of "flagged-slabs";
            /// Flagged pairs of slabs.
            FlaggedSlabPairs = 50, "flagged-slab-pairs", [[u32; 5], [u32; 9], [u32; 15]], "pair" of "flagged-slabs";
            /// [`SpherePair`](crate::format::record::SpherePair)s.
            SpherePairs = 51, "sphere-pairs", [record::SpherePair], "pair" of "spheres";
            /// One [`GridShape`](crate::format::record::GridShape).
            GridShape = 52, "grid-shape", [record::GridShape], "" of "grid";
            /// For each cell of the grid, where its list begins; then where the last one ends.
            GridStarts = 53, "grid-starts", [u8, u16, [u8; 3], u32], "list" of "grid";
            /// The slots in the cells of the grid.
            GridSlots = 54, "grid-slots", [u8, u16, [u8; 3], u32], "entry" of "grid";
            /// [`OctreeNode`](crate::format::OctreeNode)s.
            OctreeNodes = 55, "octree-nodes", [u32], "node" of "octree";
            /// For each list of the octree, where it begins; then where the last one ends.
            OctreeStarts = 56, "octree-starts", [u8, u16, [u8; 3], u32], "list" of "octree";
            /// The slots in the leaves of the octree.
            OctreeSlots = 57, "octree-slots", [u8, u16, [u8; 3], u32], "entry" of "octree";
            /// [`ApexDirection`](crate::format::record::ApexDirection)s.
            ApexDirections = 58, "apex-directions", [record::ApexDirection], "direction" of "apex";
            /// Windows of [radii](crate::format::cluster) in 1/256 unit, `i32` each. Only for packs of 24 bits.
            Radii = 59, "radii", [i32], "radius" of "wide";
            /// For each object, then each material, then each light, where its name begins in the text;
            /// then the length of the text. Absent where nothing has a name.
            NameStarts = 61, "name-starts", [u8, u16, [u8; 3], u32], "name" of "name-starts";
            /// The names, UTF-8, one behind the other.
            NameText = 62, "name-text", [u8], "byte" of "name-text";
            /// One [`Timeline`](crate::format::track::Timeline): the times of tracks.
            Timeline = 64, "timeline", [track::Timeline], "" of "";
            /// [`Track`](crate::format::track::Track)s.
            Tracks = 65, "tracks", [track::Track], "track" of "";
            /// The times of the keys of all tracks in ticks, `i32` each.
            TrackTimes = 66, "track-times", [i32], "key" of "tracks";
            /// The [values](crate::format::track) of the keys of all tracks, `i32` each.
            TrackWords = 67, "track-words", [i32], "word" of "tracks";
            /// The normals of the first vertices, octahedral: see [`smooth`](crate::geometry::smooth). A triangle
            /// whose three vertices have one is shaded by them.
            Normals = 68, "normals", [[i16; 2]], "normal" of "";
            /// [`Part`](crate::format::instance::Part)s.
            Parts = 69, "parts", [instance::Part], "part" of "";
            /// The blobs of all parts, one behind the other, in words of
            /// [`SECTION_ALIGNMENT`](crate::format::record::SECTION_ALIGNMENT) bytes.
            PartBlobs = 70, "part-blobs", [[u32; 4]], "word" of "parts";
            /// [`Instance`](crate::format::instance::Instance)s.
            Instances = 71, "instances", [instance::Instance], "instance" of "";
            /// [`Pair`](crate::format::record::Pair)s of the hierarchy above the instances, whose leaves are instances.
            InstancePairs = 72, "instance-pairs", [record::Pair], "pair" of "instances";
            /// [`Joint`](crate::format::track::Joint)s.
            Joints = 73, "joints", [track::Joint], "joint" of "tracks";
            /// For each instance, the joint on which it hangs, or `u32::MAX`. Absent where there are no joints.
            InstanceJoints = 74, "instance-joints", [u32], "instance" of "tracks";
            /// The colors of the first vertices: red, green and blue as square roots of linear light, and alpha. Those of
            /// other vertices are white.
            VertexColors = 75, "vertex-colors", [[u8; 4]], "color" of "";
            /// The texture coordinates of the first vertices, u to the right and v down, with 14 or 20 fraction bits: see
            /// [`attributes`](crate::geometry::attributes).
            TextureCoordinates = 76, "texture-coordinates", [[i16; 2], [i32; 2]], "coordinates" of "";
            /// [`SurfaceMaps`](crate::format::record::SurfaceMaps).
            SurfaceMaps = 77, "surface-maps", [record::SurfaceMaps], "maps" of "";
            /// [`Texture`](crate::format::record::Texture)s.
            Textures = 78, "textures", [record::Texture], "texture" of "";
            /// The palettes and texels of all textures: see [`Texture`](crate::format::record::Texture).
            Texels = 79, "texels", [u8], "byte" of "textures";
            /// [`LightForm`](crate::format::light_form::LightForm)s: shape, falloff and cone of lights.
            LightForms = 80, "light-forms", [light_form::LightForm], "form" of "lights";
            /// For each of the first materials, the [light](crate::format::record::Emission) that it sends out; others send
            /// out none. Absent where no material glows.
            Emissions = 81, "emissions", [record::Emission], "emission" of "";
            /// One [`Lens`](crate::format::lens::Lens): of the camera, where it is no pinhole.
            Lens = 90, "lens", [lens::Lens], "" of "";
            /// Maximum number of diffuse reflections between the eye and a light: 1 to 32. Absent where surfaces do
            /// not light each other.
            Indirect = 91, "indirect", [u32], "" of "";
            /// One [`Environment`](crate::format::environment::Environment): the light around the scene.
            Environment = 92, "environment", [environment::Environment], "" of "";
            /// The radiance of the environment, in texels of an octahedral map, row by row: red, green and blue of 9 bits
            /// each from the lowest bit on, then an exponent of 5 bits, 0 to 22. A channel times 2 to the exponent is the
            /// radiance with 20 fraction bits.
            EnvironmentTexels = 93, "environment-texels", [u32], "texel" of "environment";
            /// For each row of the map, what part of the light comes from the rows before it, 32 fraction bits.
            EnvironmentRows = 94, "environment-rows", [u32], "row" of "environment";
            /// For each texel, what part of the light of its row comes from the texels before it, 16 fraction bits.
            EnvironmentColumns = 95, "environment-columns", [u16], "column" of "environment";
            /// For each of the first materials, the width of its facets' distribution (the α of GGX, the roughness squared), 30
            /// fraction bits; 0 for a smooth one, as others are. Absent where no material is rough.
            Roughnesses = 96, "roughnesses", [i32], "roughness" of "";
            /// For each of the first forms of lights, 1 where rays meet a surface of the scene that shines so, else 0, as for
            /// others. Absent where no material is rough.
            ShownForms = 97, "shown-forms", [u8], "mark" of "light-forms";
            /// For each of the first surface maps, its [`NormalMap`](crate::format::record::NormalMap); others have none.
            NormalMaps = 98, "normal-maps", [record::NormalMap], "map" of "textures";
            /// The numbers of the materials with a priority, from the highest on: at most 8, each one of glass. Absent where
            /// there are none.
            Media = 99, "media", [u32], "medium" of "";
            /// For each morph target of the scene and its parts, its weight at rest, 24 fraction bits.
            MorphWeights = 100, "morph-weights", [i32], "morph target" of "";
            /// For each [displacement](crate::deform::MorphTargets) of a vertex by a morph target, the vertex. Vertices ascend, and
            /// for each vertex the morph targets.
            MorphVertices = 101, "morph-vertices", [u8, u16, [u8; 3], u32], "displacement" of "morph-vertices";
            /// For each displacement, its morph target.
            MorphNumbers = 102, "morph-numbers", [u8, u16, [u8; 3], u32], "displacement" of "morph-numbers";
            /// Displacement of each vertex by a weight of 1, in steps of its storage: units for 16 bits, else 1/256
            /// unit.
            Displacements = 103, "displacements", [[i16; 3], [i32; 3]], "displacement" of "";
            /// For each displacement, by how much a weight of 1 changes the vertex' [normal](crate::geometry::smooth) on its
            /// octahedron, halved. Absent where normals do not change.
            NormalChanges = 104, "normal-changes", [[i16; 3]], "change" of "normals";
            $(
                #[doc = concat!(
                    "[`", stringify!($record), "`](crate::geometry::", stringify!($module),
                    "::", stringify!($record), ")s.",
                )]
                $kind = $number, $name, [super::$module::$record], $feature of "";
            )*
        }
    };
}

shapes!(sections, kinds);

pub(crate) use sections;
