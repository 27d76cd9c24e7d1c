#include "scenario/fill.hpp"

#include <algorithm>
#include <array>
#include <unordered_map>

#include "core/error.hpp"

namespace bagnold::scenario {

namespace {

// Spheres in cells at least as wide as the largest diameter: an overlap can only be with the 27 cells around.
class Occupied {
 public:
  Occupied(const Box& box, double largest) : box_(box) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double length = box.length[static_cast<int>(k)];
      count_[k] = box.periodic[k] ? std::max(1, static_cast<int>(length / largest)) : 0;
      width_[static_cast<int>(k)] = box.periodic[k] ? length / count_[k] : largest;
    }
  }

  void add(const Sphere& sphere) { cells_[key(index(sphere.x))].push_back(sphere); }

  bool overlaps(const Sphere& sphere) const {
    const Index c = index(sphere.x);
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dz = -1; dz <= 1; ++dz) {
          const auto cell = cells_.find(key({c[0] + dx, c[1] + dy, c[2] + dz}));
          if (cell == cells_.end()) continue;
          for (const Sphere& other : cell->second) {
            const double touch = 0.5 * (sphere.diameter + other.diameter);
            if (norm2(minimum_image(box_, sphere.x - other.x)) < touch * touch) return true;
          }
        }
    return false;
  }

 private:
  using Index = std::array<int, 3>;
  Index index(const Vec3& x) const {
    Index i{};
    for (int k = 0; k < 3; ++k)
      i[static_cast<std::size_t>(k)] = static_cast<int>(std::floor((x[k] - box_.origin[k]) / width_[k]));
    return i;
  }
  std::uint64_t key(Index i) const {
    std::uint64_t out = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      if (count_[k] > 0) i[k] = ((i[k] % count_[k]) + count_[k]) % count_[k];
      out = (out << 21) ^ static_cast<std::uint64_t>(i[k] + (1 << 20));
    }
    return out;
  }

  Box box_;
  std::array<int, 3> count_{};
  Vec3 width_;
  std::unordered_map<std::uint64_t, std::vector<Sphere>> cells_;
};

}  // namespace

std::vector<Vec3> fill(const FillRegion& region, const std::vector<double>& diameters,
                       const std::vector<Sphere>& obstacles, std::uint64_t seed, random::Stream stream) {
  double largest = 0;
  for (const double d : diameters) largest = std::max(largest, d);
  for (const Sphere& s : obstacles) largest = std::max(largest, s.diameter);

  Occupied occupied(region.box, largest);
  for (const Sphere& s : obstacles) occupied.add(s);

  const Vec3 &origin = region.box.origin, &length = region.box.length;
  const double middle_x = origin.x + 0.5 * length.x, middle_y = origin.y + 0.5 * length.y;
  double height = region.height;
  std::vector<Vec3> centres;
  centres.reserve(diameters.size());
  for (std::size_t i = 0; i < diameters.size(); ++i) {
    Sphere sphere{{}, diameters[i]};
    const double r = 0.5 * diameters[i];
    if (region.cylinder_radius > 0 && region.cylinder_radius < r)
      throw UnphysicalError("scenario.radius", "the cylinder is narrower than a grain");
    for (std::uint32_t attempt = 0;; ++attempt) {
      const auto [u, v] = random::uniform2(seed, stream, i, 2 * attempt);
      const double w = random::uniform(seed, stream, i, 2 * attempt + 1);
      sphere.x = {origin.x + u * length.x, origin.y + v * length.y, region.floor + w * height};
      const bool inside = region.cylinder_radius <= 0 ||
                          std::hypot(sphere.x.x - middle_x, sphere.x.y - middle_y) <= region.cylinder_radius - r;
      if (!inside) continue;  // says nothing about crowding
      if ((!region.solid_floor || sphere.x.z >= region.floor + r) && !occupied.overlaps(sphere)) break;
      height += region.growth;
    }
    occupied.add(sphere);
    centres.push_back(sphere.x);
  }
  return centres;
}

}  // namespace bagnold::scenario
