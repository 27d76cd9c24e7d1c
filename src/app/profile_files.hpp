// Averaged profiles as files and as the `flow` block of a summary; the same for a run and for `bagnold cg`.
#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "cg/flow.hpp"
#include "cg/regime.hpp"

namespace bagnold::app {

// profile.csv: every field at every node.
void write_profile(const std::filesystem::path& file, const cg::MeanProfile& profile);
// widths.csv: solid fraction for kernels of several widths, in grain diameters (figure 6). Nothing for kernels but the Gaussian.
void write_widths(const std::filesystem::path& file, const cg::BlockedProfile& profile, double diameter);
// steadiness.csv: momentum residual against averaging time (figure 5). Nothing with fewer than two blocks.
void write_steadiness(const std::filesystem::path& file, const cg::BlockedProfile& profile,
                      const cg::FlowSetting& setting);

// The numbers and, under <name>_err, their errors; null for what does not exist.
void add_flow_numbers(nlohmann::ordered_json& flow, const cg::FlowNumbers& numbers, const cg::FlowNumbers& errors);
void add_regime(nlohmann::ordered_json& flow, const cg::RegimeReport& report);

}  // namespace bagnold::app
