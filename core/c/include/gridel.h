/* Gridel: ray traces from a scene blob, without a heap. README.md beside the library's source explains it.
 *
 * Each pointer is null, or points to what its type states, for as long as the call takes. Buffers can be written to.
 * They overlap neither each other nor any other argument, and no other thread uses them during the call.
 *
 * Written by cbindgen from the declarations in core/c/src: change those, and run `cargo run` in core/c/header. */

#ifndef GRIDEL_H
#define GRIDEL_H

#include <stddef.h>
#include <stdint.h>

/* The number of a missing object, primitive or instance. */
#define GRIDEL_NONE UINT32_C(4294967295)

/* Bytes of the stack that a ray needs in a scene whose stack is so deep (see `gridel inspect` and
 * `gridel_info`), for memory that the compiler reserves: a multiple of 8. */
#define GRIDEL_STACK_BYTES(depth) \
  ((sizeof(size_t) + 12 * (size_t)GRIDEL_STACK_ENTRIES(depth) + 7) / 8 * 8)
#define GRIDEL_STACK_ENTRIES(depth) \
  ((depth) <= 8 ? 8 : (depth) <= 16 ? 16 : (depth) <= 24 ? 24 : (depth) <= 32 ? 32 \
   : (depth) <= 48 ? 48 : (depth) <= 96 ? 96 : 160)


// Words of a `gridel_scene`.
#define GRIDEL_SCENE_WORDS 86

// Bytes of a stack that is deep enough for every scene.
#define GRIDEL_STACK_BYTES_MAX 1928

// Bytes of a workspace that is large enough for every scene, in `fixed` and in `f32`.
#define GRIDEL_WORKSPACE_BYTES_MAX 5120

// Bytes of a workspace that is large enough for every scene, in `f64`.
#define GRIDEL_WORKSPACE_BYTES_MAX_F64 7680

// The version of this header: major, minor and patch number, of 16, 8 and 8 bits. A program whose library returns
// another number by `gridel_version` is linked with the library of another header, whose types can have other sizes.
#define GRIDEL_VERSION 256

// The result of a function: 0, or the reason why it did nothing. `gridel_text` returns the
// sentence.
enum gridel_status
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // Done.
  GRIDEL_STATUS_OK = 0,
  // A pointer is null.
  GRIDEL_STATUS_NULL_POINTER = 1,
  // A pointer is not aligned for its type; memory for stacks, workspaces and parts needs 8 bytes.
  GRIDEL_STATUS_MISALIGNED = 2,
  // A buffer has fewer bytes than are needed.
  GRIDEL_STATUS_BUFFER_TOO_SMALL = 3,
  // The scene was not loaded. If `gridel_load` fails, a scene that was loaded before stays loaded; if
  // `gridel_load_with_parts` fails, it does not.
  GRIDEL_STATUS_NOT_LOADED = 4,
  // The blob does not start at a multiple of 4 bytes.
  GRIDEL_STATUS_BLOB_MISALIGNED = 10,
  // The blob is shorter or longer than its header states.
  GRIDEL_STATUS_BLOB_TRUNCATED = 11,
  // The bytes are not a blob's.
  GRIDEL_STATUS_BLOB_MAGIC = 12,
  // Blob and machine differ in byte order.
  GRIDEL_STATUS_BLOB_ENDIANNESS = 13,
  // The blob has another version of the format.
  GRIDEL_STATUS_BLOB_VERSION = 14,
  // The bytes were changed after the blob was written.
  GRIDEL_STATUS_BLOB_CHECKSUM = 15,
  // The library was built without an effect that the scene requires.
  GRIDEL_STATUS_BLOB_MISSING_EFFECTS = 16,
  // The library was built without a shape, or a form of storage, that the scene requires.
  GRIDEL_STATUS_BLOB_MISSING_PART = 17,
  // The blob does not hold the structure that the library was built for.
  GRIDEL_STATUS_BLOB_MISSING_STRUCTURE = 18,
  // The blob has parts, which `gridel_load` does not load.
  GRIDEL_STATUS_BLOB_PARTS = 19,
  // A record of the blob is invalid.
  GRIDEL_STATUS_BLOB_INVALID = 20,
  // The ray's direction is zero, infinite or NaN, or so short or long that t is no number of the hit's type.
  GRIDEL_STATUS_RAY_DIRECTION = 30,
  // The ray's origin is infinite or NaN.
  GRIDEL_STATUS_RAY_ORIGIN = 31,
  // The ray's origin is too far from the scene, or the point of its hit from 0 for the hit's type.
  GRIDEL_STATUS_RAY_DISTANCE = 32,
  // The ray's interval ends before it begins, or is NaN.
  GRIDEL_STATUS_RAY_INTERVAL = 33,
  // The picture has no pixels, or is more than 64 times as wide as high.
  GRIDEL_STATUS_PICTURE_SIZE = 40,
  // The samples per pixel are not 1 to 4096.
  GRIDEL_STATUS_PICTURE_SAMPLES = 41,
  // The ray depth is above 32.
  GRIDEL_STATUS_PICTURE_DEPTH = 42,
  // The format of the pixels is unknown.
  GRIDEL_STATUS_PICTURE_FORMAT = 43,
  // The pixels are too narrow for the number format.
  GRIDEL_STATUS_PICTURE_RESOLUTION = 44,
  // A row or a rectangle leaves the picture.
  GRIDEL_STATUS_PICTURE_RECTANGLE = 45,
  // The field of view is below 2^-31 turn, or half a turn or more.
  GRIDEL_STATUS_CAMERA_FIELD_OF_VIEW = 50,
  // Eye and target of a camera are the same place.
  GRIDEL_STATUS_CAMERA_DIRECTION = 51,
  // The camera looks along the direction that points up, or that direction is 0.
  GRIDEL_STATUS_CAMERA_ALONG_UP = 52,
  // The camera's eye is beyond the range of coordinates.
  GRIDEL_STATUS_CAMERA_EYE = 53,
  // A camera's numbers are out of range: it was not made by this library.
  GRIDEL_STATUS_CAMERA_INVALID = 54,
  // The axis that points up is neither 1 nor 2.
  GRIDEL_STATUS_CAMERA_UP_AXIS = 55,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum gridel_status gridel_status;
