//! Embree in its robust mode, if the library is installed (Debian's `libembree3-3`).
//!
//! It is loaded while the benchmark runs, so that nothing needs it to build. The declarations are
//! those of `embree3/rtcore.h`, version 3.13.

use crate::contender::{Contender, Trace};
use crate::workload::{Answer, Geometry, Query};
use libloading::Library;
use std::ffi::{c_char, c_int, c_uint, c_void};
use std::sync::atomic::{AtomicIsize, Ordering};
use std::time::Instant;

type Handle = *mut c_void;

/// `RTCRayHit`.
#[derive(Clone, Copy)]
#[repr(C, align(16))]
struct RayHit {
    origin: [f32; 3],
    tnear: f32,
    direction: [f32; 3],
    time: f32,
    tfar: f32,
    mask: c_uint,
    id: c_uint,
    flags: c_uint,
    normal: [f32; 3],
    uv: [f32; 2],
    primitive: c_uint,
    geometry: c_uint,
    instance: c_uint,
}

/// `RTCIntersectContext`.
#[repr(C)]
struct Context {
    flags: c_int,
    filter: *const c_void,
    instance: c_uint,
}

const NONE: c_uint = c_uint::MAX;
const ROBUST: c_int = 1 << 2;
const TRIANGLES: c_int = 0;
const SPHERES: c_int = 50;
const INDEX_BUFFER: c_int = 0;
const VERTEX_BUFFER: c_int = 1;
const UINT3: c_int = 0x5003;
const FLOAT3: c_int = 0x9003;
const FLOAT4: c_int = 0x9004;

type Memory = unsafe extern "C" fn(*mut c_void, isize, bool) -> bool;

/// Bytes that the library holds.
static BYTES: AtomicIsize = AtomicIsize::new(0);

unsafe extern "C" fn account(_: *mut c_void, bytes: isize, _: bool) -> bool {
    BYTES.fetch_add(bytes, Ordering::Relaxed);
    true
}

/// The functions that are used.
struct Functions {
    intersect: unsafe extern "C" fn(Handle, *mut Context, *mut RayHit),
    occluded: unsafe extern "C" fn(Handle, *mut Context, *mut RayHit),
    // Keeps the functions where they are.
    _library: Library,
}

