//! The materials of glTF in terms of light that is diffuse, mirrored, or let through.
//!
//! With base color c, metalness m, roughness r and transmission t:
//!
//! | here | from |
//! |---|---|
//! | diffuse | c ((1 - m) (1 - t) + m r): what a rough metal scatters counts as diffuse |
//! | mirror | c m (1 - r) |
//! | highlight | F0 (n + 8) / 8, scaled down to at most 1, where F0 = 0.04 (1 - m) + c m; none at r = 1 |
//! | shininess n | 2 / r^4 - 2, from 1 to 1024, the Blinn-Phong exponent of that roughness |
//! | transmit | c t (1 - m) |
//! | index of refraction | that of `KHR_materials_ior` where the glass has a volume, else 1: a pane |
//! | emission | emissive factor times `KHR_materials_emissive_strength`: 1 is display white; on the front alone |
//! | absorption | -ln(attenuation color) / attenuation distance |
//!
//! The emissive factor is weighted by the mean color of the emissive texture, and t by the mean of red of the
//! transmission texture: see [`Means`].
//!
//! A metal without textures and with a roughness from 0.05 to below 1 has a rough mirror instead. It is the mirror c m
//! with that roughness. The diffuse color has no part of it, and the highlight is that of m = 0. Others are as above: a
//! file that states neither also has a metalness and a roughness of 1.
//!
//! Where the alpha mode is `BLEND`, alpha is the part of the material that is present, and the rest is a pane. Textures
//! with alpha are the exception.

use crate::scene::{Alpha, BRIGHTEST, Color, Diffuse, Material};
use crate::table::shortened;
use gltf::material::AlphaMode;

/// The weights of a material's factors: 1 without a texture, and 0 for one that cannot be read.
pub(super) struct Means {
    /// The mean of the emissive texture, as linear light.
    pub(super) emission: Color,
    /// The mean of red of the transmission texture.
    pub(super) transmission: f64,
}

pub(super) fn name(material: &gltf::Material<'_>) -> String {
    material.name().map_or_else(
        || match material.index() {
            Some(index) => format!("material {index}"),
            None => Material::default().name,
        },
        str::to_owned,
    )
}

/// Returns whether all that has this material is cut out.
pub(super) fn is_cut_out(material: &gltf::Material<'_>) -> bool {
    material.alpha_mode() == AlphaMode::Mask && !is_there(material)
}

/// Sentences on numbers of a material that are taken otherwise.
pub(super) fn ignored(material: &gltf::Material<'_>) -> impl Iterator<Item = String> {
    let name = name(material);
    let surface = material.pbr_metallic_roughness();
    let through = material.transmission();
    let one = |number: f32| vec![number];
    let factors = [
        ("base color", surface.base_color_factor().to_vec()),
        ("metallic", one(surface.metallic_factor())),
        ("roughness", one(surface.roughness_factor())),
        ("emissive", material.emissive_factor().to_vec()),
        (
            "transmission",
            through.map_or(Vec::new(), |it| one(it.transmission_factor())),
        ),
    ];
    let is_within = |numbers: &[f32]| numbers.iter().all(|it| (0.0..=1.0).contains(it));
    let beyond = factors.into_iter().filter(move |(_, it)| !is_within(it));
    let outside = format!(
        "factor of material {:?} is outside of its range, 0 to 1",
        shortened(&name)
    );
    let beyond = beyond.map(move |(what, _)| format!("the {what} {outside}"));
    index_taken(material, &name).into_iter().chain(beyond)
}

/// A sentence on an index of refraction that is taken otherwise.
fn index_taken(material: &gltf::Material<'_>, name: &str) -> Option<String> {
    let index = material.ior().filter(|ior| !(1.0..=4.0).contains(ior));
    index.map(|ior| {
        let taken = taken_ior(ior);
        format!("the index of refraction {ior} of material {name:?} is taken as {taken}; it must be 1 to 4", name = shortened(name))
    })
}

/// Sentences on what of a material's emission is ignored.
pub(super) fn ignored_emission(
    material: &gltf::Material<'_>,
    means: &Means,
) -> impl Iterator<Item = String> {
    let name = name(material);
    let emission = emission(material, means);
    let glows = emission != [0.0; 3];
    [
        emission.iter().any(|&it| it > BRIGHTEST).then(|| {
            format!("the emission of material {name:?} is limited to {BRIGHTEST}; lower its emissive strength", name = shortened(&name))
        }),
        (material.double_sided() && glows).then(|| {
            format!("material {name:?} has two sides, and glows on the front alone", name = shortened(&name))
        }),
    ]
    .into_iter()
    .flatten()
}

