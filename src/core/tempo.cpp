#include "core/tempo.hpp"

#include <algorithm>
#include <utility>

namespace bagnold {

namespace {

// Half the team and twice the team in turn, as far as there are such.
void begin_trial(Tempo& tempo, int wished) {
  const int seats = std::min(tempo.seats, wished);
  if (seats == 1 || seats == wished) tempo.smaller_next = seats > 1;
  tempo.other = tempo.smaller_next ? seats / 2 : std::min(wished, 2 * seats);
  tempo.smaller_next = !tempo.smaller_next;
  tempo.turn = Tempo::Turn::other;
}

void end_trial(Tempo& tempo, double rate) {
  const bool change =
      tempo.other < tempo.seats ? Tempo::gain * tempo.other_rate > rate : tempo.other_rate > Tempo::gain * rate;
  if (change) tempo.seats = tempo.other;
  tempo.patience = change ? 1 : std::min(2 * tempo.patience, Tempo::most_patience);
  tempo.windows = tempo.other = 0;
  tempo.turn = Tempo::Turn::team;
}

}  // namespace

int seats_now(const Tempo& tempo, int wished) {
  return std::min(tempo.turn == Tempo::Turn::other ? tempo.other : tempo.seats, wished);
}

void record(Tempo& tempo, const LoopRun& loop) {
  tempo.work += loop.work;
  tempo.unknown += loop.known ? 0 : loop.work;
  tempo.time += loop.end - loop.begin + std::min(loop.begin - tempo.last, Tempo::pause_ns);
  tempo.last = loop.end;
  tempo.most = std::max(tempo.most, loop.wished);
  if (tempo.time < Tempo::window_ns) return;
  const double rate = tempo.work / tempo.time;
  const bool new_kind = tempo.unknown > 0.5 * tempo.work;
  const int wished = std::exchange(tempo.most, 1);
  tempo.work = tempo.time = tempo.unknown = 0;
  switch (tempo.turn) {
    case Tempo::Turn::team:
      if ((++tempo.windows >= tempo.patience || new_kind) && wished > 1) begin_trial(tempo, wished);
      return;
    case Tempo::Turn::other:
      tempo.other_rate = rate;
      tempo.turn = Tempo::Turn::team_again;
      return;
    case Tempo::Turn::team_again:
      end_trial(tempo, rate);
  }
}

}  // namespace bagnold
