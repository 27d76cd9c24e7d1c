#include "app/profile_files.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "cg/fields.hpp"
#include "io/csv.hpp"

namespace bagnold::app {

namespace {
double or_nan(const std::optional<double>& number) { return number.value_or(NAN); }
}  // namespace

void write_profile(const std::filesystem::path& file, const cg::MeanProfile& p) {
  std::vector<io::Column> columns{{"z", "length", "height above the base plane"}};
  std::vector<std::vector<double>> cells{p.z};
  const double least = cg::least_density(p.value);
  for (const cg::FieldDefinition& f : cg::all_fields()) {
    columns.push_back({f.name, f.unit, f.meaning});
    std::vector<double>& column = cells.emplace_back();
    for (std::size_t n = 0; n < p.z.size(); ++n) {
      cg::Gradient gradient;
      for (std::size_t c = 0; c < 4; ++c) gradient.d[2][c] = p.slope[n][c];
      column.push_back(f.value({p.value[n], gradient, p.kernel_width, least}));
    }
  }
  io::write_csv(file, columns, cells, io::CsvHeader::names_and_units);
}

void write_widths(const std::filesystem::path& file, const cg::BlockedProfile& profile, double diameter) {
  if (!std::holds_alternative<laws::CgGaussian>(profile.kernel()) || profile.samples() == 0) return;
  const double own = std::get<laws::CgGaussian>(profile.kernel()).width;
  std::vector<io::Column> columns;
  std::vector<std::vector<double>> cells;
  // The widest kernel reaches farthest, so its nodes are those of all.
  for (double w : {1.0, 0.5, 0.25, 0.1, 0.05}) {
    if (w * diameter < own / 8) continue;
    const cg::MeanProfile p = profile.mean_with_width(w * diameter);
    if (columns.empty()) {
      columns.push_back({"z", "length", "height above the base plane"});
      cells.push_back(p.z);
    }
    columns.push_back(
        {fmt::format("phi_w{:g}", w), "1", fmt::format("solid fraction with a kernel of width {:g} d", w)});
    std::vector<double> phi(cells[0].size(), 0.0);
    const auto skip = static_cast<std::size_t>(std::llround((p.z[0] - cells[0][0]) / p.spacing));
    for (std::size_t n = 0; n < p.z.size() && n + skip < phi.size(); ++n) phi[n + skip] = p.value[n][cg::kVolume];
    cells.push_back(std::move(phi));
  }
  if (!columns.empty()) io::write_csv(file, columns, cells, io::CsvHeader::names_and_units);
}

void write_steadiness(const std::filesystem::path& file, const cg::BlockedProfile& profile,
                      const cg::FlowSetting& setting) {
  if (profile.complete_blocks() < 2) return;
  std::vector<std::vector<double>> cells(2);
  for (const cg::SteadinessPoint& point : cg::steadiness(profile, setting)) {
    cells[0].push_back(point.duration);
    cells[1].push_back(point.residual);
  }
  io::write_csv(
      file,
      {{"duration", "time", "averaging time T"}, {"residual", "1", "depth-averaged norm of d(rho u)/dt over rho g"}},
      cells, io::CsvHeader::names_and_units);
}

void add_flow_numbers(nlohmann::ordered_json& flow, const cg::FlowNumbers& numbers, const cg::FlowNumbers& errors) {
  for_each_field<cg::FlowNumbers>([&](const auto& f) {
    flow[std::string(f.name)] = or_nan(numbers.*f.member);
    flow[std::string(f.name) + "_err"] = or_nan(errors.*f.member);
  });
}

void add_regime(nlohmann::ordered_json& flow, const cg::RegimeReport& report) {
  if (report.regime)
    flow["regime"] = cg::name_of(*report.regime);
  else
    flow["regime"] = nullptr;
  flow["energy_ratio"] = or_nan(report.energy_ratio);
  flow["energy_ratio_err"] = or_nan(report.energy_ratio_err);
  flow["energy_growth"] = or_nan(report.growth);
  flow["energy_growth_err"] = or_nan(report.growth_err);
  flow["energy_swing"] = or_nan(report.swing);
}

}  // namespace bagnold::app
