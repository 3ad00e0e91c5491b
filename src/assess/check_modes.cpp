#include "floe/assess/check_modes.h"

#include <fmt/format.h>

#include <algorithm>

#include "floe/assembly/body_stage.h"
#include "floe/plan/attachments.h"

namespace floe::assess {
using namespace assembly;

std::vector<AttachmentModes> check_modes(const Scene& whole, MPI_Comm comm) {
  constexpr PetscInt plenty = 12, small = 5000;
  const Scene scene = split_frames(whole, comm);
  const Plan plan = prepare(scene, comm);
  std::vector<std::string> faults;
  std::vector<AttachmentModes> attached(plan.bodies.size());
  for (int b = 0; b < static_cast<int>(plan.bodies.size()); ++b) {
    const PlannedBody& body = plan.bodies[b];
    const ModesSpec& modes = body.spec.reduction.modes;
    if (is_meshed(body.spec)) attached[b].count = static_cast<int>(attachments(plan, b).size());
    if (!is_meshed(body.spec) || !modes.given || modes.count * plenty <= body.structure.dofs()) continue;
    const fem::Holding holding = holding_of_modes(plan, b);
    const reduction::Statics statics(body.structure, body.frame, holding);
    const PetscInt available = reduction::ModeSolver(body.structure, body.frame, holding, statics).available();
    if (modes.count <= available) continue;
    std::string fault = fmt::format("{}: {} modes requested of a body that has {} elastic dofs under its conditions",
                                    modes.where.text(), modes.count, available);
    if (std::find(faults.begin(), faults.end(), fault) == faults.end()) faults.push_back(std::move(fault));
  }
  if (!faults.empty()) throw InputError(faults);
  for (int b = 0; b < static_cast<int>(plan.bodies.size()); ++b) {
    if (attached[b].count == 0 || plan.bodies[b].structure.dofs() > small) continue;
    Stage stage;
    BodyReport report;
    begin_stage(plan, b, as_the_body_has, stage, report);
    attached[b] = {static_cast<int>(stage.generators.fields.size() - stage.generators.modes.omega.size()), true};
  }
  return attached;
}

}  // namespace floe::assess
