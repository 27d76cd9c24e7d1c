// How many threads to ask for help on a machine that others keep busy.
#pragma once
#include <limits>

namespace bagnold {

// A thread that the system has put aside in the middle of its part holds up all others. Whether a team is worth that is
// found out: loops are taken together in windows, and if waiting took a part of the time that matters, the next window
// is run by half the team, and the faster of both sizes stays. Without waiting twice the team is tried, up to what is
// wished. The longer a size stands the more seldom others are tried. Results do not depend on the size.
struct Tempo {
  static constexpr double window_ns = 20e6;  // several turns of the scheduler
  static constexpr double disturbing = 0.1;  // part of the time spent waiting for threads that were put aside
  static constexpr int most_patience = 64;   // windows

  int seats = std::numeric_limits<int>::max();  // that stay
  int trial = 0;                                // on trial in this window, 0: none
  double work = 0, time = 0, waited = 0;        // of this window, ns; work: what its loops cost one thread
  double rate = 0;                              // work per time of `seats`, in the window before the trial
  int patience = 1, windows = 0;                // between trials, since the last one
};

int seats_now(const Tempo& tempo, int wished);

// After a loop for which `wished` seats were worth while.
void record(Tempo& tempo, int wished, double work, double time, double waited);

}  // namespace bagnold
