//! The structures. Only this file names them all.
//!
//! A structure is a file in a folder of [`accel`](crate::accel) and a line in the table below. Its code is a Cargo
//! feature of the same name. A build ignores sections of structures that it was compiled without.

/// Passes the table of structures to a macro. The columns are name, number in the blob, name in tables and Cargo
/// feature, field of the views and module in `accel`, condition.
macro_rules! structures {
    ($macro:ident) => {
        $macro! {
            /// Every primitive, one after the other.
            List = 0, "list", list in list,
                if all();
            /// A bounding volume hierarchy of pairs, 32 bytes each, with ordinary traversal.
            Bvh = 1, "bvh", bvh in hierarchy::bvh,
                if feature = "bvh";
            /// The hierarchy of `bvh` without the sides that coincide with the parent's, 16 bytes per pair.
            Flagged = 2, "flagged", flagged in hierarchy::flagged,
                if feature = "flagged";
            /// A hierarchy of nodes with a split and at most two carves, 16 bytes each.
            DualSplit = 3, "dual-split", dual_split in hierarchy::dual_split,
                if feature = "dual-split";
            /// The paper's cylinder cube: for every pair of gridels what the cylinder between them meets.
            CylinderCube = 4, "cylinder-cube", cylinder_cube in candidates::cylinder_cube,
                if feature = "cylinder-cube";
            /// The cylinder cube with tight lists, sorted along the way from one gridel to the other.
            CylinderCubeTight = 5, "cylinder-cube-tight", cylinder_cube_tight in candidates::cylinder_cube_tight,
                if feature = "cylinder-cube-tight";
            /// Lists for the rays of the camera and of lights; other rays walk `bvh`.
            Apex = 6, "apex", apex in candidates::apex,
                if feature = "apex";
            /// The cylinder cube whose lists hold nodes of `bvh`, at which a ray enters it.
            CylinderCubeEntry = 7, "cylinder-cube-entry", cylinder_cube_entry in candidates::cylinder_cube_entry,
                if feature = "cylinder-cube-entry";
            /// Lists for classes of rays by origin and direction; rays without one walk `bvh`.
            RayClasses = 8, "ray-classes", ray_classes in candidates::ray_classes,
                if feature = "ray-classes";
            /// A hierarchy of eight children per node over strips of triangles and packs of spheres, for
            /// machines with SIMD registers.
            Wide = 9, "wide", wide in wide,
                if feature = "wide";
            /// A hierarchy of volumes between planes of 3, 7 or 13 directions, with all planes.
            Slabs = 10, "slabs", slabs in hierarchy::slabs,
                if feature = "slabs";
            /// The hierarchy of `slabs` without the planes that coincide with the parent's.
            FlaggedSlabs = 11, "flagged-slabs", flagged_slabs in hierarchy::flagged_slabs,
                if feature = "flagged-slabs";
            /// A hierarchy of bounding spheres.
            Spheres = 12, "spheres", spheres in hierarchy::spheres,
                if feature = "spheres";
            /// A regular grid, walked cell by cell.
            Grid = 13, "grid", grid in cells::grid,
                if feature = "grid";
            /// An octree, walked on integer coordinates.
            Octree = 14, "octree", octree in cells::octree,
                if feature = "octree";
        }
    };
}

pub(crate) use structures;

macro_rules! names {
    ($(
        $(#[doc = $doc:literal])*
        $variant:ident = $number:literal, $name:literal, $field:ident in $($module:ident)::+,
            if $feature:meta;
    )*) => {
        /// The name of a structure.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[cfg_attr(feature = "defmt", derive(defmt::Format))]
        #[repr(u32)]
        pub enum Structure {
            $($(#[doc = $doc])* $variant = $number,)*
        }

        impl Structure {
            /// All structures, compiled in or not.
            pub const ALL: [Structure; [$($number),*].len()] = [$(Structure::$variant),*];

            /// Returns the name that command lines and tables use.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Structure::$variant => $name,)*
                }
            }

            /// Returns the structure of a [name](Self::name).
            ///
            /// ```
            /// use gridel_core::Structure;
            ///
            /// assert_eq!(Structure::from_name("bvh"), Some(Structure::Bvh));
            /// assert_eq!(Structure::from_name("tree"), None);
            /// ```
            pub fn from_name(name: &str) -> Option<Self> {
                Self::ALL.into_iter().find(|it| it.name() == name)
            }
        }
    };
}

structures!(names);

impl Structure {
    /// Returns the structure's bit in the header.
    pub const fn bit(self) -> u32 {
        1 << self as u32
    }

    /// All structures, in the order in which they are chosen where nobody names one. Lists of candidates come early,
    /// because a blob holds them only where they were asked for.
    ///
    /// ```
    /// use gridel_core::Structure;
    ///
    /// let mut all = Structure::BEST_FIRST;
    /// all.sort();
    /// assert_eq!(all, Structure::ALL);
    /// ```
    pub const BEST_FIRST: [Self; Self::ALL.len()] = [
        Self::Wide,
        Self::Apex,
        Self::RayClasses,
        Self::CylinderCubeEntry,
        Self::DualSplit,
        Self::Flagged,
        Self::Bvh,
        Self::FlaggedSlabs,
        Self::Slabs,
        Self::Grid,
        Self::Octree,
        Self::Spheres,
        Self::CylinderCubeTight,
        Self::CylinderCube,
        Self::List,
    ];

    /// Returns the [best](Self::BEST_FIRST) structure of a set, which holds their [bits](Self::bit).
    pub(crate) fn best_of(set: u32) -> Self {
        let mut held = Self::BEST_FIRST.into_iter();
        held.find(|it| set & it.bit() != 0).unwrap_or(Self::List)
    }

    /// Returns true if loading proves that this structure gives the answers of the list. Loading cannot prove it for
    /// lists of candidates, because a proof that they are complete takes more than linear time. There the blob's
    /// compiler is trusted. A walk through them still ends, and every hit is a true one.
    ///
    /// ```
    /// use gridel_core::Structure;
    ///
    /// assert!(Structure::DualSplit.is_proved());
    /// assert!(!Structure::CylinderCube.is_proved());
    /// ```
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
}
