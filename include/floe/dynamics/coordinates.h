#pragma once
#include <string>
#include <vector>

#include "floe/petsc/handle.h"

namespace floe::dynamics {

/// Numbering of the unknowns of a system: what each rank sees of them, and where that stands in PETSc's vectors.
///
/// Two kinds of block are added in turn, then number() fixes the layout:
///  - shared: a few unknowns that every rank reads and the last rank owns (frames, reduced coordinates, multipliers)
///  - distributed: finite-element dofs, this rank's own and the foreign ones it reads
///
/// "Local" indices count the blocks of one rank one after another in the order added, owned dofs before foreign ones.
class Coordinates {
 public:
  explicit Coordinates(MPI_Comm comm) : comm_(comm) {}

  /// Says what the blocks that are added from now on belong to (`body "arm"`), for messages. The same on all ranks.
  void belongs_to(std::string owner);

  /// Adds `count` shared unknowns, the same on all ranks. Returns the first local index.
  int add_shared(int count, bool multipliers = false);

  /// Adds a distributed block: this rank owns `owned` dofs (in rank order); `foreign` are block-wide indices of others.
  /// Returns the first local index.
  int add_distributed(PetscInt owned, std::vector<PetscInt> foreign);

  /// Says that a local unknown is an angle in world axes [rad]: of a frame in the plane, whose origin stands before it,
  /// or of a node.
  void add_angle(int local, bool of_frame) { angles_.push_back({local, of_frame}); }

  /// Fixes the layout. Collective.
  void number();

  MPI_Comm comm() const { return comm_; }
  int local_size() const { return local_size_; }
  PetscInt owned_size() const { return owned_size_; }
  PetscInt global_size() const { return global_size_; }
  /// Global index of each local unknown.
  const std::vector<PetscInt>& global() const { return global_; }
  /// Of each local unknown: whether it is a multiplier.
  const std::vector<char>& multiplier() const { return multiplier_; }
  /// Global indices of the multipliers that this rank owns, ascending.
  const std::vector<PetscInt>& owned_multipliers() const { return owned_multipliers_; }
  PetscInt multiplier_count() const { return multiplier_count_; }
  /// The local unknown of an angle, and whether it is that of a frame.
  struct Angle {
    int local;
    bool of_frame;
  };
  /// What add_angle() named, in its order: those that this rank sees.
  const std::vector<Angle>& angles() const { return angles_; }
  /// What belongs_to() named, in its order.
  const std::vector<std::string>& owners() const { return owners_; }
  /// Index of owners() of each local unknown, -1 where none was named.
  std::vector<int> owner_of_local() const;

 private:
  struct Block {
    bool shared;
    bool multipliers;
    PetscInt owned;  // on this rank
    std::vector<PetscInt> foreign;
    int first;  // local
    int owner;
  };
  MPI_Comm comm_;
  std::vector<Block> blocks_;
  std::vector<std::string> owners_;
  std::vector<Angle> angles_;
  int local_size_ = 0;
  PetscInt owned_size_ = 0, global_size_ = 0, multiplier_count_ = 0;
  std::vector<PetscInt> global_, owned_multipliers_;
  std::vector<char> multiplier_;
};

}  // namespace floe::dynamics
