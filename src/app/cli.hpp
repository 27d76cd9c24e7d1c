// The command line: `bagnold run|resume|check|explain|...`.
#pragma once

namespace bagnold::app {
int run(int argc, char** argv);  // the exit code of the contract
}
