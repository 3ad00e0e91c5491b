#pragma once
// What the programs of the benchmarks have in common.
#include <slepcsys.h>
#include <sys/resource.h>

#include <exception>

#include "floe/petsc/blas_kernel.h"
#include "floe/petsc/error.h"
#include "floe/petsc/factorisation.h"

namespace floe::benchmark {

inline rusage usage() {
  rusage now{};
  getrusage(RUSAGE_SELF, &now);
  return now;
}

/// Of this rank.
inline double processor_seconds() {
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  const rusage now = usage();
  return seconds(now.ru_utime) + seconds(now.ru_stime);
}

/// The maximum so far, of this rank [bytes].
inline double memory() { return 1024.0 * double(usage().ru_maxrss); }

inline PetscInt option(const char* name, PetscInt value) {
  petsc::check(PetscOptionsGetInt(nullptr, nullptr, name, &value, nullptr));
  return value;
}

inline double option(const char* name, double value) {
  petsc::check(PetscOptionsGetReal(nullptr, nullptr, name, &value, nullptr));
  return value;
}

/// Runs the program between SlepcInitialize and SlepcFinalize. @return  its exit code
inline int execute(int argc, char** argv, void (*run)()) {
  petsc::use_better_blas_kernel(argv);  // as floe does
  petsc::check(SlepcInitialize(&argc, &argv, nullptr, nullptr));
  petsc::collect_errors();
  petsc::prepare_mumps();
  int code = 0;
  try {
    run();
  } catch (const std::exception& error) {
    PetscPrintf(PETSC_COMM_WORLD, "%s\n", error.what());
    code = 1;
  }
  SlepcFinalize();
  return code;
}

}  // namespace floe::benchmark
