#pragma once
#include <Eigen/Dense>
#include <vector>

namespace floe::fem::quadratic {

using Point = Eigen::Vector2d;  ///< (r, s): [-1, 1]^2, or the triangle r, s, 1 - r - s >= 0

struct WeightedPoint {
  Point at;
  double weight;
};

/// Where the shear is taken: a component `along` of the covariant shear, the mean of one point or two.
struct Tie {
  Point along;
  std::vector<Point> at;
};

/// Shape functions of six or eight nodes, with the rules that go with them.
struct Shape {
  Eigen::VectorXd (*values)(const Point& at);
  Eigen::Matrix2Xd (*gradients)(const Point& at);  ///< d/dr, d/ds
  std::vector<Point> nodes;
  std::vector<WeightedPoint> strains, masses;  ///< the shear is integrated by the points of the masses
  std::vector<Tie> ties;
  Eigen::MatrixXd from_ties;  ///< coefficients of the shear's functions from its ties
  /// Of a triangle, whose from_ties is the linear shear of the edges: by what the ties inside differ from it, and the
  /// coefficients of functions that are that there and have no component along the edges. Of a quadrilateral empty.
  Eigen::MatrixXd inside, from_inside;
  /// Of a triangle, where the membrane strain along r, s and s - r is taken, at three points each. Of a quadrilateral
  /// none: it is taken at `strains`.
  std::vector<Tie> membrane;
  static Point bubble_gradient(const Point& at);    ///< of 27 r s (1 - r - s), one at the centroid
  Eigen::Matrix2Xd (*shears)(const Point& at);      ///< the shear's functions
  std::vector<std::vector<WeightedPoint>> of_node;  ///< points of what is nearest to each node
};

/// @param nodes  6 or 8
const Shape& shape_of(std::size_t nodes);

}  // namespace floe::fem::quadratic
