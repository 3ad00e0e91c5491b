#pragma once
#include <mpi.h>

#include <string>
#include <vector>

namespace floe::mesh {

/// A line (or, in a binary file, a byte) of one of the files that a mesh is read from.
struct Where {
  int file = 0;
  long long at = 0;
  auto operator<=>(const Where&) const = default;
};

/// What is wrong in the files, collected over the ranks and reported in the order of the files.
class Faults {
 public:
  /// @param binary  a Where counts bytes, not lines
  explicit Faults(bool binary = false) : binary_(binary) {}

  /// Names a file; returns its number.
  int add_file(const std::string& path);

  /// Those named, in their order.
  const std::vector<std::string>& files() const { return files_; }

  /// "path:line" or "path: byte n".
  std::string text_of(Where where) const;

  /// Keeps the first of this rank; the others are only counted as being there.
  void add(Where where, const std::string& text);
  bool any() const { return !faults_.empty(); }

  /// Throws the first faults of all ranks, each reported once, where any rank has one. Collective.
  /// @throws InputError  the same on every rank, whatever their number
  void throw_together(MPI_Comm comm) const;

  /// The texts of the first faults of all ranks, without their places. Collective.
  std::vector<std::string> texts_together(MPI_Comm comm) const;

 private:
  struct Fault {
    Where where;
    std::string text;
    auto operator<=>(const Fault&) const = default;
  };
  static constexpr std::size_t most_ = 20;
  Faults together(MPI_Comm comm) const;
  void shorten(std::vector<std::string>& lines) const;

  bool binary_;
  std::vector<std::string> files_;
  std::vector<Fault> faults_;
};

/// The texts of all ranks, each up to a byte 0, one rank after the other. Collective.
std::vector<std::string> gather_texts(MPI_Comm comm, const std::vector<std::string>& texts);

}  // namespace floe::mesh
