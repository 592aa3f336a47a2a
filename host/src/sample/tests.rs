use super::*;
use crate::scene::{self, MoleculeOptions, Shape};
use crate::shape::Sphere;
use std::collections::HashMap;

fn centers(scene: &Scene) -> Vec<DVec3> {
    let center = |shape: &Shape| match shape {
        Shape::Sphere(Sphere { center, .. }) => Some(*center),
        _ => None,
    };
    scene
        .objects
        .iter()
        .filter_map(|object| center(&object.shape))
        .collect()
}

/// The lengths of all bonds, and how many atoms have how many neighbors.
fn bonds(scene: &Scene) -> (Vec<f64>, HashMap<usize, usize>) {
    let atoms = centers(scene);
    let sites: Vec<Site> = atoms
        .iter()
        .map(|&position| Site {
            element: Element::CARBON,
            position,
        })
        .collect();
    let bonds = perceive(&sites).0;
    let mut neighbors = vec![0; atoms.len()];
    for &end in bonds.iter().flatten() {
        neighbors[end as usize] += 1;
    }
    let mut counts = HashMap::new();
    for neighbors in neighbors {
        *counts.entry(neighbors).or_default() += 1;
    }
    (
        bonds
            .iter()
            .map(|[a, b]| atoms[*a as usize].distance(atoms[*b as usize]))
            .collect(),
        counts,
    )
}

#[test]
fn c60_has_its_bonds() {
    let scene = c60();
    let (lengths, neighbors) = bonds(&scene);
    assert_eq!(neighbors, HashMap::from([(3, 60)]));
    let count = |length: f64| {
        lengths
            .iter()
            .filter(|l| (*l - length).abs() < 1e-12)
            .count()
    };
    assert_eq!((count(1.40), count(1.46), lengths.len()), (30, 60, 90));
    assert_eq!(scene.objects.len(), 60 + 2 * 90);
    assert_eq!(
        (scene.materials.len(), scene.materials[0].name.as_str()),
        (1, "C")
    );
}

#[test]
fn nanotubes_are_closed_around() {
    for (n, m) in [(10, 10), (12, 0), (9, 4), (6, 5)] {
        let (lengths, neighbors) = bonds(&nanotube(n, m, 60.0));
        // Across the bend a bond is the chord of its arc.
        assert!(
            lengths.iter().all(|l| (1.39..=1.421 + 1e-9).contains(l)),
            "({n}, {m})"
        );
        let inner = neighbors[&3];
        let ends: usize = neighbors
            .iter()
            .filter(|(count, _)| **count != 3)
            .map(|(_, atoms)| atoms)
            .sum();
        assert!(
            neighbors.keys().all(|count| *count <= 3),
            "({n}, {m}): {neighbors:?}"
        );
        assert!(inner > 10 * ends, "({n}, {m}): {neighbors:?}");
    }
    let atoms = centers(&nanotube(10, 10, 172.0)).len();
    assert!((2780..=2820).contains(&atoms), "{atoms}");
}

#[test]
fn a_nanotube_too_thin_is_widened() {
    assert_eq!(nanotube(0, 0, 20.0), nanotube(3, 0, 20.0));
    assert_eq!(nanotube(2, 7, 20.0), nanotube(7, 2, 20.0));
}

#[test]
fn diamond_is_tetrahedral() {
    let scene = diamond(DIAMOND_2_800);
    let (lengths, neighbors) = bonds(&scene);
    let bond = 3.567 * 3.0_f64.sqrt() / 4.0;
    assert!(lengths.iter().all(|l| (l - bond).abs() < 1e-12));
    assert!(
        neighbors[&4] > 2000 && neighbors.keys().all(|count| *count <= 4),
        "{neighbors:?}"
    );
    for (radius, expected) in [(DIAMOND_2_800, 2_800.0), (DIAMOND_27_000, 27_000.0)] {
        let atoms = diamond(radius).objects.len() as f64;
        assert!((atoms / expected - 1.0).abs() < 0.02, "{atoms}");
    }
}

