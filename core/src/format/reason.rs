//! The errors of a blob, each as one sentence.
//!
//! An error carries a byte of these enumerations. Their texts are reached only through `Display`, so a program that
//! prints no error does not hold them.

macro_rules! texts {
    (
        $(#[$attribute:meta])*
        $name:ident {
            $($variant:ident => $text:literal,)*
        }
    ) => {
        $(#[$attribute])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[cfg_attr(feature = "defmt", derive(defmt::Format))]
        #[repr(u8)]
        #[non_exhaustive]
        pub enum $name {
            $(#[doc = concat!("\"", $text, "\"")] $variant,)*
        }

        impl $name {
            /// All of them.
            pub const ALL: &'static [Self] = &[$(Self::$variant),*];

            /// Returns its text.
            pub const fn text(self) -> &'static str {
                match self {
                    $(Self::$variant => $text,)*
                }
            }
        }

        impl core::fmt::Display for $name {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                f.write_str(self.text())
            }
        }
    };
}

texts! {
    /// A number of a blob that can be out of its range, as an error names it.
    Field {
        // Header and section table.
        StackDepth => "stack depth",
        StackBytes => "number of stack bytes",
        LatticeBits => "number of lattice bits",
        StorageBits => "number of storage bits",
        UnitExponent => "unit exponent",
        CoordinateShift => "coordinate shift",
        CoordinateOrigin => "coordinate origin",
        LongestLeaf => "longest leaf",
        Slots => "number of slots",
        Kind => "kind",
        Offset => "offset",
        End => "end",
        // View.
        Eye => "eye",
        CameraVector => "camera vector",
        Background => "background",
        AmbientLight => "ambient light",
        Cutoff => "cutoff",
        Width => "width",
        Height => "height",
        Samples => "number of samples",
        RayDepth => "ray depth",
        Encoding => "encoding of the picture",
        // Lights and materials.
        Color => "color",
        PositionOrDirection => "position or direction",
        LightReference => "distance at which a light has its color",
        LightRange => "distance at which a light ends",
        ConeCosine => "cosine of a spot's angle",
        LightWidth => "width of a light",
        LightEdge => "edge of a light",
        LightForm => "form of a light",
        Emission => "radiance of a material",
        EmissionLights => "mark of what lights sample",
        LensRadius => "radius of the lens",
        Focus => "distance of the plane of focus",
        Bounces => "number of diffuse reflections",
        EnvironmentSize => "size of the environment",
        SunDirection => "direction of the sun",
        SunSize => "size of the sun",
        SunRadiance => "radiance of the sun",
        Exponent => "exponent",
        Roughness => "roughness of a material",
        ShownForm => "mark of a form that is shown",
        Diffuse => "diffuse color",
        Odd => "odd color",
        Highlight => "highlight",
        Mirror => "mirror",
        Transmittance => "transmittance",
        InverseIor => "inverse index of refraction",
        Shininess => "shininess",
        CheckerSize => "checkerboard size",
        CheckerOrigin => "checkerboard origin",
        Maps => "number of the maps",
        TextureNumber => "number of the texture",
        TextureForm => "form of texels",
        TextureFilter => "filter",
        TextureWrap => "wrap mode",
        TextureWidth => "width of the texture",
        TextureHeight => "height of the texture",
        FirstTexel => "first byte of the texels",
        // Primitives and objects.
        Coordinate => "coordinate",
        LowestCoordinate => "lowest coordinate",
        HighestCoordinate => "highest coordinate",
        Vertex => "vertex",
        Radius => "radius",
        Center => "center",
        Point => "point",
        Normal => "normal",
        Axis => "axis",
        BaseCenter => "center of the base",
        ApexCenter => "center of the apex",
        NameStart => "start",
        FirstPrimitive => "first primitive",
        Material => "material",
        Primitive => "primitive",
        // Structures.
        Primitives => "number of primitives",
        FirstSlot => "first slot",
        EndSlot => "end of the slots",
        Levels => "number of levels",
        Child => "child's number",
        Leaf => "leaf's number",
        LeafKind => "leaf's kind",
        LeafSlots => "leaf's number of slots",
        FirstMember => "first member",
        Divisions => "number of divisions",
        List => "list",
        FirstEntry => "first entry",
        Entries => "number of entries",
        Candidate => "candidate",
        Window => "window",
        Plane => "plane",
        MajorAxis => "major axis",
        FirstCell => "first cell",
        SideCells => "number of cells along a side",
        Dimension => "dimension",
        Cell => "cell",
        // Tracks.
        TicksPerSecond => "number of ticks per second",
        FirstTime => "first time",
        LastTime => "last time",
        TrackTarget => "target",
        TrackIndex => "number of a light, material, joint or morph target",
        Interpolation => "interpolation",
        Keys => "number of keys",
        KeyTime => "time of a key",
        FirstWord => "first word",
        Direction => "direction",
        FieldOfView => "field of view",
        Rotation => "rotation",
        Scale => "scale",
        Joint => "joint",
        RotationAngle => "angle to the next rotation",
        // Morph targets.
        Weight => "weight",
        MorphTarget => "number of a morph target",
        Displacement => "displacement",
        // Parts and instances.
        Start => "start",
        Length => "length",
        MatrixEntry => "matrix entry",
        InstanceExponent => "exponent",
        Part => "part",
        Instance => "instance",
    }
}

texts! {
    /// The error of a part of a blob, other than a number out of its range.
    Reason {
        // Header and section table.
        UnknownEffects => "it requires effects that this version of the format does not have",
        UnneededEffects => "it requires effects that nothing in the scene needs",
        MissingList => "it does not name the structure list, which every blob holds",
        UnknownStructures => "it names structures that this version of the format does not have",
        OriginNotFinite => "a coordinate of its origin is not finite",
        InvertedBounds => "a lower side of the scene's box lies above the upper one",
        ReservedBounds => "a side of the scene's box is -32768, which is reserved",
        SpareNotZero => "a spare field is not 0",
        MissingObjectFirst => "it counts several objects, but there is no section object-first",
        NotPrevalidated => "it requires a structure that cannot be verified at compile time",
        // Lights, materials and primitives.
        ZeroDirection => "its direction has length 0",
        FirstNotZero => "it is the first one, and not 0",
        LightOrder => "it is less than the one before it",
        MissingEffect => "it needs an effect that the header does not require",
        InvertedBox => "its lowest corner lies above its highest one",
        ZeroNormal => "its normal has length 0",
        MissingMaps => "it requires maps and has none",
        OpaqueMedium => "its material is not glass",
        RepeatedMedium => "its material has a place before it",
        ZeroAxis => "its axis has length 0",
        ZeroRadii => "both of its radii are 0",
        OutsideScene => "its box lies outside of the scene's box",
        // Names.
        NotUtf8 => "it is not UTF-8",
        InsideCharacter => "it starts inside of a character",
        // Hierarchies.
        NotReached => "no node leads to it",
        BeyondLast => "it leads beyond the last node",
        LeftOutside => "the volume of its left child lies outside of its own",
        RightOutside => "the volume of its right child lies outside of its own",
        PrimitiveOutside => "a primitive lies outside of the volume of its leaf",
        PrimitiveOutsideRegion => "a primitive of its leaf lies outside of its region",
        DirectionCount => "it does not have 3, 7 or 13 directions",
        UnusedBits => "bits that have no meaning are set",
        NoChild => "it has no child",
        LaneNotEmpty => "a lane without a child holds a box",
        ChildAfterGap => "a child follows a lane without a child",
        ChildOutside => "the box of a child lies outside of its own, or does not hold what is in it",
        // Clusters.
        UnknownArrangement => "an arrangement of its corners does not exist",
        EmptyPack => "it has no sphere",
        PartialPack => "it has fewer than eight spheres, but it is not the last pack",
        RadiusAfterLast => "a radius follows its last sphere",
        WrongSlotLocation => "it does not lead back to its slot",
        // Cells and candidates.
        WrongPartition => "its gridels are not those of the scene's box",
        KeyOrder => "it does not follow the key before it in its list",
        SlotOrder => "its slot does not follow the slot before it in its list",
        MissingPrimitive => "it lacks a primitive that reaches into its cell",
        OutsideCell => "its primitive does not reach into its cell",
        // Tracks.
        TrackOrder => "it does not follow the track before it in the order of targets and numbers",
        JointOrder => "it hangs on itself or on a joint behind it",
        WrongLight => "its light is of the other kind, which has no such property",
        ZeroRotation => "its rotation has length 0",
        // Morph targets.
        DisplacementOrder => "it does not follow the one before it in the order of vertices and morph targets",
        // Parts and instances.
        NotRotation => "its matrix is not a rotation times a factor from 1/2 to 1",
        OtherStructures => "its structures are not those of the scene",
        UnboundedPart => "it has a shape without bounds",
        OtherPart => "the part that was given is not the one in the blob",
        CameraInPart => "its camera lacks tracks: those of a camera are eye and field of view with either target and up or rotation, and orbit only with a target",
    }
}
