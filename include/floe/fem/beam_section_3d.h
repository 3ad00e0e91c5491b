#pragma once
#include <Eigen/Dense>
#include <limits>

namespace floe::fem {

/// Geometry of a beam's section in its own axes (y, z) through the centroid.
///
///   Iy = int z^2,  Iz = int y^2,  Iyz = int y z  [m4]  (Iyz positive where the area lies in the first and third
///   quadrant)
struct SectionShape {
  double A = 0, Iy = 0, Iz = 0, Iyz = 0;
  double J = 0;                                            ///< Saint-Venant torsion constant [m4]
  Eigen::Vector2d shear_centre = Eigen::Vector2d::Zero();  ///< [y, z] from the centroid [m]
  double W = 0;  ///< of Saint-Venant torsion: greatest shear stress tau = T / W [m3]; 0: not known
};

/// Width along y, height along z, all > 0 [m]; else, or with walls that leave no section, floe::InputError.
///
/// J of a rectangle, a >= b:  a b^3 [1/3 - (64/pi^5) (b/a) sum_(n odd) tanh(n pi a / 2b) / n^5], summed to rounding.
/// W of a rectangle:       J / (b [1 - (8/pi^2) sum_(n odd) 1 / (n^2 cosh(n pi a / 2b))]), in the middle of its long
/// side. Source: Timoshenko & Goodier, Theory of elasticity, 3rd ed., art. 109.
SectionShape rectangle(double width, double height);
SectionShape circle(double radius);                           ///< full
SectionShape tube(double outer_radius, double inner_radius);  ///< of any wall

/// Rectangular hollow section with sharp corners; `side` is the thickness of the walls along z, `cover` of those along
/// y. J = 4 Am^2 / (sum s/t) over the walls' middle lines (Bredt's second formula: thin walls).
SectionShape box(double width, double height, double side, double cover);

/// I section, web along z, without fillets. J = (2 b t^3 + (h - t) w^3) / 3.
/// Source: Canadian Institute of Steel Construction, Torsional section properties of steel shapes, 2002.
SectionShape i_section(double width, double height, double flange, double web);

/// The same section rotated by `angle` [rad] about x, from y towards z: principal moments (Iyz = 0) given with the
/// angle of their first axis.
SectionShape rotated(const SectionShape& shape, double angle);

/// Young's modulus and shear modulus [Pa], density [kg/m3].
struct BeamMaterial {
  double E = 0, G = 0, rho = 0;
};

/// G = E / (2 (1 + nu)). @throws floe::InputError unless -1 < nu <= 0.5
double shear_modulus(double E, double nu);

/// What a spatial beam element needs, per unit length, in element axes (x along the beam).
///
/// Second moments are about the centroid; polar rotary inertia is rhoIy + rhoIz, because all inertia comes from the
/// same material points. Mass is centred at the centroid.
struct SpatialBeamSection {
  double EA = 0, EIy = 0, EIz = 0, EIyz = 0, GJ = 0;       ///< [N], [N m2]
  double rhoA = 0, rhoIy = 0, rhoIz = 0, rhoIyz = 0;       ///< [kg/m], [kg m]
  Eigen::Vector2d centroid = Eigen::Vector2d::Zero();      ///< [y, z] from the line between the nodes [m]
  Eigen::Vector2d shear_centre = Eigen::Vector2d::Zero();  ///< [y, z] from the line between the nodes [m]
  /// Shear stiffness kappa G A along [y, z] [N]; infinite: sections stay normal to the line (Euler-Bernoulli).
  Eigen::Vector2d GA = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());

  bool shears() const { return GA.minCoeff() < std::numeric_limits<double>::infinity(); }
};

/// @param centroid  [y, z] of the centroid from the line between the nodes
/// @throws floe::InputError  moduli or shape not admissible (see check)
SpatialBeamSection spatial_section(const SectionShape& shape, const BeamMaterial& material,
                                   const Eigen::Vector2d& centroid = Eigen::Vector2d::Zero());

/// @throws floe::InputError  EA or GA <= 0, a negative stiffness or mass, EIyz^2 > EIy EIz, rotary inertia without
/// mass, or a
///                           value that is not finite. Zero bending or torsional stiffness is admitted.
void check(const SpatialBeamSection& section);

}  // namespace floe::fem