/// Embree over a geometry; `None` where it is not installed.
pub fn contender(geometry: &Geometry) -> Option<Contender<'static>> {
    // SAFETY: the library is Embree 3, whose functions have the types given here; handles come from
    // it, and buffers have the lengths that it was given.
    unsafe {
        let library = ["libembree3.so.3", "libembree3.so"]
            .iter()
            .find_map(|name| Library::new(*name).ok())?;
        macro_rules! function {
            ($name:literal, $type:ty) => {
                *library.get::<$type>($name).ok()?
            };
        }
        let device = function!(
            b"rtcNewDevice",
            unsafe extern "C" fn(*const c_char) -> Handle
        )(c"threads=1".as_ptr());
        function!(
            b"rtcSetDeviceMemoryMonitorFunction",
            unsafe extern "C" fn(Handle, Memory, *mut c_void)
        )(device, account, std::ptr::null_mut());
        let before = BYTES.load(Ordering::Relaxed);
        let scene = function!(b"rtcNewScene", unsafe extern "C" fn(Handle) -> Handle)(device);
        function!(b"rtcSetSceneFlags", unsafe extern "C" fn(Handle, c_int))(scene, ROBUST);
        let kind = match geometry {
            Geometry::Triangles(_) => TRIANGLES,
            Geometry::Spheres(_) => SPHERES,
        };
        let shape = function!(
            b"rtcNewGeometry",
            unsafe extern "C" fn(Handle, c_int) -> Handle
        )(device, kind);
        let buffer = function!(
            b"rtcSetNewGeometryBuffer",
            unsafe extern "C" fn(Handle, c_int, c_uint, c_int, usize, usize) -> *mut c_void
        );
        match geometry {
            Geometry::Triangles(triangles) => {
                let (vertices, faces) = indexed(triangles);
                let points = buffer(shape, VERTEX_BUFFER, 0, FLOAT3, 12, vertices.len());
                std::ptr::copy_nonoverlapping(vertices.as_ptr(), points.cast(), vertices.len());
                let indices = buffer(shape, INDEX_BUFFER, 0, UINT3, 12, faces.len());
                std::ptr::copy_nonoverlapping(faces.as_ptr(), indices.cast(), faces.len());
            }
            Geometry::Spheres(spheres) => {
                let records: Vec<[f32; 4]> = spheres
                    .iter()
                    .map(|(center, radius)| center.extend(*radius).to_array())
                    .collect();
                let points = buffer(shape, VERTEX_BUFFER, 0, FLOAT4, 16, records.len());
                std::ptr::copy_nonoverlapping(records.as_ptr(), points.cast(), records.len());
            }
        }
        let started = Instant::now();
        function!(b"rtcCommitGeometry", unsafe extern "C" fn(Handle))(shape);
        function!(
            b"rtcAttachGeometry",
            unsafe extern "C" fn(Handle, Handle) -> c_uint
        )(scene, shape);
        function!(b"rtcCommitScene", unsafe extern "C" fn(Handle))(scene);
        let seconds = started.elapsed().as_secs_f64();
        let functions = Functions {
            intersect: function!(
                b"rtcIntersect1",
                unsafe extern "C" fn(Handle, *mut Context, *mut RayHit)
            ),
            occluded: function!(
                b"rtcOccluded1",
                unsafe extern "C" fn(Handle, *mut Context, *mut RayHit)
            ),
            _library: library,
        };
        let bytes = (BYTES.load(Ordering::Relaxed) - before).max(0) as usize;
        Some(Contender {
            name: String::from("Embree 3 robust"),
            seconds,
            bytes,
            trace: Trace::OfQueries(Box::new(move |queries, any, answers| {
                trace(&functions, scene, queries, any, answers);
            })),
        })
    }
}

fn trace(
    functions: &Functions,
    scene: Handle,
    queries: &[Query],
    any: bool,
    answers: &mut [Answer],
) {
    let mut context = Context {
        flags: 0,
        filter: std::ptr::null(),
        instance: NONE,
    };
    for (query, answer) in queries.iter().zip(answers) {
        let mut ray = RayHit {
            origin: query.origin.to_array(),
            tnear: 0.0,
            direction: query.direction.to_array(),
            time: 0.0,
            tfar: f32::INFINITY,
            mask: NONE,
            id: 0,
            flags: 0,
            normal: [0.0; 3],
            uv: [0.0; 2],
            primitive: NONE,
            geometry: NONE,
            instance: NONE,
        };
        // SAFETY: scene, context and ray are alive and of the library's types.
        let t = unsafe {
            if any {
                (functions.occluded)(scene, &mut context, &mut ray);
                if ray.tfar < 0.0 { 0.0 } else { f32::INFINITY }
            } else {
                (functions.intersect)(scene, &mut context, &mut ray);
                if ray.geometry == NONE {
                    f32::INFINITY
                } else {
                    ray.tfar
                }
            }
        };
        *answer = Answer { t };
    }
}

/// Distinct vertices, and the triangles on them.
fn indexed(triangles: &[[glam::Vec3; 3]]) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let mut numbers = std::collections::HashMap::new();
    let mut vertices = Vec::new();
    let mut number = |corner: glam::Vec3| {
        let corner = corner.to_array();
        *numbers.entry(corner.map(f32::to_bits)).or_insert_with(|| {
            vertices.push(corner);
            vertices.len() as u32 - 1
        })
    };
    let faces = triangles.iter().map(|face| face.map(&mut number)).collect();
    (vertices, faces)
}
