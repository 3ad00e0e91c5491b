#include "floe/assess/stress_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "element_deformation.h"
#include "floe/petsc/error.h"
#include "floe/plan/mesh_copy.h"

namespace floe::assess {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using fem::SmallRows;

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t most_states = 256, most_instants = 4096;  // at a time: of full order, of coordinates
constexpr int common = 3;                                       // stress_max, stress_min, von_mises

bool is_laminate(const std::vector<fem::ShellLayer>& layers) {
  return std::any_of(layers.begin(), layers.end(), [&](const fem::ShellLayer& one) {
    return (one.Q - layers.front().Q).norm() > 1e-9 * one.Q.norm();
  });
}

/// Largest and smallest principal stress and von Mises' of plane stress, into rows `common` of values.
void take_extremes(const SmallRows& stress, SmallRows& values) {
  for (Eigen::Index t = 0; t < stress.cols(); ++t) {
    const double x = stress(0, t), y = stress(1, t), xy = stress(2, t);
    const double mean = (x + y) / 2, radius = std::hypot((x - y) / 2, xy);
    values(BodyStress::stress_max, t) = std::fmax(values(BodyStress::stress_max, t), mean + radius);
    values(BodyStress::stress_min, t) = std::fmin(values(BodyStress::stress_min, t), mean - radius);
    values(BodyStress::von_mises, t) =
        std::fmax(values(BodyStress::von_mises, t), std::sqrt(x * x - x * y + y * y + 3 * xy * xy));
  }
}

}  // namespace

struct BodyStress::Fields {
  MatrixXd coefficients;  // reduced, columns x instants
  MatrixXd states;        // full order, local dofs x instants
  Eigen::Index instants() const { return std::max(coefficients.cols(), states.cols()); }
};

BodyStress::BodyStress(const Plan& plan, int body, std::string name_there, const output::NodeMotion& motion,
                       bool corrected)
    : body_(plan.bodies[static_cast<std::size_t>(body)]),
      name_(std::move(name_there)),
      motion_(motion),
      corrected_(corrected && motion.has_correction()),
      corotational_(motion.formulation() == "cfr"),
      linear_(motion.formulation() == "lffr" || body_.spec.reduction.linear) {
  const fem::Mesh& mesh = body_.structure.mesh;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) nodes_.push_back(mesh.original_node(static_cast<int>(i)));
  petsc::agree(mesh.comm, [&] {
    const std::string& name = name_;
    const auto refuse = [&](const std::string& what) {
      throw InputError(fmt::format("body {}: {}; expected the scene and meshes of the run", name, what));
    };
    if (motion.nodes(name) != mesh.node_count)
      refuse(fmt::format("has {} nodes in the results and {} in the scene", motion.nodes(name), mesh.node_count));
    const Eigen::Matrix3Xd X = motion.positions(name, nodes_);
    double size = 0, off = 0;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      size = std::max(size, mesh.positions[i].norm());
      off = std::max(off, (X.col(static_cast<Eigen::Index>(i)) - mesh.positions[i]).norm());
    }
    if (off > 1e-8 * size)
      refuse(fmt::format("its nodes in the results are up to {:.3g} m from those in the scene", off));
    if (motion.reduced(name)) basis_ = motion.basis(name, nodes_, corrected_);
  });
  const output::ReducedShapes shapes = mesh_copy(body_);
  cells_ = shapes.cells;
  const Eigen::Isometry3d frame = frame_in_mesh(body_);
  for (const fem::Mesh::Cell& cell : mesh.cells)
    for (const std::vector<int>& piece : pictured(cell.kind)) {
      Vector3d sum = Vector3d::Zero();
      for (const int i : piece) sum += mesh.positions[cell.place[i]] / static_cast<double>(piece.size());
      centres_.push_back(frame * sum);
    }
  find_fields();
  find_singular(plan, body);
}

