#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "floe/petsc/all_ranks.h"
#include "inp_reading.h"
#include "text.h"

namespace floe::mesh {

void read_transform(const InpBlock& block, InpReading& reading) {
  const auto type = block.parameters.find("TYPE");
  const std::string kind = type == block.parameters.end() ? "R" : upper(type->second);
  if (kind != "R" && kind != "C" && kind != "S")
    reading.faults.add(block.where, block.name + " expects TYPE=R, C or S, found " + in_quotes(type->second));
  InpTransform transform{block.where, reading.scopes.whole(required(block, "NSET", reading)), kind[0], {}, {}};
  for (const auto& [where, line] : data_lines(block, 1, 1, "two points", reading.faults))
    if (const auto x = numbers(line, where, 1, 6, "two points", reading.faults))
      for (std::size_t i = 0; i < x->size(); ++i)
        (i < 3 ? transform.a : transform.b)[static_cast<Eigen::Index>(i % 3)] = (*x)[i];
  reading.transforms.push_back(transform);
  ignore(block, "only *EQUATION uses its directions", reading);
}

// The number of terms, then those: node, direction, factor, at most four on a line.
void read_equation(const InpBlock& block, InpReading& reading) {
  const auto& asked = reading.request.ignore;
  if (std::any_of(asked.begin(), asked.end(), [](const std::string& name) { return upper(name) == "EQUATION"; }))
    return ignore(block, "left out, as the scene asks: the nodes are not tied by it", reading);
  std::vector<std::string_view> fields;
  InpEquation open;
  std::size_t terms = 0;
  bool good = true;
  block.each_line([&](Where where, std::string_view line) {
    if (!good) return;
    split_fields(line, fields);
    if (terms == 0) {
      const auto count = fields.size() == 1 ? number<long long>(fields[0]) : std::nullopt;
      good = count && *count > 0;
      if (!good) return reading.faults.add(where, "*EQUATION expects its number of terms, found " + in_quotes(line));
      terms = static_cast<std::size_t>(*count);
      open = {where, {}};
      return;
    }
    for (std::size_t i = 0; i < fields.size() && good; i += 3) {
      const auto direction = i + 2 < fields.size() ? number<int>(fields[i + 1]) : std::nullopt;
      const auto factor = i + 2 < fields.size() ? fortran_number(fields[i + 2]) : std::nullopt;
      good = direction && *direction > 0 && factor && std::isfinite(*factor) && open.terms.size() < terms;
      if (good) open.terms.push_back({reading.scopes.whole(std::string(fields[i])), *direction, *factor});
    }
    if (!good)
      return reading.faults.add(where, "*EQUATION expects terms of node, direction, factor, found " + in_quotes(line));
    if (open.terms.size() < terms) return;
    reading.equations.push_back(std::move(open));
    terms = 0;
  });
  if (good && terms > 0) reading.faults.add(block.where, "*EQUATION has fewer terms than it says");
}

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A term with its node and the direction of its displacement or rotation.
struct Term {
  long long node;
  int direction;  // 1 to 6
  double factor;
  Vector3d x, e;
  bool rotation() const { return direction > 3; }
};

/// Directions 1, 2, 3 of a node at x; none: a fault.
std::optional<Matrix3d> axes_of(const InpTransform& at, const Vector3d& x, Faults& faults) {
  const bool cylindrical = at.type == 'C';
  const Vector3d first = cylindrical ? Vector3d(at.b - at.a) : at.a, second = cylindrical ? Vector3d(x - at.a) : at.b;
  const Vector3d normal = first.cross(second);
  Matrix3d axes;
  axes.col(0) = first.normalized(), axes.col(2) = normal.normalized(), axes.col(1) = axes.col(2).cross(axes.col(0));
  if (at.type == 'S' || !(normal.norm() > 1e-9 * first.norm() * second.norm())) {
    faults.add(at.where, at.type == 'S' ? "*TRANSFORM of nodes of an *EQUATION is read with TYPE=R or C"
                                        : "*TRANSFORM: its points and a node of an *EQUATION lie on one line");
    return std::nullopt;
  }
  if (!cylindrical) return axes;
  Matrix3d polar;  // radial, tangential, along the axis
  polar << axes.col(1), axes.col(2), axes.col(0);
  return polar;
}

/// What the equations say of two nodes: directions in which they move alike.
struct Pair {
  Where where;
  Matrix3d displacements = Matrix3d::Zero(), rotations = Matrix3d::Zero();  // sums of e e'
  bool turned = false;
};

class Equations {
 public:
  /// Collective.
  Equations(MPI_Comm comm, InpReading& reading) : reading_(reading), small_(1e-5 * extent_of(comm, reading.mesh)) {
    std::vector<long long> labels;
    for (const InpEquation& equation : reading.equations)
      for (const auto& term : equation.terms)
        if (const auto label = number<long long>(term.node)) labels.push_back(*label);
    std::sort(labels.begin(), labels.end());
    labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
    for (const auto& [label, x] : positions_of(comm, labels, reading)) positions_.emplace(label, x);
    for (const InpTransform& transform : reading.transforms) {
      const int set = reading.node_sets.find(reading.scopes.own(transform.nodes, InpName::nodes));
      if (set < 0) {
        reading.faults.add(transform.where, "there is no node set " + in_quotes(transform.nodes));
        continue;
      }
      std::vector<long long> mine;
      for (const long long label : reading.mesh.places[static_cast<std::size_t>(set)].labels)
        if (positions_.contains(label)) mine.push_back(label);
      for (const long long label : petsc::of_all_ranks(comm, mine)) transforms_[label] = &transform;
    }
    find_used(comm);
  }

