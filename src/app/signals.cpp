#include "app/signals.hpp"

#include <csignal>
#include <initializer_list>

namespace bagnold::app {

namespace {
volatile std::sig_atomic_t stop = 0;
void request_stop(int) { stop = 1; }
}  // namespace

void catch_signals() {
  struct sigaction action = {};
  action.sa_handler = request_stop;
  action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);  // a second signal ends the program at once
  for (const int signal : {SIGINT, SIGTERM, SIGUSR1}) sigaction(signal, &action, nullptr);
}

bool stop_requested() { return stop != 0; }

}  // namespace bagnold::app
