// A step allocates nothing: every allocation of this program passes through here and is counted.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "core/parallel.hpp"
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

DemState over_a_plane(std::int64_t per_side) {
  DemState s = testing::random_packing(per_side, 0.97, 5);
  s.walls = {{s.box.origin - Vec3{0, 0, 0.45}, {0, 0, 1}, 0}};
  s.box.periodic[2] = false;
  s.dt = 1e-4;
  s.keep_ledger = true;
  return s;
}

// How many steps of 200 allocate nothing and rebuild no list, and how many only do the latter.
struct Counts {
  int without = 0, with = 0;
};
template <class Advance>
Counts count_steps(DemState& s, Advance&& advance_by_one) {
  Counts counts;
  for (int n = 0; n < 200; ++n) {
    const std::int64_t rebuilds = s.rebuilds;
    const long before = allocations;
    advance_by_one();
    const long stepped = allocations - before;
    if (s.rebuilds == rebuilds) ++(stepped == 0 ? counts.without : counts.with);
  }
  return counts;
}

TEST(Allocation, NoneInAStep) {
  const ContactLaws laws = testing::paper_laws();
  DemState s = over_a_plane(9);
  prepare(s, laws);
  advance_plain(s, laws, 300);
  std::vector<Contact> list;
  list_contacts(s, laws, list);
  const Counts counts = count_steps(s, [&] { advance_plain(s, laws, 1); });
  EXPECT_EQ(counts.with, 0);
  EXPECT_GT(counts.without, 100);
  list_contacts(s, laws, list);
  const long before = allocations;
  list_contacts(s, laws, list);
  (void)energies(s, laws);
  EXPECT_EQ(allocations - before, 0);
}

// The lists of sections grow now and then, and are given room to spare.
TEST(Allocation, HardlyAnyInAStepOfTheFastEngine) {
  set_threads(1);
  const ContactLaws laws = testing::paper_laws();
  DemState s = over_a_plane(9);
  prepare(s, laws);
  advance_inside(s, laws, 300);
  const Counts counts = count_steps(s, [&] { advance_inside(s, laws, 1); });
  EXPECT_LE(counts.with, 5);
  EXPECT_GT(counts.without, 100);
  set_threads(0);
}

}  // namespace
}  // namespace bagnold::dem
