// Parallel loops whose results do not depend on the number of threads: items are independent, and sums are taken
// over blocks of fixed size in fixed order.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace bagnold {

void set_threads(int count);  // 0: from OMP_NUM_THREADS, else SLURM_CPUS_PER_TASK, else all cores
int threads();

// f(i) for i in [0, n), each exactly once, on any thread. f must not touch what another i writes. With
// `worthwhile` false the loop stays on this thread: starting a team costs microseconds.
template <class F>
void parallel_for(std::int64_t n, F&& f, bool worthwhile = true) {
#pragma omp parallel for schedule(static) if (worthwhile)
  for (std::int64_t i = 0; i < n; ++i) f(i);
}

// f(begin, end) over blocks of `block` items: for bodies that vectorise or carry scratch space.
template <class F>
void parallel_blocks(std::int64_t n, std::int64_t block, F&& f) {
  const std::int64_t blocks = (n + block - 1) / block;
#pragma omp parallel for schedule(static)
  for (std::int64_t b = 0; b < blocks; ++b) f(b * block, b * block + block < n ? b * block + block : n);
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