void BodyStress::find_fields() {
  int kinds[3] = {0, 0, 0};  // shells, beams, layers
  for (const fem::Mesh::Cell& cell : body_.structure.mesh.cells) {
    if (mesh::is_shell(cell.kind)) {
      kinds[0] = 1;
      const auto& layers = body_.points[static_cast<std::size_t>(cell.part)].layers;
      if (is_laminate(layers)) kinds[2] = std::max(kinds[2], static_cast<int>(layers.size()));
    }
    if (mesh::is_line(cell.kind)) kinds[1] = 1;
  }
  MPI_Allreduce(MPI_IN_PLACE, kinds, 3, MPI_INT, MPI_MAX, body_.structure.mesh.comm);
  fields_ = {
      {"stress_max", 1, "Pa", "greatest principal stress of a shell through its thickness, normal stress of a beam"},
      {"stress_min", 1, "Pa", "least, likewise"},
      {"von_mises", 1, "Pa", "greatest through the thickness; of a beam with the shear stress of torsion"}};
  width_ = common, layers_ = kinds[2];
  const auto add = [&](const std::string& name, const char* unit, const char* text, int width = 3) {
    fields_.push_back({name, width, unit, text});
    width_ += width;
  };
  if (kinds[0]) {
    shells_ = width_;
    add("membrane_force", "N/m", "xx, yy, xy of shells");
    add("bending_moment", "N", "xx, yy, xy of shells; positive ones stretch the top");
    for (const char* at : {"top", "bottom"}) add(fmt::format("strain_{}", at), "", "xx, yy, 2 xy of shells");
    for (const char* at : {"top", "middle", "bottom"}) add(fmt::format("stress_{}", at), "Pa", "xx, yy, xy of shells");
    for (const char* at : {"top", "middle", "bottom"}) add(fmt::format("von_mises_{}", at), "Pa", "of shells", 1);
    for (int i = 0; i < layers_; ++i)
      add(fmt::format("stress_layer_{}", i + 1), "Pa", "xx, yy, xy in the middle of the layer, from the bottom");
  }
  if (kinds[1]) {
    beams_ = width_;
    add("section_force", "N", "N, Vy, Vz of beams; in the plane N, V");
    add("section_moment_start", "N m", "T, My, Mz of beams at the start of the element; in the plane M as the third");
    add("section_moment_end", "N m", "likewise at its end");
  }
}

SmallRows BodyStress::displacements(const fem::Mesh::Cell& cell, const Fields& fields) const {
  const auto places = cell.places();
  const Eigen::Index w = body_.structure.dofs_per_node;
  const auto n = static_cast<Eigen::Index>(places.size());
  const bool reduced = fields.states.size() == 0;
  SmallRows q(w * n, fields.instants());
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto at = w * static_cast<Eigen::Index>(places[static_cast<std::size_t>(i)]);
    if (reduced)
      q.middleRows(w * i, w) = basis_.middleRows(at, w) * fields.coefficients;
    else
      q.middleRows(w * i, w) = fields.states.middleRows(at, w);
  }
  if (corotational_) {
    std::vector<Vector3d> X;
    for (const int node : places) X.push_back(body_.structure.mesh.positions[node]);
    for (Eigen::Index t = 0; t < q.cols(); ++t) {
      Eigen::VectorXd column = q.col(t);
      if (w == 6)
        take_deformation(X, body_.attitude, column);
      else
        take_planar_deformation(X, body_.pose[2], column);
      q.col(t) = column;
    }
    return q;
  }
  const auto* shell = std::get_if<fem::ShellSection>(&body_.structure.sections[cell.part]);
  const auto* beam = std::get_if<fem::SpatialBeam>(&body_.structure.sections[cell.part]);
  const bool second_order = (shell && shell->strains == fem::Strains::second_order) ||
                            (beam && beam->strain.strains == fem::Strains::second_order);
  if (!second_order || !cell.follows() || linear_) return q;
  for (Eigen::Index i = 0; i < n; ++i) {  // what follows a node rotates with it to second order
    const Vector3d arm = body_.structure.mesh.positions[cell.place[i]] - body_.structure.mesh.positions[cell.moved[i]];
    if (arm.isZero(0)) continue;
    for (Eigen::Index t = 0; t < q.cols(); ++t) {
      const Vector3d theta = q.col(t).segment<3>(6 * i + 3);
      q.col(t).segment<3>(6 * i) += 0.5 * theta.cross(theta.cross(arm));
    }
  }
  return q;
}

