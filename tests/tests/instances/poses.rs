//! Instances that a program moves: they are where motions lead them, under a hierarchy that the program builds.

use super::*;
use gridel_core::format::record::{Pair, UnitBox};
use gridel_core::{Angle, Motion, Poses, PosesView, Position};
use gridel_host::shape::Sphere;

const LEAF: u32 = 1 << 31;

fn ball(center: DVec3, radius: f64) -> Shape {
    Shape::Sphere(Sphere { center, radius })
}

/// A scene of parts with two balls at its corners, so that there is room between them.
fn roomy_scene(random: &mut Random, instances: usize) -> Scene {
    let mut scene = random_scene(random, 0, instances);
    let corner = |sign: f64| ball(DVec3::splat(9.0 * sign), 0.5);
    scene.objects = scenes::of([corner(1.0), corner(-1.0)]).objects;
    scene
}

/// Room for instances, as large as a scene needs.
struct Memory {
    instances: Vec<Record>,
    pairs: Vec<Pair>,
    order: Vec<u32>,
}

impl Memory {
    fn of(scene: &Loaded<'_>) -> Self {
        let count = scene.instances().len();
        Self {
            instances: scene.instances().to_vec(),
            pairs: vec![bytemuck::Zeroable::zeroed(); count],
            order: vec![0; count],
        }
    }

