#pragma once
#include <cstddef>
#include <vector>

#include "floe/assembly/model.h"

namespace floe::assembly {

/// Components of one probe at an instant, as in probe_values, without evaluating the others: those of forces in bodies
/// and of accelerations solve for consistent accelerations, one factorisation of the whole system. Collective.
std::vector<double> values_of_probe(const Model& model, std::size_t probe, double t, Vec U, Vec V);

}  // namespace floe::assembly
