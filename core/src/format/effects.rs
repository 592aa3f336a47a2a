//! Effects: the parts of light transport that a scene uses, as a set. An effect that a scene does not
//! require costs no rays and no instructions. All effects are listed here.
//!
//! An effect is a file in [`shade`](crate::shade) and a row in the table below. Its code is a Cargo
//! feature of the same name.

use crate::format::limits::MAX_RAY_DEPTH;
use core::fmt;

/// Passes the table of effects to a macro. The columns are constant, bit in the blob, name and Cargo feature, type and
/// module in `shade`. The last two are the most rays that wait after a hit because of the effect, and the scenes that
/// require it.
///
/// At each place of the ray loop effects act in this order.
macro_rules! effects {
    ($macro:ident) => {
        $macro! {
            /// The environment: a map of light around the scene, and a sun in it. It comes first, because others reduce
            /// what arrives from it.
            ENVIRONMENT = 17, "environment", Environment in environment, casts 0,
                required by "a scene with an environment";
            /// Shadows: light is blocked on its way to a surface. One shadow ray per light and hit.
            SHADOW = 0, "shadow", Shadow in shadow, casts 0,
                required by "a light and an object, unless the scene file turns shadows off";
            /// Highlights of the lights.
            HIGHLIGHT = 1, "highlight", Highlight in highlight, casts 0,
                required by "a material whose highlight is not 0";
            /// Nested dielectrics: where glass overlaps, the medium with the highest priority is there.
            NESTED = 10, "nested", Nested in nested, casts 0,
                required by "a material with a priority";
            /// Rough mirrors and rough glass: rays leave by random facets of the surface.
            GLOSSY = 18, "glossy", Glossy in glossy, casts 0,
                required by "a material with a roughness above 0";
            /// Mirrors: one more ray per hit.
            MIRROR = 2, "mirror", Mirror in mirror, casts 1,
                required by "a material whose mirror is not 0";
            /// Glass: up to two more rays per hit, and shadows through it.
            GLASS = 3, "glass", Glass in glass, casts 2,
                required by "a material whose transmit is not 0";
            /// Glass that absorbs light along the way.
            ABSORPTION = 4, "absorption", Absorption in absorption, casts 0,
                required by "such a material whose absorption is not 0";
            /// Checkerboards.
            CHECKER = 5, "checker", Checker in checker, casts 0,
                required by "a material whose checker size is above 0";
            /// Smooth normals: meshes are shaded by the normals of their vertices.
            SMOOTH = 6, "smooth", Smooth in smooth, casts 0,
                required by "a mesh with normals that are not those of its faces";
            /// Texture levels: what is far away shows smaller copies of a texture.
            TEXTURE_LEVELS = 20, "texture-levels", TextureLevels in texture_levels, casts 0,
                required by "a material with a texture or a normal map that has levels";
            /// Normal maps: meshes are shaded by normals of an image, which stand for bumps.
            NORMAL_MAP = 19, "normal-map", NormalMap in normal_map, casts 0,
                required by "a material with a normal map";
            /// Vertex colors: the diffuse color of a mesh is weighted by the colors of its vertices.
            VERTEX_COLORS = 7, "vertex-colors", VertexColors in vertex_colors, casts 0,
                required by "a mesh with colors of its vertices";
            /// Textures: the diffuse color of a mesh is weighted by that of an image.
            TEXTURE = 8, "texture", Texture in texture, casts 0,
                required by "a material with a texture";
            /// Alpha: parts of a texture let rays and light pass straight on. One more ray per hit.
            ALPHA = 9, "alpha", Alpha in alpha, casts 1,
                required by "an opaque material with a texture whose alpha is used";
            /// Lights that fall off with distance, and spots.
            FALLOFF = 11, "falloff", Falloff in falloff, casts 0,
                required by "a light with a falloff, a spot or an area";
            /// Lights with an area: soft shadows.
            AREA_LIGHT = 12, "area-light", AreaLight in area_light, casts 0,
                required by "a light that is a sphere, a rectangle, a triangle or a disc";
            /// Tone mapping: pixels are mapped to the range of a display.
            TONE_MAPPING = 13, "tone-mapping", ToneMapping in tone_mapping, casts 0,
                required by "a view with a curve for tones";
            /// Surfaces that send out light of their own.
            EMISSION = 14, "emission", Emission in emission, casts 0,
                required by "a material that glows";
            /// Depth of field: what is not in focus is blurred.
            DEPTH_OF_FIELD = 15, "depth-of-field", DepthOfField in depth_of_field, casts 0,
                required by "a camera with an aperture";
            /// Indirect light: surfaces light each other. One more ray per hit.
            INDIRECT = 16, "indirect", Indirect in indirect, casts 1,
                required by "a scene file that asks for bounces of diffuse light";
        }
    };
}

pub(crate) use effects;

/// The advice on a Cargo feature that a scene requires and that this build lacks.
macro_rules! enable {
    ($feature:literal) => {
        concat!(
            "the scene requires `",
            $feature,
            "`: enable that feature of gridel-core"
        )
    };
}

pub(crate) use enable;

/// A set of effects.
///
/// The compiler writes into a blob the set that its scene requires. The ray loop is compiled for
/// a set given as a constant, and each effect's code can be left out by its Cargo feature.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Effects(pub u32);

