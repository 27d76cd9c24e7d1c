// bagnold run CASE.toml, bagnold resume DIR: from a case to a run directory.
#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <memory>

#include "app/cost.hpp"
#include "app/driver.hpp"
#include "app/signals.hpp"
#include "app/use_threads.hpp"
#include "app/verbs.hpp"
#include "config/case.hpp"
#include "core/error.hpp"
#include "io/files.hpp"

namespace bagnold::app {

namespace {

namespace fs = std::filesystem;

struct RunOptions {
  std::string input, directory;
  std::vector<std::string> set;
  int threads = 0;
  bool overwrite = false, quiet = false;
};

// A directory that holds a run is never silently replaced; one that holds anything else is never touched.
void refuse_directory(const fs::path& directory, bool overwrite) {
  std::error_code failed;
  if (!fs::exists(directory, failed) || fs::is_empty(directory, failed)) return;
  if (!fs::exists(directory / "case.toml"))
    throw InputError(
        fmt::format("{}: error: exists and is not a run directory, expected a new one", directory.string()));
  if (!overwrite)
    throw InputError(
        fmt::format("{}: error: holds a run already, expected a new directory, --overwrite, or 'bagnold resume {}'",
                    directory.string(), directory.string()));
}

void prepare_directory(const fs::path& directory, bool overwrite) {
  refuse_directory(directory, overwrite);
  std::error_code failed;
  for (const char* name : {"case.toml", "summary.json", "series.csv", "profile.csv", "run.h5", "checkpoint.h5",
                           "checkpoint.prev.h5", "report.html", "vtk", "figures"})
    fs::remove_all(directory / name, failed);
  fs::create_directories(directory, failed);
  if (failed) throw IoError(fmt::format("{}: error: cannot be created: {}", directory.string(), failed.message()));
}

// The last keys of a case: after this every key has been read and what nobody asked for is refused.
RunContext read_context(config::Case& input, Model& model, const fs::path& directory, bool quiet) {
  RunContext context;
  context.directory = directory;
  context.quiet = quiet;
  const config::Section root = input.root();
  context.model_name = root.get<std::string>("model", std::nullopt);
  context.seed = root.get<std::int64_t>("seed", 1);
  context.output = read_output(root.child("output"), model.end_time());
  input.reject_unread();
  return context;
}

// And remembers how fast it went.
int drive_and_time(Model& model, const RunContext& context) {
  const auto start = std::chrono::steady_clock::now();
  const int exit_code = drive(model, context);
  remember_speed(model.cost(), context.model_name, model.element_steps(),
                 std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  return exit_code;
}

int run(const RunOptions& options) {
  use_threads(options.threads);
  config::Case input = config::Case::from_file(options.input, options.set);
  const fs::path directory =
      options.directory.empty() ? fs::path("out") / fs::path(options.input).stem() : fs::path(options.directory);
  input.will_live_in(directory.string());
  const auto model = make_model(input);
  RunContext context = read_context(input, *model, directory, options.quiet);
  refuse_directory(directory, options.overwrite);
  catch_signals();
  model->build({.quiet = options.quiet});
  context.resolved_case = input.resolved();
  prepare_directory(directory, options.overwrite);
  io::write_file(directory / "case.toml", context.resolved_case);
  if (!options.quiet) {
    std::vector<Derived> lines = model->derived();
    for (Derived& d : cost_lines(model->cost(), context.model_name, context.output, model->end_time()))
      lines.push_back(std::move(d));
    for (const Derived& d : lines) fmt::print(stderr, "  {:<34} {:<24} {}\n", d.name, d.value, d.meaning);
  }
  return drive_and_time(*model, context);
}

int resume(const RunOptions& options) {
  use_threads(options.threads);
  const fs::path directory = options.input;
  if (!fs::exists(directory / "case.toml"))
    throw InputError(fmt::format(
        "{}: error: is not a run directory (no case.toml), expected the DIR of 'bagnold run -o DIR'", options.input));
  config::Case input = config::Case::from_file((directory / "case.toml").string());
  const auto model = make_model(input);
  RunContext context = read_context(input, *model, directory, options.quiet);
  catch_signals();
  model->build({.quiet = options.quiet, .resuming = directory});
  context.resolved_case = input.resolved();
  context.resume = true;
  return drive_and_time(*model, context);
}

}  // namespace

void add_run(CLI::App& cli, int& exit_code) {
  CLI::App* verb = cli.add_subcommand("run", "Run a case");
  const auto options = std::make_shared<RunOptions>();
  verb->add_option("CASE", options->input, "Case file (.toml)")->required();
  verb->add_option("-o,--output", options->directory, "Run directory (default: out/<name of the case>)");
  verb->add_option("--set", options->set, "Override a key: key.path=value (repeatable)")->allow_extra_args(false);
  verb->add_option("--threads", options->threads,
                   "Threads (default: OMP_NUM_THREADS, SLURM_CPUS_PER_TASK, as many as allowed)")
      ->check(CLI::PositiveNumber);
  verb->add_flag("--overwrite", options->overwrite, "Replace the run that the directory holds");
  verb->add_flag("--quiet", options->quiet, "No progress");
  verb->callback([options, &exit_code] { exit_code = run(*options); });
}

void add_resume(CLI::App& cli, int& exit_code) {
  CLI::App* verb = cli.add_subcommand("resume", "Continue exactly where a run was interrupted or killed");
  const auto options = std::make_shared<RunOptions>();
  verb->add_option("DIR", options->input, "Run directory")->required();
  verb->add_option("--threads", options->threads, "Threads (the result does not depend on it)")
      ->check(CLI::PositiveNumber);
  verb->add_flag("--quiet", options->quiet, "No progress");
  verb->callback([options, &exit_code] { exit_code = resume(*options); });
}

}  // namespace bagnold::app
