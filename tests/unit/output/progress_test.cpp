#include "floe/output/progress.h"

#include <fcntl.h>
#include <petscsys.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <cstdlib>
#include <thread>

#include "scratch.h"

using namespace floe::output;

TEST_CASE("the progress line tells time, share, cost and what is left") {
  CHECK(progress_line(0, 1.23, 3, "s", 100000, 1.2) == "t = 1.23 / 3 s  41 %  12 us/step  eta 2 s");
  CHECK(progress_line(1, 2, 5, "ms", 10, 50) == "t = 2 / 5 ms  25 %  5 s/step  eta 2 min 30 s");
  CHECK(progress_line(0, 1, 1000, "s", 1000, 10) == "t = 1 / 1000 s  0 %  10 ms/step  eta 2 h 46 min");
  CHECK(progress_line(0, 0, 3, "s", 0, 2) == "t = 0 / 3 s  0 %");
}

TEST_CASE("progress goes to a terminal, from the first second on, at most five times a second") {
  const int ours = posix_openpt(O_RDWR | O_NOCTTY);
  REQUIRE((ours >= 0 && grantpt(ours) == 0 && unlockpt(ours) == 0));
  std::FILE* terminal = std::fopen(ptsname(ours), "w");
  REQUIRE(terminal);
  const auto began = std::chrono::steady_clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count(); };
  {
    Progress progress(PETSC_COMM_SELF, 0, 3, "s", terminal);
    for (int step = 0; elapsed() < 1.5; ++step) {
      progress.update(elapsed(), step);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }
  std::fputs("end", terminal);
  std::fflush(terminal);
  std::string text;
  for (char next = 0; text.find("end") == std::string::npos && read(ours, &next, 1) == 1;) text += next;
  CHECK(text.find("t = 1") != std::string::npos);
  CHECK(text.find("t = 0") == std::string::npos);
  std::size_t shown = 0;
  for (std::size_t at = 0; (at = text.find("t = ", at)) != std::string::npos; ++at) ++shown;
  CHECK((shown >= 1 && shown <= 3));
  CHECK(text.substr(text.size() - 7) == "\r\033[Kend");
  std::fclose(terminal);
  close(ours);
}

TEST_CASE("waiting is told on a terminal, after each second, and wiped") {
  const int ours = posix_openpt(O_RDWR | O_NOCTTY);
  REQUIRE((ours >= 0 && grantpt(ours) == 0 && unlockpt(ours) == 0));
  std::FILE* terminal = std::fopen(ptsname(ours), "w");
  REQUIRE(terminal);
  { Waiting brief(PETSC_COMM_SELF, "too short to be told", terminal); }
  {
    Waiting waiting(PETSC_COMM_SELF, "reducing body beam", terminal);
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  }
  std::fputs("end", terminal);
  std::fflush(terminal);
  std::string text;
  for (char next = 0; text.find("end") == std::string::npos && read(ours, &next, 1) == 1;) text += next;
  CHECK(text == "\rreducing body beam ... 1 s\033[K\r\033[Kend");
  std::fclose(terminal);
  close(ours);
}

TEST_CASE("progress says nothing in a pipe") {
  Scratch scratch;
  const auto path = scratch / ("pipe" + std::to_string(scratch.rank()));
  std::FILE* file = std::fopen(path.c_str(), "w");
  {
    Progress progress(PETSC_COMM_SELF, 0, 3, "s", file);
    Waiting waiting(PETSC_COMM_SELF, "reducing", file);
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));
    progress.update(1, 10);
  }
  std::fclose(file);
  CHECK(text_of(path).empty());
}
