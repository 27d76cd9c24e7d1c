#include "core/parallel.hpp"

#include <omp.h>

#include <cstdlib>

namespace bagnold {

void set_threads(int count) {
  if (count <= 0 && std::getenv("OMP_NUM_THREADS") == nullptr)
    if (const char* slurm = std::getenv("SLURM_CPUS_PER_TASK")) count = std::atoi(slurm);
  if (count > 0) omp_set_num_threads(count);
}

int threads() { return omp_get_max_threads(); }

}  // namespace bagnold