void BodyStress::add_shell(const fem::Mesh::Cell& cell, const Fields& fields, std::vector<SmallRows>& values) const {
  const auto& section = std::get<fem::ShellSection>(body_.structure.sections[cell.part]);
  const std::vector<fem::ShellLayer>& layers = body_.points[static_cast<std::size_t>(cell.part)].layers;
  const std::vector<fem::ShellSample> samples = fem::shell_samples(body_.structure, cell);
  const auto places = cell.places();
  const bool direct = fields.states.size() == 0 && !cell.follows();
  const SmallRows q = direct ? SmallRows() : displacements(cell, fields);
  const auto pieces = pictured(cell.kind);
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    Vector3d centre = Vector3d::Zero();
    for (const int i : pieces[p])
      centre += body_.structure.mesh.positions[cell.place[i]] / static_cast<double>(pieces[p].size());
    double nearest = std::numeric_limits<double>::infinity();
    for (const fem::ShellSample& one : samples) nearest = std::min(nearest, (one.at - centre).norm());
    std::vector<std::size_t> chosen;
    for (std::size_t i = 0; i < samples.size(); ++i)
      if ((samples[i].at - centre).norm() <= nearest * (1 + 1e-6)) chosen.push_back(i);
    const Vector3d axis = fem::surface_axis(section, body_.axes.transpose(), samples[chosen.front()].axes.col(2));
    fem::ShellRows rows = fem::shell_rows(samples, chosen, axis, static_cast<int>(places.size()));
    if (linear_ || (corotational_ && !mesh::is_quadratic(cell.kind))) rows.terms.clear();
    SmallRows s;
    if (direct) {
      SmallRows of_basis = SmallRows::Zero(rows.rows.rows(), basis_.cols());
      for (std::size_t i = 0; i < places.size(); ++i)
        of_basis.noalias() += rows.rows.middleCols(6 * static_cast<Eigen::Index>(i), 6) *
                              basis_.middleRows(6 * static_cast<Eigen::Index>(places[i]), 6);
      s = fem::shell_strains(rows, of_basis * fields.coefficients);
    } else {
      s = fem::shell_strains(rows, rows.rows * q);
    }
    SmallRows& out = values[p];
    out.middleRows(shells_, 3) = section.A * s.topRows(3);
    out.middleRows(shells_ + 3, 3) =
        section.coupling.transpose() * out.middleRows(shells_, 3) + section.bending * s.bottomRows(3);
    if (layers.empty()) continue;
    const double bottom = layers.front().bottom, top = layers.back().top;
    const SmallRows above = fem::layer_strain(section, top, s), below = fem::layer_strain(section, bottom, s);
    out.middleRows(shells_ + 6, 3) = above, out.middleRows(shells_ + 9, 3) = below;
    const double middle = (bottom + top) / 2;
    const auto in_middle =
        std::find_if(layers.begin(), layers.end() - 1, [&](const auto& one) { return one.top > middle; });
    const std::array<SmallRows, 3> stress{layers.back().Q * above, in_middle->Q * fem::layer_strain(section, middle, s),
                                          layers.front().Q * below};
    for (Eigen::Index i = 0; i < 3; ++i) {
      const SmallRows& of = stress[static_cast<std::size_t>(i)];
      out.middleRows(shells_ + 12 + 3 * i, 3) = of;
      out.row(shells_ + 21 + i) = (of.row(0).array().square() - of.row(0).array() * of.row(1).array() +
                                   of.row(1).array().square() + 3 * of.row(2).array().square())
                                      .sqrt();
    }
    if (!is_laminate(layers)) {
      take_extremes(stress[0], out), take_extremes(stress[2], out);
      continue;
    }
    for (std::size_t i = 0; i < layers.size(); ++i) {
      const fem::ShellLayer& layer = layers[i];
      for (const double z : {layer.bottom, layer.top}) take_extremes(layer.Q * fem::layer_strain(section, z, s), out);
      if (static_cast<int>(i) < layers_)
        out.middleRows(shells_ + 24 + 3 * static_cast<Eigen::Index>(i), 3) =
            layer.Q * fem::layer_strain(section, (layer.bottom + layer.top) / 2, s);
    }
  }
}

