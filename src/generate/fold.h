#pragma once
#include <map>

#include "plate.h"

namespace floe::generate {

/// Corner points and edges that plates have in common, and the numbers of nodes that follow.
///
/// Plate by plate: corners, then edges, then the inside, each where it is first met.
class Fold {
 public:
  /// @param plates  each checked
  /// @throws InputError  plates that do not fit
  explicit Fold(const std::vector<NamedPlate>& plates);

  PetscInt nodes() const { return nodes_; }
  PetscInt cells() const { return first_cell_.back(); }
  PetscInt number(int plate, GridNode node) const;
  Eigen::Vector3d position(PetscInt number) const;
  Cell cell(PetscInt number) const;

 private:
  struct Point {
    Eigen::Vector3d at;
    int plate;  // that met it first
    PetscInt number;
  };
  struct Edge {
    int from, to;  // points; the direction is that of the plate and side that met it first
    int plate;
    PetscInt elements, first;
    double grading;
  };
  struct Side {
    int edge;
    bool reversed;
  };
  struct Fitted {
    std::array<int, 4> corners;  // points
    std::array<Side, 4> sides;
    PetscInt first;  // node inside
  };
  // Consecutive nodes: a corner, what lies inside a side, or inside the plate that met them first.
  struct Run {
    PetscInt first;
    int plate, corner, side;  // corner and side are -1 where it is none
  };

  void add(Run run, PetscInt count);
  int point_of(int plate, int corner, double tolerance);
  Side side_of(int plate, int side, const std::array<int, 4>& corners);
  void refuse_unequal(const Edge& edge, const Edge& other) const;
  void refuse_repeated() const;
  void refuse_corners_inside_edges(double tolerance) const;

  const std::vector<NamedPlate>& plates_;
  std::vector<Point> points_;
  std::vector<Edge> edges_;
  std::map<std::array<int, 2>, int> edge_of_;  // by points, the lesser first
  std::vector<Fitted> fitted_;
  std::vector<Run> runs_;
  std::vector<PetscInt> first_cell_;
  PetscInt nodes_ = 0;
};

}  // namespace floe::generate
