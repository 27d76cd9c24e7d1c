// bagnold explain [NAME]: what the program knows of a law, a scenario or a section of a case.
#include <fmt/format.h>

#include <memory>

#include "app/driver.hpp"
#include "app/topics.hpp"
#include "app/verbs.hpp"
#include "core/error.hpp"

namespace bagnold::app {

namespace {

int explain(const std::string& name) {
  const std::vector<Topic> topics = all_topics();
  if (name.empty()) {
    fmt::print("bagnold explain NAME, with NAME one of\n");
    std::string family;
    for (const Topic& topic : topics) {
      if (topic.family != family) fmt::print("\n{}\n", family = topic.family);
      fmt::print("  {:<24} {}\n", topic.name, topic.summary);
    }
    return 0;
  }
  bool found = false;
  std::vector<std::string> known;
  for (const Topic& topic : topics) {
    known.push_back(topic.name);
    if (topic.name != name) continue;
    fmt::print("{}{} ({})\n", found ? "\n" : "", topic.text, topic.family);
    found = true;
  }
  if (found) return 0;
  const std::string close = nearest(name, known);
  throw InputError(fmt::format("explain: error: nothing known of '{}'{}, 'bagnold explain' lists all names", name,
                               close.empty() ? "" : fmt::format(", is '{}' meant?", close)));
}

}  // namespace

void add_explain(CLI::App& cli, int& exit_code) {
  CLI::App* verb =
      cli.add_subcommand("explain", "A law, scenario or section: equation, source, parameters with unit and range");
  const auto name = std::make_shared<std::string>();
  verb->add_option("NAME", *name, "What to explain (default: list everything)");
  verb->callback([name, &exit_code] { exit_code = explain(*name); });
}

}  // namespace bagnold::app
