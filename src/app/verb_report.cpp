// bagnold report DIR...: figures and tables of runs in one file.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/verbs.hpp"
#include "report/report.hpp"

namespace bagnold::app {

namespace {
struct ReportOptions {
  std::vector<std::string> directories, formats;
  std::string output;
};
}  // namespace

void add_report(CLI::App& cli, int& exit_code) {
  CLI::App* verb = cli.add_subcommand("report", "Draw the figures of runs and write report.html");
  const auto o = std::make_shared<ReportOptions>();
  verb->add_option("DIR", o->directories, "Run directories")->required();
  verb->add_option("-o,--output", o->output, "The report (default: report.html in the first directory)");
  verb->add_option("--format", o->formats, "Figures also as png or pdf")
      ->delimiter(',')
      ->check(CLI::IsMember({"png", "pdf"}));
  verb->callback([o, &exit_code] {
    const std::vector<std::filesystem::path> directories(o->directories.begin(), o->directories.end());
    const std::filesystem::path output =
        o->output.empty() ? directories[0] / "report.html" : std::filesystem::path(o->output);
    report::write_report(directories, output, o->formats);
    fmt::print("{}\n", output.string());
    exit_code = 0;
  });
}

}  // namespace bagnold::app
