#pragma once
#include <mpi.h>

#include <nlohmann/json.hpp>

#include "floe/output/folder.h"

namespace floe::output {

/// Replaces summary.json: written at the start of a run ("running") and at its end ("finished", "failed"), whole at
/// every moment.
///
/// @param summary  used on rank 0
/// @throws RunError  on every rank
/// Collective.
void write_summary(MPI_Comm comm, const ResultFolder& folder, const nlohmann::ordered_json& summary);

}  // namespace floe::output
