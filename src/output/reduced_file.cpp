#include "floe/output/reduced_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <tuple>

#include "dataset.h"
#include "floe/output/folder.h"
#include "floe/output/provenance.h"
#include "floe/petsc/error.h"
#include "floe/petsc/rank.h"
#include "reduced_file_hdf5.h"
#include "reduced_file_image.h"
#include "reduced_file_shapes.h"
#include "replaceable.h"
#include "writing.h"

namespace floe::output {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void refuse(const fs::path& path, const std::string& why) {
  throw InputError(fmt::format("reduced body '{}': {}", path.string(), why));
}

void refuse_taken(const fs::path& path, bool overwrite) {
  if (!path.has_filename()) refuse(path, "needs the name of a file");
  std::error_code ignored;
  const auto status = fs::status(path, ignored);
  if (fs::exists(status) && !fs::is_regular_file(status)) refuse(path, "exists and is not a file");
  if (fs::exists(status) && !is_of_format(path, reduced_format))
    refuse(path, "exists and is not a reduced body written by floe; use another name");
  if (fs::exists(status) && !overwrite) refuse(path, "exists; use another name, or replace it with --force");
}

void remove_draft(const fs::path& path) {
  std::error_code ignored;
  fs::remove(draft_of(path), ignored);
}

/// The draft with all but the shapes. What could not be read back is not written.
void write_draft(const fs::path& path, ReducedBodyFile file, bool shapes) {
  file.has_shapes = shapes;
  try {
    auto image = image_of(file, true);
    parse(open_image(image.bytes));
    if (shapes) image = image_of(file, false);
    write_file_atomically(draft_of(path), {image.bytes.data(), image.bytes.size()});
  } catch (const Fault& fault) {
    throw RunError(fault.what());
  } catch (const std::invalid_argument& misfit) {
    throw RunError(misfit.what());
  }
}

/// The last that is written, in place.
void mark_complete(const fs::path& draft) {
  Hid file = open_file(draft, Open::change, MPI_COMM_NULL);
  write_flag(file, "complete", 1);
  file.close();
}

/// HDF5 says neither of these well.
void check_readable(const fs::path& path) {
  std::error_code error;
  const auto status = fs::status(path, error);
  if (!fs::exists(status)) refuse(path, "does not exist");
  if (!fs::is_regular_file(status)) refuse(path, "is not a file");
  if (!std::ifstream(path)) refuse(path, "cannot be opened for reading");
}

/// What the file holds, and its image for the other ranks.
std::pair<ReducedBodyFile, Image> read_alone(const fs::path& path) {
  check_readable(path);
  try {
    silence_hdf5();
    const Hid access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    check_hdf5(H5Pset_file_locking(access, false, true));
    const Hid open(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access), H5Fclose);
    ReducedBodyFile file = parse(open);
    Image image = image_of(file, true);
    if (read_flag(open, "checksum") != image.checksum)
      throw Fault("expected contents that match its attribute 'checksum', found others: the file is damaged");
    return {std::move(file), std::move(image)};
  } catch (const Fault& fault) {
    refuse(path, fault.what());
  } catch (const std::exception& error) {
    refuse(path, fmt::format("expected a complete HDF5 file: {}", error.what()));
  }
}

void broadcast(MPI_Comm comm, std::vector<char>& bytes) {
  std::int64_t size = std::ssize(bytes);
  MPI_Bcast(&size, 1, MPI_INT64_T, 0, comm);
  bytes.resize(size);
  constexpr std::int64_t most = 1 << 30;
  for (std::int64_t at = 0; at < size; at += most)
    MPI_Bcast(bytes.data() + at, static_cast<int>(std::min(most, size - at)), MPI_CHAR, 0, comm);
}

}  // namespace

MadeBy made_here(MPI_Comm comm, std::string scene) {
  const auto all = provenance(comm);
  return {all["floe"]["version"], all["floe"]["commit"], all["date"],  all["command"],
          all["petsc_options"],   std::move(scene),      all["ranks"], {}};
}

void check_reduced_path(MPI_Comm comm, const fs::path& path, bool overwrite) {
  petsc::agree(comm, [&] {
    if (petsc::rank_of(comm) != 0) return;
    refuse_taken(path, overwrite);
    try {
      write_file_atomically(draft_of(path), "");
    } catch (const RunError& fault) {
      refuse(path, with_name(fault.what(), path));
    }
    remove_draft(path);
  });
}

void write_reduced_body(MPI_Comm comm, const fs::path& path, const ReducedBodyFile& file, bool overwrite,
                        const ReducedShapes* shapes) {
  const bool first = petsc::rank_of(comm) == 0;
  petsc::agree(comm, [&] {
    if (first) refuse_taken(path, overwrite);
  });
  try {
    petsc::agree(comm, [&] {
      if (first) writing(path, [&] { write_draft(path, file, shapes); });
    });
    if (shapes) writing(path, [&] { add_shapes(comm, draft_of(path), file, *shapes); });
    petsc::agree(comm, [&] {
      if (!first) return;
      writing(path, [&] {
        if (shapes) mark_complete(draft_of(path));
        publish_draft(draft_of(path), path);
      });
    });
  } catch (const RunError& fault) {
    if (first) remove_draft(path);
    throw RunError(with_name(fault.what(), path));
  } catch (const InputError&) {  // of whoever gives the columns
    if (first) remove_draft(path);
    throw;
  }
}

ReducedBodyFile read_reduced_body(MPI_Comm comm, const fs::path& path) {
  ReducedBodyFile file;
  Image image;
  petsc::agree(comm, [&] {
    if (petsc::rank_of(comm) != 0) return;
    std::tie(file, image) = read_alone(path);
  });
  broadcast(comm, image.bytes);
  petsc::agree(comm, [&] {
    if (petsc::rank_of(comm) != 0) file = parse(open_image(image.bytes));
  });
  return file;
}

}  // namespace floe::output
