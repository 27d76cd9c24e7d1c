#include "cg/blocks.hpp"

#include <algorithm>

#include "core/error.hpp"
#include "dem/fast/engine.hpp"

namespace bagnold::cg {
namespace {

// Sums of [begin, end) items of `width` numbers each, added to `to`.
void add_items(std::vector<double>& to, const std::vector<double>& items, std::size_t begin, std::size_t end) {
  const std::size_t width = to.size();
  for (std::size_t b = begin; b < end; ++b)
    for (std::size_t k = 0; k < width; ++k) to[k] += items[b * width + k];
}

}  // namespace

BlockedProfile::BlockedProfile(const laws::CgKernels::Any& kernel, double spacing, const Box& box,
                               std::int64_t samples_expected)
    : current_(make_moments(kernel, make_lattice(kernel, spacing), box)),
      closed_(current_),
      block_samples_(std::max<std::int64_t>(1, (samples_expected + most_blocks - 1) / most_blocks)) {}

void BlockedProfile::begin_sample(double time) {
  if (current_.samples == 0) begin_ = time;
  if (samples() == 0) start_ = time;
  end_ = time;
}

void BlockedProfile::end_sample() {
  if (current_.samples >= block_samples_) close_block();
}

void BlockedProfile::add(const Snapshot& snapshot) {
  begin_sample(snapshot.time);
  add_snapshot(current_, snapshot, scratch_);
  end_sample();
}

void BlockedProfile::add(const dem::DemState& state, const dem::ContactLaws& laws) {
  begin_sample(state.time());
  add_state(current_, state, laws, scratch_);
  end_sample();
}

void BlockedProfile::before(const dem::fast::Engine& engine) { begin_rows(engine, scratch_); }

void BlockedProfile::add(std::size_t section, dem::fast::ContactPacks contacts) {
  add_section(current_, section, contacts, scratch_);
}

void BlockedProfile::add(const dem::fast::Engine& engine) {
  begin_sample(static_cast<double>(engine.step) * engine.dt);
  add_rows(current_, engine, scratch_);
  end_sample();
}

std::int64_t BlockedProfile::samples() const { return current_.samples + closed_.samples; }

// Extends every stored block to more nodes. All sums are constant beyond the nodes they were evaluated at, so the
// outermost row continues, without slope.
void BlockedProfile::widen(const NodeRange& range) {
  const std::int64_t lo = count_ == 0 ? range.first : std::min(first_, range.first);
  const std::int64_t hi =
      count_ == 0 ? range.first + range.count : std::max(first_ + count_, range.first + range.count);
  if (count_ > 0 && lo == first_ && hi == first_ + count_) return;
  std::vector<double> wide;
  wide.reserve(static_cast<std::size_t>(complete_blocks() * (hi - lo)) * row_size);
  for (std::int64_t b = 0; b < complete_blocks(); ++b)
    for (std::int64_t n = lo; n < hi; ++n) {
      const std::int64_t from = std::clamp(n, first_, first_ + count_ - 1);
      const auto row = rows_.begin() + (b * count_ + from - first_) * static_cast<std::int64_t>(row_size);
      wide.insert(wide.end(), row, row + kChannels);
      if (from == n)
        wide.insert(wide.end(), row + kChannels, row + row_size);
      else
        wide.insert(wide.end(), kChannels, 0.0);
    }
  rows_ = std::move(wide);
  first_ = lo;
  count_ = hi - lo;
}

void BlockedProfile::close_block() {
  widen(reach(current_));
  const ProfileSums sums = evaluate(current_, first_, count_);
  for (std::size_t n = 0; n < sums.value.size(); ++n) {
    rows_.insert(rows_.end(), sums.value[n].begin(), sums.value[n].end());
    rows_.insert(rows_.end(), sums.slope[n].begin(), sums.slope[n].end());
  }
  const Vec3& f = current_.base_force;
  scalars_.insert(scalars_.end(),
                  {begin_, end_, static_cast<double>(current_.samples), current_.contacts, f.x, f.y, f.z});
  add_moments(closed_, current_);
  clear(current_);
  if (complete_blocks() == most_blocks) merge_neighbours();
}

void BlockedProfile::merge_neighbours() {
  const std::size_t size = static_cast<std::size_t>(count_) * row_size,
                    n = static_cast<std::size_t>(complete_blocks()) / 2;
  for (std::size_t b = 0; b < n; ++b) {
    for (std::size_t k = 0; k < size; ++k)
      rows_[b * size + k] = rows_[2 * b * size + k] + rows_[(2 * b + 1) * size + k];
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
  for (const auto& [begin, end] :
       {std::pair<std::int64_t, std::int64_t>{0, first}, {first + blocks, complete_blocks()}}) {
    add_items(rows, rows_, static_cast<std::size_t>(begin), static_cast<std::size_t>(end));
    add_items(scalars, scalars_, static_cast<std::size_t>(begin), static_cast<std::size_t>(end));
  }
  MeanProfile m = average(rows, scalars);
  m.begin = scalars_[0];
  m.end = scalars_[scalars_.size() - scalars_per_block + 1];
  return m;
}

ProfileMoments BlockedProfile::all_moments() const {
  ProfileMoments all = closed_;
  add_moments(all, current_);
  return all;
}

MeanProfile BlockedProfile::mean_of(const ProfileMoments& all, bool averaged) const {
  const NodeRange range = reach(all);
  const ProfileSums sums = evaluate(all, range.first, range.count, averaged);
  const double per_sample = all.samples > 0 ? 1 / static_cast<double>(all.samples) : 0;
  MeanProfile m;
  m.samples = all.samples;
  m.begin = start_;
  m.end = end_;
  m.contacts = all.contacts * per_sample;
  m.base_force = per_sample * all.base_force;
  m.spacing = all.lattice.spacing;
  m.kernel_width = std::visit([](const auto& k) { return k.width; }, all.kernel);
  m.area = all.area;
  m.value = sums.value;
  m.slope = sums.slope;
  for (auto* rows : {&m.value, &m.slope})
    for (Row& row : *rows)
      for (double& v : row) v *= per_sample;
  for (std::int64_t n = 0; n < range.count; ++n) m.z.push_back(all.lattice.node(range.first + n));
  return m;
}

MeanProfile BlockedProfile::mean() const { return mean_of(all_moments(), false); }
MeanProfile BlockedProfile::interval_mean() const { return mean_of(all_moments(), true); }

MeanProfile BlockedProfile::mean_with_width(double width) const {
  ProfileMoments all = all_moments();
  const auto* own = std::get_if<laws::CgGaussian>(&all.kernel);
  if (!own || width < own->width / 8)
    throw UnphysicalError("cg.width",
                          "profiles of another width need a Gaussian kernel and at least an eighth of its width");
  all.kernel = laws::CgGaussian{width};
  return mean_of(all, false);
}

std::vector<NamedArray> BlockedProfile::state(const std::string& prefix) {
  std::vector<NamedArray> arrays;
  const auto add_moments_of = [&](const std::string& name, ProfileMoments& m) {
    for (const auto& [part, bins] : {std::pair<std::string, BinMoments*>{"flow", &m.flow}, {"base", &m.base}}) {
      arrays.push_back({prefix + name + "/" + part + "_first", &bins->first});
      arrays.push_back({prefix + name + "/" + part + "_bins", &bins->count});
      arrays.push_back({prefix + name + "/" + part + "_powers", &bins->data});
    }
    arrays.push_back({prefix + name + "/samples", &m.samples});
    arrays.push_back({prefix + name + "/contacts", &m.contacts});
    arrays.push_back({prefix + name + "/base_force_x", &m.base_force.x});
    arrays.push_back({prefix + name + "/base_force_y", &m.base_force.y});
    arrays.push_back({prefix + name + "/base_force_z", &m.base_force.z});
  };
  add_moments_of("block", current_);
  add_moments_of("closed", closed_);
  arrays.push_back({prefix + "start", &start_});
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
