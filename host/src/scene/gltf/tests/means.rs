//! Textures of emission and transmission, whose means weight the factors.

use super::*;

/// The document with a texture of these pixels, and more members of its material.
fn with_texture(pixels: &[[u8; 4]], members: &Value) -> Value {
    let mut document = document();
    let image = crate::scene::image::tests::png_of(pixels.len() as u32, 1, pixels);
    let image = STANDARD.encode(image);
    document["images"] = json!([{"uri": format!("data:image/png;base64,{image}")}]);
    document["textures"] = json!([{"source": 0}]);
    let material = document["materials"][0].as_object_mut().unwrap();
    material.extend(members.as_object().unwrap().clone());
    document
}

fn glowing() -> Value {
    let members = json!({"emissiveFactor": [1, 1, 0.5], "emissiveTexture": {"index": 0}});
    with_texture(&[[255, 0, 0, 255], [0, 188, 255, 255]], &members)
}

fn glass() -> Value {
    let transmission = json!({"transmissionFactor": 0.5, "transmissionTexture": {"index": 0}});
    let members = json!({"extensions": {"KHR_materials_transmission": transmission}});
    with_texture(&[[188, 0, 0, 255], [0, 255, 0, 255]], &members)
}

/// Programs write the factor 1 wherever there is a texture.
#[test]
fn emissive_texture_weights_the_factor_by_its_mean_as_light() {
    let emission = scene(&glowing()).materials[0].emission;
    assert_eq!([emission[0], emission[2]], [0.5, 0.25]);
    // 188 is half of white as light.
    assert!((emission[1] - 0.25).abs() < 0.002, "{emission:?}");
    assert_eq!(
        warnings(&glowing()),
        ["textures of material \"plain\" are not drawn: emissive (its mean is taken)"]
    );
}

#[test]
fn transmission_texture_weights_the_factor_by_its_mean_of_red() {
    let material = scene(&glass()).materials.remove(0);
    let through = 0.5 * 188.0 / 510.0;
    assert_eq!(material.transmit, [through; 3]);
    assert_eq!(material.diffuse, Diffuse::Plain([1.0 - through; 3]));
    assert_eq!(
        warnings(&glass()),
        ["textures of material \"plain\" are not drawn: transmission (its mean is taken)"]
    );
}

#[test]
fn texture_of_emission_or_transmission_without_an_image_counts_as_black() {
    for (mut document, kind, without) in [
        (glowing(), "emissive", "does not glow"),
        (glass(), "transmission", "lets no light through"),
    ] {
        // The color has the same image.
        let color = json!({"index": 0});
        document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = color;
        document["images"] = json!([{"uri": "none.png"}]);
        let material = scene(&document).materials.remove(0);
        assert_eq!([material.emission, material.transmit], [[0.0; 3]; 2]);
        let found = warnings(&document);
        let named = |words: &str| {
            let mut found = found.iter();
            found.any(|it| it.contains("none.png") && it.ends_with(words))
        };
        assert!(
            named(&format!("the material \"plain\" {without}")),
            "{found:?}"
        );
        assert!(named("the plain color is used"), "{found:?}");

        document["textures"] = json!([{}]);
        let material = scene(&document).materials.remove(0);
        assert_eq!([material.emission, material.transmit], [[0.0; 3]; 2]);
        let sentence = format!(
            "the {kind} texture of material \"plain\" names no image that Gridel reads; the material {without}"
        );
        let found = warnings(&document);
        assert!(found.contains(&sentence), "{found:?}");
    }
}

#[test]
fn texture_of_emission_with_factor_0_is_not_read() {
    let mut document = glowing();
    document["images"] = json!([{"uri": "../outside.png"}]);
    assert!(cause(&document).contains("outside of the scene's folder"));
    document["materials"][0]["emissiveFactor"] = json!([0, 0, 0]);
    assert_eq!(
        warnings(&document),
        ["textures of material \"plain\" are not drawn: emissive"]
    );
}

/// Emission on the front alone, or too strong, is warned of only if weights leave it so.
#[test]
fn warnings_of_emission_are_those_of_the_weighted_factor() {
    let mut document = glowing();
    document["materials"][0]["doubleSided"] = json!(true);
    document["materials"][0]["extensions"] =
        json!({"KHR_materials_emissive_strength": {"emissiveStrength": 4000}});
    let found = warnings(&document);
    assert!(
        found.len() == 2 && found[1].contains("two sides"),
        "{found:?}"
    );
    let image = STANDARD.encode(crate::scene::image::tests::png_of(1, 1, &[[0, 0, 0, 255]]));
    document["images"] = json!([{"uri": format!("data:image/png;base64,{image}")}]);
    assert_eq!(warnings(&document).len(), 1);
}
