//! The vertices of an outline in cells, which have about one vertex each however they are spread.

use robust::Coord;

/// Fewer vertices are not worth the cells.
const FEWEST: usize = 32;

/// Vertices by their ranks along both axes. Vertices can be removed.
pub(super) struct Cells {
    /// The coordinates along each axis, in order.
    sorted: [Vec<f64>; 2],
    /// Ranks per cell, along each axis.
    width: usize,
    /// Cells per row.
    row: usize,
    /// The start of each cell in `items`, and its number of vertices.
    cells: Vec<[u32; 2]>,
    items: Vec<u32>,
    /// The cell of each vertex, and its place in `items`.
    places: Vec<[u32; 2]>,
    /// False for vertices that were removed.
    left: Vec<bool>,
}

impl Cells {
    pub(super) fn new(flat: &[Coord<f64>]) -> Self {
        let n = flat.len();
        let mut cells = Self {
            sorted: [Vec::new(), Vec::new()],
            width: n,
            row: 1,
            cells: Vec::new(),
            items: Vec::new(),
            places: Vec::new(),
            left: vec![true; n],
        };
        if n < FEWEST {
            return cells;
        }
        cells.width = n.div_ceil(n.isqrt());
        cells.row = n.div_ceil(cells.width);
        let mut cell_of = vec![0; n];
        for (axis, stride) in [1, cells.row].into_iter().enumerate() {
            let coordinate = |i: usize| [flat[i].x, flat[i].y][axis];
            let mut order: Vec<usize> = (0..n).collect();
            order.sort_by(|&i, &j| coordinate(i).total_cmp(&coordinate(j)));
            for (rank, &i) in order.iter().enumerate() {
                cell_of[i] += rank / cells.width * stride;
            }
            cells.sorted[axis] = order.into_iter().map(coordinate).collect();
        }
        cells.cells = vec![[0; 2]; cells.row * cells.row];
        for &cell in &cell_of {
            cells.cells[cell][1] += 1;
        }
        let mut begin = 0;
        for [first, count] in &mut cells.cells {
            *first = begin;
            begin += std::mem::take(count);
        }
        cells.items = vec![0; n];
        cells.places = vec![[0; 2]; n];
        for (i, cell) in cell_of.into_iter().enumerate() {
            let [first, count] = &mut cells.cells[cell];
            let place = *first + *count;
            *count += 1;
            cells.items[place as usize] = i as u32;
            cells.places[i] = [cell as u32, place];
        }
        cells
    }

    /// Returns whether a vertex was not removed.
    pub(super) fn has(&self, i: usize) -> bool {
        self.left[i]
    }

    pub(super) fn remove(&mut self, i: usize) {
        self.left[i] = false;
        let Some(&[cell, place]) = self.places.get(i) else {
            return;
        };
        // The last vertex of the cell takes its place.
        let [first, count] = &mut self.cells[cell as usize];
        *count -= 1;
        let last = self.items[(*first + *count) as usize];
        self.items[place as usize] = last;
        self.places[last as usize][1] = place;
    }

    /// The vertices that are left in the cells of a box, at least those in the box, where this is less work than to
    /// look at so many vertices.
    pub(super) fn around(
        &self,
        bounds: [[f64; 2]; 2],
        vertices: usize,
    ) -> Option<impl Iterator<Item = usize>> {
        if self.items.is_empty() {
            return None;
        }
        let [x, y] = [0, 1].map(|axis| {
            let (sorted, [low, high]) = (&self.sorted[axis], bounds[axis]);
            let first = sorted.partition_point(|&it| it < low);
            let behind = sorted.partition_point(|&it| it <= high);
            first / self.width..behind.div_ceil(self.width)
        });
        if x.len() * y.len() >= vertices {
            return None;
        }
        let cells = y.flat_map(move |y| x.clone().map(move |x| y * self.row + x));
        Some(cells.flat_map(|cell| {
            let [first, count] = self.cells[cell];
            let items = &self.items[first as usize..(first + count) as usize];
            items.iter().map(|&i| i as usize)
        }))
    }
}