macro_rules! sets {
    ($(
        $(#[doc = $doc:literal])*
        $effect:ident = $bit:literal, $name:literal, $type:ident in $module:ident,
            casts $rays:literal, required by $required_by:literal;
    )*) => {
        impl Effects {
            $($(#[doc = $doc])* pub const $effect: Effects = Effects(1 << $bit);)*

            /// Every effect, with its name and Cargo feature.
            pub const NAMED: [(Effects, &'static str); [$($bit),*].len()] =
                [$((Effects::$effect, $name)),*];

            /// The parts of a scene that require each effect of [`NAMED`](Self::NAMED).
            pub const REQUIRED_BY: [&'static str; Self::NAMED.len()] = [$($required_by),*];

            /// All effects that there are.
            pub const ALL: Effects = Effects($(1 << $bit)|*);

            /// The effects whose code this build holds.
            pub const AVAILABLE: Effects = Effects($((cfg!(feature = $name) as u32) << $bit)|*);

            /// The effects because of which rays wait: those of which [`work_depth`](Self::work_depth) knows the rays.
            pub(crate) const CASTING: Effects = {
                let casting = Effects($((($rays > 0) as u32) << $bit)|*);
                let known = Self::MIRROR.with(Self::GLASS).with(Self::ALPHA).with(Self::INDIRECT);
                assert!(casting.0 == known.0);
                casting
            };

            /// A sentence about the Cargo feature of an effect of this set that this build lacks.
            pub(crate) const fn missing(self) -> Option<&'static str> {
                let missing = self.without(Self::AVAILABLE);
                $(if missing.contains(Effects::$effect) {
                    return Some(enable!($name));
                })*
                None
            }
        }
    };
}

effects!(sets);

impl Effects {
    /// No effects: surfaces have their diffuse color under unshadowed lights.
    pub const NONE: Effects = Effects(0);

    /// Returns true if all of `other` are in this set.
    ///
    /// ```
    /// use gridel_core::Effects;
    ///
    /// let set = Effects::MIRROR.with(Effects::SHADOW);
    /// assert!(set.contains(Effects::SHADOW) && !set.contains(Effects::GLASS));
    /// ```
    pub const fn contains(self, other: Effects) -> bool {
        self.0 & other.0 == other.0
    }

    /// Returns this set without the effects of `other`.
    ///
    /// ```
    /// use gridel_core::Effects;
    ///
    /// let both = Effects::MIRROR.with(Effects::GLASS);
    /// assert_eq!(both.without(Effects::GLASS).to_string(), "mirror");
    /// ```
    pub const fn without(self, other: Effects) -> Effects {
        Effects(self.0 & !other.0)
    }

    /// Returns this set under a condition, else an empty one.
    pub const fn only_if(self, condition: bool) -> Effects {
        if condition { self } else { Effects::NONE }
    }

    /// Returns the union of this set and `other`.
    pub const fn with(self, other: Effects) -> Effects {
        Effects(self.0 | other.0)
    }

    /// Places for waiting rays that pictures with these effects need at a ray depth: `WORK` of a
    /// [`Workspace`](crate::Workspace).
    ///
    /// `depth + 1` where rays are mirrored, pass through or are reflected diffusely; `2 * depth + 1` where a hit can
    /// cause all three; 0 where no ray causes another.
    ///
    /// ```
    /// use gridel_core::Effects;
    ///
    /// assert_eq!(Effects::GLASS.work_depth(4), 5);
    /// // Shadow rays do not wait.
    /// assert_eq!(Effects::SHADOW.work_depth(4), 0);
    /// // A mirrored, a refracted and a diffuse ray.
    /// assert_eq!(Effects::GLASS.with(Effects::INDIRECT).work_depth(4), 9);
    /// ```
    pub const fn work_depth(self, depth: u8) -> usize {
        if depth == 0 || self.0 & Self::CASTING.0 == 0 {
            0
        } else if self.contains(Self::INDIRECT) && self.casts_two() {
            // All but one of the rays of every hit wait.
            2 * depth as usize + 1
        } else {
            depth as usize + 1
        }
    }

    /// Places for waiting rays that are enough for every scene.
    pub const MAX_WORK_DEPTH: usize = Self::AVAILABLE.work_depth(MAX_RAY_DEPTH as u8);

    /// Returns true if a hit causes two rays, without diffuse ones: a mirrored one and one that passes through.
    const fn casts_two(self) -> bool {
        let mirrors = self.contains(Self::MIRROR) || self.contains(Self::GLASS);
        let goes_on = self.contains(Self::GLASS) || self.contains(Self::ALPHA);
        mirrors && goes_on
    }

    /// Returns the names of the effects in this set.
    ///
    /// ```
    /// use gridel_core::Effects;
    ///
    /// assert!(Effects::GLASS.with(Effects::SHADOW).names().eq(["shadow", "glass"]));
    /// ```
    pub fn names(self) -> impl Iterator<Item = &'static str> {
        Self::NAMED
            .into_iter()
            .filter(move |(effect, _)| self.contains(*effect))
            .map(|(_, name)| name)
    }
}

impl fmt::Display for Effects {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if *self == Self::NONE {
            return f.write_str("none");
        }
        for (position, name) in self.names().enumerate() {
            if position > 0 {
                f.write_str(", ")?;
            }
            f.write_str(name)?;
        }
        Ok(())
    }
}
