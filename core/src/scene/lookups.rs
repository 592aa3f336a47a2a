//! Look-ups that a blob defines by integers: images and the environment, as the ray loop looks them up.

use crate::format::Effects;
use crate::format::environment::Environment;
use crate::format::record::{Material, NormalMap, SurfaceMaps};
use crate::scene::Scene;
use crate::scene::environment::EnvironmentMap;
use crate::scene::textures::Footprint;

impl<'a> Scene<'a> {
    /// Returns the color of a material's texture at coordinates with 20 fraction bits: linear ratios with 30 fraction
    /// bits. `None` for a material without a texture. The footprint has no effect on a texture without levels.
    pub fn texture_color(
        &self,
        material: &Material,
        coordinates: [i32; 2],
        footprint: Footprint,
    ) -> Option<[i32; 3]> {
        if !self.effects().contains(Effects::TEXTURE) || material.maps & Material::MAPS_TEXTURE == 0
        {
            return None;
        }
        let textures = self.textures.get()?;
        let texture = textures.texture(textures.maps_of(material)?.color)?;
        Some(textures.lookup(texture, coordinates, footprint).color)
    }

    /// Returns the alpha of a material's texture at coordinates with 20 fraction bits: a ratio with 30 fraction bits.
    /// `None` for a material that does not use it. The footprint has no effect on a texture without levels.
    pub fn texture_alpha(
        &self,
        material: &Material,
        coordinates: [i32; 2],
        footprint: Footprint,
    ) -> Option<i32> {
        let maps = self.surface_maps(material)?;
        let textures = self.textures.get()?;
        let texture = textures.texture(maps.color)?;
        (material.maps & Material::MAPS_ALPHA != 0)
            .then(|| textures.alpha(texture, coordinates, footprint))
    }

    /// Returns the normal in a material's normal map at coordinates with 20 fraction bits, and the map. The normal is
    /// along u, against v and along the surface's normal: ratios from -1 to 1 with 30 fraction bits. The map's factors
    /// are not yet applied. `None` for a material without a normal map. The footprint has no effect on a map without
    /// levels.
    pub fn mapped_normal(
        &self,
        material: &Material,
        coordinates: [i32; 2],
        footprint: Footprint,
    ) -> Option<([i32; 3], &'a NormalMap)> {
        if material.maps & Material::MAPS_NORMAL == 0 {
            return None;
        }
        let textures = self.textures.get()?;
        let (map, texture) = textures.normal_map_of(material)?;
        let texel = textures.normal(texture, coordinates, footprint);
        Some((texel.color, map))
    }

    /// Returns the texture of a material and the use of its alpha; `None` for a material without one.
    pub fn surface_maps(&self, material: &Material) -> Option<&'a SurfaceMaps> {
        self.textures.get()?.maps_of(material)
    }

    /// Returns the environment.
    pub fn environment(&self) -> Option<&'a Environment> {
        self.environment.get()?.record
    }

    /// Returns the map of the environment, and its record.
    #[inline(always)]
    pub(crate) fn environment_map(&self) -> Option<(&EnvironmentMap<'a>, &'a Environment)> {
        let map = self.environment.get()?;
        Some((map, map.record?))
    }

    /// Returns the radiance that rays bring from a direction, with 20 fraction bits, without that of the sun. The
    /// direction is given by its place in the octahedral map: see [`Environment`]. `None` without an environment.
    pub fn environment_radiance(&self, place: [i32; 2]) -> Option<[i32; 3]> {
        let (map, record) = self.environment_map()?;
        Some(map.mixed(record, place))
    }

    /// Returns a random place of the octahedral map, drawn in proportion to the light of its texels. The argument is a
    /// point of the unit square that has 32 fraction bits. `None` without an environment.
    pub fn environment_place(&self, point: [u32; 2]) -> Option<[i32; 2]> {
        let (map, record) = self.environment_map()?;
        Some(map.draw(record, point))
    }

    /// Returns the contribution of the map as a light from a random place, over the density of that place and π, with
    /// 20 fraction bits. Half the sum of the magnitudes of its direction's components is given, with 30 fraction bits.
    /// `None` without an environment.
    pub fn environment_light(&self, place: [i32; 2], half_sum: i32) -> Option<[i32; 3]> {
        let (map, record) = self.environment_map()?;
        Some(map.sampled(record, place, half_sum))
    }
}
