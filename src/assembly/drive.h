#pragma once
#include <string>
#include <vector>

#include "floe/dynamics/time_function.h"
#include "floe/math/breaks.h"
#include "floe/scene/scene.h"

namespace floe::assembly {
using namespace scene;

/// Whether joints of the kind prescribe an angle or a position.
bool is_drive(Joint::Kind kind);

/// Whether a derivative of f (0: f itself) differs on both sides of a break by more than round-off; not where it is no
/// number.
bool jumps(const math::Breaks& all, const math::Break& at, int derivative);

/// Where the driven angle or position is not smooth: its rate jumps, or only its acceleration does.
struct DriveKink {
  double before = 0, after = 0;      ///< [s]
  bool velocity = false;             ///< its rate jumps,
  double from = 0, to = 0;           ///< so [rad/s], [m/s]
  bool endless[2] = {false, false};  ///< its acceleration grows without limit towards it, on the left, on the right
};

/// Those of a driven joint until the scene's motion.end or `end`, the later one.
/// @throws InputError  the angle or position itself jumps, or its rate is infinite: at which time, and by how much
std::vector<DriveKink> drive_kinks(const Joint& joint, const Motion& motion, double end = 0);

/// The angle or position that a driven joint gives, with its rates; of a speed its integral from t = 0. At t = 0 they
/// are what they are just after it. Beside an instant where the acceleration is infinite a polynomial of fourth degree
/// takes the drive's place for `smoothing` steps: it joins the drive with the same angle and rate, and on the far side
/// the same acceleration.
/// @param motion  how finely the integral is kept: by panels of 16 steps
/// @throws InputError  an angle or position that is not 0 at t = 0; as drive_kinks
dynamics::TimeFunction drive_of(const Joint& joint, const Motion& motion);
constexpr double smoothing = 10;

/// What is smoothed, in words, of all joints.
std::vector<std::string> smoothed_drives(const Scene& scene);

}  // namespace floe::assembly
