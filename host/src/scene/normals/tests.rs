use super::*;

/// A box from -1 to 1, of twelve triangles that share eight vertices.
fn cube() -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let side = |bit: u32| if bit == 0 { -1.0 } else { 1.0 };
    let vertices = (0..8).map(|n: u32| DVec3::new(side(n & 1), side(n & 2), side(n & 4)));
    let quads = [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ];
    let triangles = quads
        .iter()
        .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
    (vertices.collect(), triangles.collect())
}

#[test]
fn cube_is_flat_below_a_right_angle_and_round_above() {
    let (vertices, triangles) = cube();
    assert!(Normals::computed(&vertices, &triangles, 89.0).is_flat());
    let round = Normals::computed(&vertices, &triangles, 91.0);
    assert_eq!(round.vectors.len(), 8);
    for (normals, triangle) in round.triangles.iter().zip(&triangles) {
        for (normal, vertex) in normals.iter().zip(triangle) {
            // Each face has a right angle there, however it is cut into triangles.
            let expected = unit(vertices[*vertex as usize]);
            assert!((round.vectors[*normal as usize] - expected).length() < 1e-12);
        }
    }
}

#[test]
fn vertices_at_one_place_are_one_vertex() {
    let (vertices, triangles) = cube();
    let split: Vec<DVec3> = triangles
        .iter()
        .flatten()
        .map(|&it| vertices[it as usize])
        .collect();
    let alone: Vec<[u32; 3]> = (0..12).map(|n| [3 * n, 3 * n + 1, 3 * n + 2]).collect();
    let (whole, parts) = (
        Normals::computed(&vertices, &triangles, 91.0),
        Normals::computed(&split, &alone, 91.0),
    );
    assert_eq!(whole, parts);
}

#[test]
fn edge_of_three_faces_stays_sharp() {
    let vertices = [
        DVec3::ZERO,
        DVec3::X,
        DVec3::Y,
        DVec3::Z,
        DVec3::new(0.1, -1.0, 0.0),
    ];
    let fan = [[0, 1, 2], [1, 0, 3], [0, 1, 4]];
    assert!(Normals::computed(&vertices, &fan, 180.0).is_flat());
}

#[test]
fn degenerate_normals_and_faces_are_flat() {
    let vertices = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::X * 2.0];
    let mesh = (&vertices[..], &[[0, 1, 2], [0, 1, 3], [0, 1, 2]][..]);
    let normals = vec![
        DVec3::ZERO,
        DVec3::NAN,
        DVec3::new(0.1, 0.0, 5.0),
        DVec3::INFINITY,
    ];
    let corners = vec![[0, 2, 2], [2, 2, 2], [1, 3, 9]];
    assert!(Normals::given(normals.clone(), corners, mesh).is_flat());
    let corners = vec![[2, 2, 2], Normals::FLAT, [2, 2, 3]];
    let found = Normals::given(normals, corners, mesh);
    assert_eq!(found.triangles, [[2, 2, 2], Normals::FLAT, Normals::FLAT]);
    assert!((found.vectors[2].length() - 1.0).abs() < 1e-15);
}

#[test]
fn normals_of_the_faces_call_for_nothing() {
    let (vertices, triangles) = cube();
    let faces: Vec<DVec3> = triangles
        .iter()
        .map(|it| face_normal(&vertices, it) * 3.0)
        .collect();
    let backs = faces.iter().map(|it| -*it).collect();
    for normals in [faces, backs] {
        let corners = (0..12).map(|number| [number; 3]).collect();
        assert!(Normals::given(normals, corners, (&vertices, &triangles)).is_flat());
    }
}

#[test]
fn normals_of_the_back_are_turned() {
    let vertices = [DVec3::ZERO, DVec3::X, DVec3::Y];
    let back = vec![DVec3::new(0.2, 0.0, -1.0); 3];
    let found = Normals::given(back, vec![[0, 1, 2]], (&vertices, &[[0, 1, 2]]));
    assert!(
        found.triangles[0]
            .iter()
            .all(|it| found.vectors[*it as usize].z > 0.9)
    );
}

