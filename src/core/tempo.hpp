// How many threads to ask for help: as many as it makes loops faster by.
#pragma once
#include <limits>

namespace bagnold {

// More threads may not help: a thread that the system has put aside in the middle of its part holds up all others,
// small parts wait for each other's memory, two processors may be one. So it is tried. Loops, with what lies between
// them, are taken together in windows. Now and then one window is left to half the team or to twice the team, and the
// next one to the team again. The larger size has to be faster by `gain`, or the smaller one stays. The longer a size
// stands the more seldom others are tried; loops of kinds not met before are reason to try again. Results do not depend
// on the size.
struct Tempo {
  static constexpr double window_ns = 30e6;  // several turns of the scheduler
  static constexpr double pause_ns = 1e6;    // what is longer between loops is something else: files, another phase
  static constexpr double gain = 1.2;        // from twice the threads; less is better left to others
  static constexpr int most_patience = 64;   // windows

  int seats = std::numeric_limits<int>::max();  // the team
  int other = 0;                                // size on trial, 0: none
  enum class Turn { team, other, team_again } turn = Turn::team;
  double work = 0, time = 0;      // of this window, ns; work: what its loops cost, in whatever measure
  double unknown = 0;             // part of the work, in loops of which it is not known what they cost one thread
  int most = 1;                   // seats that one of its loops was worth
  double other_rate = 0;          // work per time, of the trial
  double last = 0;                // end of the loop before
  int patience = 4, windows = 0;  // between trials, since the last one
  bool smaller_next = true;       // whether half the team is tried next
};

int seats_now(const Tempo& tempo, int wished);

// Whether the measure of work may change: not between windows that are compared.
inline bool may_measure(const Tempo& tempo) { return tempo.turn == Tempo::Turn::team; }

struct LoopRun {
  int wished = 1;             // seats it was worth
  double work = 0;            // not 0
  bool known = false;         // what it costs one thread
  double begin = 0, end = 0;  // ns
};
void record(Tempo& tempo, const LoopRun& loop);

}  // namespace bagnold
