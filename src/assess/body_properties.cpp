#include "floe/assess/body_properties.h"

#include "floe/assembly/body_stage.h"
#include "floe/plan/interface.h"
#include "floe/plan/mesh_copy.h"

namespace floe::assess {
using namespace assembly;

namespace {

/// From int rho, int rho x and int rho x x' about the frame's origin, in the axes that `frame` gives.
void set_mass(const body::Inertia& inertia, const Eigen::Isometry3d& frame, BodyProperties& found) {
  const Eigen::Index d = inertia.dimension();
  found.mass = inertia.m;
  if (!(inertia.m > 0)) return;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  centre.head(d) = inertia.s0 / inertia.m;
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();  // about the centre
  moments.topLeftCorner(d, d) = inertia.C0 - inertia.s0 * inertia.s0.transpose() / inertia.m;
  const Eigen::Matrix3d own = moments.trace() * Eigen::Matrix3d::Identity() - moments;
  found.centre = frame * centre;
  found.inertia = frame.linear() * own * frame.linear().transpose();
}

BodyProperties::Box box_of(const fem::Mesh& mesh, const Eigen::Isometry3d& frame) {
  constexpr double far = 1e300;
  BodyProperties::Box box{Eigen::Vector3d::Constant(far), Eigen::Vector3d::Constant(-far)};
  for (const Eigen::Vector3d& x : mesh.positions) {
    const Eigen::Vector3d at = frame * x;
    box.low = box.low.cwiseMin(at), box.high = box.high.cwiseMax(at);
  }
  MPI_Allreduce(MPI_IN_PLACE, box.low.data(), 3, MPI_DOUBLE, MPI_MIN, mesh.comm);
  MPI_Allreduce(MPI_IN_PLACE, box.high.data(), 3, MPI_DOUBLE, MPI_MAX, mesh.comm);
  return box;
}

std::vector<double> frequencies_of(const PlannedBody& body, const fem::Conditions& constrained,
                                   const fem::Holding& holding, int count) {
  const fem::Holding for_statics = fem::holding(body.structure, body.frame, constrained);
  const reduction::Statics statics(body.structure, body.frame, for_statics);
  reduction::ModeSolver solver(body.structure, body.frame, holding, statics);
  const auto most = static_cast<int>(std::min<PetscInt>(count, solver.available()));
  return most > 0 ? solver.solve(most).omega : std::vector<double>{};
}

}  // namespace

std::vector<BodyProperties> body_properties(const Scene& whole, MPI_Comm comm, int frequencies) {
  const Scene scene = split_frames(whole, comm);
  const Plan plan = prepare(scene, comm);
  std::vector<BodyProperties> all;
  for (int b = 0; b < static_cast<int>(plan.bodies.size()); ++b) {
    const PlannedBody& body = plan.bodies[b];
    BodyProperties& found = all.emplace_back();
    found.name = body.spec.name;
    if (body.spec.reduced) {
      const ReducedBody reduced = from_file(body, Formulation::vm_md);
      set_mass(reduced.body.inertia, Eigen::Isometry3d::Identity(), found);
      if (frequencies > 0) found.constrained = reduced.report.omega;
      if (std::ssize(found.constrained) > frequencies) found.constrained.resize(frequencies);
      continue;
    }
    const Eigen::Isometry3d frame = frame_in_mesh(body);
    set_mass(rigid(body).body.inertia, frame, found);
    found.box = box_of(body.structure.mesh, frame);
    if (body.spec.rigid || frequencies == 0) continue;
    found.free = frequencies_of(body, {}, fem::holding(body.structure, body.frame, {}), frequencies);
    const fem::Holding of_modes = holding_of_modes(plan, b);
    if (!of_modes.constrained.empty())
      found.constrained = frequencies_of(body, constrained_by_modes(plan, b), of_modes, frequencies);
  }
  return all;
}

}  // namespace floe::assess
