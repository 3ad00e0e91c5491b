#pragma once
#include <memory>

#include "floe/body/flexible_body.h"
#include "floe/reduction/basis.h"
#include "floe/reduction/statics.h"

namespace floe::reduction {

/// Static displacements W beyond the basis over which an energy is condensed, and those of the minimum at V q, which
/// are V on_V s + W on_W s, s the products of the pairs.
struct Relief {
  std::shared_ptr<const Columns> W;        ///< null: none
  std::vector<std::pair<int, int>> pairs;  ///< a <= b
  Eigen::MatrixXd on_V, on_W;              ///< columns of V x pairs, of W x pairs
};

/// The static displacements W of `condensed`, of bodies of shells and spatial beams with strains of second order, on
/// basis vectors for at most nine tenths of their dofs; of others none.
///
/// @param follows  of each coordinate whether it is a derivative's; if none is, there is no W
/// Collective. Some 32 solves with the factor of `statics`.
Columns relief(const fem::Structure& structure, const Basis& basis, const Statics& statics,
               const body::FlexibleBody& body, const std::vector<char>& follows);

/// Those of the products of deformations V q and other fields, one for each pair.
/// Collective. As many solves.
Columns relief(const fem::Structure& structure, const Basis& basis, const Statics& statics,
               const std::vector<Eigen::VectorXd>& deformations, const Columns& fields);

/// The elastic energy of a body whose strains of third order are condensed statically.
///
/// On modes phi and derivatives theta, of amplitudes q_a and q_d ~ q_a^2, the strain has parts of first, second and
/// third order, L phi q_a; L theta q_d + 1/2 e(phi, phi) q_a^2; e(phi, theta) q_a q_d. The displacement of second order
/// makes the second part small where the body can bend without stretching or shearing. The third part has no such
/// displacement in the basis: with stiff membranes or shear it costs EA e(phi, theta)^2 q^6 that the body avoids, and
/// the reduced body locks where its slopes are 0.1 to 0.3. In beams of two nodes with slopes of rotated nodes it is the
/// third-order difference of these to the deflection in between, of weight 12 EI / h^2. The displacement of third order
/// is small, the energy that its absence costs is not. So the energy becomes its minimum over static displacements W
/// beyond the basis: the strain of every product loses the part that these can cancel,
///
///   min_w 1/2 |L (V q + W w) + e(q, q)|^2 :   e  <-  e - P e,   P the projector on the strains of W,  V'K W = 0,
///   K w_n = -sum_g w_g L'D e(u_n, v_n)   at sampled deformations, u_n of modes, v_n of derivatives (products.h)
///
/// The energy stays a sum of squares and is never greater than before; as V'K W = 0, its linear part and the stiffness
/// by stresses of first order stay. Where the derivatives are static, theta = -K^-1 L'D e, of all pairs of modes, and
/// the body is straight or flat, products of modes have no part P and all terms up to the fifth order in q_a remain
/// (2n + 1 theorem). Pairs without derivative, and curved bodies, whose e(phi, phi) has a part on L phi, change from
/// the fourth order on, towards the energy with all derivatives. Loads and joints do no work on W: what they exert on
/// the sampled deformations' higher orders alone is not represented. All products lose P e: modes and attachment modes
/// also have amplitudes of second and third order, and their strains cancel a part of those of derivatives; if products
/// with derivatives alone lost it, |P e|^2 of the others would remain as stiffness.
///
/// Bending becomes one of the squares (F).
///
/// @param relief  W: none: the elasticity returns as it is; receives the displacements of the minimum
/// Collective. The factor F once more with as many columns besides.
body::Elasticity condensed(const fem::Structure& structure, const Basis& basis, const body::Elasticity& elasticity,
                           Relief& relief);

/// field += the displacement of the minimum at V q. Collective.
void add_relief(const Basis& basis, const Relief& relief, const Eigen::VectorXd& q, Vec field);

}  // namespace floe::reduction
