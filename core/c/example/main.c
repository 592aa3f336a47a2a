/* Casts rays into a scene and renders it by its own camera and by one of the program's, in the number format that FORMAT
 * names. Prints what the rays hit on standard error, and the pictures as PPM on standard output. Runs on a board under semihosting, and on a host. */
#include "gridel.h"
#include <stdio.h>

#define JOIN(name, format) name##format
#define NAME(name, format) JOIN(name, format)
#ifndef FORMAT
#define FORMAT fixed
#endif
#define CAST NAME(gridel_cast_, FORMAT)
#define ANY NAME(gridel_any_, FORMAT)
#define RENDER NAME(gridel_render_from_, FORMAT)
#define WORKSPACE_BYTES NAME(gridel_workspace_bytes_, FORMAT)
/* Rays in steps are named after what they count in, unless that is all that a format has. */
#define gridel_cast_f32 gridel_cast_steps_f32
#define gridel_any_f32 gridel_any_steps_f32

/* The blob goes into flash, aligned as it must be. */
__asm__(".section .rodata.blob, \"a\"\n"
        ".balign 4\n"
        ".global blob_start, blob_end\n"
        "blob_start: .incbin \"" BLOB "\"\n"
        "blob_end: .byte 0\n"
        ".balign 4\n"
        ".text\n");
extern const unsigned char blob_start[], blob_end[];

enum { WIDEST = 512, RAYS = 16 };

/* All the memory that there is, beside the call stack. */
static gridel_scene scene;
static uint64_t stack[GRIDEL_STACK_BYTES_MAX / sizeof(uint64_t)];
static uint64_t workspace[GRIDEL_WORKSPACE_BYTES_MAX / sizeof(uint64_t)];
static unsigned char row[3 * WIDEST];
/* A stack for one depth is whole words too, on boards of 32 bits as well. */
typedef char stack_is_whole_words[GRIDEL_STACK_BYTES(5) % sizeof(uint64_t) == 0 ? 1 : -1];

static int failed(const char *what, gridel_status status) {
  fprintf(stderr, "%s: %s\n", what, gridel_text(status));
  return 1;
}

/* Renders a picture row by row; 0 if that fails. */
static int print_picture(const gridel_picture *picture, const gridel_camera *camera) {
  const gridel_buffer for_pictures = {workspace, sizeof workspace};
  const gridel_buffer pixels = {row, sizeof row};
  gridel_rectangle line = {0, 0, 0, 1};
  printf("P6\n%u %u\n255\n", picture->width, picture->height);
  line.width = picture->width;
  for (; line.y < picture->height; line.y++) {
    const gridel_status status = RENDER(&scene, camera, picture, &line, pixels, for_pictures);
    if (status != GRIDEL_STATUS_OK) return !failed("render", status);
    fwrite(row, 3, picture->width, stdout);
  }
  return 1;
}

/* A length in scene units as steps, limited to the range of coordinates. A step is 2^exponent scene units. */
static int32_t steps(int32_t units, int32_t exponent) {
  int64_t length = units;
  for (; exponent < 0 && length <= INT32_MAX; exponent++) length *= 2;
  for (; exponent > 0; exponent--) length /= 2;
  return length > INT32_MAX ? INT32_MAX : (int32_t)length;
}

int main(void) {
  const size_t blob_bytes = (size_t)(blob_end - blob_start);
  gridel_buffer for_rays = {stack, sizeof stack};
  gridel_circle circle = {{0, 0, 0}, 0, (uint32_t)1 << 29, (uint32_t)1 << 28, (uint32_t)1 << 29, 1};
  gridel_camera camera;
  gridel_info info;
  gridel_picture picture;
  size_t needed;
  gridel_status status = gridel_load(&scene, blob_start, blob_bytes);
  if (status != GRIDEL_STATUS_OK) return failed("gridel_load", status);
  status = gridel_info_of(&scene, &info);
  if (status != GRIDEL_STATUS_OK) return failed("gridel_info_of", status);

  /* A range finder above the scene turns from left to right. */
  for (int32_t turn = 0; turn < RAYS; turn++) {
    const gridel_ray ray = {{0, steps(4, info.coordinate_exponent), 0}, {turn - RAYS / 2, -RAYS / 2, 1}, 0, UINT64_MAX};
    gridel_hit hit;
    uint32_t any;
    status = CAST(&scene, &ray, for_rays, &hit);
    if (status != GRIDEL_STATUS_OK) return failed("cast", status);
    status = ANY(&scene, &ray, for_rays, &any);
    if (status != GRIDEL_STATUS_OK) return failed("any", status);
    fprintf(stderr, "%lu %lu %ld %ld\n", (unsigned long)(hit.distance & 0xffffffff), (unsigned long)hit.object,
            (long)hit.normal[1], (long)any);
  }

  status = gridel_picture_of(&scene, &picture);
  if (status != GRIDEL_STATUS_OK) return failed("gridel_picture_of", status);
  status = WORKSPACE_BYTES(&scene, &picture, &needed);
  if (status != GRIDEL_STATUS_OK) return failed("workspace bytes", status);
  if (needed > sizeof workspace || picture.width > WIDEST) return failed("picture", GRIDEL_STATUS_BUFFER_TOO_SMALL);
  status = gridel_camera_of(&scene, &camera);
  if (status != GRIDEL_STATUS_OK) return failed("gridel_camera_of", status);
  if (!print_picture(&picture, &camera)) return 1;

  /* An eighth of a turn around the scene's middle, raised by a sixteenth; the height is seen under an eighth. */
  circle.distance = (uint32_t)steps(8, info.coordinate_exponent);
  status = gridel_orbit(&scene, &circle, &camera);
  if (status != GRIDEL_STATUS_OK) return failed("gridel_orbit", status);
  if (!print_picture(&picture, &camera)) return 1;
  fflush(stdout);
  return 0;
}
