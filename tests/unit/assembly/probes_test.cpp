#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "building.h"
#include "floe/solve/simulation.h"

using namespace floe;
using scene::Formulation;
using testing::at_start;
using testing::built;

namespace {

const char* text = R"yaml(
bodies:
  hub:
    rigid: true
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 1}}
    section: {rhoA: 5}
    initial: {angle: 0.3, angular_velocity: 2}
  beam:
    mesh: {line: {from: [0, 0], to: [2, 0], elements: 6}}
    section: {EA: 1e4, EI: 10, rhoA: 3}
    initial: {position: [3, 0], velocity: [0, 1], deformation: [0, "0.01*x*(2-x)"]}
    reduction: {modes: {count: 4, of: frame}}
motion: {end: 0.1, step: 0.01}
probes:
  position: {at: beam.middle, quantity: position}
  seen: {at: beam.middle, quantity: position, relative_to: hub.end}
  moving: {at: beam.middle, quantity: velocity, relative_to: hub.end}
  bent: {at: beam.middle, quantity: deflection}
  turned: {at: beam.end, quantity: rotation, relative_to: hub.end}
  gone: {at: beam.middle, quantity: displacement, relative_to: hub.end}
)yaml";

}  // namespace

TEST_CASE("columns of the probes with their units") {
  std::vector<std::string> columns;
  for (const auto& column : assembly::probe_columns(built(text, Formulation::vm)))
    columns.push_back(column.name + " " + column.unit);
  std::sort(columns.begin(), columns.end());
  CHECK(columns == std::vector<std::string>{"bent.x m", "bent.y m", "gone.x m", "gone.y m", "moving.x m/s",
                                            "moving.y m/s", "position.x m", "position.y m", "seen.x m", "seen.y m",
                                            "turned.angle rad"});
}

TEST_CASE("coordinates of joints are measured beside places and their rates") {
  const assembly::Model model = built(R"yaml(
bodies:
  hub: {rigid: true, mesh: {line: {from: [0, 0], to: [1, 0], elements: 1}}, section: {rhoA: 5}}
joints: {pin: {type: revolute, between: [ground, hub.start]}}
motion: {end: 0.1, step: 0.01}
probes:
  angle: {joint: pin, quantity: angle}
  rate: {joint: pin, quantity: rate}
  product: {formula: "pin.angle*pin.rate", unit: rad2/s}
)yaml",
                                      Formulation::vm);
  std::map<std::string, assembly::ProbeColumn::Kind> kinds;
  for (const auto& column : assembly::probe_columns(model)) kinds[column.name] = column.kind;
  using Kind = assembly::ProbeColumn::Kind;
  CHECK(kinds.at("angle.value") == Kind::place);
  CHECK(kinds.at("rate.value") == Kind::rate);
  CHECK(kinds.at("product.value") == Kind::formula);
}

TEST_CASE("a probe relative to a moving place is what an observer there sees") {
  for (const auto formulation : testing::all_formulations()) {
    INFO(scene::name_of(formulation));
    assembly::Model model = built(text, formulation);
    const auto columns = assembly::probe_columns(model);
    const auto index = [&](const std::string& name) {
      for (std::size_t i = 0; i < columns.size(); ++i)
        if (columns[i].name == name) return i;
      return columns.size();
    };
    const auto at = [&](const std::vector<double>& values, const char* name) {
      return Eigen::Vector2d(values[index(std::string(name) + ".x")], values[index(std::string(name) + ".y")]);
    };
    const auto values = at_start(model);
    const Eigen::Vector2d p(4, 0.01), hub(std::cos(0.3), std::sin(0.3)), hub_v = 2 * Eigen::Vector2d(-hub.y(), hub.x());
    const Eigen::Rotation2Dd back(-0.3);
    CHECK((at(values, "position") - p).norm() < 5e-5);
    CHECK((at(values, "bent") - Eigen::Vector2d(0, 0.01)).norm() < 5e-5);
    const Eigen::Vector2d seen = back * (p - hub);
    CHECK((at(values, "seen") - seen).norm() < 5e-5);
    const Eigen::Vector2d moving = back * (Eigen::Vector2d(0, 1) - hub_v) - 2 * Eigen::Vector2d(-seen.y(), seen.x());
    CHECK((at(values, "moving") - moving).norm() < 1e-3);
    CHECK(at(values, "gone").norm() < 1e-13);
    CHECK(std::abs(values[index("turned.angle")]) < 1e-14);
    // later: the relative velocity is the rate of the relative position, which displacement measures from the start
    std::vector<std::vector<double>> rows;
    solve::simulate(*model.system, {0.004, 0.001, 0.8, {}}, model.U, model.V, [&](const solve::Instant& now) {
      rows.push_back(assembly::probe_values(model, now.t, now.U, now.V));
    });
    const Eigen::Vector2d rate =
        (8 * (at(rows[3], "seen") - at(rows[1], "seen")) - (at(rows[4], "seen") - at(rows[0], "seen"))) / 0.012;
    CHECK((rate - at(rows[2], "moving")).norm() < 1e-4 * rate.norm());
    CHECK((at(rows[4], "gone") - (at(rows[4], "seen") - at(rows[0], "seen"))).norm() < 1e-13);
  }
}
