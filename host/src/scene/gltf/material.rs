//! Materials, from metallic-roughness to what rays make of surfaces here.

use super::super::{Diffuse, Material};

/// The material, without its name, and sentences about what it loses.
pub(super) fn read(material: &::gltf::Material<'_>) -> (Material, Vec<&'static str>) {
    let mut warnings = Vec::new();
    let pbr = material.pbr_metallic_roughness();
    let textured = pbr.base_color_texture().is_some()
        || pbr.metallic_roughness_texture().is_some()
        || material.normal_texture().is_some()
        || material.occlusion_texture().is_some()
        || material.emissive_texture().is_some();
    if textured {
        warnings.push("textures are passed over");
    }
    if material.emissive_factor() != [0.0; 3] {
        warnings.push("surfaces that shine by themselves do not");
    }
    let ratio = |value: f32| {
        if value.is_finite() {
            f64::from(value).clamp(0.0, 1.0)
        } else {
            0.0
        }
    };
    let [red, green, blue, _] = pbr.base_color_factor().map(ratio);
    let color = [red, green, blue];
    let (metal, rough) = (ratio(pbr.metallic_factor()), ratio(pbr.roughness_factor()));
    let through = material
        .transmission()
        .map_or(0.0, |it| ratio(it.transmission_factor()));
    // What a metal reflects sharply; what is rough spreads, and counts as diffuse.
    let sharp = metal * (1.0 - rough);
    let through = through * (1.0 - metal);
    let weighted = |weight: f64| color.map(|channel| channel * weight);
    let ior = material.ior().map_or(1.5, f64::from);
    let absorption = material.volume().map_or([0.0; 3], |volume| {
        let distance = f64::from(volume.attenuation_distance());
        volume.attenuation_color().map(|channel| {
            // After that distance the colour's part is left.
            let left = ratio(channel).max(1e-6);
            if distance > 0.0 && distance.is_finite() {
                -libm::log(left) / distance + 0.0
            } else {
                0.0
            }
        })
    });
    let exponent = 2.0 / libm::pow(rough.max(0.1), 4.0) - 2.0;
    let read = Material {
        diffuse: Diffuse::Plain(weighted((1.0 - sharp) * (1.0 - through))),
        highlight: [0.5 * (1.0 - rough); 3],
        shininess: exponent.round().clamp(1.0, 1024.0) as u16,
        mirror: weighted(sharp),
        transmit: weighted(through),
        ior: if ior.is_finite() {
            ior.clamp(1.0, 4.0)
        } else {
            1.5
        },
        absorption,
        ..Material::default()
    };
    (read, warnings)
}