fn taken_ior(ior: f32) -> f64 {
    f64::from(ior).clamp(1.0, 4.0)
}

/// Returns whether the alpha of the base color alone is not cut out.
fn is_there(material: &gltf::Material<'_>) -> bool {
    let [.., alpha] = material.pbr_metallic_roughness().base_color_factor();
    alpha >= material.alpha_cutoff().unwrap_or(0.5)
}

/// Returns the use of the alpha of a texture that is not opaque everywhere.
pub(super) fn alpha(material: &gltf::Material<'_>) -> Option<Alpha> {
    let [.., factor] = material.pbr_metallic_roughness().base_color_factor();
    let factor = f64::from(factor).clamp(0.0, 1.0);
    match material.alpha_mode() {
        AlphaMode::Opaque => None,
        AlphaMode::Blend => Some(Alpha::Blend(factor)),
        AlphaMode::Mask => {
            let cutoff = f64::from(material.alpha_cutoff().unwrap_or(0.5));
            (cutoff > 0.0).then(|| Alpha::CutOut((cutoff / factor).min(1.0)))
        }
    }
}

/// Reads a material, whose alpha is used by a texture, or else makes a pane of it.
pub(super) fn read(material: &gltf::Material<'_>, alpha_is_used: bool, means: &Means) -> Material {
    let name = name(material);
    let unit = |x: f32| f64::from(x).clamp(0.0, 1.0);
    let surface = material.pbr_metallic_roughness();
    let [red, green, blue, alpha] = surface.base_color_factor().map(unit);
    let base = [red, green, blue];
    let [metal, rough] = [surface.metallic_factor(), surface.roughness_factor()].map(unit);
    let through = material.transmission();
    let through = through.map_or(0.0, |through| unit(through.transmission_factor()));
    let through = through * means.transmission;
    let there = match material.alpha_mode() {
        AlphaMode::Blend if !alpha_is_used => alpha,
        _ => 1.0,
    };
    // Factors of a texture that is not read say little, and a mirror has no texture.
    let is_plain =
        surface.metallic_roughness_texture().is_none() && surface.base_color_texture().is_none();
    let is_glossy = metal > 0.0 && is_plain && (Material::LEAST_ROUGHNESS..1.0).contains(&rough);
    let times = |factor: f64| base.map(|channel| channel * factor * there);
    let power = 2.0 / (rough * rough * rough * rough).max(1e-9) - 2.0;
    let shininess = power.round().clamp(1.0, 1024.0);
    let facing = base.map(|channel| {
        let by_metal = if is_glossy { 0.0 } else { channel * metal };
        0.04 * (1.0 - metal) + by_metal
    });
    // At most 1 in each channel, of the same hue.
    let most = facing.into_iter().fold(0.0, f64::max);
    let peak = ((shininess + 8.0) / 8.0).min(1.0 / most.max(1e-9));
    let scattered = if is_glossy { 0.0 } else { rough };
    let volume = material.volume().filter(|v| v.thickness_factor() > 0.0);
    let glass = times(through * (1.0 - metal));
    Material {
        diffuse: Diffuse::Plain(times((1.0 - metal) * (1.0 - through) + metal * scattered)),
        highlight: if rough < 1.0 {
            facing.map(|channel| channel * peak * there)
        } else {
            [0.0; 3]
        },
        shininess: shininess as u16,
        mirror: times(metal * (1.0 - scattered)),
        roughness: if is_glossy { rough } else { 0.0 },
        transmit: glass.map(|channel| channel + 1.0 - there),
        ior: match &volume {
            Some(_) => taken_ior(material.ior().unwrap_or(1.5)),
            None => 1.0,
        },
        priority: None,
        absorption: volume.map_or([0.0; 3], |volume| {
            absorption(volume.attenuation_color(), volume.attenuation_distance())
        }),
        emission: emission(material, means).map(|channel| channel.clamp(0.0, BRIGHTEST) * there),
        name,
        ..Material::default()
    }
}

/// The radiance of a material's surface.
fn emission(material: &gltf::Material<'_>, means: &Means) -> Color {
    let strength = material.emissive_strength().unwrap_or(1.0);
    let factors = material.emissive_factor();
    std::array::from_fn(|k| f64::from(factors[k] * strength) * means.emission[k])
}

/// The coefficient of Beer's law by which white light turns into a color over a distance.
fn absorption(color: [f32; 3], distance: f32) -> Color {
    let distance = f64::from(distance);
    if !distance.is_finite() || distance <= 0.0 {
        return [0.0; 3];
    }
    // Black would take an infinite coefficient.
    color.map(|channel| -libm::log(f64::from(channel).clamp(1e-6, 1.0)) / distance)
}
