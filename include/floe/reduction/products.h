#pragma once
#include <vector>

#include "floe/body/flexible_body.h"

namespace floe::reduction {

/// The elastic energy of a body with fewer products q_a q_b and fewer squares: F of 1/2 |F z|^2 with fewer columns and
/// rows.
///
/// Products with a modal derivative are of third and fourth order in the amplitudes of the modes, and most of them move
/// the body by nothing that counts. Those of two modes stay, however little they do by themselves: by them a force
/// along the body stiffens it (spin-up). The measure are deformations sampled at random, the same in every run: modes
/// and attachment modes with amplitudes 1/K_ii (the response to forces of one size) or 1/sqrt(K_ii) (of one energy), 5
/// % of the body's length sqrt(12) (radius of gyration) in the root mean square of its mass; and what follows them by
///
///   q_d = -K_dd^-1 f_d,   f the force of second order.
///
/// There a product exerts f_p = (ds_p/dq)' F_p'y + T'F_p s_p, y = F z, T = F dz/dq, and so moves the body by
/// K_T^-1 f_p, K_T = K_b + T'T. From the least on, products are omitted as long as all of them move it by at most
/// `share` of its displacement (root mean squares over mass and samples); then likewise squares, which are taken in the
/// main directions of the products' energy beyond the span of the linear columns. What remains is a sum of squares:
/// never negative, with the same linear part to round-off.
///
/// @param follows  of each coordinate whether it is a derivative's; if none is, all products stay
/// @param share    > 0; of the two cuts each
/// Rank-local: the same on every rank where the body is. Cost O(samples r p k), r x (k + p) the size of F.
body::Elasticity with_fewer_products(const body::FlexibleBody& body, const std::vector<char>& follows, double share);

/// The sampled deformations, [modes and what follows them]; none: the body has no derivatives, or no elastic energy.
std::vector<Eigen::VectorXd> sampled_deformations(const body::FlexibleBody& body, const std::vector<char>& follows);

}  // namespace floe::reduction
