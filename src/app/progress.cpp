#include "app/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace bagnold::app {

Progress::Progress(double begin, double end, bool quiet, std::string task)
    : begin_(begin),
      end_(end),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) != 0),
      color_(terminal_ && std::getenv("NO_COLOR") == nullptr),
      task_(std::move(task)) {}

Progress::~Progress() {
  if (drawn_ && terminal_) fmt::print(stderr, "\n");
}

bool Progress::due() const {
  const double since = std::chrono::duration<double>(Clock::now() - last_).count();
  return !quiet_ && since > (terminal_ ? 0.25 : 15.0);
}

void Progress::show(double time, const std::string& physics) {
  if (quiet_) return;
  last_ = Clock::now();
  drawn_ = true;
  const double elapsed = std::chrono::duration<double>(last_ - start_).count();
  const double done = end_ > begin_ ? std::clamp((time - begin_) / (end_ - begin_), 0.0, 1.0) : 1.0;
  const std::string latest = task_.empty() ? "" : "at most ", before = task_.empty() ? "" : task_ + ": ";
  const std::string eta = latest + (done > 0 ? duration_text(elapsed * (1 - done) / done) : "?");
  if (!terminal_) {
    fmt::print(stderr, "{}t = {:.6g} of {}{:g} ({:.0f} %), {}, ETA {}\n", before, time, latest, end_, 100 * done,
               physics, eta);
    return;
  }
  constexpr int width = 24;
  const int full = static_cast<int>(done * width);
  fmt::print(stderr, "\r{}{}[{}{}]{} {:3.0f} %  t = {:.5g}  {}  ETA {}\033[K", before, color_ ? "\033[36m" : "",
             std::string(static_cast<std::size_t>(full), '='), std::string(static_cast<std::size_t>(width - full), ' '),
             color_ ? "\033[0m" : "", 100 * done, time, physics, eta);
  std::fflush(stderr);
}

std::string duration_text(double seconds) {
  const auto s = static_cast<long>(seconds + 0.5);
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {:02} s", s / 60, s % 60);
  return fmt::format("{} h {:02} min", s / 3600, s % 3600 / 60);
}

}  // namespace bagnold::app