#else
typedef uint32_t gridel_status;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// The form of a pixel in memory.
enum gridel_pixel_format
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint16_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // Three bytes: red, green, blue.
  GRIDEL_PIXEL_FORMAT_RGB888 = 0,
  // 16 bits in the machine's order, aligned: 5 of red, the uppermost, 6 of green, 5 of blue.
  GRIDEL_PIXEL_FORMAT_RGB565 = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum gridel_pixel_format gridel_pixel_format;
#else
typedef uint16_t gridel_pixel_format;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// A scene: memory of the caller that `gridel_load` fills in. It refers to the blob, which stays where it is. It can be
// moved and copied.
typedef struct gridel_scene {
  // Reserved for the library.
  size_t memory[GRIDEL_SCENE_WORDS];
} gridel_scene;

// A camera for the scene that it was made for; `gridel_camera_of` gives that of the scene file.
typedef struct gridel_camera {
  // The eye, in the library's own units.
  int64_t eye[3];
  // The vector from the eye to the middle of the picture; the three vectors have one scale.
  int32_t forward[3];
  // The vector from the middle to the right, as long as half of the picture's height.
  int32_t right[3];
  // The vector from the middle to the upper edge.
  int32_t up[3];
  // 0.
  uint32_t reserved;
} gridel_camera;

// A camera at one place that looks at another, in steps.
typedef struct gridel_look {
  // The place of the camera.
  int32_t eye[3];
  // The place in the middle of its picture.
  int32_t target[3];
  // The direction that is upwards in the picture, of any length but 0.
  int32_t up[3];
  // The angle of the picture's height, in 2^-32 turn: at least 2 and below half a turn.
  uint32_t field_of_view;
} gridel_look;

// A camera on a circle around a place, for example for a dial.
typedef struct gridel_circle {
  // The place in the middle of its picture, in steps.
  int32_t target[3];
  // The distance of the camera, in steps.
  uint32_t distance;
  // The angle by which it is turned around the axis that points up, counterclockwise as seen from above, in 2^-32
  // turn.
  uint32_t azimuth;
  // The angle by which it is raised, in 2^-32 turn; it can pass over the pole.
  uint32_t elevation;
  // The angle of the picture's height, in 2^-32 turn: at least 2 and below half a turn.
  uint32_t field_of_view;
  // The axis that points up: 1 for y, 2 for z.
  uint32_t up_axis;
} gridel_circle;