#[test]
fn the_camera_sees_every_atom() {
    for scene in [
        c60(),
        nanotube(10, 10, 172.0),
        diamond(DIAMOND_2_800),
        icosphere(2),
    ] {
        let camera = scene.camera.unwrap();
        let forward = (camera.target - camera.eye).normalize();
        let points = match &scene.objects[0].shape {
            Shape::Mesh { vertices, .. } => vertices.clone(),
            _ => centers(&scene),
        };
        for point in points {
            let angle = (point - camera.eye)
                .normalize()
                .dot(forward)
                .acos()
                .to_degrees();
            assert!(angle <= camera.fov_degrees / 2.0);
        }
    }
}

/// Writes a scene file and imports it.
fn reread(extension: &str, text: &str) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(format!("sample.{extension}"));
    std::fs::write(&path, text).unwrap();
    let imported = scene::load(&path, &MoleculeOptions::default()).unwrap();
    assert_eq!(imported.warnings, [] as [&str; 0]);
    imported.scene
}

#[test]
fn molecules_come_back_from_pdb() {
    for sample in [c60(), nanotube(10, 10, 172.0), diamond(DIAMOND_27_000)] {
        let mut read = reread("pdb", &pdb(&sample).unwrap());
        for material in &mut read.materials {
            material.place = Default::default();
        }
        assert_eq!(read.materials, sample.materials);
        let (before, after) = (centers(&sample), centers(&read));
        assert_eq!(before.len(), after.len());
        // Half of the last of three decimals.
        assert!(
            before
                .iter()
                .zip(&after)
                .all(|(a, b)| (*a - *b).abs().max_element() <= 0.000_501)
        );
    }
}

#[test]
fn scenes_that_pdb_cannot_hold_are_rejected() {
    assert_eq!(pdb(&icosphere(0)), Err(PdbError::NoAtoms));
    let mut scene = c60();
    let Shape::Sphere(Sphere { center, .. }) = &mut scene.objects[7].shape else {
        panic!("no sphere")
    };
    center.y = 10_000.0;
    assert_eq!(
        pdb(&scene),
        Err(PdbError::TooFar {
            name: "C8".to_owned(),
            value: 10_000.0
        })
    );
    scene.objects = vec![c60().objects[0].clone(); 100_000];
    assert_eq!(pdb(&scene), Err(PdbError::TooManyAtoms(100_000)));
}

#[test]
fn icospheres_are_closed_and_come_back_from_obj() {
    for levels in [0, 1, 5] {
        let sample = icosphere(levels);
        let Shape::Mesh {
            vertices,
            triangles,
        } = &sample.objects[0].shape
        else {
            panic!("no mesh")
        };
        let cut = 4_usize.pow(levels);
        assert_eq!((vertices.len(), triangles.len()), (10 * cut + 2, 20 * cut));
        assert!(vertices.iter().all(|v| (v.length() - 1.0).abs() < 1e-15));
        let mut edges = HashMap::new();
        for &[a, b, c] in triangles {
            let [p, q, r] = [a, b, c].map(|i| vertices[i as usize]);
            assert!(
                (q - p).cross(r - p).dot(p) > 0.0,
                "a triangle faces inwards"
            );
            for edge in [[a, b], [b, c], [c, a]] {
                *edges.entry(edge).or_insert(0) += 1;
            }
        }
        assert!(
            edges
                .iter()
                .all(|([a, b], count)| *count == 1 && edges.contains_key(&[*b, *a]))
        );

        let read = reread("obj", &obj(&sample));
        let Shape::Mesh {
            vertices: again,
            triangles: cut_again,
        } = &read.objects[0].shape
        else {
            panic!("no mesh")
        };
        // The importer orders vertices by their first use.
        let corners = |v: &[DVec3], t: &[[u32; 3]]| -> Vec<[DVec3; 3]> {
            t.iter().map(|t| t.map(|i| v[i as usize])).collect()
        };
        assert_eq!(corners(again, cut_again), corners(vertices, triangles));
    }
}
