#include "app/cli.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "app/signals.hpp"
#include "app/verbs.hpp"
#include "core/error.hpp"
#include "core/variant.hpp"
#include "core/version.hpp"

namespace bagnold::app {

int run(int argc, char** argv) {
  CLI::App cli{"bagnold: granular flow from grains to avalanches"};
  cli.set_version_flag("--version", [] {
    std::string executable_here;
    for (const Variant v : built_variants())
      if (executable(v)) executable_here += fmt::format("{}{}", executable_here.empty() ? "" : ", ", name(v));
    return fmt::format("bagnold {} ({}; {}; SIMD: {}, of {})", version(), git_hash(), compiler(), name(variant()),
                       executable_here);
  });
  cli.require_subcommand(1);
  int exit_code = 0;
  add_run(cli, exit_code);
  add_resume(cli, exit_code);
  add_check(cli, exit_code);
  add_explain(cli, exit_code);
  add_cg(cli, exit_code);
  add_report(cli, exit_code);
  try {
    use_variant_of_environment();
    cli.parse(argc, argv);
  } catch (const CLI::Success& wanted) {  // --help, --version
    return cli.exit(wanted);
  } catch (const CLI::ParseError& error) {
    cli.exit(error);
    return 2;
  } catch (const Interrupted& interrupted) {
    fmt::print(stderr, "{}\n", interrupted.what());
    return 75;
  } catch (const InputError& error) {  // its text says where, and "error:"
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  } catch (const NumericalError& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 3;
  } catch (const IoError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 4;
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {} (this is a bug, please report it)\n", error.what());
    return 1;
  }
  return exit_code;
}

}  // namespace bagnold::app