// A ray in steps of scene coordinates, without floating point: see `gridel_info`.
typedef struct gridel_ray {
  // The origin.
  int32_t position[3];
  // Its direction, of any length but 0.
  int32_t direction[3];
  // The least distance of a hit from `position`, in a straight line.
  uint64_t nearest;
  // The greatest distance; `UINT64_MAX` is endless.
  uint64_t farthest;
} gridel_ray;

// Memory of the caller.
typedef struct gridel_buffer {
  // The first byte.
  void *memory;
  // Its bytes.
  size_t bytes;
} gridel_buffer;

// The first hit of a `gridel_ray`.
typedef struct gridel_hit {
  // The distance from the ray's position, in a straight line, in steps; `UINT64_MAX` if nothing is hit.
  uint64_t distance;
  // The place that is hit, in steps; one beyond 32 bits is moved to their end.
  int32_t position[3];
  // The surface's normal, of length 2^30.
  int32_t normal[3];
  // The object, in scene-file order; `GRIDEL_NONE` if nothing is hit.
  uint32_t object;
  // The primitive, in scene-file order over all objects.
  uint32_t primitive;
  // The instance, in scene-file order; `GRIDEL_NONE` for the scene's own objects.
  uint32_t instance;
  // 1 if the ray came from the side to which the normal points, else 0.
  uint32_t front;
} gridel_hit;

// A ray in scene units, in single precision.
typedef struct gridel_ray_f32 {
  // The origin.
  float origin[3];
  // Its direction, of any length but 0 for which the t of a hit is a number of this type.
  float direction[3];
  // The least t of a hit, in multiples of the direction.
  float t_min;
  // The greatest t, which can be infinite.
  float t_max;
} gridel_ray_f32;

// The first hit of a `gridel_ray_f32`.
typedef struct gridel_hit_f32 {
  // The place on the ray, in multiples of the direction; infinite if nothing is hit.
  float t;
  // The place that is hit, in scene units.
  float point[3];
  // The surface's normal, of length 1.
  float normal[3];
  // The object, in scene-file order; `GRIDEL_NONE` if nothing is hit.
  uint32_t object;
  // The primitive, in scene-file order over all objects.
  uint32_t primitive;
  // The instance, in scene-file order; `GRIDEL_NONE` for the scene's own objects.
  uint32_t instance;
  // 1 if the ray came from the side to which the normal points, else 0.
  uint32_t front;
} gridel_hit_f32;

// A ray in scene units, in double precision.
typedef struct gridel_ray_f64 {
  // The origin.
  double origin[3];
  // Its direction, of any length but 0 for which the t of a hit is a number of this type.
  double direction[3];
  // The least t of a hit, in multiples of the direction.
  double t_min;
  // The greatest t, which can be infinite.
  double t_max;
} gridel_ray_f64;

// The first hit of a `gridel_ray_f64`.
typedef struct gridel_hit_f64 {
  // The place on the ray, in multiples of the direction; infinite if nothing is hit.
  double t;
  // The place that is hit, in scene units.
  double point[3];
  // The surface's normal, of length 1.
  double normal[3];
  // The object, in scene-file order; `GRIDEL_NONE` if nothing is hit.
  uint32_t object;
  // The primitive, in scene-file order over all objects.
  uint32_t primitive;
  // The instance, in scene-file order; `GRIDEL_NONE` for the scene's own objects.
  uint32_t instance;
  // 1 if the ray came from the side to which the normal points, else 0.
  uint32_t front;
} gridel_hit_f64;

// The properties and requirements of a scene.
typedef struct gridel_info {
  // The origin of `gridel_ray`, in scene units.
  double coordinate_origin[3];
  // A step of `gridel_ray` is 2 to this power scene units.
  int32_t coordinate_exponent;
  // Entries of the stack.
  uint32_t stack_depth;
  // Objects, in scene-file order.
  uint32_t objects;
  // Primitives of all objects.
  uint32_t primitives;
} gridel_info;

// A picture's settings; `gridel_picture_of` gives those of the scene file.
typedef struct gridel_picture {
  // Pixels from left to right.
  uint16_t width;
  // Pixels from top to bottom.
  uint16_t height;
  // Samples per pixel, 1 to 4096.
  uint16_t samples;
  // Maximum number of secondary rays that follow each other, 0 to 32: off mirrors, through glass or alpha, diffuse.
  uint16_t depth;
  // 1 to dither, else 0.
  uint16_t dither;
  // A `gridel_pixel_format`.
  uint16_t pixel_format;
} gridel_picture;

