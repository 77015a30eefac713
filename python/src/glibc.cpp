// SPDX-License-Identifier: BSD-3-Clause
// hypot() of glibc 2.35 is the one of 2.2.5 without its errno; a wheel that asks for the old name (--wrap=hypot) runs
// on systems with glibc 2.34, too. The same bits.
#include <cmath>   // __GLIBC__

#if defined(__x86_64__) && defined(__GLIBC__)
extern "C" {
double livens_old_hypot(double x, double y);
__asm__(".symver livens_old_hypot, hypot@GLIBC_2.2.5");
double __wrap_hypot(double x, double y);
double __wrap_hypot(double x, double y) { return livens_old_hypot(x, y); }
}
#endif
