// A long average kept as a few dozen consecutive blocks: the average, the errors of everything derived from it,
// and the decay of the momentum residual with the averaging time all come from the same rows.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "cg/moments.hpp"
#include "core/arrays.hpp"

namespace bagnold::cg {

// Averages over some blocks, at the nodes z.
struct MeanProfile {
  std::vector<double> z;
  std::vector<Row> value, slope;
  std::int64_t samples = 0;
  double begin = 0, end = 0, spacing = 0, kernel_width = 0;
  double contacts = 0;  // per sample
  Vec3 base_force{};    // of the flow on the base
  double area = 1;
};

class BlockedProfile {
 public:
  // `samples_expected` of the whole average, 0 if unknown. When `most_blocks` blocks are full, neighbours merge and
  // blocks become twice as long.
  BlockedProfile(const laws::CgKernels::Any& kernel, double spacing, const Box& box, std::int64_t samples_expected = 0);

  void add(const Snapshot& snapshot);
  void add(const dem::DemState& state, const dem::ContactLaws& laws);  // of a running engine,
  void before(const dem::fast::Engine& engine);  // of a fast one from inside: the stages of dem::Watch
  void add(std::size_t section, dem::fast::ContactPacks contacts);
  void add(const dem::fast::Engine& engine);
  std::int64_t samples() const;  // so far, the unfinished block included
  const laws::CgKernels::Any& kernel() const { return current_.kernel; }
  const Lattice& lattice() const { return current_.lattice; }
  std::int64_t complete_blocks() const { return static_cast<std::int64_t>(scalars_.size()) / scalars_per_block; }

  MeanProfile mean() const;  // of every sample
  // The same with another width of a Gaussian kernel, at least an eighth of the own one: the sums know nothing of the
  // kernel but how fine their bins are. Throws UnphysicalError otherwise.
  MeanProfile mean_with_width(double width) const;
  // Means over intervals of one spacing about the nodes instead of values at the nodes.
  MeanProfile interval_mean() const;
  MeanProfile mean(std::int64_t first_block, std::int64_t blocks) const;  // of complete blocks
  // Of all complete blocks but [first_block, first_block + blocks): what a jackknife asks for.
  MeanProfile mean_without(std::int64_t first_block, std::int64_t blocks) const;

  // Everything that decides what comes next, for exact checkpoints.
  std::vector<NamedArray> state(const std::string& prefix);

  static constexpr std::int64_t most_blocks = 64;

 private:
  static constexpr std::int64_t scalars_per_block = 7;    // begin, end, samples, contacts, base force
  static constexpr std::size_t row_size = 2 * kChannels;  // sums and their slopes

  MeanProfile mean_of(const ProfileMoments& all, bool averaged) const;
  ProfileMoments all_moments() const;  // of every sample
  void widen(const NodeRange& range);
  void begin_sample(double time);
  void end_sample();
  void close_block();
  void merge_neighbours();
  MeanProfile average(const std::vector<double>& rows, const std::vector<double>& scalars) const;

  ProfileMoments current_, closed_;  // of the unfinished block, of all others together
  ProfileScratch scratch_;
  double start_ = 0, begin_ = 0, end_ = 0;  // first sample of all, first and last of the current block
  std::int64_t block_samples_ = 1;
  std::int64_t first_ = 0, count_ = 0;  // nodes of rows_
  std::vector<double> scalars_, rows_;  // of complete blocks: [block][scalar], [block][node][row_size]
};

}  // namespace bagnold::cg
