#include <algorithm>

#include "floe/dynamics/system.h"
#include "floe/petsc/values.h"

namespace floe::dynamics {
namespace {

/// Where this rank owns it, entry i of a local vector becomes `value`.
void set_owned(const Coordinates& coordinates, petsc::Values& owned, int i, double value) {
  const PetscInt global = coordinates.global()[i];
  if (global >= owned.first && global < owned.end) owned[global] = value;
}

}  // namespace

double System::greatest_node_rotation(Vec U) const {
  if (!has_attitudes_) return 0;
  gather(U, local_.q);
  double greatest = 0;
  for (const auto& [first, attitude] : attitudes_)
    if (attitude->of_node) greatest = std::max(greatest, local_.q.segment<3>(first).norm());
  if (!whole_) petsc::check(MPI_Allreduce(MPI_IN_PLACE, &greatest, 1, MPI_DOUBLE, MPI_MAX, comm()));
  return greatest;
}

void System::rebase(Vec U, Vec V, double t) const {
  if (!has_attitudes_) return;
  gather(U, local_.q);
  petsc::Values owned(U);
  for (const auto& [first, attitude] : attitudes_) {
    attitude->advance(local_.q.segment<3>(first));
    for (int i = 0; i < 3; ++i) set_owned(coordinates_, owned, first + i, 0);
    local_.q.segment<3>(first).setZero();
  }
  begin_terms(V, t);
}

void System::commit_step(Vec U, Vec V, double t) const {
  gather(U, local_.q);
  begin_terms(has_attitudes_ ? V : nullptr, t);  // without attitudes no step begins again (rebase)
}

/// Every term begins a step at local_.q and the velocities V.
void System::begin_terms(Vec V, double t) const {
  local_.v.setZero(local_.q.size()), local_.a.setZero(local_.q.size());
  if (V) gather(V, local_.v);
  petsc::agree_if_parallel(comm(), whole_, [&] {
    for (const auto& term : terms_) {
      const TermWork& w = pick(*term);
      term->begin_step({t, w.q, w.v, w.a});
    }
  });
}

void System::save(std::vector<double>& numbers) const {
  numbers.clear();
  for (const auto& [first, attitude] : attitudes_)
    for (const double part : attitude->base.coeffs()) numbers.push_back(part);
  for (const auto& term : terms_) term->save(numbers);
}

void System::load(std::span<const double> numbers) const {
  const auto take = [&](std::size_t count) {
    if (numbers.size() < count) throw RunError("the step state of bodies and joints belongs to another system");
    const auto taken = numbers.first(count);
    numbers = numbers.subspan(count);
    return taken;
  };
  std::vector<double> own;
  for (const auto& [first, attitude] : attitudes_)
    attitude->base.coeffs() = Eigen::Map<const Eigen::Vector4d>(take(4).data());
  for (const auto& term : terms_) {
    own.clear();
    term->save(own);  // as many as it takes
    if (!own.empty()) term->load(take(own.size()));
  }
  if (!numbers.empty()) throw RunError("the step state of bodies and joints belongs to another system");
}

void System::bracket(Vec a, Vec b, Vec W) const {
  gather(a, local_.q), gather(b, local_.v);
  petsc::check(VecSet(W, 0));
  petsc::Values owned(W);
  for (const auto& [first, attitude] : attitudes_) {
    const Eigen::Vector3d cross = local_.q.segment<3>(first).cross(local_.v.segment<3>(first));
    for (int i = 0; i < 3; ++i) set_owned(coordinates_, owned, first + i, cross[i]);
  }
}

}  // namespace floe::dynamics
