#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "readers.h"

namespace floe::scene {

std::vector<std::string> shape_keys(const std::string& shape) {
  if (shape == "rectangle") return {"shape", "width", "height"};
  if (shape == "circle") return {"shape", "radius"};
  if (shape == "tube") return {"shape", "radius", "wall"};
  if (shape == "box") return {"shape", "width", "height", "wall"};
  return {"shape", "width", "height", "flange", "wall"};
}

fem::SectionShape read_shape(Document& document, Reading& reading) {
  const auto measure = [&](const char* key) {
    const auto number = reading.optional_number(key);
    if (!number) document.fault(reading.where(key), "is missing", describe(reading.key(key)));
    return number.value_or(NAN);
  };
  const std::string shape = reading.choice("shape");
  if (shape == "rectangle") return fem::rectangle(measure("width"), measure("height"));
  if (shape == "circle") return fem::circle(measure("radius"));
  if (shape == "tube") {
    const double radius = measure("radius");
    return fem::tube(radius, radius - measure("wall"));
  }
  const double width = measure("width"), height = measure("height"), wall = measure("wall");
  return shape == "box" ? fem::box(width, height, wall, wall) : fem::i_section(width, height, measure("flange"), wall);
}

void refuse_keys_but(Document& document, const Reading& reading, const std::vector<Key>& all,
                     const std::vector<std::string>& keys, const std::string& of) {
  for (const Key& key : all)
    if (reading.given(key.name) && std::count(keys.begin(), keys.end(), key.name) == 0)
      document.fault(reading.where(key.name), "does not apply to " + of,
                     fmt::format("one of {}", fmt::join(keys, ", ")));
}

}  // namespace floe::scene