void BodyStress::add_beam(const fem::Mesh::Cell& cell, const Fields& fields, std::vector<SmallRows>& values) const {
  const fem::BeamForces forces(body_.structure, cell, linear_);
  const fem::Section& section = body_.structure.sections[cell.part];
  const fem::StressPoints& points = body_.points[static_cast<std::size_t>(cell.part)];
  const SmallRows q = displacements(cell, fields);
  SmallRows& out = values.front();
  for (Eigen::Index t = 0; t < q.cols(); ++t) {
    const fem::BeamForces::Ends ends = forces(q.col(t));
    out.col(t).segment<3>(beams_) = (ends.force[0] + ends.force[1]) / 2;
    for (std::size_t i = 0; i < 2; ++i) {
      out.col(t).segment<3>(beams_ + 3 + 3 * static_cast<Eigen::Index>(i)) = ends.moment[i];
      if (!points.known()) continue;
      const auto [least, greatest] = fem::fibre_stress(section, points, ends.force[i], ends.moment[i]);
      out(stress_max, t) = std::fmax(out(stress_max, t), greatest);
      out(stress_min, t) = std::fmin(out(stress_min, t), least);
      const double shear = fem::torsion_stress(section, points, ends.force[i], ends.moment[i]);
      out(von_mises, t) = std::fmax(out(von_mises, t), std::hypot(std::max(-least, greatest), std::sqrt(3.) * shear));
    }
  }
  for (std::size_t p = 1; p < values.size(); ++p) values[p] = out;
}

void BodyStress::evaluate(std::span<const std::size_t> rows,
                          const std::function<void(std::size_t cell, std::size_t first, const SmallRows& values)>& use,
                          const std::vector<char>* wanted) const {
  const fem::Mesh& mesh = body_.structure.mesh;
  std::vector<SmallRows> values;
  const std::size_t most = motion_.reduced(name_) ? most_instants : most_states;
  for (std::size_t first = 0; first < rows.size(); first += most) {
    const auto some = rows.subspan(first, std::min(most, rows.size() - first));
    Fields fields;
    petsc::agree(mesh.comm, [&] {
      if (motion_.reduced(name_)) {
        fields.coefficients = motion_.coordinates(name_, some, corrected_);
        return;
      }
      fields.states.resize(body_.structure.local_dofs(), static_cast<Eigen::Index>(some.size()));
      for (std::size_t i = 0; i < some.size(); ++i)
        fields.states.col(static_cast<Eigen::Index>(i)) = motion_.state(name_, nodes_, some[i]);
    });
    std::size_t number = 0;
    for (const fem::Mesh::Cell& cell : mesh.cells) {
      const std::size_t count = pictured(cell.kind).size();
      const auto skips = [&] {
        const auto first_piece = wanted->begin() + static_cast<std::ptrdiff_t>(number);
        return std::all_of(first_piece, first_piece + static_cast<std::ptrdiff_t>(count), [](char is) { return !is; });
      };
      if (wanted && skips()) {
        number += count;
        continue;
      }
      values.resize(count);
      for (SmallRows& one : values) one.setConstant(width_, static_cast<Eigen::Index>(some.size()), nan);
      if (mesh::is_shell(cell.kind)) add_shell(cell, fields, values);
      if (mesh::is_line(cell.kind)) add_beam(cell, fields, values);
      for (std::size_t p = 0; p < count; ++p) use(number++, first, values[p]);
    }
  }
}