  void add(const InpEquation& equation) {
    std::vector<Term> terms;
    for (const auto& term : equation.terms) {
      if (term.direction > 6) return support(equation);  // no displacement or rotation
      auto found = term_of(term, equation.where);
      if (!found) return;
      const auto same = std::find_if(terms.begin(), terms.end(), [&](const Term& other) {
        return other.node == found->node && other.direction == found->direction;
      });
      same == terms.end() ? terms.push_back(*found) : void(same->factor += found->factor);
    }
    std::erase_if(terms, [](const Term& term) { return term.factor == 0; });
    if (terms.empty()) return;
    if (!moves_rigidly(terms)) return support(equation);
    const bool pair = terms.size() == 2 && terms[0].node != terms[1].node && terms[0].rotation() == terms[1].rotation();
    const bool one_point = pair && (terms[0].x - terms[1].x).norm() <= small_;
    if (!one_point && std::any_of(terms.begin(), terms.end(), [&](const Term& t) { return !used_.contains(t.node); }))
      return support(equation);  // of elements that are left out
    if (!one_point)
      return refuse(equation.where, "joins nodes otherwise than two at one point with the same direction");
    auto at = pairs_.find({terms[1].node, terms[0].node});
    if (at == pairs_.end()) at = pairs_.try_emplace({terms[0].node, terms[1].node}, Pair{equation.where}).first;
    (terms[0].rotation() ? at->second.rotations : at->second.displacements) += terms[0].e * terms[0].e.transpose();
    at->second.turned = at->second.turned || (equation.turned && !transforms_.contains(terms[0].node));
    ++tied_;
  }

  void finish() {
    for (const auto& [nodes, pair] : pairs_) link(nodes.first, nodes.second, pair);
    const auto report = [&](Where where, long long count, const std::string& text) {
      if (count > 0)
        reading_.notices.push_back(reading_.faults.text_of(where) + ": *EQUATION: " + counted(count, "equation") +
                                   text);
    };
    if (tied_ > 0)
      report(reading_.equations.front().where, tied_,
             " read as " + counted(static_cast<long long>(pairs_.size()), "link") + " between nodes at one point");
    report(first_support_, supports_,
           std::string(supports_ == 1 ? " is" : " are") +
               " ignored: " + (supports_ == 1 ? "it resists" : "they resist") + " rigid motion, or concern" +
               (supports_ == 1 ? "s" : "") +
               " other fields or nodes without elements; supports are joints of the scene");
  }

