#include "floe/petsc/blas_kernel.h"

#include <dlfcn.h>
#include <sys/auxv.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

namespace floe::petsc {

std::string blas_kernel() {
  const auto name = reinterpret_cast<char* (*)()>(dlsym(RTLD_DEFAULT, "openblas_get_corename"));
  return name ? name() : "";
}

std::string better_blas_kernel() {
  if (std::getenv("OPENBLAS_CORETYPE") || blas_kernel() != "Prescott") return "";
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512cd"))
    return "SkylakeX";
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return "Haswell";
#endif
  return "";
}

void use_better_blas_kernel(char** argv) {
  const std::string kernel = better_blas_kernel();
  if (kernel.empty() || getauxval(AT_BASE) == 0) return;  // 0: started through the dynamic loader, which is the "exe"
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error || setenv("OPENBLAS_CORETYPE", kernel.c_str(), 0) != 0) return;
  execv(program.c_str(), argv);
}

}  // namespace floe::petsc
