#pragma once
#include "campbell.h"

namespace floe::app {

/// A scene's model for steady rotations. Collective.
assembly::Model plan_rotation(const scene::Scene& scene, scene::Formulation formulation, MPI_Comm comm);

/// From the steady rotation at `from` to the vibrations at `point.speed`. @return  where the next search begins
double visit_speed(const solve::RotatingSystem& rotating, double from, int modes, Vec U, CampbellPoint& point);

/// The first steady rotation of the diagram at this speed; null: there is none.
const CampbellPoint* steady_at(const CampbellDiagram& diagram, double speed);

/// visit_speed() of another model of the scene from its start, through the speeds by which the diagram came to `last`.
/// @throws RunError  no steady rotation at one of these. Collective.
void follow(const solve::RotatingSystem& rotating, const CampbellDiagram& diagram, const CampbellPoint& last, int modes,
            Vec U, CampbellPoint& point);

/// A point of a diagram in another model.
struct OtherPoint {
  CampbellPoint point;  ///< its fault: why there are no vibrations
  PetscInt coordinates = 0;
};

/// follow() of the scene in a formulation, up to solve::largest_rotating_system unknowns. Collective.
OtherPoint in_other_model(const scene::Scene& scene, scene::Formulation formulation, int modes, const CampbellPoint& at,
                          MPI_Comm comm, const CampbellDiagram& diagram);

/// Whether what a reduced model says of the first unstable speed is so at full order of the same mesh: a
/// warning where it is not, or where this is not known.
void check_instability(const scene::Scene& scene, int modes, MPI_Comm comm, CampbellDiagram& diagram);

/// A warning where a frequency at a speed is further from that of geometrically exact beams and shells (cfr) on the
/// same mesh than 2.5 %, which 5 % of the stiffness make, and what the frequencies up to the next one differ at rest:
/// the error of the basis and of cfr's inertia. In the order of the frequencies. In space, where cfr
/// supports the scene with at most 300 unknowns; elsewhere nothing is checked.
void check_rotating_model(const scene::Scene& scene, double speed, int modes, MPI_Comm comm, CampbellDiagram& diagram);

}  // namespace floe::app
