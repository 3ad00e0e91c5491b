// Decks of CalculiX and Abaqus: what is read is looked through as the program does.
#include "floe/mesh/inp.h"
#include "floe/mesh/inspect.h"
#include "session.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static floe::fuzz::File file;
  file.put(data, size);
  floe::fuzz::try_to([] { floe::mesh::inspect(floe::mesh::read_inp(PETSC_COMM_SELF, file.path()).mesh); });
  return 0;
}
