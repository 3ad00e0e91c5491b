#include <algorithm>

#include "floe/scene/places.h"
#include "readers.h"

namespace floe::scene {
namespace {

using FrameKind = FrameSpec::Kind;
const std::vector<std::pair<std::string, FrameKind>> frame_kinds{
    {"pinned", FrameKind::pinned}, {"clamped", FrameKind::clamped}, {"mean-axis", FrameKind::mean_axis}};

FrameSpec read_frame(Document& document, Reading& body, const std::string& name) {
  FrameSpec frame;
  Value value{YAML::Node("pinned"), body.where()};
  frame.given = body.given("frame");
  if (frame.given) value = *body.value("frame");
  frame.where = value.where;
  if (value.node.IsScalar()) {  // the type alone
    YAML::Node mapping(YAML::NodeType::Map);
    const Key& key = schema_section("frame").key("type");
    const std::string type = read_choice(document, value, key);
    if (!type.empty()) mapping["type"] = type;
    value.node = mapping;
  }
  Reading reading(document, value, "frame");
  frame.kind = reading.choice<FrameKind>("type", frame_kinds);
  if (reading.given("type")) reading.set_kind(reading.text("type"));
  const auto place = [&](const char* key) {
    return read_own_place(document, *reading.value(key), reading.key(key), name);
  };
  frame.from = place("from");
  frame.to = place("to");
  frame.at = place("at");
  return frame;
}

DampingSpec read_damping(Document& document, Reading& body) {
  DampingSpec damping;
  const auto value = body.value("damping");
  if (!value) return damping;
  damping.where = value->where;
  Reading reading(document, *value, "damping");
  damping.mass = reading.number("mass");
  damping.stiffness = reading.number("stiffness");
  damping.modal = reading.numbers("modal");
  return damping;
}

std::optional<fem::Strains> read_strains(Document& document, Reading& body) {
  using fem::Strains;
  if (!body.given("strains")) return {};
  const std::size_t before = document.fault_count();
  const auto strains =
      body.choice<Strains>("strains", {{"von_karman", Strains::von_karman}, {"second_order", Strains::second_order}});
  if (document.fault_count() != before) return {};
  if (strains == Strains::second_order && body.given("strain") && body.choice("strain") == "pointwise")
    document.fault(body.where("strain"), "is pointwise with strains of second order", "averaged");
  if (strains == Strains::second_order && document.dimension == 2)
    document.fault(body.where("strains"), "is second_order in the plane",
                   "von_karman, or a scene in space (points of three coordinates)");
  return strains;
}

/// A section of a rigid body whose mass is given: of no account.
void give_section(Body& body) {
  body.section.EA = body.section.EI = body.section.rhoA = 1;
  if (body.mesh.plate) {
    body.parts = {{"", fem::shell_section({{fem::isotropic(1, 0, 1), 1, 0}}, 0, Eigen::Vector3d::Zero()), body.where}};
    return;
  }
  const auto& points = body.mesh.points;
  Eigen::Vector3d across = Eigen::Vector3d::UnitY();
  for (const auto& [from, to] : body.mesh.segments) {  // oblique to all of them
    const Eigen::Vector3d along =
        Eigen::Map<const Eigen::Vector3d>(points[to].data()) - Eigen::Map<const Eigen::Vector3d>(points[from].data());
    if (across.cross(along).norm() < 1e-3 * along.norm())
      across = Eigen::Vector3d(across.z(), across.x() + 0.3, across.y() + 0.7).normalized();
  }
  body.parts = {
      {"", fem::SpatialBeam{fem::spatial_section(fem::circle(1), {1, 1, 1}, {0, 0}), across, {}}, body.where}};
}

// The default count of modes fits every mesh; what the file asks for is taken at its word.
void fit_default_modes(Body& body) {
  if (body.reduction.modes.given || body.mesh.points.empty() || body.frames < 1) return;
  const int elastic = 3 * ((node_count(body.mesh) - 1) / body.frames);
  body.reduction.modes.count = std::min(body.reduction.modes.count, std::max(elastic, 0));
}

}  // namespace

InitialSpec read_initial(Document& document, Reading& body) {
  InitialSpec initial;
  const auto value = body.value("initial");
  if (!value) return initial;
  initial.where = value->where;
  Reading reading(document, *value, "initial");
  if (reading.given("position")) initial.position = reading.point("position");
  initial.angle = reading.number("angle");
  if (reading.given("rotation")) initial.rotation = reading.point("rotation");
  if (reading.given("velocity")) initial.velocity = reading.point("velocity");
  initial.angular_velocity = reading.rotating("angular_velocity");
  if (document.dimension == 3) {
    initial.spatial_deformation = reading.formulas<3>("deformation", {"x", "y", "z"});
    initial.spatial_deformation_rate = reading.formulas<3>("deformation_rate", {"x", "y", "z"});
  } else {
    initial.deformation = reading.formulas<2>("deformation", {"x", "y"});
    initial.deformation_rate = reading.formulas<2>("deformation_rate", {"x", "y"});
  }
  return initial;
}

Body read_body(Document& document, const std::string& name, const Value& value) {
  const std::size_t before = document.fault_count();
  Body body;
  body.name = name;
  body.where = value.where;
  Reading reading(document, value, "body");
  if (!value.node.IsMap()) return body;
  if (reading.given("reduced")) return read_reduced(document, name, reading);
  if (const auto mesh = reading.value("mesh")) body.mesh = read_mesh(document, *mesh);
  read_rigid(document, reading, body);
  const bool in_space = document.dimension == 3;
  const bool sectionless =
      body.mass && (!body.mass->has_mesh || (!reading.given("section") && !reading.given("parts") && !body.mesh.file));
  if (sectionless)
    give_section(body);
  else if (in_space)
    body.parts = read_parts(document, reading);
  else
    body.section = read_section(document, reading, body.rigid);
  body.strain = reading.choice<Strain>("strain", {{"averaged", Strain::averaged}, {"pointwise", Strain::pointwise}});
  body.strains = read_strains(document, reading);
  body.rotary_inertia = reading.flag("rotary_inertia");
  body.frame = read_frame(document, reading, name);
  body.masses = read_masses(document, reading, name);
  body.frames = reading.integer("frames");
  if (body.frames > 1 && !body.masses.empty())
    document.fault(reading.where("masses"), "does not apply to a body in several frames", "frames: 1");
  if (body.rigid) body.frames = 1;
  const Value nothing{YAML::Node(YAML::NodeType::Map), body.where};
  body.reduction = read_reduction(document, reading.value("reduction").value_or(nothing), name);
  body.damping = read_damping(document, reading);
  body.initial = read_initial(document, reading);
  if (!in_space) fit_default_modes(body);
  if (document.fault_count() == before) check_body(document, body);
  return body;
}

}  // namespace floe::scene
