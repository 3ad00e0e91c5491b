#include "gathered_file.h"

#include "floe/error.h"
#include "floe/petsc/error.h"

namespace floe::mesh {

GatheredFile::GatheredFile(MPI_Comm comm, std::string path) : comm_(comm), path_(std::move(path)) {
  MPI_Comm_rank(comm, &rank_);
  MPI_Comm_size(comm, &ranks_);
  petsc::agree(comm, [&] {
    if (rank_ == 0) file_.open(path_, std::ios::binary);
    if (rank_ == 0 && !file_) throw RunError(path_ + ": cannot be opened for writing");
  });
}

void GatheredFile::add(const std::string& text) {
  if (rank_ == 0) file_.write(text.data(), static_cast<std::streamsize>(text.size()));
}

void GatheredFile::receive(int from) {
  std::string piece;
  for (;;) {
    MPI_Status status;
    int size = 0;
    MPI_Probe(from, 0, comm_, &status);
    MPI_Get_count(&status, MPI_CHAR, &size);
    piece.resize(size);
    MPI_Recv(piece.data(), size, MPI_CHAR, from, 0, comm_, MPI_STATUS_IGNORE);
    if (size == 0) return;
    add(piece);
  }
}

void GatheredFile::add_all(std::size_t count, const std::function<void(std::size_t, std::string&)>& record) {
  constexpr std::size_t full = 1 << 20;  // bytes of a piece
  std::string piece;
  const auto send = [&] {
    // Synchronous: a rank whose turn has not come waits with one piece.
    rank_ == 0 ? add(piece) : void(MPI_Ssend(piece.data(), static_cast<int>(piece.size()), MPI_CHAR, 0, 0, comm_));
    piece.clear();
  };
  for (std::size_t i = 0; i < count; ++i) {
    record(i, piece);
    if (piece.size() >= full) send();
  }
  if (!piece.empty()) send();
  if (rank_ > 0) return send();  // an empty piece ends
  for (int r = 1; r < ranks_; ++r) receive(r);
}

void GatheredFile::close() {
  petsc::agree(comm_, [&] {
    if (rank_ > 0) return;
    file_.close();
    if (!file_) throw RunError(path_ + ": not all could be written");
  });
}

}  // namespace floe::mesh
