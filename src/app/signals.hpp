// SIGINT, SIGTERM and SIGUSR1 ask a run to write a checkpoint and leave with exit code 75.
#pragma once

namespace bagnold::app {
void catch_signals();
bool stop_requested();
}  // namespace bagnold::app
