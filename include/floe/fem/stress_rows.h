#pragma once
#include <array>
#include <span>
#include <vector>

#include "floe/fem/piece_rows.h"
#include "floe/fem/section_points.h"
#include "floe/fem/shell_samples.h"

namespace floe::fem {

/// Strains of a shell element as the mean of some of its samples, in common axes, for many displacements at once:
///
///   s = (e, kappa),   s_i = (L q)_i + sum of terms C_i a_p a_q,   a = G q
struct ShellRows {
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< body axes
  Eigen::Matrix3d axes;                          ///< x, y and the normal as columns in body axes
  SmallRows rows;                                ///< L (six rows), then G, on the dofs of the element's own corners
  struct Term {
    int p, q;  ///< rows of G
    std::array<double, 6> C;
  };
  std::vector<Term> terms;
};

/// @param samples  of the element (shell_samples)
/// @param chosen   their numbers
/// @param axis     the section's axis, or another one that the surface is not normal to, in body axes
/// @param corners  how many nodes the element has
ShellRows shell_rows(const std::vector<ShellSample>& samples, std::span<const std::size_t> chosen,
                     const Eigen::Vector3d& axis, int corners);

/// s of each column, 6 x T. @param values  rows times displacements
SmallRows shell_strains(const ShellRows& of, const Eigen::Ref<const SmallRows>& values);

/// The axis that components on a surface refer to: that of the section, else x of the mesh, or y where that is normal.
Eigen::Vector3d surface_axis(const ShellSection& section, const Eigen::Matrix3d& mesh_axes,
                             const Eigen::Vector3d& normal);

/// Strain at height z above the plane of the nodes, eps + z kappa, 3 x T.
SmallRows layer_strain(const ShellSection& section, double z, const Eigen::Ref<const SmallRows>& s);

/// Section forces of a beam at both ends, from the displacements of its nodes: what acts on the end from the part
/// beyond it, towards increasing x; N, Vy, Vz and T, My, Mz in the axes of the section as it rotates, about the node.
///
///   f = dU/dq of the element:  at its second end f_2, at its first -f_1
///
/// In the plane N, V and M alone. Distributed inertia and loads of the element are not seen: V is that of its middle.
class BeamForces {
 public:
  /// @param linear  of small deflections: without quadratic strains, in the axes of the undeformed element
  BeamForces(const Structure& structure, const Mesh::Cell& cell, bool linear = false);
  struct Ends {
    std::array<Eigen::Vector3d, 2> force, moment;
  };
  /// @param q  of the element's own nodes, body axes
  Ends operator()(const Eigen::VectorXd& q) const;

 private:
  ElementMaps maps_;
  std::array<Eigen::Matrix3d, 2> axes_;
  bool plane_, linear_, rotation_vectors_;
};

/// Normal stress in a section of a beam, least and greatest over its fibres. [Pa]
///
///   sigma = E (N / EA + y b_y + z b_z),   (M_y, -M_z) = [EIyz EIy; EIz EIyz] (b_y, b_z)   about the centroid
///
/// @param force, moment  as BeamForces has them
std::array<double, 2> fibre_stress(const Section& section, const StressPoints& points, const Eigen::Vector3d& force,
                                   const Eigen::Vector3d& moment);

/// Greatest shear stress of Saint-Venant's torsion in a section of a beam in space, (M_x - y_s V_z + z_s V_y) / W about
/// the shear centre; 0 where W is not known. [Pa]
double torsion_stress(const Section& section, const StressPoints& points, const Eigen::Vector3d& force,
                      const Eigen::Vector3d& moment);

}  // namespace floe::fem
