#pragma once
#include "scene_motion.h"

namespace floe::test {

/// The cantilever of Wu and Tiso: L = 100, A = 70, I = 585, E = 16000, rho = 0.0078, tip force 2500 sin(9.5 t), at
/// rest.
struct PaperCantilever {
  std::string frame = "pinned", frames = "1", elements = "20", rotary = "true", end = "1.5", step = "1e-3";
  std::string reduction = "{modes: 3}";
};

inline std::string text_of(const PaperCantilever& c) {
  return fill(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [100, 0], elements: $elements}}
    section: {A: 70, I: 585}
    material: {E: 16000, rho: 0.0078}
    rotary_inertia: $rotary
    frame: $frame
    frames: $count
    reduction: $reduction
joints:
  clamp: {type: fixed, between: [ground, beam.start]}
loads:
  tip: {type: force, at: beam.end, force: [0, "2500*sin(9.5*t)"]}
motion: {end: $end, step: $step}
probes:
  tip: {at: beam.end, quantity: displacement}
)yaml",
              {{"elements", c.elements},
               {"rotary", c.rotary},
               {"frame", c.frame},
               {"count", c.frames},
               {"reduction", c.reduction},
               {"end", c.end},
               {"step", c.step}});
}

}  // namespace floe::test
