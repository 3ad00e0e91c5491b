// Rigid links of decks that act at an arm across a beam.
#include <catch2/catch.hpp>

#include "spatial_scenes.h"

using namespace floe;
using namespace floe::test;

namespace {

/// A blade of 1 m along x with a node 0.1 m above its end, by a rigid link whose independent node this is, or the end.
std::string armed_deck(int elements, bool end_independent = false) {
  std::string text = "BEGIN BULK\nMAT1,1,7.+10,,0.,2700.\nPBAR,2,1,8.-4,2.66667-6,1.06667-9,4.-9\n";
  for (int i = 0; i <= elements; ++i) text += fmt::format("GRID,{},,{:.6f},0.,0.\n", i + 1, double(i) / elements);
  for (int i = 1; i <= elements; ++i) text += fmt::format("CBAR,{0},2,{0},{1},0.,1.,0.\n", i, i + 1);
  const int end = elements + 1;
  return text + fmt::format("GRID,999,,1.,0.,0.1\nRBE2,77,{},123456,{}\nENDDATA\n", end_independent ? end : 999,
                            end_independent ? 999 : end);
}

}  // namespace

// The moment of a force at the arm against its tension: the end rotates by M/sqrt(N EI) tanh(L sqrt(N/EI)), M = N h cos
// t, while rotations t are small; of a long beam 2 sin(t/2) is in place of t (the energy of the elastica). An element
// at an arm of the node that leads it resisted the rotation, with shorter elements more, and M was N h.
TEST_CASE("rigid links: an arm across a beam does not stiffen it, whatever the elements") {
  const Scratch scratch;
  const int elements = GENERATE(12, 96);
  const std::string deck = (scratch.path / "armed.bdf").string();
  write_text(deck, armed_deck(elements));
  struct Case {
    double N;
    Formulation formulation;
  };
  const double EI = 7e10 * 1.06667e-9;
  for (const auto& [N, formulation] :
       {Case{60, Formulation::nlffr}, Case{60, Formulation::cfr}, Case{60, Formulation::vm_md},
        Case{1000, Formulation::nlffr}, Case{1000, Formulation::cfr}}) {
    INFO(scene::name_of(formulation) << " " << elements << " " << N);
    const double by_moment = 0.1 * std::sqrt(N / EI) * std::tanh(std::sqrt(N / EI));
    double expected = 0;
    for (int i = 0; i < 50; ++i) expected = 2 * std::asin(by_moment * std::cos(expected) / 2);
    const History at = rest(fill(R"yaml(
bodies: {b: {mesh: {file: {path: $deck}}, reduction: {modes: 8, attachment: all}}}
joints: {root: {type: fixed, between: [ground, {body: b, node: [0, 0, 0]}]}}
loads: {pull: {type: force, at: {body: b, node: [1, 0, 0.1]}, force: [$N, 0, 0]}}
motion: {end: 1, step: 1}
probes: {end: {at: {body: b, node: [1, 0, 0]}, quantity: rotation}}
)yaml",
                                 {{"deck", deck}, {"N", number(N)}}),
                            formulation);
    CHECK(at["end.ry"].back() == Approx(expected).epsilon(N < 100 ? 5e-3 : 1e-2));
  }
}

// Whichever of the two nodes is the independent one: the one without elements is of the piece that has the other.
TEST_CASE("rigid links: an arm at a body of several frames") {
  const Scratch scratch;
  const bool end_independent = GENERATE(false, true);
  const std::string deck = (scratch.path / "armed.bdf").string();
  write_text(deck, armed_deck(12, end_independent));
  std::vector<double> ends;
  for (const char* frames : {"1", "2"})
    ends.push_back(rest(fill(R"yaml(
bodies: {b: {mesh: {file: {path: $deck}}, frames: $frames}}
joints: {root: {type: fixed, between: [ground, {body: b, node: [0, 0, 0]}]}}
loads: {pull: {type: force, at: {body: b, node: [1, 0, 0.1]}, force: [1, 2, 0]}}
motion: {end: 1, step: 1}
probes: {end: {at: {body: b, node: [1, 0, 0]}, quantity: rotation}}
)yaml",
                             {{"deck", deck}, {"frames", frames}}),
                        Formulation::nlffr)["end.ry"]
                       .back());
  CHECK(ends[0] > 1e-3);
  CHECK(ends[1] == Approx(ends[0]).epsilon(1e-3));
}
