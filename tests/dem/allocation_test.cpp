// A step allocates nothing: every allocation of this program passes through here and is counted.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "dem/contacts.hpp"
#include "helpers.hpp"

namespace {
std::atomic<long> allocations{0};
void* counted(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size > 0 ? size : 1)) return p;
  throw std::bad_alloc();
}
}  // namespace

void* operator new(std::size_t size) { return counted(size); }
void* operator new[](std::size_t size) { return counted(size); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size > 0 ? size : 1);
}
void operator delete(void* p, const std::nothrow_t&) noexcept { std::free(p); }
void operator delete(void* p) noexcept { std::free(p); }
void operator delete[](void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t) noexcept { std::free(p); }

namespace bagnold::dem {
namespace {

TEST(Allocation, NoneInAStep) {
  const ContactLaws laws = testing::paper_laws();
  DemState s = testing::random_packing(9, 0.97, 5);
  s.walls = {{s.box.origin - Vec3{0, 0, 0.45}, {0, 0, 1}, 0}};
  s.box.periodic[2] = false;
  s.dt = 1e-4;
  s.keep_ledger = true;
  prepare(s, laws);
  advance(s, laws, 300);
  std::vector<Contact> list;
  list_contacts(s, laws, list);
  int steps_without = 0;
  for (int n = 0; n < 200; ++n) {
    const std::int64_t rebuilds = s.rebuilds;
    const long before = allocations;
    advance(s, laws, 1);
    const long stepped = allocations - before;
    if (s.rebuilds != rebuilds) continue;
    EXPECT_EQ(stepped, 0);
    ++steps_without;
  }
  EXPECT_GT(steps_without, 100);
  list_contacts(s, laws, list);
  const long before = allocations;
  list_contacts(s, laws, list);
  (void)energies(s, laws);
  EXPECT_EQ(allocations - before, 0);
}

}  // namespace
}  // namespace bagnold::dem
