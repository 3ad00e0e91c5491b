#include "interruption.h"

#include <fmt/format.h>

#include <cstring>

#include "floe/error.h"

namespace floe::app {
namespace {

constexpr int signals[] = {SIGINT, SIGTERM, SIGHUP};
volatile std::sig_atomic_t noted = 0;
int within = 0;  // how many Interruptions live

int greatest(MPI_Comm comm) {
  int number = noted;
  MPI_Allreduce(MPI_IN_PLACE, &number, 1, MPI_INT, MPI_MAX, comm);
  return number;
}

}  // namespace

Interruption::Interruption() {
  if (within++ > 0) return;
  noted = 0;
  struct sigaction note {};
  note.sa_handler = [](int number) { noted = number; };
  note.sa_flags = static_cast<int>(SA_RESETHAND);
  for (int i = 0; i < 3; ++i) sigaction(signals[i], &note, &before_[i]);
}

Interruption::~Interruption() {
  if (--within > 0) return;
  for (int i = 0; i < 3; ++i) sigaction(signals[i], &before_[i], nullptr);
}

void Interruption::check(MPI_Comm comm) const {
  const int number = greatest(comm);
  if (number != 0) throw RunError(fmt::format("interrupted by signal {} ({})", number, strsignal(number)));
}

bool Interruption::happened(MPI_Comm comm) { return greatest(comm) != 0; }

}  // namespace floe::app
