// SPDX-License-Identifier: GPL-3.0-or-later
// Floating-point exceptions as signals: in test programs, arithmetic that makes NaN of numbers, infinity of finite
// ones, or divides by zero, and comparisons with NaN, end the test at the place, in all threads. What is about lost
// numbers (steps above the stable one, input that is no number) goes between trap_off and trap_on. Programs that
// tests start do not trap.
#ifndef VSC_TESTS_TRAP_H
#define VSC_TESTS_TRAP_H

// Both act on the calling thread and on as many threads as the library then uses.
void trap_on(void);
void trap_off(void);

#endif
