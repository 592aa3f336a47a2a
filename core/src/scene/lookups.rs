//! What a blob defines by integers: images and the environment, looked up as the ray loop does.

use crate::format::Effects;
use crate::format::environment::Environment;
use crate::format::record::{Material, NormalMap, SurfaceMaps};
use crate::scene::Scene;
use crate::scene::textures::Footprint;

impl<'a> Scene<'a> {
    /// The color of a material's texture at coordinates with 20 fraction bits: linear ratios with 30 fraction bits.
    /// `None` of a material without a texture. Of one without levels the footprint means nothing.
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

    /// The alpha of a material's texture at coordinates with 20 fraction bits: a ratio with 30 fraction bits. `None` of a
    /// material that does not use it. Of a texture without levels the footprint means nothing.
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

    /// The normal that a material's normal map holds at coordinates with 20 fraction bits, along u, against v and along the
    /// surface's normal: ratios from -1 to 1 with 30 fraction bits, and the map, whose factors are not yet in them. `None`
    /// of a material without one. Of one without levels the footprint means nothing.
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

    /// The texture of a material and how its alpha is used; `None` of a material without one.
    pub fn surface_maps(&self, material: &Material) -> Option<&'a SurfaceMaps> {
        self.textures.get()?.maps_of(material)
    }

    /// The environment.
    pub fn environment(&self) -> Option<&'a Environment> {
        self.environment.get()?.record
    }

    /// The radiance with 20 fraction bits, without that of the sun, that rays bring from a direction, given by the
    /// direction's place in the octahedral map: see [`Environment`]. `None` without an environment.
    pub fn environment_radiance(&self, place: [i32; 2]) -> Option<[i32; 3]> {
        let map = self.environment.get()?;
        Some(map.mixed(map.record?, place))
    }

    /// A random place of the octahedral map, drawn in proportion to the light of its texels with a point of the unit square
    /// that has 32 fraction bits; `None` without an environment.
    pub fn environment_place(&self, point: [u32; 2]) -> Option<[i32; 2]> {
        let map = self.environment.get()?;
        Some(map.draw(map.record?, point))
    }

    /// What the map brings as a light from a place that was drawn, over the density with which it is drawn and π, with
    /// 20 fraction bits, given half the sum of the magnitudes of its direction's components, with 30. `None` without an
    /// environment.
    pub fn environment_light(&self, place: [i32; 2], half_sum: i32) -> Option<[i32; 3]> {
        let map = self.environment.get()?;
        Some(map.sampled(map.record?, place, half_sum))
    }
}
