#pragma once
#include <string>

namespace floe::petsc {

/// OpenBLAS's name of the kernels that it selected for this processor when it was loaded, "SkylakeX" for instance;
/// empty for another BLAS. Rank-local, at any time.
std::string blas_kernel();

/// What OPENBLAS_CORETYPE should be where OpenBLAS is older than the processor, which it then takes for one without AVX
/// ("Prescott"); empty where its kernels fit, and where the environment names some.
std::string better_blas_kernel();

/// Starts the program again with OPENBLAS_CORETYPE = better_blas_kernel() where there is one: kernels can only be
/// selected before OpenBLAS is loaded. Dense products are then 3 to 5 times faster. Same process, arguments, files and
/// environment otherwise; returns where there is nothing to do or starting fails. The first call of main, before MPI's.
void use_better_blas_kernel(char** argv);

}  // namespace floe::petsc
