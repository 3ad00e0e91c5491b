include(${CMAKE_CURRENT_LIST_DIR}/find_dependencies.cmake)

add_library(floe_outside INTERFACE)
target_link_libraries(floe_outside INTERFACE PkgConfig::SLEPC PkgConfig::PETSC PkgConfig::HDF5 MPI::MPI_CXX
  PkgConfig::EIGEN ${METIS_LIBRARY} ${LAPACK_LIBRARY} ${BLAS_LIBRARY} yaml-cpp fmt::fmt)
target_include_directories(floe_outside SYSTEM INTERFACE ${PETSC_PRIVATE} ${CLI11_INCLUDE} ${NLOHMANN_INCLUDE}
  ${METIS_INCLUDE})
