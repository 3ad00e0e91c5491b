#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "floe/assembly/reduce_once.h"
#include "floe/output/folder.h"
#include "floe/scene/variation.h"

namespace floe::app {

/// One of a sweep's parameters and its values.
struct Varied {
  std::string path;
  std::vector<double> values;
};
/// `PATH=FROM:TO:STEP` or `PATH=A,B,C`. @throws InputError  anything else, or more than 100000 values
Varied parse_varied(const std::string& text);

/// The members: every combination, the last parameter fastest; `together`: the i-th value of all, equally many of each.
/// @throws InputError  one path twice, more than a million members, unequal numbers of values
std::vector<std::vector<scene::Variation>> members_of(const std::vector<Varied>& varied, bool together);

/// What came of one member.
struct Member {
  std::string fault = {};  ///< empty: it was finished
  PetscInt steps = 0;
  double end = 0;                                          ///< reached [s]
  std::vector<std::vector<double>> rows = {};              ///< time and probes
  std::vector<double> greatest = {}, rms = {}, last = {};  ///< of each probe: greatest absolute value, over time; end
  std::vector<std::string> warnings = {};                  ///< what floe run would note
  std::vector<double> errors = {};  ///< of each probe, where they are estimated: total (error_budget.h); NaN: none
};

/// A warning of some members: the same words for all of them, whatever numbers stand in it.
struct SweepWarning {
  std::string text;                   ///< as the first of them has it
  std::vector<std::int64_t> members;  ///< their numbers, from 1, ascending
  std::vector<scene::Variation> of;   ///< what the first one was moved with
};
/// A warning's words, with # in place of each number that stands alone ("slopes to 2.7": "slopes to #"; "beam2" stays).
std::string without_numbers(const std::string& text);
/// In the terminal's words: text, the first member and what was varied in it, how many more.
std::string words_of(const SweepWarning& warning);

/// What `floe sweep` is asked for.
struct SweepRequest {
  std::string scene;  ///< its file
  scene::Formulation formulation;
  std::vector<Varied> varied;
  bool together = false;     ///< members_of
  bool estimate = false;     ///< the total error of each member, its bodies reduced anew, in the time budget of a run
  int ranks_per_member = 1;  ///< at least 1
};

/// `floe sweep`: simulates a reduced scene with some of its numbers varied.
///
/// Groups of ranks_per_member consecutive ranks (the last one of what remains) prepare and simulate members of their
/// own: member i in group i mod the number of groups, so that neighbours, which cost alike, go to different groups, and
/// nothing depends on who is faster. Bodies are reduced anew only where what they are made of
/// changes (scene::offline_inputs). A member that fails is reported, and the others go on; warnings of members are
/// printed at the end, once for all that have them. Rank 0 writes members in their order into sweep.h5 and sweep.csv,
/// as they come in: a sweep that is killed leaves whole files.
/// @throws InputError  before anything is simulated: more ranks for a member than there are, a path that the scene does
/// not have, a folder in use
/// @throws RunError    members failed, how many and the first reason; it was interrupted. Collective.
void sweep(const SweepRequest& request, MPI_Comm comm, const output::ResultFolder& folder);

}  // namespace floe::app
