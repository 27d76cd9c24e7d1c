// What the particle model writes: rows of the series, snapshots, ParaView files, the summary, `check`.
#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "app/dem_input.hpp"
#include "app/model.hpp"
#include "dem/observe.hpp"

namespace bagnold::app {

std::vector<io::Column> dem_series_columns();
// Energies are of the flowing grains; gravity counts from the initial state.
std::vector<double> dem_series_row(const DemInput& in, const dem::Observation& seen, double initial_energy);

void write_dem_snapshot(io::H5File& file, const std::string& group, const dem::DemState& state,
                        const std::vector<dem::Contact>& contacts);
std::vector<std::pair<std::string, std::string>> write_dem_vtk(const std::filesystem::path& directory, int number,
                                                               const dem::DemState& state,
                                                               const std::vector<dem::Contact>& contacts);
void add_dem_summary(nlohmann::ordered_json& summary, const DemInput& in, const dem::Observation& seen,
                     double initial_energy);
std::vector<Derived> dem_derived(const DemInput& in);
Cost dem_cost(const DemInput& in);

}  // namespace bagnold::app