    fn at_rest(&mut self, scene: &Loaded<'_>) -> PosesView<'_> {
        let Self {
            instances,
            pairs,
            order,
        } = self;
        PosesView::at_rest(scene, instances, pairs, order).expect("as much room")
    }
}

/// A motion, and the same of a place in scene units.
fn random_motion(random: &mut Random, step: f64) -> (Motion, impl Fn(DVec3) -> DVec3 + use<>) {
    let mut coordinates = |reach: f64| [(); 3].map(|()| (reach * random.signed() / step) as i32);
    let (pivot, shift) = (coordinates(2.0), coordinates(1.0));
    let axis = random.direction();
    let angle = Angle((random.unit() * f64::powi(2.0, 32)) as u32);
    let scale = if random.one_in(2) {
        1 << 24
    } else {
        (random.magnitude(0.3, 1.5) * f64::powi(2.0, 24)) as i32
    };
    let integers = axis.map(|x| (x * 1e6) as i32);
    let turn = Motion::turn(Position(pivot), integers, angle).expect("an axis");
    let motion = Motion::scale(Position(pivot), scale)
        .then(&turn)
        .then(&Motion::shift(shift));
    let place = |steps: [i32; 3]| DVec3::from_array(steps.map(f64::from)) * step;
    let (pivot, shift) = (place(pivot), place(shift));
    let radians = f64::from(angle.0) / f64::powi(2.0, 32) * std::f64::consts::TAU;
    let rotation = DQuat::from_axis_angle(
        DVec3::from_array(integers.map(f64::from)).normalize(),
        radians,
    );
    let scale = f64::from(scale) / f64::powi(2.0, 24);
    let moved = move |it: DVec3| pivot + shift + scale * (rotation * (it - pivot));
    (motion, moved)
}

/// Proves that a hierarchy leads to every instance once, with boxes around all that is below.
fn check_hierarchy(instances: &[Record], pairs: &[Pair], around: impl Fn(&Record) -> UnitBox) {
    let mut reached = vec![0; instances.len()];
    let below = |child: u32| {
        if child & LEAF != 0 {
            return around(&instances[(child & !LEAF) as usize]);
        }
        let pair = &pairs[child as usize];
        let side = |side: usize| UnitBox(pair.planes.map(|[low, high]| [low[side], high[side]]));
        side(0).union(&side(1))
    };
    for (index, pair) in pairs.iter().enumerate() {
        for (side, child) in pair.children.into_iter().enumerate() {
            let bounds = UnitBox(pair.planes.map(|[low, high]| [low[side], high[side]]));
            assert!(bounds.contains(&below(child)));
            if child & LEAF != 0 {
                reached[(child & !LEAF) as usize] += 1;
            } else {
                assert!(child as usize > index, "breadth first");
            }
        }
    }
    assert!(instances.len() < 2 || reached.iter().all(|count| *count == 1));
}

fn agree_in<N: Number>(one: &Loaded<'_>, other: &Loaded<'_>, rays: &[(DVec3, DVec3)]) {
    for &(from, way) in rays {
        let ray = ray::<N>(one, from, way);
        for structure in [Structure::List, Structure::DualSplit] {
            let answers = [one, other].map(|scene| {
                let (hit, any) = through(structure, scene, &ray);
                let hit = hit.as_ref().map(|hit| (HitBits::of(hit), hit.primitive));
                (hit, any)
            });
            assert_eq!(answers[0], answers[1], "{:?}", N::FORMAT);
        }
    }
}

#[test]
fn hierarchy_of_the_program_gives_the_blobs_answers() {
    let random = &mut Random(11);
    for round in 0..part_of(8, 80) {
        let count = [1, 2, 3, 32, 33, 200][round % 6];
        let scene = random_scene(random, round % 3, count);
        let blob = blob(&scene, &[Structure::DualSplit]);
        let loaded = blob.scene().expect("a scene");
        let mut memory = Memory::of(&loaded);
        let posed = loaded.with_poses(memory.at_rest(&loaded)).expect("poses");
        assert_eq!(posed.instances(), loaded.instances());
        let rays: Vec<_> = (0..200).map(|_| random_ray(random, &loaded)).collect();
        every_format!(agree_in(&loaded, &posed, &rays));
    }
}

#[test]
fn instances_are_where_motions_lead_them() {
    let random = &mut Random(12);
    let (mut hits, mut outside) = (0, 0);
    for round in 0..part_of(20, 300) {
        let scene = roomy_scene(random, [1, 7, 40][round % 3]);
        let blob = blob(&scene, &[Structure::DualSplit]);
        let loaded = blob.scene().expect("a scene");
        let header = loaded.header();
        let step = f64::powi(2.0, loaded.coordinate_exponent());
        let unit = f64::powi(2.0, header.unit_exponent.into());
        let origin = DVec3::from_array(header.origin);
        let mut memory = Memory::of(&loaded);
        let mut poses = memory.at_rest(&loaded);
        for rest in loaded.instances() {
            let (motion, moved) = random_motion(random, step);
            poses.place(&loaded, rest.number, &motion).expect("a pose");
            // A place of the scene at rest is the place of the part that it is when both are moved.
            let mut other = Memory::of(&loaded);
            let mut one = other.at_rest(&loaded);
            one.place(&loaded, rest.number, &motion).expect("a pose");
            let Ok(posed) = loaded.with_poses(one) else {
                outside += 1;
                poses
                    .place(&loaded, rest.number, &Motion::REST)
                    .expect("a pose");
                continue;
            };
            let same = |it: &&Record| it.number == rest.number;
            let placed = posed.instances().iter().find(same).expect("the instance");
            for _ in 0..10 {
                let place =
                    DVec3::from_array(rest.center.map(|x| f64::from(x) / 256.0 * unit)) + origin;
                let place = place + DVec3::from_array(random.direction());
                let [expected, found] = [(rest, place), (placed, moved(place))]
                    .map(|(record, place)| into_part(record, (place - origin) / unit));
                let off = (expected - found).abs().max_element();
                // The center is rounded to 1/256 unit; a unit of the scene is 2^exponent of the part's.
                let most =
                    f64::powi(2.0, i32::from(placed.exponent)) * (1.0 / 256.0 + 2e-7 / unit) + 1e-2;
                assert!(off <= most, "off by {off}, at most {most}");
            }
        }
        let posed = loaded.with_poses(poses).expect("poses");
        let rays: Vec<_> = (0..100).map(|_| random_ray(random, &posed)).collect();
        every_format!(hits_lie_where_maps_place_them_in(&posed, &rays, &mut hits));
        check_hierarchy(
            &memory.instances,
            &memory.pairs[..loaded.instances().len() - 1],
            |record| {
                let part = &loaded.parts()[usize::from(record.part)];
                record.around(part.bounds()).expect("a box")
            },
        );
    }
    assert!(hits > 500 && outside < hits, "{hits} {outside}");
}

#[test]
fn closed_part_is_closed_under_every_motion() {
    let random = &mut Random(13);
    let (vertices, triangles) = scenes::icosphere(3);
    let mesh = Shape::Mesh {
        vertices,
        triangles,
    };
    let mut scene = scenes::of([-8.0, 8.0].map(|it| ball(DVec3::splat(it), 0.01)));
    scene.parts = vec![part("ball", [mesh])];
    scene.instances = vec![instance(0, Placement::IDENTITY)];
    let blob = blob(
        &scene,
        &[Structure::Bvh, Structure::DualSplit, Structure::Wide],
    );
    let loaded = blob.scene().expect("a scene");
    let step = f64::powi(2.0, loaded.coordinate_exponent());
    let origin = DVec3::from_array(loaded.header().origin);
    let unit = f64::powi(2.0, loaded.header().unit_exponent.into());
    let mut tested = 0;
    for _ in 0..part_of(40, 1000) {
        let (motion, moved) = random_motion(random, step);
        let mut memory = Poses::<1>::new();
        let mut poses = memory.at_rest(&loaded).expect("room for one");
        // Some leave the room.
        let placed = poses.place(&loaded, 0, &motion);
        let Ok(posed) = placed.and_then(|()| loaded.with_poses(poses)) else {
            continue;
        };
        tested += 1;
        let middle = (moved(DVec3::ZERO) - origin) / unit;
        let radius = (moved(DVec3::X) - moved(DVec3::ZERO)).length() / unit;
        for _ in 0..part_of(20, 400) {
            let inside = middle + 0.3 * radius * DVec3::from_array(random.direction());
            let way = DVec3::from_array(random.direction());
            let outside = inside - 4.0 * radius * way;
            every_format!(meets_in(
                &posed,
                [(inside, way, false), (outside, way, true)]
            ));
        }
    }
    assert!(tested > 10, "{tested}");
}

fn meets_in<N: Number>(scene: &Loaded<'_>, rays: [(DVec3, DVec3, bool); 2]) {
    for (from, way, front) in rays {
        let ray = ray::<N>(scene, from, way);
        for structure in held(scene) {
            let (hit, any) = through(structure, scene, &ray);
            let meets =
                any && hit.is_some_and(|hit| hit.instance() == Some(0) && hit.front == front);
            assert!(meets, "{:?} {}: {hit:?}", N::FORMAT, structure.name());
        }
    }
}

#[test]
fn poses_that_do_not_fit_are_rejected() {
    let random = &mut Random(14);
    let scene = roomy_scene(random, 3);
    let blob = blob(&scene, &[]);
    let loaded = blob.scene().expect("a scene");
    let error = Poses::<2>::new().at_rest(&loaded).expect_err("no room");
    assert_eq!(
        error.to_string(),
        "the program passed 2 records for section instances of the blob, which has 3"
    );
    let mut memory = Poses::<3>::new();
    let mut poses = memory.at_rest(&loaded).expect("room");
    let error = poses.place(&loaded, 3, &Motion::REST);
    assert_eq!(
        error.expect_err("no such instance").to_string(),
        "there is no instance 3: the scene has 3, counted from 0"
    );
    let far = Motion::shift([i32::MAX; 3]);
    let error = poses.place(&loaded, 1, &far).expect_err("too far");
    assert!(error.to_string().contains("center"), "{error}");
    // A rejected instance stays where it was.
    let step = f64::powi(2.0, loaded.coordinate_exponent());
    let beside = Motion::shift([0, (40.0 / step) as i32, 0]);
    let unmoved = loaded.with_poses(poses).expect("poses at rest");
    assert_eq!(unmoved.instances(), loaded.instances());
    let mut poses = memory.at_rest(&loaded).expect("room");
    let placed = poses.place(&loaded, 1, &beside);
    let error = placed.and_then(|()| loaded.with_poses(poses).map(|_| ()));
    let error = error.expect_err("outside").to_string();
    assert!(error.contains("instance 1:"), "{error}");
}
