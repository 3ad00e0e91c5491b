#include "floe/plan/held_by_modes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "floe/plan/attachments.h"
#include "floe/plan/hold_at_frame.h"
#include "floe/plan/prepare_spatial_joints.h"
#include "floe/plan/reduced_place.h"

namespace floe::plan {
namespace {

constexpr const char* interface = "interface";

/// ` about z`, of an axis along one of the frame's; empty: oblique.
std::string along_frame(const char* preposition, const Eigen::Vector3d& axis) {
  Eigen::Index along = 0;
  return axis.cwiseAbs().maxCoeff(&along) > 1 - 1e-9 ? fmt::format(" {} {}", preposition, "xyz"[along]) : "";
}

std::string support_text(const Joint& joint) {
  static constexpr std::array names{"x", "y", "z", "rx", "ry", "rz"};
  std::vector<std::string> held;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (joint.hold[i]) held.emplace_back(names[i]);
  return fmt::format("support of {}", fmt::join(held, ", "));
}

/// What the joint holds, with its axis in those of the body's frame; empty: nothing (springs, distances).
std::string text_of(const Plan& plan, std::size_t j, const PlannedBody& body) {
  using Kind = Joint::Kind;
  const Joint& joint = plan.scene.joints[j];
  if (clamps(joint)) return "fixed";
  if (joint.kind == Kind::support) return support_text(joint);
  if (joint.kind == Kind::spherical || joint.kind == Kind::universal) return "spherical";
  const bool planar = plan.joint_axes.empty();
  const Eigen::Vector3d world(joint.axis[0], joint.axis[1], 0);
  const Eigen::Vector3d axis =
      planar ? Eigen::AngleAxisd(-body.spec.initial.angle - body.frame_angle, Eigen::Vector3d::UnitZ()) *
                   world.normalized()
             : body.attitude.transpose() * plan.joint_axes[j].col(2);
  switch (joint.kind) {
    case Kind::revolute:
      return "revolute" + (planar ? "" : along_frame("about", axis));
    case Kind::prismatic:
      return "prismatic" + along_frame("along", axis);
    case Kind::cylindrical:
      return "cylindrical" + along_frame("along", axis);
    case Kind::planar:
      return "planar" + along_frame("normal to", axis);
    default:
      return "";
  }
}

/// What holds, and where: `fixed at left`, `fixed at (1, 0)`.
std::string line_of(const std::string& what, const Place& place, int dimension) {
  const std::string name = name_in_file(place, dimension);
  return what + " at " + (place.point ? name.substr(2) : name);
}

/// A place of a body from a file by the number of its anchors, and what holds it.
using Hold = std::pair<PetscInt, std::string>;

/// Of the lines of a file.
std::vector<Hold> holds_of_file(const output::ReducedBodyFile& file) {
  std::vector<Hold> holds;
  for (const std::string& line : *file.held) {
    const std::size_t at = line.find(" at ");
    const std::string name = at == std::string::npos ? "" : line.substr(at + 4);
    const auto place = std::find_if(file.places.begin(), file.places.end(), [&](const output::ReducedPlace& each) {
      return each.name == name || each.name == "at" + name;
    });
    holds.emplace_back(place == file.places.end() ? -1 : number_in_file(file, place->map.x), line.substr(0, at));
  }
  return holds;
}

std::string listed(const std::vector<std::string>& lines) {
  return lines.empty() ? "nothing" : fmt::format("{}", fmt::join(lines, ", "));
}

}  // namespace

std::string name_in_file(const Place& place, int dimension) {
  if (!place.point) return place.name;
  return fmt::format("at({})", fmt::join(place.point->begin(), place.point->begin() + dimension, ", "));
}

std::optional<std::vector<std::string>> held_by_modes(const Plan& plan, int index) {
  const PlannedBody& body = plan.bodies[index];
  if (of_frame(body)) return std::nullopt;
  const int dimension = body.structure.dimension();
  std::vector<std::string> held;
  for (std::size_t j = 0; j < plan.joints.size(); ++j) {
    const Anchor* place = constrained_place(plan, j);
    if (!(place && place->body == index) && !joins_at_frame(plan, index, j)) continue;
    const Joint& joint = plan.scene.joints[j];
    const std::string text = text_of(plan, j, body);
    if (!text.empty())
      held.push_back(line_of(text, plan.joints[j][0].body == index ? joint.first : joint.second, dimension));
  }
  for (const Place& place : body.spec.reduction.interface) held.push_back(line_of(interface, place, dimension));
  return held;
}

std::string held_otherwise(const Plan& plan, int index) {
  const PlannedBody& body = plan.bodies[index];
  if (!body.spec.reduced || !body.spec.reduced->file->held) return "";
  const output::ReducedBodyFile& file = *body.spec.reduced->file;
  std::vector<Hold> of_file = holds_of_file(file), of_scene;
  const auto in_interface = [&](PetscInt place) {
    return std::find(of_file.begin(), of_file.end(), Hold(place, interface)) != of_file.end();
  };
  std::vector<std::string> lines;
  for (std::size_t j = 0; j < plan.joints.size(); ++j)
    for (const int side : {0, 1}) {
      const Anchor& place = plan.joints[j][side];
      if (place.body != index || in_interface(place.node)) continue;
      const Joint& joint = plan.scene.joints[j];
      const std::string text = text_of(plan, j, body);
      if (text.empty()) continue;
      // joints to other bodies count where they hold the frame, also by an edge, as those of the file do
      const bool at_frame = body.frame.kind == fem::ReferenceFrame::Kind::clamped &&
                            (place.x.norm() <= 1e-9 * plan.extent ||
                             std::find(of_file.begin(), of_file.end(), Hold(place.node, text)) != of_file.end());
      if (!plan.joints[j][1 - side].ground() && !at_frame) continue;
      of_scene.emplace_back(place.node, text);
      lines.push_back(line_of(text, side == 0 ? joint.first : joint.second, file.dimension));
    }
  std::erase_if(of_file, [](const Hold& hold) { return hold.second == interface; });
  std::sort(of_file.begin(), of_file.end()), std::sort(of_scene.begin(), of_scene.end());
  if (of_file == of_scene) return "";
  return fmt::format(
      "body {}: the modes in {} are constrained by {}, the body in this scene by {}: it can be much too stiff; reduce "
      "it with the joints of this scene",
      body.spec.name, body.spec.reduced->path, listed(*file.held), listed(lines));
}

}  // namespace floe::plan
