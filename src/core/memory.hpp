// How the process deals with the system's memory.
#pragma once
#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace bagnold {

// Arrays from a megabyte on go back to the system as soon as they are freed. By default the C library keeps what has
// the size of arrays freed before, so that a program whose large arrays come and go is counted for all of them at once.
inline void return_large_arrays() {
#if defined(__GLIBC__)
  mallopt(M_MMAP_THRESHOLD, 1 << 20);
  mallopt(M_TRIM_THRESHOLD, 16 << 20);  // and what many small ones leave, from here on
#endif
}

}  // namespace bagnold