// A rectangle of a picture, in pixels from its upper left corner.
typedef struct gridel_rectangle {
  // The first column.
  uint16_t x;
  // The first row.
  uint16_t y;
  // Columns.
  uint16_t width;
  // Rows.
  uint16_t height;
} gridel_rectangle;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// Writes the camera of the scene file.
gridel_status gridel_camera_of(const struct gridel_scene *loaded, struct gridel_camera *camera);

// Makes a camera at one place that looks at another.
gridel_status gridel_look_at(const struct gridel_scene *loaded,
                             const struct gridel_look *look,
                             struct gridel_camera *camera);

// Makes a camera on a circle around a place.
gridel_status gridel_orbit(const struct gridel_scene *loaded,
                           const struct gridel_circle *circle,
                           struct gridel_camera *camera);

// Finds the first hit of a ray, in integers. `stack` is memory of `gridel_stack_bytes` bytes.
gridel_status gridel_cast_fixed(const struct gridel_scene *loaded,
                                const struct gridel_ray *ray,
                                struct gridel_buffer stack,
                                struct gridel_hit *hit);

// Finds the first hit of a ray in steps, in single precision.
gridel_status gridel_cast_steps_f32(const struct gridel_scene *loaded,
                                    const struct gridel_ray *ray,
                                    struct gridel_buffer stack,
                                    struct gridel_hit *hit);

// Finds the first hit of a ray in scene units, in single precision.
gridel_status gridel_cast_f32(const struct gridel_scene *loaded,
                              const struct gridel_ray_f32 *ray,
                              struct gridel_buffer stack,
                              struct gridel_hit_f32 *hit);

// Finds the first hit of a ray in scene units, in double precision.
gridel_status gridel_cast_f64(const struct gridel_scene *loaded,
                              const struct gridel_ray_f64 *ray,
                              struct gridel_buffer stack,
                              struct gridel_hit_f64 *hit);

// Writes 1 if a ray hits anything, else 0: in integers. Takes less time than `gridel_cast_fixed`.
gridel_status gridel_any_fixed(const struct gridel_scene *loaded,
                               const struct gridel_ray *ray,
                               struct gridel_buffer stack,
                               uint32_t *any);

// Writes 1 if a ray in steps hits anything, else 0: in single precision.
gridel_status gridel_any_steps_f32(const struct gridel_scene *loaded,
                                   const struct gridel_ray *ray,
                                   struct gridel_buffer stack,
                                   uint32_t *any);

// Writes 1 if a ray in scene units hits anything, else 0: in single precision.
gridel_status gridel_any_f32(const struct gridel_scene *loaded,
                             const struct gridel_ray_f32 *ray,
                             struct gridel_buffer stack,
                             uint32_t *any);

// Writes 1 if a ray in scene units hits anything, else 0: in double precision.
gridel_status gridel_any_f64(const struct gridel_scene *loaded,
                             const struct gridel_ray_f64 *ray,
                             struct gridel_buffer stack,
                             uint32_t *any);

// Checks a blob and fills in a scene. The blob starts at a multiple of 4 bytes and stays where it is, unchanged, for as
// long as the scene is used. Takes time linear in its length, and about 2 KiB of stack. A scene with parts is loaded by
// `gridel_load_with_parts`. If it fails, the scene stays as it was.
gridel_status gridel_load(struct gridel_scene *to,
                          const void *blob,
                          size_t blob_bytes);

// Writes the bytes of memory that `gridel_load_with_parts` needs; 0 for a blob without parts.
gridel_status gridel_parts_bytes(const void *blob, size_t blob_bytes, size_t *needed);

// Checks a blob that has parts and fills in a scene. The memory of the parts starts at a multiple of 8 bytes. It has
// as many bytes as `gridel_parts_bytes` states, and belongs to the scene for as long as that is used. If it fails, the
// scene is not loaded. Takes about 2.5 KiB of stack.
gridel_status gridel_load_with_parts(struct gridel_scene *to,
                                     const void *blob,
                                     size_t blob_bytes,
                                     struct gridel_buffer parts);

