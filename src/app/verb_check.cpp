// bagnold check CASE.toml: read every key, build the start, print what follows from the input; take no step.
#include <fmt/format.h>

#include <memory>

#include "app/cost.hpp"
#include "app/driver.hpp"
#include "app/model.hpp"
#include "app/use_threads.hpp"
#include "app/verbs.hpp"
#include "config/case.hpp"

namespace bagnold::app {

namespace {

int check(const std::string& path, const std::vector<std::string>& set, bool resolved) {
  use_threads(0);
  config::Case input = config::Case::from_file(path, set);
  const auto model = make_model(input);
  const config::Section root = input.root();
  const auto name = root.get<std::string>("model", std::nullopt);
  const OutputSettings output = read_output(root.child("output"), model->end_time());
  (void)root.get<std::int64_t>("seed", 1);
  input.reject_unread();
  model->build({.estimate = true, .quiet = true});
  if (resolved) {
    fmt::print("{}", input.resolved());
    return 0;
  }
  fmt::print("{}: {}\n", path, model->scenario());
  std::vector<Derived> lines = model->derived();
  for (Derived& d : cost_lines(model->cost(), name, output, model->end_time())) lines.push_back(std::move(d));
  for (const Derived& d : lines) fmt::print("  {:<34} {:<24} {}\n", d.name, d.value, d.meaning);
  return 0;
}

}  // namespace

void add_check(CLI::App& cli, int& exit_code) {
  CLI::App* verb = cli.add_subcommand("check", "Build a case, print what follows from it, take no step");
  struct Options {
    std::string input;
    std::vector<std::string> set;
    bool resolved = false;
  };
  const auto options = std::make_shared<Options>();
  verb->add_option("CASE", options->input, "Case file (.toml)")->required();
  verb->add_option("--set", options->set, "Override a key: key.path=value (repeatable)")->allow_extra_args(false);
  verb->add_flag("--resolved", options->resolved, "Print the resolved case, every default written out");
  verb->callback([options, &exit_code] { exit_code = check(options->input, options->set, options->resolved); });
}

}  // namespace bagnold::app
