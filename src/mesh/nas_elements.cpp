#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "nas_reader.h"
#include "text.h"

namespace floe::mesh {
void read_grid(NasReader& r) {
  NasGrid grid{r.card.integer(0, "the grid's number"),
               r.card.integer(1, "axes (CP)", -1),
               r.card.integer(5, "axes (CD)", -1),
               {},
               {},
               r.where()};
  for (int i = 0; i < 3; ++i) grid.x[i] = r.card.real(2 + i, "a coordinate", 0);
  if (!r.card.card.blank(6)) grid.constrained = NasGrid::are_constrained(r.card.card.text(6));
  if (grid.constrained.value_or(false)) r.count_ignored("GRID PS");
  if (r.card.good()) r.model.grids.push_back(grid);
}

void read_axes(NasReader& r) {
  const std::string& name = r.card.card.name;
  const bool by_grids = name[4] == '1';
  for (std::size_t first = 0; first < (by_grids ? 8 : 1); first += 4) {
    if (first > 0 && r.card.card.blank(first)) break;
    const long long id = r.card.integer(first, "the number of the axes");
    NasAxes axes{name.back(), -1, {}, {}, r.where()};
    if (by_grids) {
      for (int i = 0; i < 3; ++i) axes.grids[i] = r.card.integer(first + 1 + i, "a grid");
    } else {
      axes.reference = std::max(0LL, r.card.integer(1, "axes (RID)", 0));
      for (int i = 0; i < 9; ++i) axes.points[i / 3][i % 3] = r.card.real(2 + i, "a coordinate", 0);
    }
    r.define(r.model.axes, id, axes, "axes");
  }
}

void read_shell(NasReader& r) {
  const bool four = r.card.card.name.starts_with("CQUAD");
  NasShell shell{
      r.card.integer(0, "the element's number"), 0, {-1, -1, -1, -1}, four ? 4 : 3, 0, -1, 0, {}, false, r.where()};
  shell.property = r.card.card.blank(1) ? shell.id : r.card.integer(1, "a property");
  for (int i = 0; i < shell.count; ++i) shell.nodes[i] = r.card.integer(2 + i, "a grid");
  const bool middles = r.card.card.name == "CQUAD8" || r.card.card.name == "CTRIA6";
  for (int i = 0; i < shell.count && middles; ++i)
    shell.quadratic = shell.quadratic || !r.card.card.blank(2 + shell.count + i);
  for (int i = 0; i < shell.count && shell.quadratic; ++i)
    shell.middles[i] = r.card.integer(2 + shell.count + i, "a grid between two corners");
  if (middles && !shell.quadratic)
    r.count_ignored("second order of " + r.card.card.name + " without grids between corners");
  const std::size_t after = !middles ? 2 + shell.count : four ? 14 : 8;
  if (r.card.is_integer(after))
    shell.axes = std::max(0LL, r.card.integer(after, "axes (MCID)", 0));
  else
    shell.angle = r.card.real(after, "an angle (THETA) or axes (MCID)", 0);
  shell.offset = r.card.real(after + 1, "an offset (ZOFFS)", 0);
  shell.ratio = r.card.integer(!middles ? 9 : four ? 16 : 13, "0 or 1 (TFLAG)", 0) == 1;
  for (int i = 0; i < shell.count; ++i) {
    if (r.card.card.blank(10 + i)) continue;
    shell.thicknesses[i] = r.card.real(10 + i, "a thickness");
    if (*shell.thicknesses[i] < 0) r.card.refuse(10 + i, "expects a thickness that is not negative");
  }
  if (r.card.good()) r.model.shells.push_back(shell);
}

namespace {

// X1, X2, X3 or G0 in fields 6 to 8 of a beam, or of the defaults for beams.
void read_orientation_of(NasFields& card, NasBeam& beam) {
  if (card.is_integer(4) && card.card.blank(5) && card.card.blank(6)) {
    beam.orientation_node = card.integer(4, "a grid (G0)");
    return;
  }
  for (int i = 0; i < 3; ++i) beam.orientation[i] = card.real(4 + i, "a component of the orientation vector", 0);
}

/// OFFT: three letters for the orientation vector (G: displacement axes of GA, B: basic) and the offsets of both ends
/// (G, or O: axes of the element); or the flag F of older decks (1: a vector, 2: a grid).
void read_axes_of(NasFields& card, const std::string& offt, const std::string& of, NasBeam& beam) {
  const auto flag = number<double>(offt);
  if (offt.empty() || (flag && (*flag == 0 || *flag == 1 || *flag == 2))) return;
  const auto one_of = [&](std::size_t i, const char* letters) {
    return std::string(letters).find(offt[i]) != std::string::npos;
  };
  if (offt.size() != 3 || !one_of(0, "GB") || !one_of(1, "GO") || !one_of(2, "GO"))
    return card.refuse(7,
                       "expects G or B, and twice G or O (OFFT: axes of the orientation vector and of the offsets), "
                       "as GGG; found " +
                           in_quotes(offt) + of);
  beam.in_basic = offt[0] == 'B';
  beam.own_axes = {offt[1] == 'O', offt[2] == 'O'};
}

/// PA or PB: digits from 1 to 6.
void read_pin_flags(NasFields& card, int end, NasBeam& beam) {
  const std::string_view flags = card.card.text(8 + end);
  if (flags.empty() || flags == "0") return;
  if (flags.find_first_not_of("123456") != std::string_view::npos)
    return card.refuse(8 + end, "expects pin flags from 1 to 6, found " + in_quotes(flags));
  for (const char digit : flags) beam.releases |= 1u << (6 * end + digit - '1');
}

}  // namespace

void read_beam(NasReader& r) {
  NasBeam beam{r.card.integer(0, "the element's number"), 0, {}, Eigen::Vector3d::Zero(), 0, {}, r.where()};
  const auto found = r.model.defaults.find(r.card.card.name == "CBAR" ? "BAROR" : "BEAMOR");
  const NasCard* otherwise = found == r.model.defaults.end() ? nullptr : &found->second;
  if (!r.card.card.blank(1))
    beam.property = r.card.integer(1, "a property");
  else if (otherwise && !otherwise->blank(1))
    beam.property = number<long long>(otherwise->text(1)).value_or(beam.id);
  else
    beam.property = beam.id;
  for (int i : {0, 1}) beam.nodes[i] = r.card.integer(2 + i, "a grid");
  const auto& card = r.card.card;
  if (card.blank(4) && card.blank(5) && card.blank(6) && otherwise) {
    NasFields fields(*otherwise, r.card.faults());
    read_orientation_of(fields, beam);
  } else {
    read_orientation_of(r.card, beam);
  }
  const bool own = !card.blank(7) || !otherwise;
  read_axes_of(r.card, upper(own ? card.text(7) : otherwise->text(7)), own ? "" : " of " + otherwise->name, beam);
  for (int end : {0, 1}) read_pin_flags(r.card, end, beam);
  for (int end : {0, 1})
    for (int i = 0; i < 3; ++i) beam.offsets[end][i] = r.card.real(10 + 3 * end + i, "an offset", 0);
  if (card.name == "CBEAM" && !(card.blank(16) && card.blank(17))) r.count_ignored("CBEAM SA, SB");
  if (beam.orientation_node == 0 && beam.orientation.isZero(0))
    r.card.refuse(4, "expects an orientation vector, or a grid (G0)");
  if (r.card.good()) r.model.beams.push_back(beam);
}

void read_conm2(NasReader& r) {
  NasMass found{r.card.integer(1, "a grid"),
                std::max(-1LL, r.card.integer(2, "axes (CID)", 0)),
                {},
                r.where(),
                fmt::format("CONM2 {}", r.card.integer(0, "the element's number", 0))};
  found.mass.mass = r.card.real(3, "a mass");
  if (r.card.good() && found.mass.mass < 0) r.card.refuse(3, "expects a mass that is not negative");
  for (int i = 0; i < 3; ++i) found.mass.offset[i] = r.card.real(4 + i, "an offset", 0);
  double inertia[6];  // 11 21 22 31 32 33
  for (int i = 0; i < 6; ++i) inertia[i] = r.card.real(8 + i, "a moment of inertia", 0);
  found.mass.inertia << inertia[0], -inertia[1], -inertia[3], -inertia[1], inertia[2], -inertia[4], -inertia[3],
      -inertia[4], inertia[5];
  if (r.card.good() && (found.mass.mass > 0 || !found.mass.inertia.isZero(0))) r.model.masses.push_back(found);
}

namespace {

/// Components, each once, ascending.
std::string components(std::string_view text) {
  std::string digits(text);
  std::sort(digits.begin(), digits.end());
  digits.erase(std::unique(digits.begin(), digits.end()), digits.end());
  return digits;
}

bool all_six(std::string_view text) { return components(text) == "123456"; }

/// The components of its dependent grids that a link constrains: at least all translations.
void read_constrained(NasFields& card, std::size_t field, NasLink& link) {
  const std::string found = components(card.card.text(field));
  if (found == "123456") return;
  link.constrains = found;
  if (!found.starts_with("123") || found.find_first_not_of("123456") != std::string::npos)
    card.refuse(field, "expects 123456, or 123: rigid links constrain all three translations; found " +
                           in_quotes(card.card.text(field)));
}

}  // namespace

void read_rbe2(NasReader& r) {
  const auto& card = r.card.card;
  NasLink link{r.card.integer(1, "the independent grid (GN)"), {}, r.where(), "RBE2 " + std::string(card.text(0))};
  read_constrained(r.card, 2, link);
  std::size_t last = card.fields.size();
  while (last > 3 && card.blank(last - 1)) --last;
  if (last > 4 && card.text(last - 1).find('.') != std::string_view::npos) --last;  // ALPHA
  for (std::size_t i = 3; i < last; ++i)
    if (!card.blank(i)) link.nodes.push_back(r.card.integer(i, "a dependent grid"));
  if (r.card.good()) r.model.links.push_back(link);
}

namespace {

/// What a place cannot have instead of the mean of its grids.
void refuse_mean(NasReader& r, std::size_t field, const std::string& expected) {
  r.card.refuse(field, "expects " + expected + ", found " + in_quotes(r.card.card.text(field)) +
                           ": a place is the mean of its grids; to leave the card out: file: {ignore: [RBE3]}");
}

/// Components that take part in a mean: all translations, perhaps with rotations, which are left out.
void check_components(NasReader& r, std::size_t field) {
  const std::string found = components(r.card.card.text(field));
  if (!found.starts_with("123") || found.find_first_not_of("123456") != std::string::npos)
    refuse_mean(r, field, "the components 123 of all grids");
  else if (found.size() > 3)
    r.count_ignored("RBE3 456 of the grids");
}

}  // namespace

// Weights (real numbers), each with the directions and the grids that follow it.
void read_rbe3(NasReader& r) {
  const auto& card = r.card.card;
  NasMean mean{r.card.integer(0, "the element's number"), r.card.integer(2, "the reference grid"), {}, r.where()};
  bool directions = false;  // the next number
  double weight = 1;
  for (std::size_t i = 4; i < card.fields.size(); ++i) {
    if (card.blank(i)) continue;
    const std::string word = upper(card.text(i));
    if (word == "UM" || word == "ALPHA") break;
    if (card.text(i).find('.') != std::string_view::npos) {
      directions = true;
      const double found = r.card.real(i, "a weight");
      if (r.card.good() && !(found > 0)) refuse_mean(r, i, "a weight greater than 0");
      weight = found;
    } else if (directions) {
      directions = false;
      check_components(r, i);
    } else {
      mean.nodes.push_back(r.card.integer(i, "a weight with its directions, or a grid"));
      mean.weights.push_back(weight);
    }
  }
  if (r.card.good() && mean.nodes.empty()) r.card.refuse_card("has no grids");
  if (r.card.good()) r.model.means.push_back(mean);
}

void read_rbar(NasReader& r) {
  const auto& card = r.card.card;
  const long long a = r.card.integer(1, "a grid (GA)"), b = r.card.integer(2, "a grid (GB)");
  const bool first = all_six(card.text(3)) && card.blank(4), second = all_six(card.text(4)) && card.blank(3);
  if (!first && !second) r.card.refuse(3, "and 6 expect 123456 for one end and nothing for the other (CNA, CNB)");
  NasLink link{first ? a : b, {first ? b : a}, r.where(), "RBAR " + std::string(card.text(0))};
  const std::string_view dependent = card.text(first ? 6 : 5);
  if (!dependent.empty() && dependent != "0") read_constrained(r.card, first ? 6 : 5, link);
  if (r.card.good()) r.model.links.push_back(link);
}

}  // namespace floe::mesh
