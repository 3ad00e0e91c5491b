// Bulk data of Nastran: what is read is looked through as the program does.
#include "floe/mesh/inspect.h"
#include "floe/mesh/nastran.h"
#include "session.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static floe::fuzz::File file;
  file.put(data, size);
  floe::fuzz::try_to([] { floe::mesh::inspect(floe::mesh::read_nastran(PETSC_COMM_SELF, file.path()).mesh); });
  return 0;
}