// Writes the reason why a blob is rejected as a sentence, with the section, the record and the expected value. The
// sentence ends with 0 and is cut off where the buffer ends. Returns the code. For a blob with valid parts the code is
// `GRIDEL_STATUS_BLOB_PARTS`, as from `gridel_load`. What places the parts is checked by `gridel_load_with_parts`
// alone. Takes some KiB of code and of stack; a program that does not call it does not hold it.
gridel_status gridel_blob_error(const void *blob,
                                size_t blob_bytes,
                                char *text,
                                size_t text_bytes);

// Writes the properties and requirements of a scene.
gridel_status gridel_info_of(const struct gridel_scene *loaded, struct gridel_info *info);

// Writes the bytes of the stack that rays need, which starts at a multiple of 8 bytes.
gridel_status gridel_stack_bytes(const struct gridel_scene *loaded, size_t *needed);

// Writes the settings of the scene file, without dithering, in RGB888.
gridel_status gridel_picture_of(const struct gridel_scene *loaded, struct gridel_picture *picture);

// Writes the bytes of the workspace that a picture needs in `fixed`, which starts at a multiple of 8 bytes.
gridel_status gridel_workspace_bytes_fixed(const struct gridel_scene *loaded,
                                           const struct gridel_picture *picture,
                                           size_t *needed);

// Writes the bytes of the workspace that a picture needs in `f32`, which starts at a multiple of 8 bytes.
gridel_status gridel_workspace_bytes_f32(const struct gridel_scene *loaded,
                                         const struct gridel_picture *picture,
                                         size_t *needed);

// Writes the bytes of the workspace that a picture needs in `f64`, which starts at a multiple of 8 bytes.
gridel_status gridel_workspace_bytes_f64(const struct gridel_scene *loaded,
                                         const struct gridel_picture *picture,
                                         size_t *needed);

// Renders a rectangle of a picture, such as a row, in integers. `pixels` holds its rows one behind the other; `workspace`
// is memory of `gridel_workspace_bytes_fixed` bytes. Pixels do not depend on each other: a picture is the same bytes
// whatever its rectangles. Each row is black from when it is begun until its pixels are written. Where that would be
// seen, render into other memory than that which is shown.
gridel_status gridel_render_fixed(const struct gridel_scene *loaded,
                                  const struct gridel_picture *picture,
                                  const struct gridel_rectangle *rectangle,
                                  struct gridel_buffer pixels,
                                  struct gridel_buffer workspace);

// Renders a rectangle of a picture, such as a row, in single precision: see `gridel_render_fixed`.
gridel_status gridel_render_f32(const struct gridel_scene *loaded,
                                const struct gridel_picture *picture,
                                const struct gridel_rectangle *rectangle,
                                struct gridel_buffer pixels,
                                struct gridel_buffer workspace);

// Renders a rectangle of a picture, such as a row, in double precision: see `gridel_render_fixed`.
gridel_status gridel_render_f64(const struct gridel_scene *loaded,
                                const struct gridel_picture *picture,
                                const struct gridel_rectangle *rectangle,
                                struct gridel_buffer pixels,
                                struct gridel_buffer workspace);

// Renders a rectangle of a picture as seen by a camera that was made for this scene, in integers: see
// `gridel_render_fixed`.
gridel_status gridel_render_from_fixed(const struct gridel_scene *loaded,
                                       const struct gridel_camera *camera,
                                       const struct gridel_picture *picture,
                                       const struct gridel_rectangle *rectangle,
                                       struct gridel_buffer pixels,
                                       struct gridel_buffer workspace);

// Renders a rectangle of a picture as seen by a camera that was made for this scene, in single precision: see
// `gridel_render_fixed`.
gridel_status gridel_render_from_f32(const struct gridel_scene *loaded,
                                     const struct gridel_camera *camera,
                                     const struct gridel_picture *picture,
                                     const struct gridel_rectangle *rectangle,
                                     struct gridel_buffer pixels,
                                     struct gridel_buffer workspace);

// Renders a rectangle of a picture as seen by a camera that was made for this scene, in double precision: see
// `gridel_render_fixed`.
gridel_status gridel_render_from_f64(const struct gridel_scene *loaded,
                                     const struct gridel_camera *camera,
                                     const struct gridel_picture *picture,
                                     const struct gridel_rectangle *rectangle,
                                     struct gridel_buffer pixels,
                                     struct gridel_buffer workspace);

// Returns the sentence for a code, which says what to do; it lives forever.
const char *gridel_text(uint32_t status);

// Returns the version of the library, in the form of `GRIDEL_VERSION`.
uint32_t gridel_version(void);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* GRIDEL_H */
