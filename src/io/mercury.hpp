// Files of MercuryDPM: particles (.data, 14 columns in three dimensions) and contacts (.fstat).
#pragma once
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "core/vec3.hpp"

namespace bagnold::io {

struct MercuryParticles {
  double time = 0;
  Vec3 lo{}, hi{};  // of the domain
  std::vector<Vec3> x, v, omega;
  std::vector<double> radius, info;  // info: the species, unless the driver writes something else there
};

// A contact as it concerns `i`; pairs of free particles appear twice in a file, once for each.
struct MercuryContact {
  std::int64_t i = 0, j = 0;  // rows of the particles; j < 0: wall -1 - j
  double overlap = 0;
  Vec3 normal{};  // unit, from j to i (walls are turned round: the file has them the other way)
  Vec3 force{};   // on i
};

struct MercuryContacts {
  double time = 0;
  std::vector<MercuryContact> contacts;
};

// Both read instant by instant; nothing at the end. They throw IoError, and InputError with file and line.
class MercuryData {
 public:
  explicit MercuryData(const std::filesystem::path& path);
  std::optional<MercuryParticles> next();

 private:
  std::filesystem::path path_;
  std::ifstream in_;
  std::int64_t line_ = 0;
};

class MercuryFstat {
 public:
  explicit MercuryFstat(const std::filesystem::path& path);
  std::optional<MercuryContacts> next();

 private:
  std::filesystem::path path_;
  std::ifstream in_;
  std::int64_t line_ = 0;
  std::string held_;  // first header line of the next instant
};

}  // namespace bagnold::io
