//! `verify` finds no fault in right answers, and every fault that is made on purpose.

use glam::{DQuat, DVec3, EulerRot};
use gridel_core::accel::{SceneGeometry, StackView, StructureViews, Traverse};
use gridel_core::format::Leaf;
use gridel_core::shared::Cull;
use gridel_core::{Accel, Flagged, Hit, Kind, List, Number, Observer, Ray, Scene, Structure};
use gridel_host::blob::Blob;
use gridel_host::random::Random;
use gridel_host::scene::Shape;
use gridel_host::shape::Solid;
use gridel_host::shape::{Cone, Cuboid};
use gridel_host::verify::judge::{GRAZING, Judge, STEPS};
use gridel_host::verify::rounded::{Answer, HitId, RoundedRay};
use gridel_host::verify::{
    ClosedMesh, Property, RAYS, StructureAnswer, Targets, UnitRay, ask, ask_all, check, leave,
    sealed, verify,
};
use gridel_tests::effort::{part_of, sixth_of};
use gridel_tests::scenes;
use gridel_tests::shapes::examples;

fn mesh(subdivisions: usize) -> Blob {
    let (vertices, triangles) = scenes::icosphere(subdivisions);
    let shape = Shape::Mesh {
        vertices,
        triangles,
    };
    scenes::blob(&scenes::of([shape]), 24)
}

#[test]
fn right_scenes_are_right() {
    let soup = scenes::blob(&scenes::soup(21, 60, 0.4), 24);
    let coarse = scenes::blob(&scenes::soup(22, 60, 0.4), 10);
    for (name, blob) in [("soup", soup), ("coarse", coarse), ("mesh", mesh(2))] {
        let scene = blob.scene().expect("a scene");
        let report = verify(&scene, 1500, &|| ());
        eprintln!("{name}: {report:#?}");
        assert_eq!(report.broken(), 0, "{name}");
        assert_eq!(report.closed_meshes, usize::from(name == "mesh"));
        let leaks = report.properties.last().expect("properties").checked;
        assert_eq!(leaks > 0, name == "mesh");
    }
}

/// For some structures a blob stores primitives only in clusters.
#[test]
fn scenes_of_every_structure_alone_are_right() {
    for structure in Structure::ALL {
        let all = scenes::of(examples().into_iter().map(|(_, shape)| shape));
        for scene in [scenes::soup(23, 40, 0.4), all] {
            let options = gridel_host::compile::Options {
                structures: vec![structure],
                ..Default::default()
            };
            let name = structure.name();
            let compiled = gridel_host::compile::compile(&scene, &options).expect(name);
            let view = compiled.blob.scene().expect("a scene");
            let primitives = Kind::ALL.map(|kind| (kind, view.count(kind)));
            for (kind, slot) in primitives
                .into_iter()
                .flat_map(|(kind, n)| (0..n).map(move |it| (kind, it)))
            {
                assert!(
                    view.geometry(kind, slot).is_some(),
                    "{name}: {kind:?} {slot}"
                );
            }
            let report = verify(&view, part_of(80, 300) as u64, &|| ());
            assert_eq!(report.broken(), 0, "{name}: {report:#?}");
        }
    }
}

/// A ray through the hole of a torus meets it again, and one towards a plane meets it far from the scene's box.
#[test]
fn every_shape_keeps_its_promises() {
    for (name, shape) in examples() {
        let blob = scenes::blob(&scenes::of([shape]), 24);
        let report = verify(&blob.scene().expect("a scene"), 1500, &|| ());
        assert_eq!(report.broken(), 0, "{name}: {report:#?}");
    }
    let all = scenes::of(examples().into_iter().map(|(_, shape)| shape));
    let blob = scenes::blob(&all, 24);
    let report = verify(&blob.scene().expect("a scene"), 3000, &|| ());
    assert_eq!(report.broken(), 0, "{report:#?}");
}

/// The corners of this card are not level on the lattice, so that it has an inside thinner than a step. In `f32` no place
/// in it is a number.
#[test]
fn card_with_two_sides_lets_nothing_leave() {
    let corners = [
        [0.0, 0.0, 0.0],
        [1.0, 0.1, 0.3],
        [1.2, 1.3, 0.45],
        [0.2, 1.2, 0.15],
    ];
    let file = format!(
        "[[object]]\nkind = 'mesh'\nvertices = {corners:?}\nfaces = [[0, 1, 2, 3], [3, 2, 1, 0]]"
    );
    let imported = gridel_host::scene::read("card.toml".as_ref(), file.into(), &Default::default());
    let blob = scenes::blob(&imported.expect("a card").scene, 24);
    let report = verify(&blob.scene().expect("a scene"), 3000, &|| ());
    assert_eq!(report.broken(), 0, "{report:#?}");
}

