// How a run tells where it is: a bar with ETA on a terminal, plain lines otherwise, nothing with --quiet.
#pragma once
#include <chrono>
#include <string>

namespace bagnold::app {

class Progress {
 public:
  // `task`: what it is that goes on, when that is not a run; then `end` is when it ends at the latest.
  Progress(double begin, double end, bool quiet, std::string task = "");
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  bool due() const;                                    // worth asking the model for its numbers?
  void show(double time, const std::string& physics);  // physics: a few words of the model

 private:
  using Clock = std::chrono::steady_clock;
  double begin_, end_;
  bool quiet_, terminal_, color_;
  std::string task_;
  Clock::time_point start_ = Clock::now(), last_ = Clock::now();
  bool drawn_ = false;
};

std::string duration_text(double seconds);  // "1 h 02 min", "3 min 20 s", "12 s"

}  // namespace bagnold::app
