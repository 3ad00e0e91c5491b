#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "floe/assembly/reduce_bodies.h"
#include "floe/plan/place_weights.h"
#include "floe/reduction/place_set.h"

namespace floe::assembly {
namespace {

using output::ReducedColumn;

int leading_fields(const PlannedBody& body) {
  const ReducedSpec& spec = *body.spec.reduced;
  const auto derivative = [](const ReducedColumn& column) { return column.kind == "derivative"; };
  std::vector<ReducedColumn> kept;
  std::copy_if(spec.file->columns.begin(), spec.file->columns.end(), std::back_inserter(kept),
               [](const ReducedColumn& column) { return column.kept; });
  if (!std::is_partitioned(kept.begin(), kept.end(), std::not_fn(derivative)))
    throw InputError(
        fmt::format("{}: a derivative precedes a mode in \"{}\", so that formulation vm cannot use the modes alone; "
                    "expected formulation vm+md or lffr",
                    spec.where.text(), spec.path));
  return static_cast<int>(std::count_if(kept.begin(), kept.end(), std::not_fn(derivative)));
}

body::Inertia leading(const body::Inertia& inertia, int k) {
  body::Inertia part = inertia;
  part.S = inertia.S.leftCols(k);
  for (auto& row : part.h)
    for (auto& h : row) h = h.head(k).eval();
  for (auto& row : part.M)
    for (auto& M : row) M = M.topLeftCorner(k, k).eval();
  for (auto& Q : part.Q) Q = Q.topLeftCorner(k, k).eval();
  for (auto& row : part.W)
    for (auto& W : row) W = W.topLeftCorner(k, k).eval();
  return part;
}

std::vector<reduction::ColumnOrigin> origins_of(const output::ReducedBodyFile& file, Formulation formulation) {
  using Kind = reduction::ColumnOrigin::Kind;
  std::vector<reduction::ColumnOrigin> origins;
  for (const ReducedColumn& column : file.columns) {
    const Kind kind = column.kind == "mode"         ? Kind::mode
                      : column.kind == "derivative" ? Kind::derivative
                                                    : Kind::attachment;
    const bool kept = column.kept && (formulation != Formulation::vm || kind != Kind::derivative);
    origins.push_back({kind, column.label, column.omega, column.new_part, kept, column.interaction, column.dropped});
  }
  return origins;
}

}  // namespace

ReducedBody from_file(const PlannedBody& body, Formulation formulation) {
  const output::ReducedBodyFile& file = *body.spec.reduced->file;
  ReducedBody reduced;
  reduced.body = file.body;
  reduced.damping = file.damping;
  reduced.strain_rate_damping = file.strain_rate_damping;
  if (file.strain_rate_damping > 0)
    reduced.damping -= file.strain_rate_damping * file.body.elasticity.linear_stiffness();
  if (formulation == Formulation::lffr) reduced.body.elasticity = body::linearised(file.body.elasticity);
  if (formulation == Formulation::vm) {
    const int k = leading_fields(body);
    const std::vector<char> all(file.body.elasticity.pairs.size(), 1);
    reduced.body = {leading(file.body.inertia, k), body::part(file.body.elasticity, k, all),
                    leading(file.body.line, k)};
    if (reduced.damping.size() > 0) reduced.damping = reduced.damping.topLeftCorner(k, k).eval();
  }
  BodyReport& report = reduced.report;
  report.name = report.whole = body.spec.name, report.file = body.spec.reduced->path;
  report.file_version = file.version, report.file_has_shells = !file.pressures.empty();
  report.nodes = file.nodes, report.elements = file.cells, report.dofs = file.dofs;
  report.dimension = file.dimension;
  report.shapes_in_file = file.has_shapes;
  report.columns = reduced.body.coordinates();
  report.products = static_cast<int>(reduced.body.elasticity.pairs.size());
  if (formulation == Formulation::vm_md) report.omitted_products = static_cast<int>(file.omitted_products);
  report.omega = file.omega, report.residual = file.residual;
  report.origins = origins_of(file, formulation);
  return reduced;
}

body::PlaceMap place_map(const Plan& plan, const ReducedBody& reduced, const Anchor& place) {
  if (place.map) {
    const Eigen::Index k = reduced.body.coordinates();
    body::PlaceMap map{place.map->x, place.map->S.leftCols(k), place.map->psi.leftCols(k), place.map->Q, place.map->H};
    for (Eigen::MatrixXd& Q : map.Q) Q = Q.topLeftCorner(k, k).eval();
    return map;
  }
  const fem::Structure& structure = plan.bodies[place.body].structure;
  if (place.nodes.empty()) return reduction::place_map(structure, *reduced.basis, place.node);
  return reduction::place_map(structure, *reduced.basis,
                              place.weights ? *place.weights : place_weights(structure, place.nodes));
}

}  // namespace floe::assembly
