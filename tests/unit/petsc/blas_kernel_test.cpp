#include "floe/petsc/blas_kernel.h"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <string>

// The tests' main selects them as floe's does.
TEST_CASE("OpenBLAS has kernels for this processor, also for one that is newer") {
  CHECK(floe::petsc::better_blas_kernel().empty());
#if defined(__x86_64__)
  const char* named = std::getenv("OPENBLAS_CORETYPE");
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && (!named || std::string(named) != "Prescott"))
    CHECK(floe::petsc::blas_kernel() != "Prescott");
#endif
}
