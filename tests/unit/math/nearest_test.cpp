#include "floe/math/nearest.h"

#include <catch2/catch.hpp>

using floe::math::nearest;

TEST_CASE("the nearest word is the one with the least edit distance") {
  const std::vector<std::string> known{"elements", "from", "to", "tolerance", "spectral_radius"};
  CHECK(nearest("elments", known) == "elements");          // a letter missing
  CHECK(nearest("fromm", known) == "from");                // one too many
  CHECK(nearest("form", known) == "from");                 // two swapped
  CHECK(nearest("Tolerance", known) == "tolerance");       // case
  CHECK(nearest("spectral", known) == "spectral_radius");  // the beginning
  const std::vector<std::string> quantities{"stress", "principal_stress", "von_mises_stress"};
  CHECK(nearest("vonmises", quantities) == "von_mises_stress");
  CHECK(nearest("mises", quantities) == "von_mises_stress");              // a part of it
  CHECK(nearest("rane", {"membrane_force", "membrane_strain"}).empty());  // a part of several
}

TEST_CASE("nothing is near what is far") {
  const std::vector<std::string> known{"E", "rho", "colour"};
  CHECK(nearest("x", known).empty());
  CHECK(nearest("density", known).empty());
  CHECK(nearest("", known).empty());
  CHECK(nearest("rho", {}).empty());
  CHECK(nearest(std::string(100000, 'r'), known).empty());
  CHECK(nearest("e", known) == "E");
}
