#include "floe/generate/generate.h"
#include "share.h"

namespace floe::generate {

RawMesh scaled(RawMesh mesh, double factor) {
  Checks checks("scaled");
  checks.positive("factor", factor);
  checks.finish();
  for (auto& x : mesh.positions) x *= factor;
  return mesh;
}

RawMesh prefixed(RawMesh mesh, const std::string& prefix) {
  for (auto* names : {&mesh.parts, &mesh.places})
    for (auto& name : *names) name.insert(0, prefix);
  return mesh;
}

}  // namespace floe::generate
