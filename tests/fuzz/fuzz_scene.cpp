// What `floe check` does before it builds: YAML, the grammar, formulas, names. The text is the whole input; files that
// it names are those of the working directory.
#include "floe/scene/scene.h"
#include "session.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  floe::fuzz::try_to([&] { floe::scene::parse_scene({reinterpret_cast<const char*>(data), size}, "fuzz"); });
  return 0;
}
