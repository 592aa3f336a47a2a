use super::dim_reflections;

const RECTANGLE: &str =
    "kind = 'rectangle'\ncorner = [-3, 1, -3]\nedges = [[6, 0, 0], [0, 0, 6]]\nradiance =";

/// Sentences about a disc that mirrors, or another material, with a light.
fn sentences(material: &str, light: &str) -> Vec<String> {
    let file = format!(
        "[[object]]\nkind = 'disc'\ncenter = [0, 0, 0]\nnormal = [0, 1, 0]\nradius = 3\nmaterial = 'm'\n\
         [material.m]\ndiffuse = 0\n{material}\n[[light]]\n{light}"
    );
    let imported = crate::scene::read("a.toml".as_ref(), file.into(), &Default::default());
    dim_reflections(&imported.unwrap().scene)
}

fn of_mirror(roughness: f64, light: &str) -> Vec<String> {
    sentences(&format!("mirror = 1\nroughness = {roughness}"), light)
}

#[test]
fn lights_that_facets_mirror_too_brightly_for_fixed_have_a_sentence() {
    let found = of_mirror(0.05, &format!("{RECTANGLE} 1\nname = 'lamp'"));
    let [sentence] = &found[..] else {
        panic!("{found:?}")
    };
    assert!(
        sentence.starts_with(
            "in `fixed` and linear radiance, material m (a.toml:7) may show too little of light 0 (lamp): its facets"
        ),
        "{sentence}"
    );
    assert!(sentence.contains("a roughness of 0."), "{sentence}");
    for (roughness, rest, expected) in [
        (0.3, "1", 0),
        // At grazing angles alone.
        (0.2, "1", 1),
        (0.05, "0.0001", 0),
        // Rays hit what is seen, if the material is smooth enough.
        (0.05, "1\nvisible = true", 0),
        (0.3, "100\nvisible = true", 1),
        (1.0, "10000", 1),
    ] {
        let found = of_mirror(roughness, &format!("{RECTANGLE} {rest}"));
        assert_eq!(found.len(), expected, "{roughness} {rest}: {found:?}");
        let is_grazing = found.iter().any(|it| it.contains("at grazing angles"));
        assert_eq!(is_grazing, roughness == 0.2, "{found:?}");
        let is_rougher = found.iter().any(|it| it.contains("a roughness of"));
        assert_eq!(is_rougher, expected == 1 && roughness < 1.0, "{found:?}");
    }
}

#[test]
fn lights_without_an_area_have_a_sentence() {
    for (light, name) in [
        ("kind = 'directional'\ndirection = [0, -1, 0]", "light 0"),
        ("kind = 'point'\nposition = [0, 3, 0]", "light 0"),
        (
            "kind = 'spot'\nposition = [0, 3, 0]\ndirection = [0, -1, 0]",
            "light 0",
        ),
        (
            "kind = 'point'\nposition = [0, 3, 0]\ncolor = 0\n\
             [environment]\nzenith = 0\nhorizon = 0\nground = 0\nsun = {direction = [0, -1, 0], color = 1}",
            "the sun",
        ),
    ] {
        for (roughness, words) in [
            (0.05, Some("shows too little of NAME: ")),
            (
                0.15,
                Some("may show too little of NAME at grazing angles: "),
            ),
            (0.3, None),
        ] {
            let found = of_mirror(roughness, light);
            assert_eq!(
                found.len(),
                usize::from(words.is_some()),
                "{light}: {found:?}"
            );
            if let Some(words) = words {
                let words = words.replace("NAME", name);
                assert!(found[0].contains(&words), "{light}: {found:?}");
            }
        }
    }
    // What arrives is a ninth of the color.
    let square = |color: f64| {
        let light = "kind = 'point'\nposition = [0, 3, 0]\nfalloff = 'square'\ncolor =";
        of_mirror(0.3, &format!("{light} {color}")).len()
    };
    assert_eq!([9.0, 90.0].map(square), [0, 1]);
}

#[test]
fn rough_glass_mirrors_a_part_of_lights() {
    let distant = "kind = 'directional'\ndirection = [0, -1, 0]\ncolor = 10";
    let glass =
        |ior: f64, roughness: f64| format!("transmit = 1\nior = {ior}\nroughness = {roughness}");
    for (material, expected) in [
        (glass(2.0, 0.1), "shows"),
        (glass(1.5, 0.2), "may show"),
        (glass(1.0, 0.1), ""),
        (glass(1.5, 0.5), ""),
    ] {
        let found = sentences(&material, distant);
        assert_eq!(found.is_empty(), expected.is_empty(), "{material}");
        let words = format!("material m (a.toml:7) {expected} too little");
        assert!(found.iter().all(|it| it.contains(&words)), "{found:?}");
    }
}

/// A small sphere is sampled by solid angle: its samples are not brighter than it is.
#[test]
fn small_lights_far_away_have_no_sentence() {
    let sphere = |radius: f64, roughness: f64| {
        let light = format!("kind = 'sphere'\ncenter = [0, 3, 0]\nradius = {radius}\nradiance = 5");
        of_mirror(roughness, &light).len()
    };
    assert_eq!(sphere(0.02, 0.15), 0);
    assert_eq!(sphere(2.9, 0.15), 1);
    let behind = RECTANGLE.replace("[[6, 0, 0], [0, 0, 6]]", "[[0, 0, 6], [6, 0, 0]]");
    assert_eq!(of_mirror(0.05, &format!("{behind} 1")).len(), 0);
}

/// A large light at the surface, seen at a grazing angle.
#[test]
fn lights_that_fill_the_hemisphere_have_a_sentence() {
    let light = "kind = 'rectangle'\ncorner = [-0.3, -0.5, -2]\nedges = [[0, 2, 0], [0, 0, 4]]\nradiance = 0.78";
    let found = of_mirror(0.1, light);
    assert!(
        found.len() == 1 && found[0].contains("may show"),
        "{found:?}"
    );
}

#[test]
fn exposure_and_tracks_make_lights_brighter() {
    let distant = "kind = 'directional'\ndirection = [0, -1, 0]";
    assert_eq!(of_mirror(0.3, distant).len(), 0);
    let exposed = format!("{distant}\n[render]\nexposure = 4");
    assert_eq!(of_mirror(0.3, &exposed).len(), 1);
    let track = |target: &str| {
        format!(
            "{distant}\n[[track]]\ntarget = '{target}'\ntimes = [0, 1]\nvalues = [[0, 0, 0], [90, 9, 9]]"
        )
    };
    assert_eq!(of_mirror(0.3, &track("light.0.color")).len(), 1);
}
