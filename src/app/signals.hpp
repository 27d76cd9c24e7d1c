// SIGINT, SIGTERM and SIGUSR1 ask a run to write a checkpoint and leave with exit code 75.
#pragma once
#include <stdexcept>

namespace bagnold::app {
void catch_signals();
bool stop_requested();

// Thrown by what heeds a signal before there is a run to be resumed (exit 75).
struct Interrupted : std::runtime_error {
  using std::runtime_error::runtime_error;
};
}  // namespace bagnold::app
