#pragma once
#include <mpi.h>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <cstdio>
#include <mutex>
#include <string>
#include <thread>

namespace floe::output {

/// `t = 1.23 / 3 s  41 %  12 us/step  eta 3 s`
///
/// @param elapsed  wall time since `start` [s]
std::string progress_line(double start, double t, double end, const std::string& unit, std::int64_t steps,
                          double elapsed);

/// One line on a terminal that tells how far a run has come, from its first second on, at most five times a second.
///
/// Silent where `stream` is no terminal, and on all ranks but the first. Rank-local.
class Progress {
 public:
  Progress(MPI_Comm comm, double start, double end, std::string time_unit = "s", std::FILE* stream = stderr);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// Wipes the line.
  ~Progress();
  /// To be called after every step; costs a look at the clock.
  void update(double t, std::int64_t steps);

 private:
  using Clock = std::chrono::steady_clock;
  double start_, end_;
  std::string unit_;
  std::FILE* stream_;
  bool shown_ = false;
  Clock::time_point began_, next_;
};

/// `reducing body beam ... 12 s` on a terminal, for work whose end is not known, from its first second on, every
/// second.
///
/// Silent where `stream` is no terminal, and on all ranks but the first. A thread of its own writes the line.
/// Rank-local.
class Waiting {
 public:
  Waiting(MPI_Comm comm, const std::string& what, std::FILE* stream = stderr);
  Waiting(const Waiting&) = delete;
  Waiting& operator=(const Waiting&) = delete;
  /// Wipes the line.
  ~Waiting();

 private:
  void show(const std::string& what);
  std::FILE* stream_;
  bool done_ = false;
  std::mutex mutex_;
  std::condition_variable end_;
  std::thread writer_;
};

}  // namespace floe::output
