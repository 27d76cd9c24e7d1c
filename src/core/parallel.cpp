#include "core/parallel.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <signal.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <exception>
#include <limits>
#include <memory>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include "core/cpu_limit.hpp"
#include "core/tempo.hpp"

namespace bagnold {

namespace {

constexpr double spin_ns = 50e3;          // a thread that waits looks so long before it sleeps
constexpr double chunk_ns = 10e3;         // of work are claimed at a time
constexpr double share_ns = 2e3;          // least work of a thread that is worth asking it
constexpr std::size_t destructive = 128;  // bytes that two processors cannot write at once, with the line fetched ahead

thread_local int my_index = 0;
thread_local bool inside = false;

double now() {
  return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void relax() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

// Looks every now and then until done() or the time is up.
template <class Done>
bool spin(Done&& done) {
  const double end = now() + spin_ns;
  do
    for (int k = 0; k < 32; ++k, relax())
      if (done()) return true;
  while (now() < end);
  return done();
}

enum SeatState : std::uint32_t {
  idle,     // its thread looks whether there is work
  asleep,   // its thread has to be woken
  posted,   // there is work for it
  running,  // it works
  awaited,  // it works, and the caller sleeps until it is done
};

// A place in the team; seat 0 is the caller's.
struct alignas(destructive) Seat {
  std::atomic<std::uint32_t> state{idle};
  bool started = false;
  std::int64_t done = 0;                                     // items of this loop
  alignas(destructive) std::atomic<std::uint64_t> share{0};  // chunks: begin in the upper half, end in the lower
};

struct Job {
  RangeBody body = nullptr;
  void* context = nullptr;
  std::int64_t n = 0, chunk = 1;
  int seats = 1;
  std::mutex guard;
  std::exception_ptr error;
  std::int64_t error_at = 0;
};

// What is known of loops of one kind, told by their body.
struct Site {
  RangeBody body = nullptr;
  double item_ns = 0;     // on one thread
  bool measured = false;  // it was
  double weight = 0;      // of an item in the work of a window
};

struct Team {
  std::atomic<bool> in_use{false};
  std::vector<std::unique_ptr<Seat>> seats;
  Job job;
  std::array<Site, 512> sites;
  Tempo tempo;
};

std::atomic<Team*> present{nullptr};
std::atomic<int> size{0};  // 0: not set yet
std::atomic<bool> forced{false};

Team& team() {
  Team* t = present.load(std::memory_order_acquire);
  if (t != nullptr) return *t;
  auto fresh = std::make_unique<Team>();
  if (!present.compare_exchange_strong(t, fresh.get(), std::memory_order_acq_rel)) return *t;
  static const int registered = pthread_atfork(nullptr, nullptr, [] { present.store(nullptr); });
  static_cast<void>(registered);  // a forked process has no threads but the one that forked: it makes its own team
  return *fresh.release();        // threads look at it until the process ends
}

constexpr std::uint64_t pack(std::uint64_t begin, std::uint64_t end) { return begin << 32 | end; }

// The next chunk of a share, from the front for its owner, from the back for others; -1: none left.
std::int64_t claim(std::atomic<std::uint64_t>& share, bool front) {
  std::uint64_t s = share.load(std::memory_order_relaxed);
  while (true) {
    const std::uint64_t begin = s >> 32, end = s & 0xffffffff;
    if (begin >= end) return -1;
    const std::uint64_t rest = front ? pack(begin + 1, end) : pack(begin, end - 1);
    if (share.compare_exchange_weak(s, rest, std::memory_order_relaxed))
      return static_cast<std::int64_t>(front ? begin : end - 1);
  }
}

void run_chunk(Job& job, std::int64_t chunk, Seat& seat) {
  const std::int64_t begin = chunk * job.chunk, end = std::min(begin + job.chunk, job.n);
  try {
    job.body(job.context, begin, end);
  } catch (...) {
    const std::lock_guard lock(job.guard);
    if (!job.error || begin < job.error_at) job.error = std::current_exception(), job.error_at = begin;
  }
  seat.done += end - begin;
}

// The own share, then what is left of the others'.
void take_part(Team& t, int me) {
  Job& job = t.job;
  Seat& own = *t.seats[static_cast<std::size_t>(me)];
  own.done = 0;
  for (int k = 0; k < job.seats; ++k) {
    const auto victim = static_cast<std::size_t>((me + k) % job.seats);
    for (std::int64_t c; (c = claim(t.seats[victim]->share, k == 0)) >= 0;) run_chunk(job, c, own);
  }
}

void serve(Team& t, Seat& seat, int me) {
  my_index = me;
  inside = true;
  while (true) {
    if (!spin([&] { return seat.state.load(std::memory_order_relaxed) == posted; })) {
      std::uint32_t expected = idle;
      if (seat.state.compare_exchange_strong(expected, asleep, std::memory_order_relaxed))
        seat.state.wait(asleep, std::memory_order_relaxed);
    }
    std::uint32_t expected = posted;  // unless the caller could not wait
    if (!seat.state.compare_exchange_strong(expected, running, std::memory_order_acquire)) continue;
    take_part(t, me);
    if (seat.state.exchange(idle, std::memory_order_release) == awaited) seat.state.notify_one();
  }
}

// A thread for this seat, that leaves signals to others. False: the system gives no more threads.
bool start(Team& t, int k) {
  Seat& seat = *t.seats[static_cast<std::size_t>(k)];
  if (seat.started) return true;
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  try {
    std::thread(serve, std::ref(t), std::ref(seat), k).detach();
    seat.started = true;
  } catch (const std::system_error&) {
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return seat.started;
}

void post(Seat& seat) {
  if (seat.state.exchange(posted, std::memory_order_release) == asleep) seat.state.notify_one();
}

// Takes the work back from a thread that has not come, or waits until it is done.
void finish(Seat& seat) {
  std::uint32_t expected = posted;
  if (seat.state.compare_exchange_strong(expected, idle, std::memory_order_acquire)) return;
  if (spin([&] { return seat.state.load(std::memory_order_acquire) == idle; })) return;
  expected = running;
  if (seat.state.compare_exchange_strong(expected, awaited, std::memory_order_acquire))
    seat.state.wait(awaited, std::memory_order_acquire);
}

// As many seats as wished with threads on them, as far as the system gives them.
int fill_seats(Team& t, int wished) {
  while (static_cast<int>(t.seats.size()) < wished) t.seats.push_back(std::make_unique<Seat>());
  int seats = 1;
  while (seats < wished && start(t, seats)) ++seats;
  return seats;
}

// A table with a place for every body; should it be full, one forgets another.
Site& site_of(Team& t, RangeBody body) {
  const std::size_t home = (reinterpret_cast<std::uintptr_t>(body) >> 4) % t.sites.size();
  std::size_t place = home;
  while (t.sites[place].body != body && t.sites[place].body != nullptr) {
    place = (place + 1) % t.sites.size();
    if (place == home) t.sites[home] = {};
  }
  t.sites[place].body = body;
  return t.sites[place];
}

// On this thread alone. Times that the system has interrupted count for little.
void run_alone(const Job& job, Site& site) {
  const double begin = now();
  job.body(job.context, 0, job.n);
  const double item_ns = (now() - begin) / static_cast<double>(job.n);
  site.item_ns = site.measured ? 0.7 * site.item_ns + 0.3 * std::min(item_ns, 3 * site.item_ns) : item_ns;
  site.measured = true;
}

// Cuts the loop into chunks and gives every seat an equal part of them.
void hand_out(Team& t, int seats, double item_ns) {
  Job& job = t.job;
  job.seats = seats;
  const std::int64_t quarter = (job.n + 4 * seats - 1) / (4 * seats);  // of a share
  job.chunk = item_ns > 0 ? static_cast<std::int64_t>(std::min(chunk_ns / item_ns, 1e18)) : quarter;
  job.chunk = std::max({std::int64_t{1}, std::min(job.chunk, quarter), job.n >> 31});
  if (job.chunk > 16) job.chunk = job.chunk / 16 * 16;  // whole registers and cache lines
  const auto chunks = static_cast<std::uint64_t>((job.n + job.chunk - 1) / job.chunk);
  const auto parts = static_cast<std::uint64_t>(seats);
  for (std::uint64_t k = 0; k < parts; ++k)
    t.seats[k]->share.store(pack(chunks * k / parts, chunks * (k + 1) / parts), std::memory_order_relaxed);
}

void run_shared(Team& t, int seats, Site& site) {
  hand_out(t, seats, site.item_ns);
  const double begin = now();
  for (int k = 1; k < seats; ++k) post(*t.seats[static_cast<std::size_t>(k)]);
  take_part(t, 0);
  const auto mine = static_cast<double>(t.seats[0]->done);
  if (!site.measured && mine > 0) site.item_ns = (now() - begin) / mine;  // for want of better
  for (int k = 1; k < seats; ++k) finish(*t.seats[static_cast<std::size_t>(k)]);
}

// For one caller at a time; false if there is another.
struct Occupied {
  Team& t;
  const bool here;
  explicit Occupied(Team& of) : t(of), here(!of.in_use.exchange(true, std::memory_order_acquire)) {
    if (here) inside = true;
  }
  Occupied(const Occupied&) = delete;
  ~Occupied() {
    if (!here) return;
    inside = false;
    t.in_use.store(false, std::memory_order_release);
  }
};

void run_with(Team& t, int wished) {
  Job& job = t.job;
  job.error = nullptr;
  Site& site = site_of(t, job.body);
  if (forced) {
    run_shared(t, fill_seats(t, wished), site);
  } else {
    const double work = site.item_ns * static_cast<double>(job.n);
    if (work > 0) wished = std::max(1, static_cast<int>(std::min<double>(wished, work / share_ns)));
    const int seats = fill_seats(t, seats_now(t.tempo, wished));
    const double begin = now();
    if (seats > 1)
      run_shared(t, seats, site);
    else
      run_alone(job, site);
    if (may_measure(t.tempo) || site.weight == 0) site.weight = site.item_ns;
    record(t.tempo, {wished, site.weight * static_cast<double>(job.n), site.measured, begin, now()});
  }
  if (job.error) std::rethrow_exception(std::exchange(job.error, nullptr));
}

}  // namespace

Alone::Alone(bool meant) : before_(inside) { inside = inside || meant; }
Alone::~Alone() { inside = before_; }

void run_items(std::int64_t n, RangeBody body, void* context) {
  if (n <= 0) return;
  const int wished = static_cast<int>(std::min<std::int64_t>(threads(), n));
  if (wished == 1 || inside) return body(context, 0, n);
  Team& t = team();
  const Occupied occupied(t);
  if (!occupied.here) return body(context, 0, n);
  t.job.body = body;
  t.job.context = context;
  t.job.n = n;
  run_with(t, wished);
}

std::string set_threads(int count) {
  const auto number_in = [](const char* variable) {
    const char* text = std::getenv(variable);
    return text == nullptr ? 0 : std::max(0, std::atoi(text));
  };
  std::string who = "--threads";
  for (const char* variable : {"OMP_NUM_THREADS", "SLURM_CPUS_PER_TASK"})
    if (count <= 0 && (count = number_in(variable)) > 0) who = variable;
  const int limit = cpu_limit();
  forced = false;
  size = count > 0 ? std::min(count, limit) : limit;
  if (count <= limit) return "";
  return fmt::format("{} asks for {} threads; the processors and the quota of this process allow {}", who, count,
                     limit);
}

void force_threads(int count) {
  size = std::max(1, count);
  forced = true;
}

int threads() {
  if (size == 0) set_threads(0);
  return size;
}

int thread_index() { return my_index; }

}  // namespace bagnold
