#include "core/tempo.hpp"

#include <algorithm>

namespace bagnold {

namespace {

void end_trial(Tempo& tempo, double rate) {
  const bool better = rate > tempo.rate;
  if (better) tempo.seats = tempo.trial;
  tempo.patience = better ? 1 : std::min(2 * tempo.patience, Tempo::most_patience);
  tempo.trial = tempo.windows = 0;
}

void begin_trial(Tempo& tempo, double rate, int wished) {
  const int seats = std::min(tempo.seats, wished);
  const bool disturbed = tempo.waited > Tempo::disturbing * tempo.time;
  const int next = disturbed ? std::max(1, seats / 2) : std::min(wished, 2 * seats);
  if (next == seats) return;
  tempo.trial = next;
  tempo.rate = rate;
}

}  // namespace

int seats_now(const Tempo& tempo, int wished) { return std::min(tempo.trial > 0 ? tempo.trial : tempo.seats, wished); }

void record(Tempo& tempo, int wished, double work, double time, double waited) {
  tempo.work += work;
  tempo.time += time;
  tempo.waited += waited;
  if (tempo.time < Tempo::window_ns) return;
  const double rate = tempo.work / tempo.time;
  ++tempo.windows;
  if (tempo.trial > 0)
    end_trial(tempo, rate);
  else if (tempo.windows >= tempo.patience)
    begin_trial(tempo, rate, wished);
  tempo.work = tempo.time = tempo.waited = 0;
}

}  // namespace bagnold
