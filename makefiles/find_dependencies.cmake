# Everything from outside, as imported targets: for the build, and for find_package(floe).
find_package(PkgConfig REQUIRED)
find_package(MPI REQUIRED COMPONENTS C CXX)
# Indices of 64 bits are another build of PETSc and SLEPc, which Debian installs beside the usual one.
if(FLOE_INDEX64)
  set(index64 64)
endif()
pkg_check_modules(PETSC REQUIRED IMPORTED_TARGET petsc${index64})
pkg_check_modules(SLEPC REQUIRED IMPORTED_TARGET slepc${index64})
pkg_search_module(HDF5 REQUIRED IMPORTED_TARGET hdf5-openmpi hdf5)  # Debian's name of the parallel one, and HDF5's own
pkg_check_modules(EIGEN REQUIRED IMPORTED_TARGET eigen3)
find_package(yaml-cpp REQUIRED)
find_package(fmt REQUIRED)
find_path(CLI11_INCLUDE CLI/CLI.hpp REQUIRED)
find_path(NLOHMANN_INCLUDE nlohmann/json.hpp REQUIRED)
find_path(CATCH_INCLUDE catch2/catch.hpp)
# floe registers a TS type of its own; PETSc ships the header that this needs beside its public ones.
find_path(PETSC_PRIVATE petsc/private/tsimpl.h PATHS ${PETSC_INCLUDE_DIRS} /usr/share/petsc/3.18/include REQUIRED)

find_path(METIS_INCLUDE metis.h REQUIRED)
find_library(METIS_LIBRARY metis REQUIRED)

# The BLAS and LAPACK that PETSc uses: the reduction's own products go there too.
find_library(LAPACK_LIBRARY lapack REQUIRED)
find_library(BLAS_LIBRARY blas REQUIRED)