/// Among them was a ray down a cylinder whose other slope vanished when it was squared.
#[test]
fn fixtures_keep_their_promises() {
    for (name, scene) in scenes::fixtures() {
        let blob = scenes::blob(&scene, 24);
        let rays = sixth_of(RAYS as usize) as u64;
        let report = verify(&blob.scene().expect("a scene"), rays, &|| ());
        assert_eq!(report.broken(), 0, "{name}: {:#?}", report.properties);
        for format in &report.formats {
            let worst = format.worst.error;
            // A surface that is off by STEPS, met at the flattest angle that does not graze.
            assert!(
                worst <= STEPS / GRAZING,
                "{name} {}: {worst}",
                format.format
            );
        }
    }
}

/// The full run casts the program's own number of rays.
#[test]
fn real_scenes_keep_their_promises() {
    let names = [
        "spd/balls_s2.nff",
        "spd/jacks.nff",
        "meshes/suzanne.obj",
        "meshes/cornell_box.obj",
        "meshes/TestScene.gltf",
        "molecules/hem.pdb",
    ];
    let scenes = names.iter().filter_map(|name| scenes::real(name));
    for path in scenes {
        let blob = scenes::blob(&scenes::read(&path), 24);
        let rays = part_of(300, RAYS as usize) as u64;
        let report = verify(&blob.scene().expect("a scene"), rays, &|| ());
        let properties = &report.properties;
        assert_eq!(report.broken(), 0, "{}: {properties:#?}", path.display());
    }
}

/// Two closed pyramids, base on base, whose corners the lattice rounded apart. A ray that leaves the one may report the
/// other. Then it does not hit the first again, because it continues behind both.
#[test]
fn closed_meshes_that_touch_do_not_leak() {
    for turn in 0..8 {
        let angle = 0.3 + 0.7 * f64::from(turn);
        let place = DQuat::from_euler(EulerRot::XYZ, angle, 1.3 * angle, 0.6);
        let pyramid = |tip: f64, apart: f64| {
            let corners = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
            let base = corners.map(|[x, y]| DVec3::new(x, y, x * apart));
            let vertices = base.into_iter().chain([DVec3::new(0.0, 0.0, tip)]);
            let sides = [
                [0, 1, 4],
                [1, 2, 4],
                [2, 3, 4],
                [3, 0, 4],
                [1, 0, 3],
                [1, 3, 2],
            ];
            Shape::Mesh {
                vertices: vertices.map(|vertex| place * vertex).collect(),
                triangles: sides
                    .map(|[a, b, c]| if tip > 0.0 { [a, b, c] } else { [a, c, b] })
                    .to_vec(),
            }
        };
        let blob = scenes::blob(&scenes::of([pyramid(1.0, 0.0), pyramid(-1.0, 2e-7)]), 24);
        let report = verify(&blob.scene().expect("a scene"), 1000, &|| ());
        assert_eq!(report.closed_meshes, 2);
        assert_eq!(report.broken(), 0, "{turn}: {:#?}", report.properties);
    }
}

fn cuboid(min: [f64; 3], max: [f64; 3]) -> Shape {
    Shape::Box(Cuboid {
        min: min.into(),
        max: max.into(),
    })
}

