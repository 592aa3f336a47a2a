/* The start of a Cortex-M: vectors, and the floating-point unit where there is one. newlib's `_start` does the rest. */
#include <stdint.h>

extern uint32_t stack_top;
void _start(void);

void reset(void) {
#ifdef __ARM_FP
  /* Coprocessors 10 and 11: full access (Armv7-M Architecture Reference Manual, B3.2.20). */
  *(volatile uint32_t *)0xe000ed88 |= 0xfu << 20;
  __asm__ volatile("dsb\nisb");
#endif
  _start();
  for (;;) {
  }
}

static void fault(void) {
  for (;;) {
  }
}

__attribute__((section(".vectors"), used)) static void (*const vectors[])(void) = {
    (void (*)(void))&stack_top, reset, fault, fault, fault, fault, fault,
};
