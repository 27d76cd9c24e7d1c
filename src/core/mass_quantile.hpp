// Where a share of the mass lies.
#pragma once
#include <algorithm>
#include <utility>
#include <vector>

namespace bagnold {

// Places and masses of particles, sorted by place.
class MassQuantiles {
 public:
  explicit MassQuantiles(std::vector<std::pair<double, double>> place_and_mass) : sorted_(std::move(place_and_mass)) {
    std::sort(sorted_.begin(), sorted_.end());
    for (const auto& [x, m] : sorted_) mass_ += m;
  }
  // The first place up to which `share` of the mass, 0 to 1, is found. There is at least one particle.
  double at(double share) const {
    double below = 0;
    for (const auto& [x, m] : sorted_)
      if ((below += m) >= share * mass_) return x;
    return sorted_.back().first;
  }

 private:
  std::vector<std::pair<double, double>> sorted_;
  double mass_ = 0;
};

}  // namespace bagnold
