#include "cg/blocks.hpp"

#include <algorithm>

namespace bagnold::cg {
namespace {

// Sums of [begin, end) items of `width` numbers each, added to `to`.
void add_items(std::vector<double>& to, const std::vector<double>& items, std::size_t begin, std::size_t end) {
  const std::size_t width = to.size();
  for (std::size_t b = begin; b < end; ++b)
    for (std::size_t k = 0; k < width; ++k) to[k] += items[b * width + k];
}

}  // namespace

BlockedProfile::BlockedProfile(const laws::CgKernels::Any& kernel, double spacing, const Box& box, std::int64_t samples_expected)
    : current_(make_moments(kernel, make_lattice(kernel, spacing), box)),
      block_samples_(std::max<std::int64_t>(1, (samples_expected + most_blocks - 1) / most_blocks)) {}

void BlockedProfile::add(const Snapshot& snapshot) {
  if (current_.samples == 0) begin_ = snapshot.time;
  end_ = snapshot.time;
  add_snapshot(current_, snapshot, scratch_);
  if (current_.samples >= block_samples_) close_block();
}

std::int64_t BlockedProfile::samples() const {
  double sum = static_cast<double>(current_.samples);
  for (std::size_t b = 0; b < static_cast<std::size_t>(complete_blocks()); ++b) sum += scalars_[b * scalars_per_block + 2];
  return static_cast<std::int64_t>(sum);
}

std::vector<double> BlockedProfile::current_scalars() const {
  const Vec3& f = current_.base_force;
  return {begin_, end_, static_cast<double>(current_.samples), current_.contacts, f.x, f.y, f.z};
}

std::vector<double> BlockedProfile::current_rows() const {
  const ProfileSums sums = evaluate(current_, first_, count_);
  std::vector<double> rows;
  rows.reserve(static_cast<std::size_t>(count_) * row_size);
  for (std::size_t n = 0; n < sums.value.size(); ++n) {
    rows.insert(rows.end(), sums.value[n].begin(), sums.value[n].end());
    rows.insert(rows.end(), sums.slope[n].begin(), sums.slope[n].end());
  }
  return rows;
}

// Extends every stored block to more nodes. All sums are constant beyond the nodes they were evaluated at, so the
// outermost row continues, without slope.
void BlockedProfile::widen(const NodeRange& range) {
  const std::int64_t lo = count_ == 0 ? range.first : std::min(first_, range.first);
  const std::int64_t hi = count_ == 0 ? range.first + range.count : std::max(first_ + count_, range.first + range.count);
  if (count_ > 0 && lo == first_ && hi == first_ + count_) return;
  std::vector<double> wide;
  wide.reserve(static_cast<std::size_t>(complete_blocks() * (hi - lo)) * row_size);
  for (std::int64_t b = 0; b < complete_blocks(); ++b)
    for (std::int64_t n = lo; n < hi; ++n) {
      const std::int64_t from = std::clamp(n, first_, first_ + count_ - 1);
      const auto row = rows_.begin() + (b * count_ + from - first_) * static_cast<std::int64_t>(row_size);
      wide.insert(wide.end(), row, row + kChannels);
      if (from == n) wide.insert(wide.end(), row + kChannels, row + row_size);
      else wide.insert(wide.end(), kChannels, 0.0);
    }
  rows_ = std::move(wide);
  first_ = lo;
  count_ = hi - lo;
}

void BlockedProfile::close_block() {
  widen(reach(current_));
  const std::vector<double> rows = current_rows(), scalars = current_scalars();
  rows_.insert(rows_.end(), rows.begin(), rows.end());
  scalars_.insert(scalars_.end(), scalars.begin(), scalars.end());
  clear(current_);
  if (complete_blocks() == most_blocks) merge_neighbours();
}

void BlockedProfile::merge_neighbours() {
  const std::size_t size = static_cast<std::size_t>(count_) * row_size, n = static_cast<std::size_t>(complete_blocks()) / 2;
  for (std::size_t b = 0; b < n; ++b) {
    for (std::size_t k = 0; k < size; ++k) rows_[b * size + k] = rows_[2 * b * size + k] + rows_[(2 * b + 1) * size + k];
    double* to = scalars_.data() + b * scalars_per_block;
    const double *one = scalars_.data() + 2 * b * scalars_per_block, *two = one + scalars_per_block;
    const double begin = one[0], end = two[1];
    for (std::int64_t k = 2; k < scalars_per_block; ++k) to[k] = one[k] + two[k];
    to[0] = begin;
    to[1] = end;
  }
  rows_.resize(n * size);
  scalars_.resize(n * scalars_per_block);
  block_samples_ *= 2;
}

MeanProfile BlockedProfile::average(const std::vector<double>& rows, const std::vector<double>& scalars) const {
  MeanProfile m;
  const double samples = scalars[2], per_sample = samples > 0 ? 1 / samples : 0;
  m.samples = static_cast<std::int64_t>(samples);
  m.contacts = scalars[3] * per_sample;
  m.base_force = per_sample * Vec3{scalars[4], scalars[5], scalars[6]};
  m.spacing = current_.lattice.spacing;
  m.kernel_width = std::visit([](const auto& k) { return k.width; }, current_.kernel);
  m.area = current_.area;
  for (std::size_t n = 0; n < rows.size() / row_size; ++n) {
    m.z.push_back(current_.lattice.node(first_ + static_cast<std::int64_t>(n)));
    Row& value = m.value.emplace_back();
    Row& slope = m.slope.emplace_back();
    for (std::size_t c = 0; c < kChannels; ++c) value[c] = rows[n * row_size + c] * per_sample;
    for (std::size_t c = 0; c < kChannels; ++c) slope[c] = rows[n * row_size + kChannels + c] * per_sample;
  }
  return m;
}

MeanProfile BlockedProfile::mean(std::int64_t first, std::int64_t blocks) const {
  std::vector<double> rows(static_cast<std::size_t>(count_) * row_size), scalars(scalars_per_block);
  add_items(rows, rows_, static_cast<std::size_t>(first), static_cast<std::size_t>(first + blocks));
  add_items(scalars, scalars_, static_cast<std::size_t>(first), static_cast<std::size_t>(first + blocks));
  MeanProfile m = average(rows, scalars);
  m.begin = scalars_[static_cast<std::size_t>(first * scalars_per_block)];
  m.end = scalars_[static_cast<std::size_t>((first + blocks - 1) * scalars_per_block + 1)];
  return m;
}

MeanProfile BlockedProfile::mean_without(std::int64_t first, std::int64_t blocks) const {
  std::vector<double> rows(static_cast<std::size_t>(count_) * row_size), scalars(scalars_per_block);
  for (const auto& [begin, end] : {std::pair<std::int64_t, std::int64_t>{0, first}, {first + blocks, complete_blocks()}}) {
    add_items(rows, rows_, static_cast<std::size_t>(begin), static_cast<std::size_t>(end));
    add_items(scalars, scalars_, static_cast<std::size_t>(begin), static_cast<std::size_t>(end));
  }
  MeanProfile m = average(rows, scalars);
  m.begin = scalars_[0];
  m.end = scalars_[scalars_.size() - scalars_per_block + 1];
  return m;
}

MeanProfile BlockedProfile::mean() const {
  if (current_.samples == 0) return complete_blocks() > 0 ? mean(0, complete_blocks()) : MeanProfile{};
  BlockedProfile all = *this;   // with the unfinished block closed
  all.block_samples_ = 0;
  all.widen(reach(all.current_));
  const std::vector<double> rows = all.current_rows(), scalars = all.current_scalars();
  all.rows_.insert(all.rows_.end(), rows.begin(), rows.end());
  all.scalars_.insert(all.scalars_.end(), scalars.begin(), scalars.end());
  return all.mean(0, all.complete_blocks());
}

std::vector<NamedArray> BlockedProfile::state(const std::string& prefix) {
  std::vector<NamedArray> arrays;
  const auto add_bins = [&](const std::string& name, BinMoments& m) {
    arrays.push_back({prefix + name + "/first", &m.first});
    arrays.push_back({prefix + name + "/count", &m.count});
    arrays.push_back({prefix + name + "/moments", &m.data});
  };
  add_bins("flow", current_.flow);
  add_bins("base", current_.base);
  arrays.push_back({prefix + "samples", &current_.samples});
  arrays.push_back({prefix + "contacts", &current_.contacts});
  arrays.push_back({prefix + "base_force_x", &current_.base_force.x});
  arrays.push_back({prefix + "base_force_y", &current_.base_force.y});
  arrays.push_back({prefix + "base_force_z", &current_.base_force.z});
  arrays.push_back({prefix + "begin", &begin_});
  arrays.push_back({prefix + "end", &end_});
  arrays.push_back({prefix + "block_samples", &block_samples_});
  arrays.push_back({prefix + "first_node", &first_});
  arrays.push_back({prefix + "nodes", &count_});
  arrays.push_back({prefix + "block_scalars", &scalars_});
  arrays.push_back({prefix + "block_rows", &rows_});
  return arrays;
}

}  // namespace bagnold::cg
