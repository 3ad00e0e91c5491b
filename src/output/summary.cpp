#include "floe/output/summary.h"

#include "floe/petsc/error.h"

namespace floe::output {

void write_summary(MPI_Comm comm, const ResultFolder& folder, const nlohmann::ordered_json& summary) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  petsc::agree(comm, [&] {
    if (rank == 0) write_file_atomically(folder.summary(), summary.dump(2) + "\n");
  });
}

}  // namespace floe::output
