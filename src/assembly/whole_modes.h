#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "floe/assembly/reduce_bodies.h"
#include "floe/dynamics/coordinates.h"
#include "floe/plan/whole_modes.h"
#include "floe/reference/full_order.h"

namespace floe::assembly {

/// Modal damping of the plan's bodies in several frames: modes of each as one, as its joints hold it. Collective.
/// @throws RunError  nodes at one place, which pieces and the whole do not distinguish
std::vector<WholeModes> modes_of_wholes(const Plan& plan);

/// Where the unknowns of a piece are: reduced, its elastic coordinates; at full order, its nodes.
struct PieceUnknowns {
  const ReducedBody* reduced = nullptr;
  int elastic = -1;  ///< local index of the first
  const reference::NodeCoordinates* nodes = nullptr;
  const fem::Conditions* constrained = nullptr;
};

/// The modal damping of one body in several frames in a model.
class WholeDamping {
 public:
  /// At full order y_i are unknowns of their own, with as many multipliers. @param full  whether the model is of full
  /// order
  WholeDamping(const Plan& plan, const WholeModes& modes, bool full, dynamics::Coordinates& coordinates);
  /// Its terms. @param owner  whether this rank has what ranks share. Collective.
  std::vector<std::unique_ptr<dynamics::Term>> terms(const std::function<PieceUnknowns(int)>& piece, bool owner) const;
  /// y and its rate from the deformations at the start. Collective.
  void set_start(const dynamics::Coordinates& coordinates, bool owner, Vec U, Vec V) const;

 private:
  const Plan& plan_;
  const WholeModes& modes_;
  int y_ = -1, multipliers_ = -1;
};

}  // namespace floe::assembly