#[test]
fn transforms_keep_normals_at_right_angles_to_the_surface() {
    let (vertices, triangles) = cube();
    let round = Normals::computed(&vertices, &triangles, 91.0);
    for (matrix, mirrors) in [
        (DMat3::from_diagonal(DVec3::new(1.0, 2.0, -3.0)), true),
        (
            DMat3::from_rotation_x(0.3) * DMat3::from_diagonal(DVec3::new(5e-9, 1e-9, 1e-9)),
            false,
        ),
    ] {
        let moved = round.transformed(&DAffine3::from_mat3(matrix));
        for (before, after) in round.triangles.iter().zip(&moved.triangles) {
            let [a, b, c] = *before;
            assert_eq!(*after, if mirrors { [a, c, b] } else { [a, b, c] });
        }
        for (before, after) in round.vectors.iter().zip(&moved.vectors) {
            // A vector of the tangent plane stays one.
            let tangent = before.cross(DVec3::new(0.3, 0.2, 0.9));
            assert!(unit(matrix * tangent).dot(*after).abs() < 1e-12);
            assert!(
                (matrix * *before).dot(*after) > 0.0,
                "outside stays outside"
            );
        }
    }
}

/// The displacements that turn vertices about y, seen from above.
fn turning(vertices: &[DVec3], degrees: f64) -> [Displacements; 1] {
    let turn = DQuat::from_rotation_y(degrees.to_radians());
    let vectors = vertices.iter().map(|it| turn * *it - *it).collect();
    [Displacements { target: 0, vectors }]
}

#[test]
fn sharp_faces_of_a_mesh_that_turns_are_flat() {
    let (vertices, triangles) = cube();
    let mesh = (&vertices[..], &triangles[..]);
    let turned = turning(&vertices, 150.0);
    for degrees in [0.0, 40.0, 89.0] {
        assert!(
            Normals::computed_for(mesh, degrees, &turned).is_flat(),
            "{degrees}"
        );
    }
    let round = Normals::computed_for(mesh, 91.0, &turned);
    assert!(round.triangles.iter().all(|it| *it != Normals::FLAT));
}

/// A square of two triangles, of which only one corner is lifted, beside a triangle that stays.
#[test]
fn faces_that_bend_apart_are_smooth_where_an_angle_is_given() {
    let points = [[0, 0], [1, 0], [1, 1], [0, 1], [5, 0], [6, 0], [5, 1]];
    let vertices = points.map(|[x, y]| DVec3::new(x.into(), y.into(), 0.0));
    let triangles = [[0, 1, 2], [0, 2, 3], [4, 5, 6]];
    let mut vectors = vec![DVec3::ZERO; vertices.len()];
    vectors[3] = DVec3::Z;
    let lifted = [Displacements { target: 0, vectors }];
    let mesh = (&vertices[..], &triangles[..]);
    assert!(Normals::computed_for(mesh, 0.0, &lifted).is_flat());
    let found = Normals::computed_for(mesh, 40.0, &lifted);
    let is_flat: Vec<bool> = found
        .triangles
        .iter()
        .map(|it| *it == Normals::FLAT)
        .collect();
    assert_eq!(is_flat, [false, false, true]);
}

/// Two halves that both targets bend by the same angle: together they lie in one plane only with equal weights.
#[test]
fn faces_that_are_parallel_at_some_weights_alone_are_smooth() {
    let vertices =
        [[0, 0], [0, 1], [-1, 0], [1, 0]].map(|[x, y]| DVec3::new(x.into(), y.into(), 0.0));
    let triangles = [[0, 1, 2], [1, 0, 3]];
    let lifted = |target: usize, corner: usize, by: f64| {
        let mut vectors = vec![DVec3::ZERO; 4];
        vectors[corner] = DVec3::Z * by;
        Displacements { target, vectors }
    };
    let both = [lifted(0, 2, 1.0), lifted(1, 3, -1.0)];
    let found = Normals::computed_for((&vertices, &triangles), 40.0, &both);
    assert!(found.triangles.iter().all(|it| *it != Normals::FLAT));
}