/// A ray that starts inside of several solids leaves them where they end, at one place or at several. Reporting the
/// later one is wrong.
#[test]
fn surfaces_that_a_ray_leaves_are_judged_as_those_it_enters() {
    // All share the face x = 1; one of them reaches further on the other sides.
    let boxes = [
        cuboid([-1.0; 3], [1.0; 3]),
        cuboid([-2.0; 3], [1.0, 2.0, 2.0]),
        cuboid([-1.0; 3], [1.0, 1.0, 1.5]),
    ];
    let blob = scenes::blob(&scenes::of(boxes), 24);
    let scene = blob.scene().expect("a scene");
    let judge = Judge::of(&scene);
    fn judged<N: Number>(scene: &Scene<'_>, judge: &Judge) {
        let mut random = Random(31);
        let (mut shared, mut caught) = (0, 0);
        // The middle of the first box, in units.
        let bounds = judge.solid(HitId::own(0)).map(|it| it.solid.clone());
        let Some(Solid::Box(Cuboid {
            min: lowest,
            max: highest,
        })) = bounds
        else {
            panic!("a box");
        };
        let middle = [0, 1, 2].map(|k| 0.5 * (lowest[k] + highest[k]));
        let size = highest[0] - lowest[0];
        let mut slots = 0..scene.count(Kind::Box);
        let second = slots.find(|&slot| scene.primitive(Kind::Box, slot as u32) == 1);
        let second = second.expect("the second box");
        for _ in 0..3000 {
            let origin = middle.map(|x| x + 0.4 * size * random.signed());
            let ray = UnitRay::new(origin, random.direction());
            let ready = ray.ready::<N>(scene).expect("a ray");
            let heard = ask_all::<N>(scene, &ready);
            let outcome = check(scene, judge, &ready, &heard, true);
            assert!(outcome.judged);
            assert_eq!(outcome.faults, [], "{ray:?}");
            let hit = heard[0].hit.expect("a hit");
            shared += usize::from(hit.normal[0] == N::ONE);
            // The ray leaves the second box last wherever it does not leave it at the shared face.
            let rounded = RoundedRay::of(&ready);
            let outer = |k: usize| {
                let sides = scene.primitive_bounds(Kind::Box, second).expect("a box").0[k];
                let sides = sides.map(f64::from).map(|x| x - rounded.start[k]);
                let [a, b] = sides.map(|x| x / rounded.slope[k]);
                a.max(b)
            };
            let last = Answer {
                t: outer(0).min(outer(1)).min(outer(2)),
                hit: HitId::own(1),
            };
            let wrong = judge.check(N::FORMAT, &rounded, Some(last));
            let is_later = last.t > N::far_to_f64(hit.t) + 1.0;
            assert_eq!(wrong.is_err(), is_later, "{ray:?} {wrong:?}");
            caught += usize::from(is_later);
        }
        assert!(shared > 300 && caught > 1000, "{shared} {caught}");
    }
    gridel_tests::every_format!(judged(&scene, &judge));
}

#[test]
fn a_ray_that_is_nearly_parallel_to_a_cylinder_meets_its_cap() {
    let cylinder = Shape::Cone(Cone {
        base: glam::DVec3::ZERO,
        base_radius: 1.0,
        apex: glam::DVec3::Y,
        apex_radius: 1.0,
    });
    let blob = scenes::blob(&scenes::of([cylinder]), 24);
    let scene = blob.scene().expect("a scene");
    fn meets<N: Number>(scene: &Scene<'_>) {
        for slope in [1e-10, 1e-20, 1e-26, 1e-38, 1e-300] {
            for sign in [1.0, -1.0] {
                let [[x0, x1], [y0, y1], [z0, z1]] = scene.bounds().0.map(|s| s.map(f64::from));
                let origin = [
                    0.6 * x0 + 0.4 * x1,
                    y0 + 3.0 * (y1 - y0),
                    0.6 * z0 + 0.4 * z1,
                ];
                let ray = UnitRay::new(origin, [0.0, -1.0, sign * slope]);
                let ready = ray.ready::<N>(scene).expect("a ray");
                let hit = ask::<N, List>(scene, &ready).hit;
                assert!(
                    hit.is_some_and(|hit| hit.front),
                    "{} {slope} {sign}",
                    N::FORMAT.name()
                );
            }
        }
    }
    gridel_tests::every_format!(meets(&scene));
}

/// Changes the answers of one structure and returns which properties are found broken.
fn broken_by(change: impl Fn(&mut StructureAnswer<f64>)) -> Vec<Property> {
    let blob = mesh(2);
    let scene = blob.scene().expect("a scene");
    let judge = Judge::of(&scene);
    let mut properties = Vec::new();
    for ray in Targets::of(&scene).rays(3).take(400) {
        let Some(ready) = ray.ready::<f64>(&scene) else {
            continue;
        };
        let mut heard = ask_all::<f64>(&scene, &ready);
        heard.iter_mut().for_each(&change);
        let outcome = check(&scene, &judge, &ready, &heard, true);
        properties.extend(outcome.faults.iter().map(|fault| fault.property));
    }
    properties.sort();
    properties.dedup();
    properties
}

fn with_hit(change: impl Fn(&mut Hit<f64>)) -> impl Fn(&mut StructureAnswer<f64>) {
    move |heard| {
        if let Some(hit) = &mut heard.hit {
            change(hit);
        }
    }
}

