#pragma once
#include "scene_motion.h"

namespace floe::test {

/// Von Mises' truss: two hinged bars of half span 1 and rise h, EA = 1000, that a force pushes through at their apex.
inline std::string truss(double h, const std::string& force = "-t") {
  return fill(R"yaml(
bodies:
  a:
    mesh: {line: {from: [-1, 0], to: [0, $h], elements: 2}}
    section: {EA: 1e3, EI: 10, rhoA: 1}
  b:
    mesh: {line: {from: [0, $h], to: [1, 0], elements: 2}}
    section: {EA: 1e3, EI: 10, rhoA: 1}
joints:
  left: {type: revolute, between: [ground, a.start]}
  apex: {type: revolute, between: [a.end, b.start]}
  right: {type: revolute, between: [ground, b.end]}
loads: {push: {type: force, at: a.end, force: [0, "$force"]}}
probes: {apex: {at: a.end}}
)yaml",
              {{"h", number(h)}, {"force", force}});
}

}  // namespace floe::test
