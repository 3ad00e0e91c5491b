#include "floe/assess/probe_errors.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "floe/assess/budget.h"

using namespace floe::assembly;
using namespace floe::assess;

namespace {

const std::vector<ProbeColumn> columns = {{"tip.x", "m", 10},
                                          {"tip.y", "m", 10},
                                          {"middle.angle", "rad", 1},
                                          {"tip_speed.x", "m/s", 10, ProbeColumn::Kind::rate}};

}  // namespace

TEST_CASE("errors of probes: root mean squares of vectors, relative to what they are of") {
  ProbeErrors errors(columns);
  errors.add({0.3, 0.4, 0.01, 0}, {3, 4, 0.1, 5});
  errors.add({0, 0, 0, 0}, {4, 3, 0.1, -5});
  const std::vector<double> relative = errors.relative(2);
  REQUIRE(relative.size() == 3);
  CHECK(relative[0] == Approx(std::sqrt(0.5 * 0.25) / 5));
  CHECK(relative[1] == Approx(std::sqrt(0.5 * 1e-4) / 0.1));
  CHECK(relative[2] == 0);
}

TEST_CASE("errors of probes that symmetry holds are of no account, others that move little are seen") {
  const auto of = [](double size, double error) {
    ProbeErrors errors(columns);
    errors.add({1e-6, 0, error, 0}, {1e-3, 0, size, 0});  // moves by 1e-4 of the extent
    return errors.relative(2)[1];
  };
  CHECK(of(1e-16, 1e-14) < 1e-2);
  CHECK(of(0, 1e-14) < 1e-2);
  CHECK(of(1e-9, 5e-11) == Approx(0.05));
  CHECK(of(0, 1e-9) == Approx(10));  // it stands still, and should not move
}

TEST_CASE("sizes that errors refer to: what goes far asks no more than what goes as far as the scene is long") {
  const std::vector<double> still = reference_sizes(columns, {0, 0, 0}, 2);
  CHECK(still[0] == Approx(1e-9));
  CHECK(still[1] == Approx(1e-10));
  CHECK(still[2] == Approx(1e-10 * 10 / 2));
  const std::vector<double> rotated = reference_sizes(columns, {0, 6000, 0}, 2);
  CHECK(rotated[0] == Approx(1e-6));
  CHECK(rotated[1] == 6000);
  CHECK(rotated[2] == Approx(1e-7 * 10 / 2));
  CHECK(reference_sizes(columns, {0, 0, 70}, 2) == std::vector<double>{still[0], still[1], 70});
}

TEST_CASE("accelerations of a body at rest that are zero up to round-off are of no account") {
  const std::vector<ProbeColumn> at_rest = {{"tip.x", "m", 2},
                                            {"shock.x", "m/s^2", 2, ProbeColumn::Kind::acceleration}};
  const std::vector<double> sizes = reference_sizes(at_rest, {0.1, 1e-12}, 0.5);
  CHECK(sizes[1] == Approx(1e-7 * 0.05 * 2 / 0.25));
  CHECK(reference_sizes(at_rest, {0.1, 9.8}, 0.5)[1] == 9.8);
}

TEST_CASE("errors of probes that are no numbers stay none") {
  ProbeErrors errors(columns);
  errors.add({std::numeric_limits<double>::quiet_NaN(), 0, 0, 0}, {1, 0, 0, 0});
  CHECK(std::isnan(errors.relative(1)[0]));
  CHECK(ProbeErrors({}).relative(1).empty());
}

TEST_CASE("errors of forces that are zero up to round-off are of no account") {
  const std::vector<ProbeColumn> loads = {{"root.x", "N", 200, ProbeColumn::Kind::load},
                                          {"clamp.z", "N m", 400, ProbeColumn::Kind::load}};
  const auto of = [&](double size, double error) {
    ProbeErrors errors(loads);
    errors.add({error, 0}, {size, 0});
    return errors.relative(1)[0];
  };
  CHECK(of(1e-12, 1e-10) < 1e-4);  // also where no other force is measured
  CHECK(of(0, 1e-6) == Approx(1e-6 / 2e-5));
  CHECK(of(0.1, 1e-3) == Approx(0.01));
  CHECK(reference_sizes(loads, {0, 5e4}, 1)[0] == Approx(1e-7 * 125 * 200));
}

TEST_CASE("errors of formulas refer to those of the same unit") {
  using Kind = ProbeColumn::Kind;
  const std::vector<ProbeColumn> formulas = {{"power.value", "W", 1, Kind::formula},
                                             {"error.value", "rad", 1, Kind::formula},
                                             {"other.value", "rad", 1, Kind::formula},
                                             {"plain.value", "", 1, Kind::formula}};
  const std::vector<double> sizes = reference_sizes(formulas, {2e6, 5e-3, 1e-12, 1e-3}, 1);
  CHECK(sizes[0] == 2e6);
  CHECK(sizes[1] == 5e-3);  // 1e-7 of the power would be 0.2
  CHECK(sizes[2] == Approx(5e-10));
  CHECK(sizes[3] == 1e-3);
}

TEST_CASE("a part that covers only a beginning says nothing of probes that move later") {
  ProbeSeries own;
  own.columns = {{"tip.x", "m", 10}, {"tip.y", "m", 10}, {"middle.angle", "rad", 1}};
  for (int i = 0; i <= 10; ++i) own.t.push_back(0.1 * i), own.values.push_back({1, i < 6 ? 0. : 1., 0.1 * i});
  ErrorPart part;
  part.none.clear();
  part.probes = {0, 0.02}, part.until = 0.5;
  leave_out_quiet(own, part);
  CHECK(std::isnan(part.probes[0]));
  CHECK(part.probes[1] == 0.02);
  REQUIRE(part.notes.size() == 1);
  CHECK_THAT(part.notes[0], Catch::Contains("tip moves later than t = 0.5 s"));
  for (const double until : {0.6, 1.}) {  // it moves, or all of the motion is covered
    ErrorPart more;
    more.probes = {0.01, 0.02}, more.until = until;
    leave_out_quiet(own, more);
    CHECK(more.probes == std::vector<double>{0.01, 0.02});
    CHECK(more.notes.empty());
  }
}
