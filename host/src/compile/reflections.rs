//! Lights that rough mirrors and rough glass reflect by their random points, brighter than `fixed` holds.

use super::requirements::RequiringPart;
use crate::scene::{Light, LightShape, Material, Scene};
use crate::table::printable;

/// The largest radiance of a sample in `fixed`.
const MOST: f64 = 2048.0;

/// The roughness from which on lights that rays could hit are reflected by their random points, too.
const FOR_ALL: f64 = 0.3;

/// Returns a sentence for each rough material that in `fixed` shows too little of a light with an area. `scene` has
/// its [emitters](Scene::with_emitters).
pub(super) fn dim_reflections(scene: &Scene) -> Vec<String> {
    let mut is_used = vec![false; scene.materials.len()];
    for object in scene.all_objects() {
        is_used[object.material] = true;
    }
    let materials = scene.materials.iter().zip(is_used);
    let used = materials.filter(|(material, is_used)| *is_used && material.is_rough());
    used.filter_map(|(material, _)| dim_reflection(scene, material))
        .collect()
}

fn dim_reflection(scene: &Scene, material: &Material) -> Option<String> {
    let roughness = material.roughness.max(Material::LEAST_ROUGHNESS);
    let forms = scene.light_forms.iter();
    let lights = scene.lights.iter().zip(forms).filter_map(|(light, form)| {
        let (form, Light::Point { color, .. }) = (form.as_ref()?, light) else {
            return None;
        };
        let has_area = !matches!(form.shape, LightShape::Point | LightShape::Facet { .. });
        let is_drawn = !form.is_surface || roughness >= FOR_ALL;
        (has_area && is_drawn).then(|| largest(*color))
    });
    let radiance = lights.reduce(f64::max)? * libm::exp2(scene.render.exposure);
    let part = match material.transmit == [0.0; 3] {
        true => largest(material.mirror),
        false => 1.0,
    };
    // The brightest facets, seen from above: 1 / (4 α^2).
    let brightness = part * radiance / 4.0;
    let alpha = roughness * roughness;
    if brightness / (alpha * alpha) <= MOST {
        return None;
    }
    let least = libm::sqrt(libm::sqrt(brightness / MOST));
    let remedy = match least {
        ..=1.0 => format!(
            "a roughness of {:.2} or more",
            (100.0 * least).ceil() / 100.0
        ),
        _ => String::from("a darker light"),
    };
    let label = format!("material {}", printable(&material.name));
    let label = RequiringPart::new(label, &material.place);
    Some(format!(
        "in `fixed` {label} shows too little of lights with an area: single samples are brighter than {MOST}, the \
         largest radiance; use `f32`, or {remedy}"
    ))
}

fn largest([red, green, blue]: [f64; 3]) -> f64 {
    red.max(green).max(blue)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sentences about a mirror under a rectangular light.
    fn sentences(roughness: f64, mirror: f64, light: &str) -> Vec<String> {
        let file = format!(
            "[[object]]\nkind = 'disc'\ncenter = [0, 0, 0]\nnormal = [0, 1, 0]\nradius = 3\nmaterial = 'm'\n\
             [material.m]\ndiffuse = 0\nmirror = {mirror}\nroughness = {roughness}\n\
             [[light]]\nkind = 'rectangle'\ncorner = [-3, 1, -3]\nedges = [[6, 0, 0], [0, 0, 6]]\n{light}"
        );
        let imported = crate::scene::read("a.toml".as_ref(), file.into(), &Default::default());
        dim_reflections(&imported.unwrap().scene.with_emitters())
    }

    #[test]
    fn lights_that_facets_mirror_too_brightly_for_fixed_have_a_sentence() {
        let found = sentences(0.05, 1.0, "radiance = 1");
        assert!(
            found.len() == 1 && found[0].starts_with("in `fixed` material m (a.toml:7) shows"),
            "{found:?}"
        );
        assert!(
            found[0].ends_with("a roughness of 0.11 or more"),
            "{found:?}"
        );
        for (roughness, mirror, light) in [
            (0.15, 1.0, "radiance = 1"),
            (0.05, 0.05, "radiance = 1"),
            (0.05, 1.0, "radiance = 0.05"),
            // Rays hit what is seen, if the material is smooth enough.
            (0.05, 1.0, "radiance = 1\nvisible = true"),
            (0.05, 0.0, "radiance = 1"),
        ] {
            let found = sentences(roughness, mirror, light);
            assert!(found.is_empty(), "{found:?}");
        }
        assert_eq!(
            sentences(0.3, 1.0, "radiance = 100\nvisible = true").len(),
            1
        );
        let brightest = sentences(1.0, 1.0, "radiance = 10000");
        assert!(brightest[0].ends_with("a darker light"), "{brightest:?}");
    }
}
