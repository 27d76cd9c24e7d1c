// The end of a run whose step varies: met exactly, without a sliver of a step.
#pragma once

namespace bagnold {

struct StepLength {
  double dt = 0;
  bool shortened = false;  // by the end alone
  bool last = false;       // the time after it is the end, whatever the sum of the steps rounds to
};

// `dt`, or less where the end comes within two steps of it: the two share what is left. It does not matter how a run is
// cut into calls, nor what is written in between. Beyond the end nothing is shortened.
inline StepLength step_towards(double end, double time, double dt) {
  const double left = end - time;
  if (!(left > 0)) return {dt, false, false};
  if (dt >= left) return {left, dt > left, true};
  if (2 * dt > left) return {0.5 * left, true, false};
  return {dt, false, false};
}

}  // namespace bagnold
