#include "floe/output/provenance.h"

#include <petscsys.h>

#include <catch2/catch.hpp>

#include "floe/version.h"

using Catch::Matchers::StartsWith;
using floe::output::blas_name;
using floe::output::provenance;

TEST_CASE("provenance names what made a result") {
  PetscOptionsSetValue(nullptr, "-modes_eps_nev", "7");
  const auto all = provenance(PETSC_COMM_WORLD);
  PetscOptionsClearValue(nullptr, "-modes_eps_nev");
  CHECK(all["floe"]["version"] == FLOE_VERSION);
  CHECK(all["petsc_options"].get<std::string>().find("-modes_eps_nev 7") != std::string::npos);
  CHECK_THAT(all["petsc"].get<std::string>(),
             StartsWith("Petsc Release Version " + std::to_string(PETSC_VERSION_MAJOR)));
  CHECK_THAT(all["slepc"].get<std::string>(), StartsWith("SLEPc Release Version "));
  CHECK_THAT(all["mpi"].get<std::string>(), StartsWith("Open MPI"));
  CHECK_THAT(all["hdf5"].get<std::string>(), StartsWith("HDF5 1."));
  CHECK(all["command"].get<std::string>().find("test_unit_output") != std::string::npos);
  int ranks = 0;
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  CHECK(all["ranks"] == ranks);
  CHECK(all["cores"].get<int>() >= 1);
  CHECK(all["blas"]["name"] != "unknown");
  CHECK(all["blas"]["kernel"].get<std::string>().empty() == (all["blas"]["name"] != "openblas"));
  int year = 0, second = -1;
  char zone = 0;
  CHECK(std::sscanf(all["date"].get<std::string>().c_str(), "%4d-%*2d-%*2dT%*2d:%*2d:%2d%c", &year, &second, &zone) ==
        3);
  CHECK((year >= 2024 && second >= 0 && zone == 'Z'));
}

TEST_CASE("the BLAS is known by its file") {
  CHECK(blas_name("/usr/lib/x86_64-linux-gnu/openblas-serial/libblas.so.3") == "openblas");
  CHECK(blas_name("/usr/lib/x86_64-linux-gnu/blas/libblas.so.3.11.0") == "reference");
  CHECK(blas_name("/opt/intel/mkl/lib/libmkl_rt.so") == "mkl");
  CHECK(blas_name("") == "unknown");
}
