#include <algorithm>

#include "floe/dynamics/system.h"
#include "floe/petsc/values.h"

// A Jacobian kept from before is one of a scene whose bodies have rotated since. Rows and unknowns in the axes of
// bodies (moments, elastic coordinates) hardly see that; those in world axes do, and rotate with the body they belong
// to.

namespace floe::dynamics {

namespace {

/// Pairs of global indices that ranks know, of all ranks, each once. Collective.
std::vector<std::pair<PetscInt, PetscInt>> of_all_ranks(MPI_Comm comm, std::vector<PetscInt> mine) {
  int ranks = 1, count = static_cast<int>(mine.size());
  MPI_Comm_size(comm, &ranks);
  std::vector<int> counts(ranks), first(ranks + 1, 0);
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, comm);
  for (int rank = 0; rank < ranks; ++rank) first[rank + 1] = first[rank] + counts[rank];
  std::vector<PetscInt> all(first[ranks]);
  MPI_Allgatherv(mine.data(), count, MPIU_INT, all.data(), counts.data(), first.data(), MPIU_INT, comm);
  std::vector<std::pair<PetscInt, PetscInt>> pairs;
  for (std::size_t i = 0; i + 1 < all.size(); i += 2) pairs.emplace_back(all[i], all[i + 1]);
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

}  // namespace

void System::set_up_corotated() {
  const auto& global = coordinates_.global();
  std::vector<Corotated> corotated;
  std::vector<PetscInt> mine;
  for (const auto& term : terms_) term->add_corotated(corotated);
  for (const Corotated& one : corotated) mine.insert(mine.end(), {global[one.vector], global[one.frame]});
  const auto pairs = of_all_ranks(comm(), std::move(mine));

  PetscInt first = 0, end = 0;
  const petsc::VecHandle layout = create_vector();
  petsc::check(VecGetOwnershipRange(layout, &first, &end));
  // Shared unknowns have one owner. A vector with parts on another rank than its frame's stays as it is: the Jacobian
  // is no better there than one that is not rotated.
  const auto own = [&](PetscInt from, int count) { return from >= first && from + count <= end; };
  const auto add_frame = [&](int R, int x, const Attitude* attitude) {
    const int parts = attitude ? 3 : 2;
    if (!own(global[x], attitude ? 3 : 1)) return;
    if (R >= 0 && own(global[R], parts)) corotated_.push_back({global[R], frames_.size()});
    for (const auto& [vector, frame] : pairs)
      if (frame == global[x] && own(vector, parts)) corotated_.push_back({vector, frames_.size()});
    frames_.push_back({global[x], attitude});
  };
  for (const auto& [x, attitude] : attitudes_) add_frame(x - 3, x, attitude.get());
  for (const Coordinates::Angle& angle : coordinates_.angles())
    if (angle.of_frame) add_frame(angle.local - 2, angle.local, nullptr);
}

void System::frame_axes(Vec U, std::vector<Eigen::Matrix3d>& axes) const {
  axes.clear();
  petsc::ConstValues u(U);
  for (const auto& [x, attitude] : frames_) {
    if (attitude)
      axes.push_back(attitude->axes({u[x], u[x + 1], u[x + 2]}));
    else
      axes.push_back(Eigen::AngleAxisd(u[x], Eigen::Vector3d::UnitZ()).toRotationMatrix());
  }
}

void System::rotate(const std::vector<Eigen::Matrix3d>& from, Vec U, bool back, Vec y) const {
  frame_axes(U, axes_);
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    axes_[i] = (axes_[i] * from[i].transpose()).eval();
    if (back) axes_[i].transposeInPlace();
  }
  petsc::Values values(y);
  for (const auto& [first, frame] : corotated_) {
    const Eigen::Matrix3d& Q = axes_[frame];
    if (frames_[frame].attitude) {
      Eigen::Map<Eigen::Vector3d> vector(&values[first]);
      vector = (Q * vector).eval();
    } else {
      Eigen::Map<Eigen::Vector2d> vector(&values[first]);
      vector = (Q.topLeftCorner<2, 2>() * vector).eval();
    }
  }
}

}  // namespace floe::dynamics