void BodyStress::find_singular(const Plan& plan, int body) {
  const fem::Structure& structure = body_.structure;
  const fem::Mesh& mesh = structure.mesh;
  const auto local = static_cast<Eigen::Index>(mesh.positions.size());
  singular_.assign(cells_.size(), Singular::none);
  if (structure.dofs_per_node != 6 || shells_ < 0) return;
  const auto summed = [&](const std::function<void(Eigen::VectorXd&)>& add) {  // over the elements of all ranks
    Eigen::VectorXd mine = Eigen::VectorXd::Zero(6 * local);
    add(mine);
    const petsc::VecHandle all = fem::field(structure);
    structure.exchange.add(mine, all);
    return structure.exchange.gather(all);
  };
  const auto each_shell = [&](const auto& act) {
    for (const fem::Mesh::Cell& cell : mesh.cells)
      if (mesh::is_shell(cell.kind)) act(cell.corners());
  };
  const Eigen::VectorXd angles = summed([&](Eigen::VectorXd& sum) {
    each_shell([&](std::span<const int> corners) {
      const std::size_t n = corners.size();
      for (std::size_t i = 0; i < n; ++i) {
        const Vector3d& x = mesh.positions[corners[i]];
        const Vector3d a = mesh.positions[corners[(i + 1) % n]] - x, b = mesh.positions[corners[(i + n - 1) % n]] - x;
        sum[6 * corners[i]] += std::atan2(a.cross(b).norm(), a.dot(b));
      }
    });
  });
  std::vector<Singular> of_nodes(static_cast<std::size_t>(local), Singular::none);
  constexpr double degree = M_PI / 180;
  for (Eigen::Index i = 0; i < local; ++i)
    if (angles[6 * i] > 200 * degree && angles[6 * i] < 340 * degree)
      of_nodes[static_cast<std::size_t>(i)] = Singular::corner;
  const auto look = [&](const Anchor& place, bool holds) {
    if (place.body != body || place.nodes.empty()) return;
    std::vector<char> in(static_cast<std::size_t>(local), 0);
    for (Eigen::Index i = 0; i < local; ++i)
      in[static_cast<std::size_t>(i)] =
          std::find(place.nodes.begin(), place.nodes.end(), mesh.global_node(static_cast<int>(i))) != place.nodes.end();
    Eigen::VectorXd edges;
    if (place.nodes.size() > 1) {
      if (!holds) return;
      edges = summed([&](Eigen::VectorXd& sum) {
        each_shell([&](std::span<const int> corners) {
          for (std::size_t i = 0; i < corners.size(); ++i) {
            const int a = corners[i], b = corners[(i + 1) % corners.size()];
            if (in[static_cast<std::size_t>(a)] && in[static_cast<std::size_t>(b)]) sum[6 * a] += 1, sum[6 * b] += 1;
          }
        });
      });
    }
    for (Eigen::Index i = 0; i < local; ++i) {
      if (!in[static_cast<std::size_t>(i)] || angles[6 * i] == 0) continue;
      if (place.nodes.size() == 1)
        of_nodes[static_cast<std::size_t>(i)] = Singular::point;
      else if (edges[6 * i] < 1.5)
        of_nodes[static_cast<std::size_t>(i)] = Singular::end_of_edge;
    }
  };
  for (const auto& places : plan.joints)
    for (const Anchor& place : places) look(place, true);
  for (std::size_t l = 0; l < plan.loads.size(); ++l)
    if (!plan.scene.loads[l].spread()) look(plan.loads[l], false);
  std::size_t number = 0;
  for (const fem::Mesh::Cell& cell : mesh.cells) {
    Singular worst = Singular::none;
    if (mesh::is_shell(cell.kind))
      for (const int node : cell.places()) worst = std::max(worst, of_nodes[static_cast<std::size_t>(node)]);
    for (std::size_t p = 0; p < pictured(cell.kind).size(); ++p) singular_[number++] = worst;
  }
}

}  // namespace floe::assess
