#include "report/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace bagnold::report {

std::string in_quotes(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("''") : std::string(1, c);
  return out + "'";
}

double tic_step(double length, int most) {
  const double least = length / most, power = std::pow(10, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= least) return factor * power;
  return 10 * power;
}

Palette thickness_palette() {
  static constexpr std::array<Rgb, 5> colours{
      {{255, 255, 255}, {189, 215, 231}, {107, 174, 214}, {33, 113, 181}, {8, 48, 107}}};
  return colours;
}

Palette hot_palette() {
  static constexpr std::array<Rgb, 5> colours{
      {{255, 247, 168}, {254, 204, 92}, {253, 141, 60}, {227, 40, 30}, {110, 0, 30}}};
  return colours;
}

Palette time_palette() {
  static constexpr std::array<Rgb, 5> colours{
      {{68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {240, 190, 30}}};
  return colours;
}

Rgb colour(Palette palette, double share) {
  const double at = std::clamp(share, 0.0, 1.0) * static_cast<double>(palette.size() - 1);
  const auto k = std::min(static_cast<std::size_t>(at), palette.size() - 2);
  const double f = at - static_cast<double>(k);
  Rgb mixed{};
  for (std::size_t c = 0; c < 3; ++c) mixed[c] = (1 - f) * palette[k][c] + f * palette[k + 1][c];
  return mixed;
}

std::string hex(const Rgb& colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", std::lround(colour[0]), std::lround(colour[1]), std::lround(colour[2]));
}

std::string set_palette(Palette palette, double exponent) {
  std::string nodes;
  const auto last = static_cast<double>(palette.size() - 1);
  for (std::size_t k = 0; k < palette.size(); ++k)
    nodes += fmt::format("{}{:.6g} '{}'", k == 0 ? "" : ", ", std::pow(static_cast<double>(k) / last, exponent),
                         hex(palette[k]));
  return "set palette defined (" + nodes + ")\n";
}

}  // namespace bagnold::report
