#include "../../../src/app/options.h"

#include <catch2/catch.hpp>
#include <filesystem>

#include "../../../src/app/options_probe.h"

using namespace floe::app;
using Catch::Matchers::Contains;

TEST_CASE("options with a prefix of floe's solvers or of PETSc's own pass") {
  for (const char* name :
       {"modes_eps_nev", "derivatives_ksp_rtol", "motion_ts_max_steps", "motion_start_ksp_type", "static_snes_monitor",
        "ranking_ts_type", "mat_mumps_icntl_14", "bv_type", "vec_view", "mesh_mat_partitioning_type", "options_left",
        "options_view", "memory_view", "viewer_hdf5_collective"})
    CHECK(option_fault(name, "") == "");
}

TEST_CASE("options with another prefix are refused, with the one that is near") {
  CHECK_THAT(option_fault("ts_dt", "1e-4"), Contains("did you mean -motion_ts_dt?"));
  CHECK_THAT(option_fault("eps_nev", "3"), Contains("did you mean -modes_eps_nev?"));
  CHECK_THAT(option_fault("pc_type", "lu"), Contains("did you mean -derivatives_pc_type?"));
  CHECK_THAT(option_fault("mode_eps_nev", "3"), Contains("did you mean -modes_eps_nev?"));
  CHECK_THAT(option_fault("option_left", ""), Contains("did you mean -options_left?"));
  for (const char* name : {"options_leftt", "log_vieww", "infoo", "vec_viewer", "on_error_abortt"})
    CHECK_THAT(option_fault(name, ""), Contains("unknown prefix; did you mean -"));
  CHECK_THAT(option_fault("mat_type", "aij"), Contains("unknown prefix"));
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

TEST_CASE("options that no solver reads are found without a scene, with the nearest that one reads") {
  const auto fault = [](const std::vector<Option>& options) {
    const auto faults = faults_of(options);
    return faults.empty() ? std::string() : faults.front();
  };
  // read by each kind of object: TS, SNES, line search, KSP, PC, factor, EPS, ST, PEP, MatPartitioning, BV
  const std::vector<std::pair<Option, std::string>> misspelt = {
      {{"motion_ts_monitorr", ""}, "motion_ts_monitor"},
      {{"ranking_ts_adapt_typ", "basic"}, "ranking_ts_adapt_type"},
      {{"motion_start_ksp_tpye", "gmres"}, "motion_start_ksp_type"},
      {{"static_snes_converged_reasn", ""}, "static_snes_converged_reason"},
      {{"static_snes_linesearch_monitorr", ""}, "static_snes_linesearch_monitor"},
      {{"estimate_pc_factor_zeropivt", "1"}, "estimate_pc_factor_zeropivot"},
      {{"derivatives_mat_mumps_icntl_144", "9"}, "derivatives_mat_mumps_icntl_14"},
      {{"modes_eps_view_valuess", ""}, "modes_eps_view_values"},
      {{"modes_st_pc_tpye", "lu"}, "modes_st_pc_type"},
      {{"campbell_pep_monitr", ""}, "campbell_pep_monitor"},
      {{"mesh_mat_partitioning_typ", "metis"}, "mesh_mat_partitioning_type"},
      {{"bv_orthog_blok", "gs"}, "bv_orthog_block"}};
  for (const auto& [option, nearest] : misspelt) {
    CHECK_THAT(fault({option}), Contains("option " + written(option) + ": unknown"));
    CHECK_THAT(fault({option}), Contains("did you mean -" + nearest + "?"));
    CHECK(fault({{nearest, option.second}}) == "");
  }
  const auto two = faults_of({{"motion_ts_monitorr", ""}, {"motion_ts_dt", "0.1"}, {"modes_eps_nve", "3"}});
  CHECK(two.size() == 2);
}

TEST_CASE("options within a preconditioner are read where one of its type is selected") {
  const Option inner{"derivatives_mg_levels_2_sub_pc_type", "lu"};
  CHECK(faults_of({inner}).size() == 1);
  CHECK(faults_of({inner, {"derivatives_pc_type", "jacobi"}}).size() == 1);
  CHECK(faults_of({inner, {"derivatives_pc_type", "gamg"}}).empty());
  CHECK(faults_of({inner, {"derivatives_pc_type", "gamg"}, {"derivatives_mg_levels_2_pc_type", "asm"}}).empty());
  CHECK(faults_of({inner, {"derivatives_pc_type", "gamg"}, {"derivatives_mg_levels_2_pc_type", "sor"}}).size() == 1);
  const Option gamg{"derivatives_pc_type", "gamg"};
  const std::vector<Option> read = {
      {"pc_gamg_esteig_ksp_pc_side", "left"}, {"pc_gamg_esteig_ksp_cg_single_reduction", ""},
      {"pc_gamg_esteig_pc_jacobi_abs", ""},   {"mg_coarse_pc_bjacobi_blocks", "1"},
      {"mg_coarse_sub_pc_type", "lu"},        {"mg_levels_ksp_chebyshev_esteig", "0,0.1,0,1.1"},
      {"mg_levels_esteig_ksp_max_it", "5"},   {"mg_levels_ksp_converged_reason", ""}};
  for (const auto& [name, value] : read) CHECK(faults_of({gamg, {"derivatives_" + name, value}}).empty());
  const auto misspelt = faults_of({gamg, {"derivatives_mg_levels_pc_typ", "sor"}});
  REQUIRE(misspelt.size() == 1);
  CHECK_THAT(misspelt[0], Contains("did you mean -derivatives_mg_levels_pc_type?"));
}

TEST_CASE("a value that PETSc rejects is named with its option") {
  const auto faults = faults_of({{"motion_snes_max_it", "4"}, {"motion_ts_dt", "abc"}, {"modes_eps_nev", "3"}});
  REQUIRE(faults.size() == 1);
  CHECK_THAT(faults[0], Contains("option -motion_ts_dt abc: is rejected: PETSc error 63"));
  const auto type = faults_of({{"mesh_mat_partitioning_type", "foo"}});
  REQUIRE(type.size() == 1);
  CHECK_THAT(type[0], Contains("option -mesh_mat_partitioning_type foo: is rejected"));
  // of two, neither is the only one
  const auto both = faults_of({{"motion_ts_dt", "abc"}, {"modes_eps_nev", "x"}});
  REQUIRE(both.size() == 1);
  CHECK_THAT(both[0], Contains("an option -") && Contains("is rejected: ") && !Contains("judged"));
}

TEST_CASE("viewers of options that are only judged write no files") {
  CHECK(faults_of({{"motion_ts_monitor", ":options_test_never.txt"}, {"static_ksp_view", "binary"}}).empty());
  CHECK_FALSE(std::filesystem::exists("options_test_never.txt"));
  CHECK_FALSE(std::filesystem::exists("binaryoutput"));
}

TEST_CASE("times of the motion are positive and finite") {
  for (const char* value : {"-1", "0", "nan", "inf", "-1e-3"}) {
    CHECK_THAT(option_fault("motion_ts_dt", value), Contains("is not a positive number"));
    CHECK_THAT(option_fault("motion_ts_max_time", value), Contains("is not a positive number"));
  }
  for (const char* value : {"1e-3", "2", "abc", ""}) CHECK(option_fault("motion_ts_dt", value) == "");
}
