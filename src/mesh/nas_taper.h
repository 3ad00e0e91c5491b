#pragma once
#include <functional>

#include "nas_reading.h"

namespace floe::mesh {

/// What a section has along a beam with taper: values at stations, linear between them.
class NasTaper {
 public:
  explicit NasTaper(std::vector<double> at_a) : stations_{{0, {at_a.begin(), at_a.end()}}} {}

  /// A station at x of the length, whose values may be missing: those of end A at end B (x = 1), else between its ends.
  void add(double x, std::vector<std::optional<double>> values) { stations_.push_back({x, std::move(values)}); }

  /// Fills what is missing; a fault where the stations do not end at 1, or two coincide.
  void complete(NasFields& card);

  /// Whether a value differs from end A.
  bool varies() const;

  std::vector<double> at(double x) const;

  /// The property's pieces of equal length, each with the section in its middle: `take` makes it of the values.
  void divide(NasBeamProperty& property,
              const std::function<void(const std::vector<double>&, NasBeamProperty&)>& take) const;

 private:
  struct Station {
    double x;
    std::vector<std::optional<double>> values;
  };
  std::vector<Station> stations_;  // by x, from end A
};

}  // namespace floe::mesh
