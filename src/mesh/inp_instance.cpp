#include <algorithm>

#include "inp_reading.h"
#include "text.h"

namespace floe::mesh {
namespace {

/// A translation and then a rotation about the axis from a to b, by an angle in degrees.
std::optional<Eigen::Isometry3d> motion_of(const InpBlock& block, InpReading& reading) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  const auto lines = data_lines(block, 0, 2, "a translation, and perhaps a rotation", reading.faults);
  if (lines.empty()) return motion;
  const auto shift = numbers(lines[0].second, lines[0].first, 0, 3, "a translation", reading.faults);
  if (!shift) return std::nullopt;
  for (std::size_t i = 0; i < shift->size(); ++i) motion.translation()[static_cast<Eigen::Index>(i)] = (*shift)[i];
  if (lines.size() == 1) return motion;
  const auto rotation = numbers(lines[1].second, lines[1].first, 7, 7, "two points and an angle", reading.faults);
  if (!rotation) return std::nullopt;
  const Eigen::Vector3d a((*rotation)[0], (*rotation)[1], (*rotation)[2]),
      b((*rotation)[3], (*rotation)[4], (*rotation)[5]);
  if (!((b - a).norm() > 0)) {
    reading.faults.add(lines[1].first, "the axis of an *INSTANCE has no length");
    return std::nullopt;
  }
  const Eigen::AngleAxisd by((*rotation)[6] * M_PI / 180, (b - a).normalized());
  return Eigen::Translation3d(a) * by * Eigen::Translation3d(-a) * motion;
}

/// Of the part: whether they rotate with it is not known.
void refuse_directions(InpReading& reading) {
  const std::string why = " in a part whose *INSTANCE is rotated is not read";
  for (const InpUse& use : reading.uses)
    if (use.kind == InpUse::spring && use.directions[0] > 0)
      reading.faults.add(use.where, "*SPRING with directions" + why);
  for (const InpLink& link : reading.links)
    if (std::any_of(link.free.axis.begin(), link.free.axis.end(), [](double x) { return x != 0; }))
      reading.faults.add(link.where,
                         "*KINEMATIC with one or two of the rotations" + why + ": define it in the *ASSEMBLY");
}

}  // namespace

void read_instance(const InpBlock& block, InpReading& reading) {
  if (!reading.instance.empty()) reading.faults.add(block.where, "a second *INSTANCE: one is read, for one body");
  reading.instance = required(block, "NAME", reading);
  reading.motion = motion_of(block, reading);
}

/// The part before it and the nodes of the instance move, with their axes.
void read_end_instance(const InpBlock&, InpReading& reading) {
  const auto motion = std::exchange(reading.motion, std::nullopt);
  if (!motion) return;
  for (Eigen::Vector3d& x : reading.mesh.positions) x = *motion * x;
  for (Orientation& orientation : reading.deck.orientations) {
    orientation.a = motion->linear() * orientation.a;
    orientation.b = motion->linear() * orientation.b;
  }
  for (InpTransform& transform : reading.transforms) {
    transform.a = transform.type == 'R' ? motion->linear() * transform.a : *motion * transform.a;
    transform.b = transform.type == 'R' ? motion->linear() * transform.b : *motion * transform.b;
  }
  const bool turned = !motion->linear().isIdentity(1e-12);
  for (InpEquation& equation : reading.equations) equation.turned = turned;
  if (turned) refuse_directions(reading);
  for (InpCylinder& cylinder : reading.cylinders) {
    cylinder.a = *motion * cylinder.a;
    cylinder.b = *motion * cylinder.b;
  }
  for (BeamSection& section : reading.deck.beam_sections) section.direction_1 = motion->linear() * section.direction_1;
}

}  // namespace floe::mesh
