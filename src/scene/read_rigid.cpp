#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>

#include "readers.h"

namespace floe::scene {
namespace {

/// Principal moments are positive and each at most the sum of the others.
void check_inertia(Document& document, const Where& where, const std::array<double, 6>& J) {
  Eigen::Matrix3d tensor;
  tensor << J[0], J[3], J[4], J[3], J[1], J[5], J[4], J[5], J[2];
  const Eigen::Vector3d moments = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(tensor).eigenvalues();
  const std::string are =
      fmt::format("has the principal moments {:.6g}, {:.6g}, {:.6g}", moments[0], moments[1], moments[2]);
  if (!(moments[0] > 0))
    document.fault(where, are, "positive ones");
  else if (moments[2] > (moments[0] + moments[1]) * (1 + 1e-9))
    document.fault(where, are + ", which no body has", "each at most the sum of the other two");
}

}  // namespace

std::array<double, 6> read_inertia(Document& document, Reading& reading) {
  std::array<double, 6> J{};
  const auto value = reading.value("inertia");
  if (!value) return J;
  const std::size_t before = document.fault_count();
  const Key& key = reading.key("inertia");
  if (document.dimension == 2) {
    J[2] = read_number(document, *value, key);
    if (document.fault_count() == before && !(J[2] > 0))
      document.fault(value->where, fmt::format("is {:.6g}", J[2]), "a number > 0");
    return J;
  }
  const auto numbers = read_list(document, *value, key);
  if (document.fault_count() != before) return J;
  if (numbers.size() != 3 && numbers.size() != 6)
    document.fault(value->where, fmt::format("has length {}", numbers.size()), describe(key, 3));
  for (std::size_t i = 0; i < std::min(numbers.size(), J.size()); ++i) J[i] = read_number(document, numbers[i], key);
  if (document.fault_count() == before) check_inertia(document, value->where, J);
  return J;
}

void read_rigid(Document& document, Reading& reading, Body& body) {
  const auto value = reading.value("rigid");
  body.rigid = value->node.IsMap() || read_flag(document, *value, reading.key("rigid"));
  if (!value->node.IsMap()) {
    if (!reading.given("mesh"))
      document.fault(reading.where("mesh"), "is missing", describe(reading.key("mesh"), document.dimension));
    return;
  }
  Reading rigid(document, *value, "rigid");
  RigidMass mass{rigid.number("mass"), rigid.point("centre"), read_inertia(document, rigid), reading.given("mesh")};
  if (!mass.has_mesh) {  // as long as the body is wide
    const auto& J = mass.inertia;
    const double wide = std::sqrt((J[0] + J[1] + J[2]) / mass.mass);
    body.mesh.points = {mass.centre, mass.centre};
    body.mesh.points[1][0] += std::isfinite(wide) && wide > 0 ? wide : 1;
    body.mesh.segments = {{0, 1}}, body.mesh.elements = {1};
    body.mesh.where = body.where;
  }
  for (const char* key : {"section", "material", "parts"})
    if (reading.given(key) && !mass.has_mesh)
      document.fault(reading.where(key), "does not apply to a body without mesh", "this key only with mesh");
  if (reading.given("masses"))
    document.fault(reading.where("masses"), "does not apply to a body whose mass is given", "mass with all of it");
  body.mass = mass;
}

}  // namespace floe::scene
