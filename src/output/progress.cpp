#include "floe/output/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

namespace floe::output {
namespace {

constexpr std::chrono::milliseconds before_first{1000}, between_lines{200};

std::string duration(double seconds) {
  const auto whole = static_cast<std::int64_t>(std::lround(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

std::string per_step(double seconds) {
  if (seconds < 1e-3) return fmt::format("{:.3g} us/step", 1e6 * seconds);
  return seconds < 1 ? fmt::format("{:.3g} ms/step", 1e3 * seconds) : fmt::format("{:.3g} s/step", seconds);
}

bool shown_to_user(MPI_Comm comm, std::FILE* stream) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  return rank == 0 && isatty(fileno(stream));
}

void write(std::FILE* stream, const std::string& line) {
  std::fputs(("\r" + line + "\033[K").c_str(), stream);
  std::fflush(stream);
}

}  // namespace

std::string progress_line(double start, double t, double end, const std::string& unit, std::int64_t steps,
                          double elapsed) {
  const double done = end > start ? std::clamp((t - start) / (end - start), 0.0, 1.0) : 1.0;
  std::string line = fmt::format("t = {:.4g} / {:.4g} {}  {} %", t, end, unit, static_cast<int>(100 * done));
  if (steps > 0) line += "  " + per_step(elapsed / static_cast<double>(steps));
  if (done > 0) line += "  eta " + duration(elapsed * (1 - done) / done);
  return line;
}

Progress::Progress(MPI_Comm comm, double start, double end, std::string time_unit, std::FILE* stream)
    : start_(start), end_(end), unit_(std::move(time_unit)), stream_(nullptr), began_(Clock::now()) {
  if (shown_to_user(comm, stream)) stream_ = stream;
  next_ = began_ + before_first;
}

Progress::~Progress() {
  if (!shown_) return;
  write(stream_, "");
}

void Progress::update(double t, std::int64_t steps) {
  if (!stream_) return;
  const auto now = Clock::now();
  if (now < next_) return;
  next_ = now + between_lines;
  shown_ = true;
  const double elapsed = std::chrono::duration<double>(now - began_).count();
  write(stream_, progress_line(start_, t, end_, unit_, steps, elapsed));
}

Waiting::Waiting(MPI_Comm comm, const std::string& what, std::FILE* stream) : stream_(stream) {
  if (shown_to_user(comm, stream)) writer_ = std::thread([this, what] { show(what); });
}

Waiting::~Waiting() {
  if (!writer_.joinable()) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    done_ = true;
  }
  end_.notify_one();
  writer_.join();
}

void Waiting::show(const std::string& what) {
  int seconds = 0;
  std::unique_lock<std::mutex> lock(mutex_);
  while (!end_.wait_for(lock, before_first, [&] { return done_; })) {
    ++seconds;
    write(stream_, what + " ... " + duration(seconds));
  }
  if (seconds > 0) write(stream_, "");
}

}  // namespace floe::output
