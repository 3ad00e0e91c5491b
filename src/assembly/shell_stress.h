#pragma once
#include <array>
#include <memory>
#include <vector>

#include "floe/fem/shell_samples.h"
#include "floe/plan/prepare.h"
#include "floe/reduction/basis.h"
#include "floe/reference/corotational_element.h"

namespace floe::assembly {
using namespace plan;

/// Stresses or resultants of a shell at a node, as a quadratic function of coordinates: what this rank has of it.
///
///   s_r = sum over shares of L_r q + 1/2 q' Q_r q,   r = xx, yy, xy
struct ShellPoint {
  struct Share {
    std::vector<int> coordinates;
    Eigen::MatrixXd L;                 ///< 3 x coordinates
    std::array<Eigen::MatrixXd, 3> Q;  ///< coordinates x coordinates
    /// Corotational: its deformations stand for q.
    std::shared_ptr<const reference::CorotationalElement> element = {};
  };
  std::vector<Share> shares;
  Eigen::Vector3d value(double t, const Eigen::VectorXd& q) const;
};

/// A sample of a shell element near the node, and what it adds to the value there.
struct PatchSample {
  int cell;                          ///< of this rank
  std::size_t number;                ///< among fem::shell_samples of the cell
  Eigen::Matrix<double, 3, 6> from;  ///< s_r of the strains (e, kappa)
};

/// Samples of the elements around the node whose stresses, fitted by a polynomial of second order (where they are few,
/// first), give those at the node: recovery from superconvergent points.
///
/// Elements count to the second ring around the node (on edges the third), of the part and on the smooth surface of the
/// one element that leads `toward`, or of any.
/// @param place  one node
/// @throws InputError  no shell there; a fold, or parts that meet there, and no `toward`; stresses of a section whose
/// layers are not known. Collective.
/// Source: Zienkiewicz & Zhu 1992 (superconvergent patch recovery).
std::vector<PatchSample> patch_samples(const Plan& plan, std::size_t probe);

/// Share of a sample on dofs: those of its element's corners q_c = T q.
ShellPoint::Share share_of(const fem::ShellSample& sample, const PatchSample& in_patch, const Eigen::MatrixXd& T);

/// The sum over ranks of shares on the coordinates of a reduced body. Collective; replicated.
ShellPoint::Share reduced_share(const PlannedBody& body, const reduction::Basis& basis,
                                const std::vector<PatchSample>& patch, std::vector<int> coordinates);

}  // namespace floe::assembly
