//! Shapes and effects whose programs are recorded.

/// Returns shapes and effects that scenes often require together. Each takes eight builds, two on every kind of core,
/// so the list is short. The memory report bounds the combinations that are not on it.
pub fn usual() -> impl Iterator<Item = (Vec<&'static str>, Vec<&'static str>)> {
    const EVERY: &str = "shadow highlight mirror glass absorption checker";
    const EVERY_SMOOTH: &str = "shadow highlight mirror glass absorption checker smooth";
    const EVERY_LAMP: &str = "shadow highlight mirror glass absorption checker smooth vertex-colors texture \
        falloff area-light tone-mapping emission";
    const GLTF: &str =
        "shadow glossy mirror smooth normal-map vertex-colors texture alpha falloff emission";
    const EVERY_SHAPE: &str = "triangle sphere box disc cone torus plane";
    let programs = [
        ("triangle", "shadow"),
        ("triangle", "shadow highlight"),
        ("triangle", EVERY),
        ("triangle", "shadow smooth"),
        ("triangle", "shadow highlight smooth"),
        ("triangle", EVERY_SMOOTH),
        ("triangle", "shadow falloff"),
        ("triangle", "shadow falloff area-light"),
        ("triangle", "shadow smooth falloff area-light"),
        ("triangle", "shadow smooth texture"),
        ("triangle instances", "shadow"),
        ("sphere", "shadow"),
        ("sphere", "shadow highlight"),
        ("sphere", EVERY),
        ("sphere", "shadow falloff area-light"),
        ("box", "shadow"),
        ("box", "shadow highlight"),
        ("disc", "shadow"),
        ("cone", "shadow"),
        ("torus", "shadow"),
        ("triangle plane", "shadow"),
        ("triangle sphere", "shadow"),
        ("triangle box", "shadow"),
        ("sphere box", "shadow"),
        // Molecules as balls and sticks.
        ("sphere cone", "shadow"),
        ("sphere cone", "shadow highlight"),
        ("triangle sphere box", EVERY),
        ("triangle sphere box disc cone", "shadow"),
        ("triangle sphere box disc cone", "shadow highlight"),
        ("triangle sphere box disc cone", EVERY),
        // They bound the programs of many scenes that are not on this list.
        (EVERY_SHAPE, EVERY_SMOOTH),
        (EVERY_SHAPE, EVERY_LAMP),
        // Meshes as glTF files have them.
        ("triangle", GLTF),
        (
            "triangle sphere box disc cone",
            "environment shadow highlight glossy mirror glass absorption checker smooth texture falloff area-light \
             tone-mapping emission depth-of-field indirect",
        ),
        // The fixtures: glass-chess, cornell, robot-arm, room, sky, studio, tumbler, turntable.
        (
            "sphere box disc cone",
            "shadow highlight glass absorption checker",
        ),
        (
            "triangle sphere box",
            "shadow highlight mirror glass absorption",
        ),
        (
            "sphere box disc cone instances",
            "shadow highlight mirror checker",
        ),
        (
            "triangle sphere box",
            "shadow falloff area-light tone-mapping emission indirect",
        ),
        (
            "sphere disc",
            "environment shadow glossy mirror checker tone-mapping depth-of-field indirect",
        ),
        (
            "triangle sphere",
            "shadow mirror vertex-colors texture alpha falloff area-light tone-mapping emission",
        ),
        (
            "box cone",
            "shadow highlight nested glass absorption checker falloff area-light",
        ),
        (
            "sphere box disc cone torus",
            "shadow highlight mirror checker",
        ),
    ];
    let split = |text: &'static str| text.split_whitespace().collect::<Vec<_>>();
    programs
        .into_iter()
        .map(move |(shapes, effects)| (split(shapes), split(effects)))
}
