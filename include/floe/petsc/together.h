#pragma once
#include <mpi.h>

#include <functional>
#include <string>

namespace floe::petsc {

/// Runs collective work that may fail, and lets all ranks know of it: why, the same on every rank (the first one that
/// failed), or empty.
///
/// A rank that fails alone leaves the others waiting within the work. Where they do not come within ten seconds it
/// throws what it has caught: nobody can go on then.
/// Collective.
std::string failed_together(MPI_Comm comm, const std::function<void()>& work);

}  // namespace floe::petsc
