// bagnold cg INPUT...: coarse-grain stored runs, own and foreign.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/cg_input.hpp"
#include "app/profile_files.hpp"
#include "app/use_threads.hpp"
#include "app/verbs.hpp"
#include "cg/fields.hpp"
#include "cg/grid.hpp"
#include "core/error.hpp"
#include "core/version.hpp"
#include "io/csv.hpp"
#include "io/json.hpp"

namespace bagnold::app {

namespace {

namespace fs = std::filesystem;

struct CgOptions {
  std::vector<std::string> inputs;
  std::string directory = "cg", kernel = "gaussian", grid = "z";
  double width = 0, spacing = 0, from = -INFINITY, until = INFINITY;
  bool intervals = false, series = false;
  std::vector<double> gravity;
  int threads = 0;
  ForeignOptions foreign;
};

laws::CgKernels::Any kernel_of(const CgOptions& o, const cg::StoredSnapshot& first) {
  const auto made = laws::CgKernels::make(o.kernel);
  if (!made)
    throw InputError(fmt::format("error: no kernel is called '{}', expected one of {}", o.kernel,
                                 fmt::join(laws::CgKernels::names(), ", ")));
  auto kernel = *made;
  const double d = first.diameter.empty() ? 1 : first.diameter[0];
  std::visit([&](auto& k) { k.width = o.width > 0 ? o.width : 0.25 * d; }, kernel);
  return kernel;
}

double width_of(const laws::CgKernels::Any& kernel) {
  return std::visit([](const auto& k) { return k.width; }, kernel);
}

// ---- depth profiles

struct Profiles {
  std::optional<cg::BlockedProfile> average;
  double diameter = 1;
  std::vector<std::vector<double>> series;  // t, z, fields
};

void add_to_series(Profiles& p, const CgOptions& o, const cg::StoredSnapshot& s) {
  cg::BlockedProfile instant(p.average->kernel(), p.average->lattice().spacing, s.box);
  instant.add(s.view());
  const cg::MeanProfile m = instant.mean();
  const double least = cg::least_density(m.value);
  p.series.resize(cg::all_fields().size() + 2);
  for (std::size_t n = 0; n < m.z.size(); ++n) {
    cg::Gradient gradient;
    for (std::size_t c = 0; c < 4; ++c) gradient.d[2][c] = m.slope[n][c];
    p.series[0].push_back(s.time);
    p.series[1].push_back(m.z[n]);
    for (std::size_t f = 0; f < cg::all_fields().size(); ++f)
      p.series[f + 2].push_back(cg::all_fields()[f].value({m.value[n], gradient, width_of(kernel_of(o, s)), least}));
  }
}

void write_series(const fs::path& file, const Profiles& p) {
  std::vector<io::Column> columns{{"t", "time", "time"}, {"z", "length", "height above the base plane"}};
  for (const cg::FieldDefinition& f : cg::all_fields()) columns.push_back({f.name, f.unit, f.meaning});
  io::write_csv(file, columns, p.series, io::CsvHeader::names_and_units);
}

void write_profiles(const Profiles& p, const CgOptions& o, std::optional<Vec3> gravity) {
  const fs::path dir = o.directory;
  write_profile(dir / "profile.csv", o.intervals ? p.average->interval_mean() : p.average->mean());
  write_widths(dir / "widths.csv", *p.average, p.diameter);
  if (o.series) write_series(dir / "profiles.csv", p);
  nlohmann::ordered_json summary;
  summary["version"] = version();
  summary["samples"] = p.average->samples();
  summary["averaged_from"] = p.average->mean().begin;
  summary["averaged_until"] = p.average->mean().end;
  if (o.gravity.size() == 3) gravity = Vec3{o.gravity[0], o.gravity[1], o.gravity[2]};
  if (gravity) {
    const cg::FlowSetting setting{*gravity, p.diameter};
    write_steadiness(dir / "steadiness.csv", *p.average, setting);
    nlohmann::ordered_json flow;
    flow["theta_deg"] = std::atan2(gravity->x, -gravity->z) * 180 / M_PI;
    add_flow_numbers(flow, cg::analyse(p.average->mean(), setting), cg::errors(*p.average, setting));
    summary["flow"] = flow;
  }
  io::write_json(dir / "summary.json", summary);
}

// ---- planes and space

struct Fields {
  std::optional<cg::Grid> grid;
  laws::CgKernels::Any kernel;
  Box box;
  std::vector<cg::Row> sums;
  std::int64_t samples = 0;
};

void add_to_fields(Fields& f, const CgOptions& o, const cg::StoredSnapshot& s) {
  if (!f.grid) {
    f.kernel = kernel_of(o, s);
    f.box = s.box;
    double lo = INFINITY, hi = -INFINITY;
    for (std::int64_t i = 0; i < s.flowing; ++i) {
      lo = std::min(lo, s.x[static_cast<std::size_t>(i)].z);
      hi = std::max(hi, s.x[static_cast<std::size_t>(i)].z);
    }
    const double margin = 4 * width_of(f.kernel), spacing = o.spacing > 0 ? o.spacing : 2 * width_of(f.kernel);
    f.grid = cg::make_grid(s.box, {true, o.grid == "xyz", true}, lo - margin, hi + margin, spacing);
  }
  cg::add_snapshot(f.sums, *f.grid, f.kernel, s.view());
  ++f.samples;
}

void write_fields(Fields& f, const CgOptions& o) {
  for (cg::Row& row : f.sums)
    for (double& v : row) v /= static_cast<double>(f.samples);
  const auto gradients = cg::gradients(f.sums, *f.grid, f.box);
  const double least = cg::least_density(f.sums);
  std::vector<io::Column> columns;
  std::vector<std::vector<double>> cells;
  for (int a = 0; a < 3; ++a) {
    if (!f.grid->resolved[static_cast<std::size_t>(a)]) continue;
    columns.push_back({std::string(1, "xyz"[a]), "length", "coordinate of the node"});
    auto& column = cells.emplace_back();
    for (std::int64_t n = 0; n < f.grid->size(); ++n) column.push_back(f.grid->node(n)[a]);
  }
  for (const cg::FieldDefinition& field : cg::all_fields()) {
    columns.push_back({field.name, field.unit, field.meaning});
    auto& column = cells.emplace_back();
    for (std::size_t n = 0; n < f.sums.size(); ++n)
      column.push_back(field.value({f.sums[n], gradients[n], width_of(f.kernel), least}));
  }
  io::write_csv(fs::path(o.directory) / "fields.csv", columns, cells, io::CsvHeader::names_and_units);
}

int coarse_grain(const CgOptions& o) {
  use_threads(o.threads);
  Profiles profiles;
  Fields fields;
  std::int64_t samples = 0;
  const std::vector<fs::path> inputs(o.inputs.begin(), o.inputs.end());
  const SourceInfo info = read_instants(inputs, o.foreign, [&](const cg::StoredSnapshot& s) {
    if (s.time < o.from || s.time > o.until || s.flowing == 0) return;
    ++samples;
    if (o.grid != "z") return add_to_fields(fields, o, s);
    if (!profiles.average) {
      const auto kernel = kernel_of(o, s);
      profiles.average.emplace(kernel, o.spacing > 0 ? o.spacing : 0.25 * width_of(kernel), s.box);
      profiles.diameter = s.diameter[0];
    }
    profiles.average->add(s.view());
    if (o.series) add_to_series(profiles, o, s);
  });
  if (samples == 0) throw InputError("error: no instants with flowing grains between --from and --until");
  std::error_code failed;
  fs::create_directories(o.directory, failed);
  if (failed) throw IoError(fmt::format("{}: cannot be created: {}", o.directory, failed.message()));
  if (o.grid == "z")
    write_profiles(profiles, o, info.gravity);
  else
    write_fields(fields, o);
  fmt::print("{}: averages over {} instants\n", o.directory, samples);
  return 0;
}

}  // namespace

void add_cg(CLI::App& cli, int& exit_code) {
  CLI::App* verb = cli.add_subcommand("cg", "Coarse-grain stored runs: own, LAMMPS dumps, MercuryDPM files");
  const auto o = std::make_shared<CgOptions>();
  verb->add_option("INPUT", o->inputs, "Run directories, run.h5, LAMMPS dumps (atoms, then contacts), MercuryDPM .data")
      ->required();
  verb->add_option("-o,--output", o->directory, "Where results go (default: cg)");
  verb->add_option("--kernel", o->kernel, "gaussian, lucy or heaviside");
  verb->add_option("--width", o->width, "Standard deviation of the kernel (default: a quarter of the first diameter)")
      ->check(CLI::PositiveNumber);
  verb->add_option("--spacing", o->spacing, "Distance of the nodes")->check(CLI::PositiveNumber);
  verb->add_option("--grid", o->grid, "z (profiles), xz or xyz")->check(CLI::IsMember({"z", "xz", "xyz"}));
  verb->add_option("--from", o->from, "First time to use");
  verb->add_option("--until", o->until, "Last time to use");
  verb->add_flag("--intervals", o->intervals, "Profiles of means over intervals instead of values at nodes");
  verb->add_flag("--series", o->series, "Also the profile of every instant (profiles.csv)");
  verb->add_option("--gravity", o->gravity, "gx gy gz, for the flow numbers of foreign files")->expected(3);
  verb->add_option("--base-types", o->foreign.base_types, "LAMMPS types or MercuryDPM species that do not flow")
      ->delimiter(',');
  verb->add_option("--density", o->foreign.density, "Of the grains, where the files hold no masses")
      ->check(CLI::PositiveNumber);
  verb->add_option("--timestep", o->foreign.timestep, "Of LAMMPS, where the dump holds no times")
      ->check(CLI::PositiveNumber);
  verb->add_option("--contact-columns", o->foreign.contact_columns,
                   "Columns of the local dump, for example id1,id2,fx,fy,fz,tx,ty,tz")
      ->delimiter(',');
  verb->add_option("--threads", o->threads, "Threads (the result does not depend on it)")->check(CLI::PositiveNumber);
  verb->callback([o, &exit_code] { exit_code = coarse_grain(*o); });
}

}  // namespace bagnold::app