#[test]
fn mutated_answers_are_caught() {
    assert_eq!(broken_by(|_| ()), []);
    // One structure is broken.
    let flagged = |heard: &StructureAnswer<f64>| heard.structure == Structure::Flagged;
    let lost = broken_by(|heard| {
        if flagged(heard) {
            heard.hit = None;
        }
    });
    assert_eq!(lost, [Property::Structures, Property::AnyHit]);
    let last_bit = broken_by(|heard| {
        if let (true, Some(hit)) = (flagged(heard), &mut heard.hit) {
            hit.normal[1] = f64::from_bits(hit.normal[1].to_bits() ^ 1);
        }
    });
    assert_eq!(last_bit, [Property::Structures]);
    let no_shadow = broken_by(|heard| heard.any = false);
    assert_eq!(no_shadow, [Property::AnyHit]);
    // All structures are broken.
    let blind = broken_by(|heard| (heard.hit, heard.any) = (None, false));
    assert_eq!(blind, [Property::Answers]);
    assert_eq!(
        broken_by(with_hit(|hit| hit.t += 1e-3)),
        [Property::Answers]
    );
    let farther = broken_by(with_hit(|hit| hit.primitive ^= 1));
    assert_eq!(farther, [Property::Answers]);
    let nan = broken_by(with_hit(|hit| hit.point[2] = f64::NAN));
    assert!(nan.contains(&Property::Numbers), "{nan:?}");
    let short = broken_by(with_hit(|hit| hit.normal = hit.normal.map(|x| 0.999 * x)));
    assert_eq!(short, [Property::Numbers]);
}

/// A structure that forgets some of its leaves.
enum Forgetful {}

impl Accel for Forgetful {
    fn views<'s, 'a>(views: &'s StructureViews<'a>) -> &'s Self::Views<'a> {
        Flagged::views(views)
    }
}

impl Traverse for Forgetful {
    const STRUCTURE: Structure = Structure::Flagged;
    type Views<'a> = <Flagged as Traverse>::Views<'a>;
    type Cull<N: Number> = Cull;

    fn walk<N: Number, C: Observer>(
        geometry: &SceneGeometry<'_>,
        views: &Self::Views<'_>,
        ray: &Ray<N>,
        cull: &Cull,
        stack: &mut StackView,
        count: &mut C,
        mut leaf: impl FnMut(Leaf, &mut C) -> Option<N>,
    ) {
        Flagged::walk(geometry, views, ray, cull, stack, count, |found, count| {
            if found.first.is_multiple_of(5) {
                return Some(ray_end(ray));
            }
            leaf(found, count)
        });
    }
}

fn ray_end<N: Number>(_: &Ray<N>) -> N {
    N::FAR
}

#[test]
fn a_broken_structure_is_caught() {
    let blob = mesh(3);
    let scene = blob.scene().expect("a scene");
    let judge = Judge::of(&scene);
    let mut caught = 0;
    for ray in Targets::of(&scene).rays(4).take(2000) {
        let Some(ready) = ray.ready::<f32>(&scene) else {
            continue;
        };
        let heard = [
            ask::<f32, List>(&scene, &ready),
            ask::<f32, Forgetful>(&scene, &ready),
        ];
        let outcome = check(&scene, &judge, &ready, &heard, false);
        assert!(
            outcome
                .faults
                .iter()
                .all(|fault| fault.property == Property::Structures)
        );
        caught += usize::from(!outcome.faults.is_empty());
    }
    assert!(caught > 20, "{caught}");

    // And rays get out of a mesh through it.
    let [closed] = &ClosedMesh::all(&scene).0[..] else {
        panic!("one closed mesh");
    };
    let mut leaks = [0; 2];
    for index in 0..closed.count() {
        let corners = closed.triangle(index);
        let middle = [0, 1, 2].map(|k| (corners[0][k] + corners[1][k] + corners[2][k]) / 3.0);
        let from = [0.0; 3];
        let whole = sealed::<f32, Flagged>(&scene, &judge, closed, from, middle);
        let holed = sealed::<f32, Forgetful>(&scene, &judge, closed, from, middle);
        leaks[0] += usize::from(whole.is_some());
        leaks[1] += usize::from(holed.is_some());
    }
    assert_eq!(leaks[0], 0);
    assert!(leaks[1] > 20, "{}", leaks[1]);
}

/// If the error bound of a hit is too small, secondary rays hit their own surface.
#[test]
fn a_bound_that_is_too_small_is_caught() {
    let tori = examples().into_iter().filter(|(name, _)| *name == "torus");
    let scenes = [
        scenes::soup(23, 30, 0.4),
        scenes::of(tori.map(|(_, shape)| shape)),
    ];
    for scene in scenes {
        let blob = scenes::blob(&scene, 24);
        let scene = blob.scene().expect("a scene");
        let judge = Judge::of(&scene);
        let mut random = Random(9);
        let (mut honest, mut lying) = (0, 0);
        for ray in Targets::of(&scene).rays(5).take(3000) {
            let Some(ready) = ray.ready::<f32>(&scene) else {
                continue;
            };
            let Some(mut hit) = ask::<f32, List>(&scene, &ready).hit else {
                continue;
            };
            honest += leave(&scene, &judge, &hit, &mut random).faults.len();
            hit.error = 0.0;
            lying += leave(&scene, &judge, &hit, &mut random).faults.len();
        }
        assert_eq!(honest, 0);
        assert!(lying > 20, "{lying}");
    }
}
