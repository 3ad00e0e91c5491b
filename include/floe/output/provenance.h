#pragma once
#include <mpi.h>

#include <nlohmann/json.hpp>
#include <string>

namespace floe::output {

/// What made a result: floe's version and commit, the libraries and theirs, BLAS, ranks, cores, date, command line,
/// PETSc options.
///
/// Keys: floe {version, commit}, date (UTC, ISO 8601), command, petsc_options, ranks, cores, petsc, slepc, mpi, hdf5,
/// blas {name, file, kernel}. After PetscInitialize. Rank-local.
nlohmann::ordered_json provenance(MPI_Comm comm);

/// "openblas", "reference", "mkl", "blis", "atlas" or "unknown", from the file that dgemm_ was loaded from.
std::string blas_name(const std::string& file);

}  // namespace floe::output
