// How the process deals with the system's memory.
#pragma once
#include <sys/mman.h>

#include <cstdlib>
#include <new>
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

// For arrays that sweeps over neighbours read: large ones come in pages of 2 MB, where the system has them, for their reads go
// to a dozen places at a time and fetching ahead ends at every page.
template <class T>
struct LargePages {
  using value_type = T;
  static constexpr std::size_t page = 2 << 20;
  LargePages() = default;
  template <class U>
  LargePages(const LargePages<U>&) {}
  T* allocate(std::size_t n) {
    const std::size_t bytes = n * sizeof(T), whole = (bytes + page - 1) / page * page;
    void* p = bytes < 2 * page ? std::aligned_alloc(64, (bytes + 63) / 64 * 64) : std::aligned_alloc(page, whole);
    if (p == nullptr) throw std::bad_alloc();
#if defined(MADV_HUGEPAGE)
    if (bytes >= 2 * page) madvise(p, whole, MADV_HUGEPAGE);
#endif
    return static_cast<T*>(p);
  }
  void deallocate(T* p, std::size_t) { std::free(p); }
  friend bool operator==(const LargePages&, const LargePages&) { return true; }
};

}  // namespace bagnold
