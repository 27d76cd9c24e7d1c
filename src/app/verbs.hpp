// Every verb of the program: one file verb_<name>.cpp each, one line here and one in cli.cpp.
#pragma once
#include <CLI/App.hpp>

namespace bagnold::app {

// Adds the verb's options to the command line; when the verb is chosen its callback sets `exit_code`.
void add_run(CLI::App& cli, int& exit_code);
void add_resume(CLI::App& cli, int& exit_code);
void add_check(CLI::App& cli, int& exit_code);
void add_explain(CLI::App& cli, int& exit_code);
void add_cg(CLI::App& cli, int& exit_code);
void add_report(CLI::App& cli, int& exit_code);

}  // namespace bagnold::app
