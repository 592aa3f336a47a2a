//! tinybvh's layouts for CPUs, where its header was found: see `build.rs`.

use crate::contender::{Contender, Trace};
use crate::workload::{Answer, Query};
use glam::Vec3;
use std::ffi::c_void;
use std::time::Instant;

/// `bvhvec4`.
#[repr(C, align(16))]
struct Corner([f32; 4]);

unsafe extern "C" {
    fn tinybvh4_build(corners: *const Corner, triangles: u32) -> *mut c_void;
    fn tinybvh8_build(corners: *const Corner, triangles: u32) -> *mut c_void;
    fn tinybvh4_bytes(layout: *const c_void) -> usize;
    fn tinybvh8_bytes(layout: *const c_void) -> usize;
    fn tinybvh4_trace(
        layout: *const c_void,
        queries: *const Query,
        count: usize,
        any: bool,
        answers: *mut Answer,
    );
    fn tinybvh8_trace(
        layout: *const c_void,
        queries: *const Query,
        count: usize,
        any: bool,
        answers: *mut Answer,
    );
}

type Build = unsafe extern "C" fn(*const Corner, u32) -> *mut c_void;
type Bytes = unsafe extern "C" fn(*const c_void) -> usize;
type Run = unsafe extern "C" fn(*const c_void, *const Query, usize, bool, *mut Answer);

/// The layouts, built.
pub fn contenders(triangles: &[[Vec3; 3]]) -> [Contender<'static>; 2] {
    [
        contender(
            "tinybvh BVH4_CPU",
            triangles,
            (tinybvh4_build, tinybvh4_bytes, tinybvh4_trace),
        ),
        contender(
            "tinybvh BVH8_CPU",
            triangles,
            (tinybvh8_build, tinybvh8_bytes, tinybvh8_trace),
        ),
    ]
}

fn contender(
    name: &str,
    triangles: &[[Vec3; 3]],
    (build, bytes, run): (Build, Bytes, Run),
) -> Contender<'static> {
    let corners: Vec<Corner> = triangles
        .iter()
        .flatten()
        .map(|corner| Corner(corner.extend(0.0).to_array()))
        .collect();
    // They are read while it traces, too.
    let corners: &'static [Corner] = corners.leak();
    let started = Instant::now();
    // SAFETY: three corners for each triangle, for good; the layout lives until the program ends.
    let layout = unsafe { build(corners.as_ptr(), triangles.len() as u32) };
    let seconds = started.elapsed().as_secs_f64();
    Contender {
        name: name.to_owned(),
        seconds,
        // SAFETY: what `build` returned.
        bytes: unsafe { bytes(layout) },
        trace: Trace::OfQueries(Box::new(move |queries, any, answers| {
            assert_eq!(queries.len(), answers.len());
            // SAFETY: what `build` returned; as many answers as queries, both laid out as in C.
            unsafe {
                run(
                    layout,
                    queries.as_ptr(),
                    queries.len(),
                    any,
                    answers.as_mut_ptr(),
                );
            }
        })),
    }
}
