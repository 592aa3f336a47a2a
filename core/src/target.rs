//! The target that the code is compiled for.

/// True if the code is optimized for size where that makes it slower; no bit of an answer depends on it.
pub(crate) const SMALL: bool = cfg!(feature = "small");

/// True if the code for vertex colors is in this build.
pub(crate) const VERTEX_COLORS: bool = cfg!(feature = "vertex-colors");

/// True if the code for textures is in this build.
pub(crate) const TEXTURE: bool = cfg!(feature = "texture");

/// True if the code for texture levels is in this build.
pub(crate) const TEXTURE_LEVELS: bool = cfg!(feature = "texture-levels");

/// True if the code for an environment is in this build.
pub(crate) const ENVIRONMENT: bool = cfg!(feature = "environment");

/// A value that only builds with [`ENVIRONMENT`] hold.
pub(crate) type EnvironmentOnly<T> = InSomeBuilds<T, { ENVIRONMENT as usize }>;

/// True if the code of the structure `wide`, and of the clusters in its leaves, is in this build.
pub(crate) const WIDE: bool = cfg!(feature = "wide");

/// A value that only builds with [`WIDE`] hold.
pub(crate) type WideOnly<T> = InSomeBuilds<T, { WIDE as usize }>;

/// A value that only builds with the code of all structures hold.
pub(crate) type AllStructuresOnly<T> =
    InSomeBuilds<T, { cfg!(feature = "all-structures") as usize }>;

/// A value that only builds with the code for instances hold.
pub(crate) type InstancesOnly<T> = InSomeBuilds<T, { cfg!(feature = "instances") as usize }>;

/// A value that only builds with the code for smooth normals hold.
pub(crate) type SmoothOnly<T> = InSomeBuilds<T, { cfg!(feature = "smooth") as usize }>;

/// A value that only builds with the code for vertex colors hold.
pub(crate) type VertexColorsOnly<T> = InSomeBuilds<T, { VERTEX_COLORS as usize }>;

/// A value that only builds with the code for textures hold.
pub(crate) type TextureOnly<T> = InSomeBuilds<T, { TEXTURE as usize }>;

/// A value that only builds with the code for texture levels hold.
pub(crate) type TextureLevelsOnly<T> = InSomeBuilds<T, { TEXTURE_LEVELS as usize }>;

/// A value that only builds with the code for normal maps hold.
pub(crate) type NormalMapOnly<T> = InSomeBuilds<T, { cfg!(feature = "normal-map") as usize }>;

/// A value that only builds with the code for the forms of lights hold.
pub(crate) type FalloffOnly<T> = InSomeBuilds<T, { cfg!(feature = "falloff") as usize }>;

/// A value that only builds with the code for surfaces that send out light hold.
pub(crate) type EmissionOnly<T> = InSomeBuilds<T, { cfg!(feature = "emission") as usize }>;

/// A value that only builds with the code for depth of field hold.
pub(crate) type DepthOfFieldOnly<T> =
    InSomeBuilds<T, { cfg!(feature = "depth-of-field") as usize }>;

/// A value that only builds with the code for indirect light hold.
pub(crate) type IndirectOnly<T> = InSomeBuilds<T, { cfg!(feature = "indirect") as usize }>;

/// A value that only builds with the code for glass that absorbs hold.
pub(crate) type AbsorptionOnly<T> = InSomeBuilds<T, { cfg!(feature = "absorption") as usize }>;

/// A value that only builds with the code for nested dielectrics hold.
pub(crate) type NestedOnly<T> = InSomeBuilds<T, { cfg!(feature = "nested") as usize }>;

/// A value that only builds with the code for rough materials hold.
pub(crate) type GlossyOnly<T> = InSomeBuilds<T, { cfg!(feature = "glossy") as usize }>;

/// A value that builds hold for which `COUNT` is 1; it has no size where `COUNT` is 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct InSomeBuilds<T, const COUNT: usize>([T; COUNT]);

impl<T, const COUNT: usize> InSomeBuilds<T, COUNT> {
    #[inline(always)]
    pub(crate) fn new(make: impl Fn() -> T) -> Self {
        Self(core::array::from_fn(|_| make()))
    }

    /// A value that is at hand: without code that could overflow, as far as the compiler knows.
    #[inline(always)]
    pub(crate) fn of(value: T) -> Self
    where
        T: Copy,
    {
        Self([value; COUNT])
    }

    #[inline(always)]
    pub(crate) fn get(&self) -> Option<&T> {
        self.0.first()
    }

    pub(crate) fn get_mut(&mut self) -> Option<&mut T> {
        self.0.first_mut()
    }
}

/// Returns a value that only builds with [`WIDE`] hold. Unlike [`InSomeBuilds::new`] it is inlined with all that it
/// calls, so that no part of the value goes through memory.
#[inline(always)]
pub(crate) fn wide_only<T>(make: impl FnOnce() -> T) -> WideOnly<T> {
    #[cfg(feature = "wide")]
    let held = [make()];
    #[cfg(not(feature = "wide"))]
    let held = {
        let _ = make;
        []
    };
    InSomeBuilds(held)
}

/// True if this core multiplies only 32 bits to 32. That is the Cortex-M0, the only family of Arm's without an
/// instruction that compares and swaps.
pub(crate) const NARROW_PRODUCTS: bool =
    cfg!(all(target_arch = "arm", not(target_has_atomic = "32")));

/// Inlines a function into every caller, except in builds optimized for size, where the compiler decides. For short
/// functions on the path of most rays.
macro_rules! inline_unless_small {
    ($function:item) => {
        #[cfg_attr(not(feature = "small"), inline(always))]
        $function
    };
}

/// Inlines a function into every caller in builds with [`WIDE`], which are for hosts; on boards the compiler decides.
/// For functions that pass a ray or a hit on: hosts have enough memory for copies, and passing it through memory takes
/// longer.
macro_rules! inline_on_hosts {
    ($function:item) => {
        #[cfg_attr(feature = "wide", inline(always))]
        $function
    };
}

/// Like [`inline_on_hosts!`], with a hint to inline on boards.
macro_rules! inline_on_hosts_hint_on_boards {
    ($function:item) => {
        #[cfg_attr(feature = "wide", inline(always))]
        #[cfg_attr(not(feature = "wide"), inline)]
        $function
    };
}

/// Inlines a function into every caller on boards, and into none in builds with [`WIDE`], which are for hosts. For
/// functions that hosts rarely call, from many places.
macro_rules! inline_on_boards {
    ($function:item) => {
        #[cfg_attr(feature = "wide", inline(never))]
        #[cfg_attr(not(feature = "wide"), inline(always))]
        $function
    };
}

pub(crate) use {
    inline_on_boards, inline_on_hosts, inline_on_hosts_hint_on_boards, inline_unless_small,
};
