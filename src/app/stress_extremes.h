#pragma once
#include <mpi.h>

#include "floe/assess/stress_fields.h"

namespace floe::app {

/// Where and when a stress is greatest.
struct Peak {
  double value = -1;  ///< [Pa]; -1: there is none
  std::size_t row = 0, cell = 0;
  int rank = 0;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< mesh axes
  assess::Singular singular = assess::Singular::none;
};

/// Extremes over the motion: of each element of this rank, and of the body.
struct Extremes {
  std::vector<double> von_mises, greatest_principal, least_principal;
  std::vector<std::size_t> row;  ///< of von_mises
  Peak greatest;                 ///< of von Mises' stress
  Peak regular;                  ///< away from singular places
};

/// Collective; `greatest` and `regular` are the same on all ranks.
Extremes find_extremes(const assess::BodyStress& stress, const std::vector<std::size_t>& rows, MPI_Comm comm);

/// Of elements over the motion, for files: von_mises_max, time_of_max, stress_max_of_all, stress_min_of_all, singular.
std::vector<output::CellField> constant_fields();
std::vector<double> constant_values(const Extremes& extremes, const assess::BodyStress& stress,
                                    const std::vector<double>& times);

/// `at a point load or joint: singular, ...`; empty for none.
std::string words_of(assess::Singular singular);

}  // namespace floe::app
