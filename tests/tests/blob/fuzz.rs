//! The fuzz targets, a bounded number of times from their committed corpora: what libFuzzer runs
//! without an end (see `tests/fuzz`).

use gridel_host::scene::IMPORTERS;
use gridel_tests::effort::part_of;
use gridel_tests::fuzz::bounded::{corpus, run};
use gridel_tests::fuzz::{blob, import, npy, seeds, toml};
use gridel_tests::scenes::fixture_folder;
use std::path::{Path, PathBuf};

fn corpus_folder(target: &str) -> PathBuf {
    let fuzz = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz");
    fuzz.join("corpus").join(target)
}

#[test]
fn fuzzed_blobs_are_rejected_or_answer_as_brute_force() {
    run(
        &corpus(&fixture_folder().join("blobs")),
        part_of(20_000, 200_000),
        blob,
    );
}

#[test]
fn fuzzed_scene_files_are_rejected_or_compile_and_load() {
    let corpus = corpus(&corpus_folder("import"));
    for importer in IMPORTERS {
        run(&seeds(importer, &corpus), part_of(500, 5_000), import);
    }
}

#[test]
fn fuzzed_toml_scenes_are_rejected_or_compile_and_load() {
    run(
        &corpus(&corpus_folder("toml")),
        part_of(2_000, 20_000),
        toml,
    );
}

#[test]
fn fuzzed_arrays_of_rays_are_rejected_or_answer_as_brute_force() {
    run(
        &corpus(&corpus_folder("npy")),
        part_of(20_000, 200_000),
        npy,
    );
}
