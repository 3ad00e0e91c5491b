#define CATCH_CONFIG_RUNNER
#include <slepcsys.h>

#include <catch2/catch.hpp>

#include "floe/petsc/blas_kernel.h"
#include "floe/petsc/error.h"
#include "floe/petsc/factorisation.h"
#include "floe/solve/generalized_alpha.h"

int main(int argc, char** argv) {
  floe::petsc::use_better_blas_kernel(argv);
  int none = 1;
  char* name[] = {argv[0], nullptr};
  char** arguments = name;
  if (SlepcInitialize(&none, &arguments, nullptr, nullptr)) return 1;
  floe::petsc::collect_errors();
  floe::petsc::prepare_mumps();
  floe::solve::register_generalized_alpha();
  const int failures = Catch::Session().run(argc, argv);
  int any = 0;
  MPI_Allreduce(&failures, &any, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD);
  SlepcFinalize();
  return any > 255 ? 255 : any;
}
