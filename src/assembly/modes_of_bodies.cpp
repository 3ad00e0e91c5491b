#include "floe/assembly/reduce_bodies.h"
#include "floe/fem/element_count.h"
#include "floe/plan/held_by_modes.h"

namespace floe::assembly {

std::vector<BodyReport> body_modes(const Scene& whole, MPI_Comm comm) {
  const Scene scene = split_frames(whole, comm);
  const Plan plan = prepare(scene, comm);
  return modes_of_bodies(plan);
}

std::vector<BodyReport> body_sizes(const Scene& whole, MPI_Comm comm) {
  const Scene scene = split_frames(whole, comm);
  const Plan plan = prepare(scene, comm);
  std::vector<BodyReport> reports;
  for (const PlannedBody& body : plan.bodies) {
    BodyReport report;
    if (body.spec.reduced) {
      report = from_file(body, Formulation::vm_md).report;
    } else {
      const fem::Mesh& mesh = body.structure.mesh;
      report.dofs = body.structure.dofs(), report.nodes = mesh.node_count, report.elements = fem::element_count(mesh);
      if (!body.spec.rigid) report.strains = body.strains;
    }
    report.name = body.spec.name, report.rigid = body.spec.rigid;
    report.notices = body.notices;
    if (std::string line = held_otherwise(plan, static_cast<int>(reports.size())); !line.empty())
      report.notices.push_back(std::move(line));
    report.frame = body.parent < 0 ? name_of(body.frame.kind) : "of " + plan.bodies[body.parent].spec.name;
    reports.push_back(std::move(report));
  }
  return reports;
}

}  // namespace floe::assembly
