/* Every function with pointers that are null or misaligned, buffers that are too small, and scenes that were not loaded:
 * codes, and nothing else. Compiles as C99 and as C++17. The arguments are blobs: of a scene, with the structure `list`
 * alone, with hits beyond single precision, with a plane, and with parts. */
#include "gridel.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int failures;

#define EXPECT(status, call)                                                                    \
  do {                                                                                          \
    const unsigned found = (unsigned)(call), expected = (unsigned)(status);                     \
    if (found != expected) {                                                                    \
      printf("line %d: %u in place of %u: %s\n", __LINE__, found, expected, gridel_text(found)); \
      failures++;                                                                               \
    }                                                                                           \
  } while (0)

#define CHECK(condition)                                       \
  do {                                                         \
    if (!(condition)) {                                        \
      printf("line %d: not so: %s\n", __LINE__, #condition);   \
      failures++;                                              \
    }                                                          \
  } while (0)

#define NULL_POINTER GRIDEL_STATUS_NULL_POINTER
#define MISALIGNED GRIDEL_STATUS_MISALIGNED
#define TOO_SMALL GRIDEL_STATUS_BUFFER_TOO_SMALL
#define NOT_LOADED GRIDEL_STATUS_NOT_LOADED

typedef gridel_status (*cast_steps)(const gridel_scene *, const gridel_ray *, gridel_buffer, gridel_hit *);
typedef gridel_status (*any_steps)(const gridel_scene *, const gridel_ray *, gridel_buffer, uint32_t *);
typedef gridel_status (*render)(const gridel_scene *, const gridel_picture *, const gridel_rectangle *, gridel_buffer,
                                gridel_buffer);
typedef gridel_status (*render_from)(const gridel_scene *, const gridel_camera *, const gridel_picture *,
                                     const gridel_rectangle *, gridel_buffer, gridel_buffer);
typedef gridel_status (*count)(const gridel_scene *, const gridel_picture *, size_t *);

/* Memory at a multiple of 16 bytes. */
static unsigned char *aligned(size_t bytes) {
  unsigned char *const memory = (unsigned char *)malloc(bytes + 16);
  return memory + (16 - (uintptr_t)memory % 16) % 16;
}

static unsigned char *load(const char *path, size_t *bytes) {
  FILE *const file = fopen(path, "rb");
  unsigned char *blob = aligned(1 << 20);
  if (!file) exit(2);
  *bytes = fread(blob, 1, 1 << 20, file);
  fclose(file);
  return blob;
}

static gridel_buffer buffer(void *memory, size_t bytes) {
  gridel_buffer it;
  it.memory = memory;
  it.bytes = bytes;
  return it;
}

int main(int count_of_arguments, char **arguments) {
  size_t blob_bytes, list_bytes, far_bytes, floor_bytes, arm_bytes, bytes, parts;
  unsigned char *blob, *list, *far, *floor_blob, *arm, *damaged;
  static gridel_scene scene, fresh, copy;
  static uint64_t memory[1024];
  static unsigned char pixels[3 * 64 * 64];
  char text[400];
  gridel_info info;
  gridel_picture picture;
  gridel_rectangle rectangle;
  gridel_hit hit;
  gridel_hit_f32 hit_f32;
  gridel_hit_f64 hit_f64;
  uint32_t any;
  int k;
  gridel_ray ray = {{0, 0, 0}, {0, -1, 0}, 0, UINT64_MAX};
  gridel_ray_f32 ray_f32 = {{0, 4, 0}, {0, -1, 0}, 0, 100};
  gridel_ray_f64 ray_f64 = {{0, 4, 0}, {0, -1, 0}, 0, 100};
  const gridel_buffer stack = buffer(memory, sizeof memory);
  const gridel_buffer none = buffer(NULL, 100);
  const gridel_buffer odd = buffer((unsigned char *)memory + 4, sizeof memory - 8);
  const cast_steps casts[] = {gridel_cast_fixed, gridel_cast_steps_f32};
  const any_steps anys[] = {gridel_any_fixed, gridel_any_steps_f32};
  const render renders[] = {gridel_render_fixed, gridel_render_f32, gridel_render_f64};
  const render_from renders_from[] = {gridel_render_from_fixed, gridel_render_from_f32, gridel_render_from_f64};
  static uint64_t for_pictures[GRIDEL_WORKSPACE_BYTES_MAX_F64 / sizeof(uint64_t)];
  const gridel_buffer large = buffer(for_pictures, sizeof for_pictures);
  gridel_camera camera;
  gridel_look look = {{0, 0, 0}, {0, 0, 0}, {0, 1, 0}, (uint32_t)1 << 29};
  gridel_circle circle = {{0, 0, 0}, 0, 0, 0, (uint32_t)1 << 29, 1};
  const count counts[] = {gridel_workspace_bytes_fixed, gridel_workspace_bytes_f32, gridel_workspace_bytes_f64};
  if (count_of_arguments != 6) return 2;
  blob = load(arguments[1], &blob_bytes);
  list = load(arguments[2], &list_bytes);
  far = load(arguments[3], &far_bytes);
  floor_blob = load(arguments[4], &floor_bytes);
  arm = load(arguments[5], &arm_bytes);

  CHECK(gridel_version() == GRIDEL_VERSION);
  CHECK(sizeof GRIDEL_NONE == sizeof(uint32_t));

  /* Loading. */
  EXPECT(NULL_POINTER, gridel_load(NULL, blob, blob_bytes));
  EXPECT(NULL_POINTER, gridel_load(&scene, NULL, blob_bytes));
  EXPECT(MISALIGNED, gridel_load((gridel_scene *)((unsigned char *)&scene + 1), blob, blob_bytes));
  EXPECT(GRIDEL_STATUS_BLOB_TRUNCATED, gridel_load(&scene, blob, (size_t)-1));
  EXPECT(GRIDEL_STATUS_BLOB_MAGIC, gridel_load(&scene, blob, 0));
  EXPECT(GRIDEL_STATUS_BLOB_TRUNCATED, gridel_load(&scene, blob, blob_bytes - 16));
  damaged = aligned(blob_bytes + 8);
  memcpy(damaged + 8, blob, blob_bytes);
  EXPECT(GRIDEL_STATUS_OK, gridel_load(&copy, damaged + 8, blob_bytes));
  memcpy(damaged + 4, blob, blob_bytes);
  EXPECT(GRIDEL_STATUS_OK, gridel_load(&copy, damaged + 4, blob_bytes));
  memcpy(damaged + 2, blob, blob_bytes);
  EXPECT(GRIDEL_STATUS_BLOB_MISALIGNED, gridel_load(&scene, damaged + 2, blob_bytes));
  memcpy(damaged, blob, blob_bytes);
  damaged[blob_bytes / 2] ^= 1;
  EXPECT(GRIDEL_STATUS_BLOB_CHECKSUM, gridel_load(&scene, damaged, blob_bytes));
  EXPECT(GRIDEL_STATUS_BLOB_CHECKSUM, gridel_blob_error(damaged, blob_bytes, text, sizeof text));
  CHECK(strstr(text, "checksum is 0x") != NULL);
  EXPECT(GRIDEL_STATUS_BLOB_CHECKSUM, gridel_blob_error(damaged, blob_bytes, text, 8));
  CHECK(strcmp(text, "the blo") == 0);
  damaged[0] ^= 1;
  EXPECT(GRIDEL_STATUS_BLOB_MAGIC, gridel_load(&scene, damaged, blob_bytes));
  EXPECT(GRIDEL_STATUS_OK, gridel_blob_error(blob, blob_bytes, text, sizeof text));
  CHECK(text[0] == 0);
  EXPECT(GRIDEL_STATUS_BLOB_PARTS, gridel_load(&copy, arm, arm_bytes));
  EXPECT(GRIDEL_STATUS_BLOB_PARTS, gridel_blob_error(arm, arm_bytes, text, sizeof text));
  CHECK(strstr(text, "gridel_load_with_parts") != NULL);
  arm[arm_bytes - 8] ^= 1;
  EXPECT(GRIDEL_STATUS_BLOB_CHECKSUM, gridel_blob_error(arm, arm_bytes, text, sizeof text));
  EXPECT(NULL_POINTER, gridel_blob_error(NULL, blob_bytes, text, sizeof text));
  EXPECT(NULL_POINTER, gridel_blob_error(blob, blob_bytes, NULL, sizeof text));
  EXPECT(GRIDEL_STATUS_BLOB_MISSING_STRUCTURE, gridel_load(&scene, list, list_bytes));
  EXPECT(GRIDEL_STATUS_BLOB_MISSING_STRUCTURE, gridel_blob_error(list, list_bytes, text, sizeof text));
  CHECK(strstr(text, "gridel build --accel") != NULL);
  EXPECT(NOT_LOADED, gridel_info_of(&scene, &info));
  memcpy(damaged, blob, blob_bytes);
  damaged[100] ^= 1;
  EXPECT(GRIDEL_STATUS_BLOB_CHECKSUM, gridel_parts_bytes(damaged, blob_bytes, &parts));
  EXPECT(GRIDEL_STATUS_BLOB_CHECKSUM, gridel_load_with_parts(&scene, damaged, blob_bytes, stack));
  EXPECT(NULL_POINTER, gridel_parts_bytes(NULL, blob_bytes, &parts));
  EXPECT(NULL_POINTER, gridel_parts_bytes(blob, blob_bytes, NULL));
  EXPECT(GRIDEL_STATUS_OK, gridel_parts_bytes(blob, blob_bytes, &parts));
  CHECK(parts == 0);
  EXPECT(NULL_POINTER, gridel_load_with_parts(&scene, blob, blob_bytes, none));
  EXPECT(GRIDEL_STATUS_OK, gridel_load_with_parts(&scene, blob, blob_bytes, stack));
  EXPECT(GRIDEL_STATUS_OK, gridel_load(&scene, blob, blob_bytes));
  /* A blob that cannot be loaded leaves the scene as it was. */
  EXPECT(GRIDEL_STATUS_BLOB_CHECKSUM, gridel_load(&scene, damaged, blob_bytes));
  EXPECT(GRIDEL_STATUS_OK, gridel_info_of(&scene, &info));

  /* What a scene needs; a copy is a scene, too. */
  memcpy(&copy, &scene, sizeof scene);
  EXPECT(NOT_LOADED, gridel_info_of(&fresh, &info));
  EXPECT(NULL_POINTER, gridel_info_of(NULL, &info));
  EXPECT(NULL_POINTER, gridel_info_of(&scene, NULL));
  EXPECT(MISALIGNED, gridel_info_of((const gridel_scene *)((unsigned char *)&scene + 1), &info));
  EXPECT(GRIDEL_STATUS_OK, gridel_info_of(&copy, &info));
  CHECK(info.objects > 0 && info.primitives >= info.objects);
  EXPECT(NOT_LOADED, gridel_stack_bytes(&fresh, &bytes));
  EXPECT(NULL_POINTER, gridel_stack_bytes(&scene, NULL));
  EXPECT(GRIDEL_STATUS_OK, gridel_stack_bytes(&scene, &bytes));
  CHECK(bytes == GRIDEL_STACK_BYTES(info.stack_depth) && bytes <= GRIDEL_STACK_BYTES_MAX);
  EXPECT(NOT_LOADED, gridel_picture_of(&fresh, &picture));
  EXPECT(NULL_POINTER, gridel_picture_of(&scene, NULL));
  EXPECT(GRIDEL_STATUS_OK, gridel_picture_of(&scene, &picture));

  /* Rays. */
  ray.position[1] = (int32_t)1 << (2 - info.coordinate_exponent);
  for (k = 0; k < 2; k++) {
    gridel_ray wrong = ray;
    EXPECT(NOT_LOADED, casts[k](&fresh, &ray, stack, &hit));
    EXPECT(NULL_POINTER, casts[k](&scene, NULL, stack, &hit));
    EXPECT(NULL_POINTER, casts[k](&scene, &ray, none, &hit));
    EXPECT(MISALIGNED, casts[k](&scene, &ray, odd, &hit));
    EXPECT(TOO_SMALL, casts[k](&scene, &ray, buffer(memory, bytes - 1), &hit));
    EXPECT(NULL_POINTER, casts[k](&scene, &ray, stack, NULL));
    EXPECT(GRIDEL_STATUS_OK, casts[k](&scene, &ray, buffer(memory, bytes), &hit));
    CHECK(hit.object < info.objects && hit.distance > 0);
    wrong.farthest = hit.distance / 2;
    EXPECT(GRIDEL_STATUS_OK, casts[k](&scene, &wrong, stack, &hit));
    CHECK(hit.object == GRIDEL_NONE && hit.distance == UINT64_MAX);
    EXPECT(GRIDEL_STATUS_OK, anys[k](&scene, &wrong, stack, &any));
    CHECK(any == 0);
    wrong.nearest = wrong.farthest + 1;
    EXPECT(GRIDEL_STATUS_RAY_INTERVAL, casts[k](&scene, &wrong, stack, &hit));
    EXPECT(GRIDEL_STATUS_RAY_INTERVAL, anys[k](&scene, &wrong, stack, &any));
    wrong.direction[1] = 0;
    wrong.nearest = 0;
    EXPECT(GRIDEL_STATUS_RAY_DIRECTION, casts[k](&scene, &wrong, stack, &hit));
    EXPECT(NOT_LOADED, anys[k](&fresh, &ray, stack, &any));
    EXPECT(NULL_POINTER, anys[k](&scene, &ray, stack, NULL));
    EXPECT(TOO_SMALL, anys[k](&scene, &ray, buffer(memory, bytes - 1), &any));
    EXPECT(GRIDEL_STATUS_OK, anys[k](&scene, &ray, stack, &any));
    CHECK(any == 1);
  }
  EXPECT(NOT_LOADED, gridel_cast_f32(&fresh, &ray_f32, stack, &hit_f32));
  EXPECT(NULL_POINTER, gridel_cast_f32(&scene, NULL, stack, &hit_f32));
  EXPECT(NULL_POINTER, gridel_cast_f32(&scene, &ray_f32, stack, NULL));
  EXPECT(GRIDEL_STATUS_OK, gridel_cast_f32(&scene, &ray_f32, stack, &hit_f32));
  EXPECT(GRIDEL_STATUS_OK, gridel_cast_f64(&scene, &ray_f64, stack, &hit_f64));
  EXPECT(GRIDEL_STATUS_OK, gridel_cast_fixed(&scene, &ray, stack, &hit));
  CHECK(hit_f32.object == hit.object && hit_f64.object == hit.object);
  /* Four units down, less what remains. */
  CHECK(hit_f32.t > 0 && hit_f32.point[1] + hit_f32.t > 3.999f && hit_f32.point[1] + hit_f32.t < 4.001f);
  CHECK(hit_f64.t - hit_f32.t < 1e-5 && hit_f32.t - hit_f64.t < 1e-5);
  EXPECT(GRIDEL_STATUS_OK, gridel_any_f32(&scene, &ray_f32, stack, &any));
  CHECK(any == 1);
  EXPECT(GRIDEL_STATUS_OK, gridel_any_f64(&scene, &ray_f64, stack, &any));
  CHECK(any == 1);
  EXPECT(NULL_POINTER, gridel_any_f32(&scene, &ray_f32, stack, NULL));
  EXPECT(NULL_POINTER, gridel_any_f64(&scene, NULL, stack, &any));
  /* Directions of any length. */
  {
    const double down = ray_f64.direction[1], t = hit_f64.t;
    const double lengths[] = {1e-250, 1e-200, 1e-31, 1e31, 1e200, 1e250};
    ray_f64.t_max = HUGE_VAL;
    ray_f32.t_max = HUGE_VALF;
    for (k = 0; k < 6; k++) {
      ray_f64.direction[1] = down * lengths[k];
      EXPECT(GRIDEL_STATUS_OK, gridel_cast_f64(&scene, &ray_f64, stack, &hit_f64));
      CHECK(hit_f64.object == hit.object && hit_f64.t * lengths[k] > 0.999999 * t && hit_f64.t * lengths[k] < 1.000001 * t);
      EXPECT(GRIDEL_STATUS_OK, gridel_any_f64(&scene, &ray_f64, stack, &any));
      CHECK(any == 1);
    }
    ray_f64.direction[1] = down * 1e-310;
    EXPECT(GRIDEL_STATUS_RAY_DIRECTION, gridel_cast_f64(&scene, &ray_f64, stack, &hit_f64));
    ray_f64.direction[1] = down;
    ray_f32.direction[1] = (float)down * 1e-37f;
    EXPECT(GRIDEL_STATUS_OK, gridel_cast_f32(&scene, &ray_f32, stack, &hit_f32));
    CHECK(hit_f32.t > 1e37f && hit_f32.object == hit.object);
    /* Four units away, t is more than single precision holds. */
    ray_f32.direction[1] = (float)down * 1e-39f;
    EXPECT(GRIDEL_STATUS_RAY_DIRECTION, gridel_cast_f32(&scene, &ray_f32, stack, &hit_f32));
    ray_f32.direction[1] = (float)down;
  }
  /* Finite, but not in the scene's units. */
  ray_f64.origin[0] = 1.7e308;
  EXPECT(GRIDEL_STATUS_RAY_DISTANCE, gridel_cast_f64(&scene, &ray_f64, stack, &hit_f64));
  ray_f32.t_max = -1;
  EXPECT(GRIDEL_STATUS_RAY_INTERVAL, gridel_cast_f32(&scene, &ray_f32, stack, &hit_f32));
  ray_f64.origin[0] = 1e300;
  EXPECT(GRIDEL_STATUS_RAY_DISTANCE, gridel_cast_f64(&scene, &ray_f64, stack, &hit_f64));
  ray_f64.origin[0] = ray_f64.origin[0] * 1e300;
  EXPECT(GRIDEL_STATUS_RAY_ORIGIN, gridel_any_f64(&scene, &ray_f64, stack, &any));
  ray_f32.direction[1] = 0;
  EXPECT(GRIDEL_STATUS_RAY_DIRECTION, gridel_any_f32(&scene, &ray_f32, stack, &any));
  /* From inside a ball with a radius of 1e39, which is a double and no float. */
  {
    gridel_ray_f32 from_f32 = {{0, 0, 0}, {0, 1e20f, 0}, 0, 1e30f};
    gridel_ray_f64 from_f64 = {{0, 0, 0}, {0, 1e20, 0}, 0, 1e30};
    EXPECT(GRIDEL_STATUS_OK, gridel_load(&copy, far, far_bytes));
    EXPECT(GRIDEL_STATUS_RAY_DISTANCE, gridel_cast_f32(&copy, &from_f32, stack, &hit_f32));
    EXPECT(GRIDEL_STATUS_OK, gridel_cast_f64(&copy, &from_f64, stack, &hit_f64));
    CHECK(hit_f64.object == 0 && hit_f64.point[1] > 9e38);
    /* On a plane, where no lattice reaches. */
    EXPECT(GRIDEL_STATUS_OK, gridel_load(&copy, floor_blob, floor_bytes));
    for (k = 0; k < 11; k++) {
      const gridel_ray_f64 along = {{0, 20, 8}, {pow(10, k), -21, 0}, 0, INFINITY};
      EXPECT(GRIDEL_STATUS_OK, gridel_cast_f64(&copy, &along, stack, &hit_f64));
      CHECK(fabs(hit_f64.point[0] / pow(10, k) - hit_f64.t) < 1e-6);
      CHECK(fabs(hit_f64.point[1] + 1) < 1e-3 && fabs(hit_f64.point[2] - 8) < 1e-3 && fabs(hit_f64.t - 1) < 1e-3);
    }
    EXPECT(GRIDEL_STATUS_OK, gridel_load(&copy, far, far_bytes));
    /* As lengths, both ends are infinite. */
    from_f64.t_min = INFINITY;
    from_f64.t_max = 1.7e308;
    EXPECT(GRIDEL_STATUS_RAY_INTERVAL, gridel_cast_f64(&copy, &from_f64, stack, &hit_f64));
  }

  /* Pictures. */
  rectangle.x = rectangle.y = 0;
  rectangle.width = picture.width;
  rectangle.height = 1;
  for (k = 0; k < 3; k++) {
    gridel_picture wrong = picture;
    size_t needed;
    gridel_rectangle beyond = rectangle;
    const gridel_buffer row = buffer(pixels, sizeof pixels);
    EXPECT(NOT_LOADED, counts[k](&fresh, &picture, &bytes));
    EXPECT(NULL_POINTER, counts[k](&scene, NULL, &bytes));
    EXPECT(NULL_POINTER, counts[k](&scene, &picture, NULL));
    EXPECT(GRIDEL_STATUS_OK, counts[k](&scene, &picture, &bytes));
    wrong.depth = 33;
    EXPECT(GRIDEL_STATUS_PICTURE_DEPTH, counts[k](&scene, &wrong, &needed));
    wrong = picture;
    wrong.width = 0;
    EXPECT(GRIDEL_STATUS_PICTURE_SIZE, counts[k](&scene, &wrong, &needed));
    wrong = picture;
    CHECK(bytes <= (k == 2 ? GRIDEL_WORKSPACE_BYTES_MAX_F64 : GRIDEL_WORKSPACE_BYTES_MAX));
    EXPECT(NOT_LOADED, renders[k](&fresh, &picture, &rectangle, row, stack));
    EXPECT(NULL_POINTER, renders[k](&scene, NULL, &rectangle, row, stack));
    EXPECT(NULL_POINTER, renders[k](&scene, &picture, NULL, row, stack));
    EXPECT(NULL_POINTER, renders[k](&scene, &picture, &rectangle, none, stack));
    EXPECT(NULL_POINTER, renders[k](&scene, &picture, &rectangle, row, none));
    EXPECT(MISALIGNED, renders[k](&scene, &picture, &rectangle, row, odd));
    EXPECT(TOO_SMALL, renders[k](&scene, &picture, &rectangle, row, buffer(memory, bytes - 1)));
    EXPECT(TOO_SMALL, renders[k](&scene, &picture, &rectangle, buffer(pixels, 3 * (size_t)picture.width - 1), stack));
    EXPECT(GRIDEL_STATUS_OK, renders[k](&scene, &picture, &rectangle, row, buffer(memory, bytes)));
    beyond.y = picture.height;
    EXPECT(GRIDEL_STATUS_PICTURE_RECTANGLE, renders[k](&scene, &picture, &beyond, row, stack));
    beyond.height = beyond.width = 0;
    EXPECT(GRIDEL_STATUS_OK, renders[k](&scene, &picture, &beyond, row, stack));
    wrong.pixel_format = GRIDEL_PIXEL_FORMAT_RGB565;
    EXPECT(GRIDEL_STATUS_OK, renders[k](&scene, &wrong, &rectangle, row, stack));
    EXPECT(MISALIGNED, renders[k](&scene, &wrong, &rectangle, buffer(pixels + 1, sizeof pixels - 1), stack));
    wrong.pixel_format = 2;
    EXPECT(GRIDEL_STATUS_PICTURE_FORMAT, renders[k](&scene, &wrong, &rectangle, row, stack));
    wrong = picture;
    wrong.width = 0;
    EXPECT(GRIDEL_STATUS_PICTURE_SIZE, renders[k](&scene, &wrong, &rectangle, row, stack));
    wrong = picture;
    wrong.samples = 4097;
    EXPECT(GRIDEL_STATUS_PICTURE_SAMPLES, renders[k](&scene, &wrong, &rectangle, row, stack));
    wrong = picture;
    wrong.depth = 33;
    EXPECT(GRIDEL_STATUS_PICTURE_DEPTH, renders[k](&scene, &wrong, &rectangle, row, stack));
    wrong.depth = 256;
    EXPECT(GRIDEL_STATUS_PICTURE_DEPTH, renders[k](&scene, &wrong, &rectangle, row, stack));
  }

  /* Every code has a text of its own. */
  for (k = 0; k < 56; k++) CHECK(strlen(gridel_text((gridel_status)k)) > 3);
  CHECK(strcmp(gridel_text((gridel_status)999), "unknown status") == 0);
  /* Cameras. */
  EXPECT(NOT_LOADED, gridel_camera_of(&fresh, &camera));
  EXPECT(NULL_POINTER, gridel_camera_of(&scene, NULL));
  EXPECT(GRIDEL_STATUS_OK, gridel_camera_of(&scene, &camera));
  EXPECT(NOT_LOADED, gridel_look_at(&fresh, &look, &camera));
  EXPECT(NULL_POINTER, gridel_look_at(&scene, NULL, &camera));
  EXPECT(NULL_POINTER, gridel_look_at(&scene, &look, NULL));
  EXPECT(GRIDEL_STATUS_CAMERA_DIRECTION, gridel_look_at(&scene, &look, &camera));
  look.eye[1] = 1000;
  EXPECT(GRIDEL_STATUS_CAMERA_ALONG_UP, gridel_look_at(&scene, &look, &camera));
  memset(look.up, 0, sizeof look.up);
  EXPECT(GRIDEL_STATUS_CAMERA_ALONG_UP, gridel_look_at(&scene, &look, &camera));
  CHECK(strstr(gridel_text(GRIDEL_STATUS_CAMERA_ALONG_UP), "or that is 0") != NULL);
  look.up[1] = 1;
  look.eye[0] = 1000;
  look.field_of_view = 0;
  EXPECT(GRIDEL_STATUS_CAMERA_FIELD_OF_VIEW, gridel_look_at(&scene, &look, &camera));
  look.field_of_view = (uint32_t)1 << 31;
  EXPECT(GRIDEL_STATUS_CAMERA_FIELD_OF_VIEW, gridel_look_at(&scene, &look, &camera));
  look.field_of_view -= 2;
  EXPECT(GRIDEL_STATUS_OK, gridel_look_at(&scene, &look, &camera));
  EXPECT(GRIDEL_STATUS_OK,
         gridel_render_from_f64(&scene, &camera, &picture, &rectangle, buffer(pixels, sizeof pixels), large));
  look.field_of_view = 2;
  EXPECT(GRIDEL_STATUS_OK, gridel_look_at(&scene, &look, &camera));
  EXPECT(GRIDEL_STATUS_PICTURE_RESOLUTION,
         gridel_render_from_f64(&scene, &camera, &picture, &rectangle, buffer(pixels, sizeof pixels), large));
  EXPECT(NOT_LOADED, gridel_orbit(&fresh, &circle, &camera));
  EXPECT(NULL_POINTER, gridel_orbit(&scene, NULL, &camera));
  EXPECT(NULL_POINTER, gridel_orbit(&scene, &circle, NULL));
  EXPECT(GRIDEL_STATUS_CAMERA_DIRECTION, gridel_orbit(&scene, &circle, &camera));
  circle.distance = 0xffffffffu;
  EXPECT(GRIDEL_STATUS_CAMERA_EYE, gridel_orbit(&scene, &circle, &camera));
  circle.distance = 1000;
  circle.up_axis = 0;
  EXPECT(GRIDEL_STATUS_CAMERA_UP_AXIS, gridel_orbit(&scene, &circle, &camera));
  circle.up_axis = 2;
  EXPECT(GRIDEL_STATUS_OK, gridel_orbit(&scene, &circle, &camera));
  EXPECT(GRIDEL_STATUS_OK, gridel_picture_of(&scene, &picture));
  picture.width = picture.height = 4;
  rectangle.x = rectangle.y = 0;
  rectangle.width = rectangle.height = 4;
  for (k = 0; k < 3; k++) {
    gridel_camera wrong = camera;
    EXPECT(NOT_LOADED, renders_from[k](&fresh, &camera, &picture, &rectangle, buffer(pixels, 48), large));
    EXPECT(NULL_POINTER, renders_from[k](&scene, NULL, &picture, &rectangle, buffer(pixels, 48), large));
    EXPECT(NULL_POINTER, renders_from[k](&scene, &camera, NULL, &rectangle, buffer(pixels, 48), large));
    EXPECT(TOO_SMALL, renders_from[k](&scene, &camera, &picture, &rectangle, buffer(pixels, 47), large));
    EXPECT(GRIDEL_STATUS_OK, renders_from[k](&scene, &camera, &picture, &rectangle, buffer(pixels, 48), large));
    wrong.right[2] = ((int32_t)1 << 28) + 1;
    EXPECT(GRIDEL_STATUS_CAMERA_INVALID, renders_from[k](&scene, &wrong, &picture, &rectangle, buffer(pixels, 48), large));
    wrong = camera;
    wrong.eye[0] = ((int64_t)1 << 50) + 1;
    EXPECT(GRIDEL_STATUS_CAMERA_INVALID, renders_from[k](&scene, &wrong, &picture, &rectangle, buffer(pixels, 48), large));
    wrong = camera;
    memset(wrong.forward, 0, sizeof wrong.forward);
    memset(wrong.right, 0, sizeof wrong.right);
    memset(wrong.up, 0, sizeof wrong.up);
    EXPECT(GRIDEL_STATUS_CAMERA_INVALID, renders_from[k](&scene, &wrong, &picture, &rectangle, buffer(pixels, 48), large));
    wrong = camera;
    wrong.reserved = 1;
    EXPECT(GRIDEL_STATUS_CAMERA_INVALID, renders_from[k](&scene, &wrong, &picture, &rectangle, buffer(pixels, 48), large));
  }

  if (failures == 0) printf("scene %u bytes\n", (unsigned)sizeof scene);
  return failures != 0;
}
