//! Closed meshes around the origin.

use glam::DVec3;

/// Vertices and triangles, outward.
pub type Mesh = (Vec<DVec3>, Vec<[u32; 3]>);

/// A box of half size 1, every face cut into `n` by `n` squares of two triangles.
pub fn cut_box(n: u32) -> Mesh {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let first = vertices.len() as u32;
            for (i, j) in (0..=n).flat_map(|i| (0..=n).map(move |j| (i, j))) {
                let place = |k: u32| 2.0 * f64::from(k) / f64::from(n) - 1.0;
                let mut vertex = DVec3::splat(side);
                vertex[(axis + 1) % 3] = place(i);
                vertex[(axis + 2) % 3] = place(j);
                vertices.push(vertex);
            }
            for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                let corner = first + i * (n + 1) + j;
                let (across, both) = (corner + n + 1, corner + n + 2);
                let faces = [[corner, across, both], [corner, both, corner + 1]];
                let turned = |[a, b, c]: [u32; 3]| if side > 0.0 { [a, b, c] } else { [a, c, b] };
                triangles.extend(faces.map(turned));
            }
        }
    }
    (vertices, triangles)
}

/// A torus of radius 1 about z, the tube's radius being 0.4, of `n` by `m` squares.
pub fn torus(n: u32, m: u32) -> Mesh {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    let angle = |i: u32, n: u32| f64::from(i) / f64::from(n) * std::f64::consts::TAU;
    for (i, j) in (0..n).flat_map(|i| (0..m).map(move |j| (i, j))) {
        let ((sin_a, cos_a), (sin_b, cos_b)) = (angle(i, n).sin_cos(), angle(j, m).sin_cos());
        let radius = 1.0 + 0.4 * cos_b;
        vertices.push(DVec3::new(radius * cos_a, radius * sin_a, 0.4 * sin_b));
        let number = |i: u32, j: u32| (i % n) * m + j % m;
        let (a, b) = (number(i, j), number(i + 1, j));
        let (c, d) = (number(i + 1, j + 1), number(i, j + 1));
        triangles.extend([[a, b, c], [a, c, d]]);
    }
    (vertices, triangles)
}

pub fn stretched((vertices, triangles): Mesh, by: DVec3) -> Mesh {
    (vertices.into_iter().map(|it| it * by).collect(), triangles)
}
