#include "session.h"

#include <petscsys.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include "floe/error.h"
#include "floe/petsc/error.h"
#include "floe/petsc/factorisation.h"

namespace floe::fuzz {

File::File() : descriptor_(memfd_create("fuzz", MFD_CLOEXEC)), path_("/proc/self/fd/" + std::to_string(descriptor_)) {
  if (descriptor_ < 0) throw std::runtime_error("no file in memory");
}

File::~File() { close(descriptor_); }

void File::put(const std::uint8_t* data, std::size_t size) {
  if (ftruncate(descriptor_, 0) != 0 || pwrite(descriptor_, data, size, 0) != static_cast<ssize_t>(size))
    throw std::runtime_error("the file in memory took less than the input");
}

void try_to(const std::function<void()>& read) {
  try {
    read();
  } catch (const InputError& refused) {
    for (const std::string& fault : refused.faults()) {
      if (fault.empty() || fault.find('\n') != std::string::npos) {
        std::fprintf(stderr, "ERROR: a fault that is not one line: <%s>\n", fault.c_str());
        std::abort();
      }
    }
    if (refused.faults().empty()) std::abort();
  } catch (const std::exception& other) {
    std::fprintf(stderr, "ERROR: not an InputError: %s\n", other.what());
    std::abort();
  }
}

}  // namespace floe::fuzz

/// libFuzzer calls it before the first input. PETSc and Open MPI keep their hands off the signals: libFuzzer wants
/// them.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  setenv("OMPI_MCA_opal_signal", "", 1);
  char name[] = "fuzz", quiet[] = "-no_signal_handler";
  char* words[] = {name, quiet, nullptr};
  char** arguments = words;
  int count = 2;
  if (PetscInitialize(&count, &arguments, nullptr, nullptr)) std::abort();
  floe::petsc::collect_errors();
  floe::petsc::prepare_mumps();
  return 0;
}
