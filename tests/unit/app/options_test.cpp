#include "../../../src/app/options.h"

#include <catch2/catch.hpp>

using namespace floe::app;
using Catch::Matchers::Contains;

TEST_CASE("options with a prefix of floe's solvers or of PETSc's own pass") {
  for (const char* name :
       {"modes_eps_nev", "derivatives_ksp_rtol", "motion_ts_max_steps", "motion_start_ksp_type", "static_snes_monitor",
        "ranking_ts_type", "mat_mumps_icntl_14", "bv_type", "vec_type", "mesh_mat_partitioning_type", "log_view",
        "options_left", "options_view", "malloc_dump", "on_error_abort"})
    CHECK(option_fault(name, "") == "");
}

TEST_CASE("options with another prefix are refused, with the one that is near") {
  CHECK_THAT(option_fault("ts_dt", "1e-4"), Contains("did you mean -motion_ts_dt?"));
  CHECK_THAT(option_fault("eps_nev", "3"), Contains("did you mean -modes_eps_nev?"));
  CHECK_THAT(option_fault("pc_type", "lu"), Contains("did you mean -derivatives_pc_type?"));
  CHECK_THAT(option_fault("mode_eps_nev", "3"), Contains("did you mean -modes_eps_nev?"));
  CHECK_THAT(option_fault("option_left", ""), Contains("did you mean -options_left?"));
  CHECK_THAT(option_fault("foo_bar", "1"), Contains("expected -modes_..., -derivatives_..., -motion_..."));
}

TEST_CASE("options that would change what is solved, or end in PETSc, are refused by name") {
  const auto refused = [](const char* name, const char* value) {
    const std::string fault = option_fault(name, value);
    return fault.find(std::string("option -") + name) == 0;
  };
  CHECK(refused("motion_ts_exact_final_time", "INTERPOLATE"));
  CHECK(refused("ranking_ts_init_time", "1"));
  CHECK(refused("motion_snes_type", "ksponly"));
  CHECK(refused("static_snes_type", "vinewtonrsls"));
  CHECK(refused("motion_start_ksp_type", "pipelcg"));
  CHECK(refused("modes_eps_hermitian", ""));
  CHECK(refused("modes_st_pc_factor_mat_ordering_type", "wbm"));
  CHECK_FALSE(refused("motion_ts_exact_final_time", "MatchStep"));
  CHECK_FALSE(refused("motion_ts_monitor_cancel", "false"));
  CHECK_FALSE(refused("static_snes_type", "newtontr"));
  CHECK_FALSE(refused("motion_ksp_type", "gmres"));
  CHECK_FALSE(refused("modes_eps_gen_hermitian", ""));
}

TEST_CASE("times of the motion are positive and finite") {
  for (const char* value : {"-1", "0", "nan", "inf", "-1e-3"}) {
    CHECK_THAT(option_fault("motion_ts_dt", value), Contains("is not a positive number"));
    CHECK_THAT(option_fault("motion_ts_max_time", value), Contains("is not a positive number"));
  }
  for (const char* value : {"1e-3", "2", "abc", ""}) CHECK(option_fault("motion_ts_dt", value) == "");
}