 private:
  /// Nodes of elements, masses and links, among those of the equations. Collective.
  void find_used(MPI_Comm comm) {
    std::set<long long> mine;
    const auto use = [&](long long label) {
      if (positions_.contains(label)) mine.insert(label);
    };
    for (const FileCell& cell : reading_.mesh.cells)
      for (int i = 0; i < node_count(cell.kind); ++i) use(cell.nodes[static_cast<std::size_t>(i)]);
    for (const Mention& mention : reading_.mesh.mentions) use(mention.label);
    const std::vector<long long> all = petsc::of_all_ranks(comm, std::vector<long long>(mine.begin(), mine.end()));
    used_.insert(all.begin(), all.end());
  }

  std::optional<Term> term_of(const InpEquation::Term& given, Where where) {
    const auto label = number<long long>(given.node);
    if (!label) {
      reading_.faults.add(where, "*EQUATION is read with node numbers, not with the set " + in_quotes(given.node));
      return std::nullopt;
    }
    const auto at = positions_.find(*label);
    if (at == positions_.end()) {
      reading_.faults.add(where, "this equation names node " + std::to_string(*label) + ", which is not defined");
      return std::nullopt;
    }
    const auto transform = transforms_.find(*label);
    const auto axes = transform == transforms_.end() ? std::optional(Matrix3d(Matrix3d::Identity()))
                                                     : axes_of(*transform->second, at->second, reading_.faults);
    if (!axes) return std::nullopt;
    return Term{*label, given.direction, given.factor, at->second, axes->col((given.direction - 1) % 3)};
  }

  /// Whether every rigid motion of the body satisfies the equation.
  bool moves_rigidly(const std::vector<Term>& terms) const {
    Vector3d force = Vector3d::Zero(), moment = force;
    double forces = 0, moments = 0;
    for (const Term& term : terms) {
      (term.rotation() ? moment : force) += term.factor * term.e;
      if (!term.rotation()) moment += term.factor * (term.x - terms[0].x).cross(term.e);
      (term.rotation() ? moments : forces) += std::abs(term.factor);
    }
    constexpr double round_off = 1e-6;
    return force.norm() <= round_off * forces && moment.norm() <= round_off * moments + small_ * forces;
  }

  void support(const InpEquation& equation) {
    if (supports_++ == 0) first_support_ = equation.where;
  }

  void refuse(Where where, const std::string& why) {
    reading_.faults.add(
        where, "this equation " + why + ", which is not read; to leave all equations out: file: {ignore: [EQUATION]}");
  }

  void link(long long node, long long reference, const Pair& pair) {
    const auto directions = [](const Matrix3d& sum) { return Eigen::SelfAdjointEigenSolver<Matrix3d>(sum); };
    const auto rank = [](const Vector3d& values) { return static_cast<int>((values.array() > 1e-6).count()); };
    const auto of_rotations = directions(pair.rotations);
    const int locked = rank(of_rotations.eigenvalues());
    const std::string nodes = "nodes " + std::to_string(node) + " and " + std::to_string(reference);
    if (rank(directions(pair.displacements).eigenvalues()) < 3)
      return refuse(pair.where, "and those beside it leave displacements of " + nodes + " free of each other");
    RigidLink free{};
    free.others = locked < 2;
    if (locked == 1 || locked == 2) {
      if (pair.turned)
        return refuse(pair.where, "in a rotated *INSTANCE has directions of " + nodes + " without *TRANSFORM");
      Vector3d::Map(free.axis.data()) = of_rotations.eigenvectors().col(locked == 1 ? 2 : 0);
    }
    add_link(reference, reading_.rank == 0 ? std::vector{node} : std::vector<long long>{}, pair.where, reading_, free);
  }

  InpReading& reading_;
  double small_;
  std::map<long long, Vector3d> positions_;
  std::map<long long, const InpTransform*> transforms_;
  std::set<long long> used_;
  std::map<std::pair<long long, long long>, Pair> pairs_;
  long long tied_ = 0, supports_ = 0;
  Where first_support_;
};

}  // namespace

void resolve_equations(MPI_Comm comm, InpReading& reading) {
  if (reading.equations.empty()) return;
  Equations equations(comm, reading);
  for (const InpEquation& equation : reading.equations) equations.add(equation);
  equations.finish();
}

}  // namespace floe::mesh
