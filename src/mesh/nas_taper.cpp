#include "nas_taper.h"

#include <algorithm>

#include "nas_shapes.h"

namespace floe::mesh {
namespace {

// Each piece is uniform: the error of a frequency goes with the square of a piece's length.
constexpr int pieces_between_two = 4, pieces_with_more = 8;

}  // namespace

void NasTaper::complete(NasFields& card) {
  std::stable_sort(stations_.begin(), stations_.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
  if (stations_.front().x < 0) return card.refuse_card("expects stations (X/XB) between 0 and 1");
  for (std::size_t i = 1; i < stations_.size(); ++i)
    if (!(stations_[i].x > stations_[i - 1].x && stations_[i].x <= 1))
      return card.refuse_card("expects stations (X/XB) between 0 and 1, all different");
  if (stations_.size() == 1) return;
  if (stations_.back().x != 1) return card.refuse_card("expects a station at end B (X/XB = 1)");
  Station &a = stations_.front(), &b = stations_.back();
  for (std::size_t k = 0; k < a.values.size(); ++k) {
    if (!b.values[k]) b.values[k] = a.values[k];
    for (Station& s : stations_)
      if (!s.values[k]) s.values[k] = *a.values[k] + s.x * (*b.values[k] - *a.values[k]);
  }
}

bool NasTaper::varies() const {
  const Station& a = stations_.front();
  return std::any_of(stations_.begin(), stations_.end(), [&](const Station& s) {
    for (std::size_t k = 0; k < a.values.size(); ++k)
      if (!equal_lengths(*s.values[k], *a.values[k])) return true;
    return false;
  });
}

std::vector<double> NasTaper::at(double x) const {
  std::size_t next = 1;
  while (next + 1 < stations_.size() && stations_[next].x < x) ++next;
  const Station &from = stations_[next - 1], &to = stations_[next];
  const double share = (x - from.x) / (to.x - from.x);
  std::vector<double> values;
  for (std::size_t k = 0; k < from.values.size(); ++k)
    values.push_back(*from.values[k] + share * (*to.values[k] - *from.values[k]));
  return values;
}

void NasTaper::divide(NasBeamProperty& property,
                      const std::function<void(const std::vector<double>&, NasBeamProperty&)>& take) const {
  const int count = stations_.size() > 2 ? pieces_with_more : pieces_between_two;
  const NasBeamProperty whole = property;
  for (int i = 0; i < count; ++i) {
    take(at((i + 0.5) / count), property.pieces.emplace_back(whole));
    property.pieces.back().section.shear_factors = whole.section.shear_factors;
  }
}

}  // namespace floe::mesh
