// Parallel loops whose results do not depend on the number of threads: items are independent, and sums are taken
// over blocks of fixed size in fixed order. Which thread does an item, and whether other threads are asked at all,
// depends on how busy the machine is.
#pragma once
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

namespace bagnold {

// The wish: `count`, or if that is 0 OMP_NUM_THREADS, else SLURM_CPUS_PER_TASK, else as many as allowed. Never more
// than the affinity mask and the CPU quota allow. Returns a note for the user if a wish had to be reduced, else nothing.
std::string set_threads(int count);
// Exactly so many, allowed or not, all of them used in every loop: for tests.
void force_threads(int count);
int threads();       // at most so many take part in a loop
int thread_index();  // who runs this item: 0 to threads() - 1, for memory of its own; 0 outside of loops

// While it lives, and if it is meant, loops of this thread stay on it: where most of the work cannot be shared, sharing
// the rest only moves data between processors.
class Alone {
 public:
  explicit Alone(bool meant = true);
  Alone(const Alone&) = delete;
  Alone& operator=(const Alone&) = delete;
  ~Alone();

 private:
  bool before_;
};

// Scratch memory of each thread, one object of a type that only who uses it has to know. A copy has none.
class PerThread {
 public:
  PerThread() = default;
  PerThread(const PerThread&) {}
  PerThread& operator=(const PerThread&) { return *this; }
  void prepare() { objects_.resize(std::max(objects_.size(), static_cast<std::size_t>(threads()))); }  // before a loop
  template <class T>
  T& mine() {  // within an item
    std::shared_ptr<void>& object = objects_[static_cast<std::size_t>(thread_index())];
    if (!object) object = std::shared_ptr<T>(new T());
    return *static_cast<T*>(object.get());
  }

 private:
  std::vector<std::shared_ptr<void>> objects_;
};

// body(context, begin, end) over parts of [0, n), each item exactly once. What an item throws reaches the caller when
// nobody works any more: the exception of the first item that threw; which of the items after it were done is left open.
// Loops within items stay on their thread.
using RangeBody = void (*)(void* context, std::int64_t begin, std::int64_t end);
void run_items(std::int64_t n, RangeBody body, void* context);

// f(begin, end) over parts of [0, n) of any size.
template <class F>
void parallel_ranges(std::int64_t n, F&& f) {
  using Function = std::remove_reference_t<F>;
  run_items(
      n, [](void* context, std::int64_t begin, std::int64_t end) { (*static_cast<Function*>(context))(begin, end); },
      const_cast<void*>(static_cast<const void*>(&f)));
}

// f(i) for i in [0, n), each exactly once, on any thread. f must not touch what another i writes. With
// `worthwhile` false the loop stays on this thread: asking for help costs microseconds.
template <class F>
void parallel_for(std::int64_t n, F&& f, bool worthwhile = true) {
  const auto range = [&f](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) f(i);
  };
  if (worthwhile)
    parallel_ranges(n, range);
  else
    range(0, n);
}

// f(begin, end) over blocks of `block` items: for bodies that vectorise or carry scratch space.
template <class F>
void parallel_blocks(std::int64_t n, std::int64_t block, F&& f) {
  parallel_for((n + block - 1) / block,
               [&](std::int64_t b) { f(b * block, b * block + block < n ? b * block + block : n); });
}

// Whether f(i) holds for all i. f is called for every i, whatever the others say.
template <class F>
bool parallel_all(std::int64_t n, F&& f, bool worthwhile = true) {
  std::atomic<bool> all{true};
  const auto range = [&](std::int64_t begin, std::int64_t end) {
    bool mine = true;
    for (std::int64_t i = begin; i < end; ++i) mine = f(i) && mine;
    if (!mine) all.store(false, std::memory_order_relaxed);
  };
  if (worthwhile)
    parallel_ranges(n, range);
  else
    range(0, n);
  return all.load(std::memory_order_relaxed);
}

// Sum of f(i): each block of 1024 items is summed in order, then the block sums in order. T needs T{} and +=.
template <class T, class F>
T parallel_sum(std::int64_t n, F&& f) {
  constexpr std::int64_t block = 1024;
  const std::int64_t blocks = (n + block - 1) / block;
  std::vector<T> partial(static_cast<std::size_t>(blocks));
  parallel_blocks(n, block, [&](std::int64_t begin, std::int64_t end) {
    T sum{};
    for (std::int64_t i = begin; i < end; ++i) sum += f(i);
    partial[static_cast<std::size_t>(begin / block)] = sum;
  });
  T total{};
  for (const T& p : partial) total += p;
  return total;
}

}  // namespace bagnold
