//! The Cargo features are those of the registries: a shape, an effect or a structure is in every list.

use super::text;
use gridel_core::{Effects, Kind, Structure};
use std::collections::{BTreeMap, BTreeSet};

type Features = BTreeMap<String, BTreeSet<String>>;

/// The features of a manifest, each with the features that it enables.
fn features(manifest: &str) -> Features {
    let manifest: toml::Table = text(manifest).parse().expect("a manifest");
    let features = manifest["features"].clone();
    features.try_into().expect("lists of features")
}

fn set<'n>(names: impl IntoIterator<Item = &'n str>) -> BTreeSet<String> {
    names.into_iter().map(String::from).collect()
}

fn shapes() -> BTreeSet<String> {
    // Two wider forms of storage, besides the kinds.
    let kinds = Kind::ALL.into_iter().map(Kind::name);
    set(kinds.chain(["wide-lattice", "wide-indices"]))
}

fn effects() -> BTreeSet<String> {
    // Views of display values are no effect of the ray loop.
    let named = Effects::NAMED.into_iter().map(|(_, name)| name);
    set(named.chain(["display-values"]))
}

/// All structures but brute force, which needs no feature.
fn structures() -> BTreeSet<String> {
    let all = Structure::ALL.into_iter();
    set(all
        .filter(|&structure| structure != Structure::List)
        .map(Structure::name))
}

#[test]
fn core_feature_lists_equal_the_registries() {
    let features = features("core/Cargo.toml");
    assert_eq!(features["all-shapes"], shapes());
    assert_eq!(features["all-effects"], effects());
    let mut listed = features["all-structures"].clone();
    assert!(listed.remove("comparison"), "all-structures lacks it");
    let twice: Vec<_> = listed.intersection(&features["comparison"]).collect();
    assert!(twice.is_empty(), "in both lists: {twice:?}");
    listed.extend(features["comparison"].clone());
    assert_eq!(listed, structures());
    for name in [shapes(), effects(), structures()].iter().flatten() {
        assert!(features.contains_key(name), "{name} is no feature");
    }
}

#[test]
fn firmware_passes_on_every_shape_and_effect() {
    let features = features("tests/firmware/Cargo.toml");
    for name in shapes().union(&effects()) {
        let expected = set([&*format!("gridel-core/{name}")]);
        assert_eq!(features.get(name), Some(&expected), "{name}");
    }
    let named = structures();
    let passed_on: Vec<_> = features
        .keys()
        .filter(|name| named.contains(*name))
        .collect();
    assert!(passed_on.len() >= 5, "{passed_on:?}");
    for name in passed_on {
        assert_eq!(features[name], set([&*format!("gridel-core/{name}")]));
    }
}
