#pragma once
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "floe/assembly/body_stage.h"
#include "floe/assembly/offline.h"
#include "floe/assembly/start_vectors.h"
#include "floe/assess/candidate_basis.h"

namespace floe::assess {

/// What one body may have.
struct Source {
  Stage stage;
  BodyReport report;
  reduction::Columns columns;
  std::vector<reduction::ColumnOrigin> origins;
  std::vector<std::size_t> group;  ///< of each column: its place in the candidate basis
  std::shared_ptr<const reduction::Statics> statics;
};

struct CandidateBasis::Parts {
  Scene whole;  ///< as the user wrote it
  MPI_Comm comm;
  std::shared_ptr<Offline> offline;  ///< of the bodies as flexible as they come
  std::vector<Source> sources;       ///< of each body
  std::vector<CandidateVector> columns;
  mutable std::map<std::vector<char>, std::shared_ptr<Offline>> rigid;  ///< by the bodies that are made rigid
  mutable std::map<std::pair<std::size_t, std::vector<char>>, ReducedBody> reduced;

  Parts(const Scene& scene, MPI_Comm communicator);

  const PlannedBody& body(std::size_t b) const { return offline->plan.bodies[b]; }
  bool flexible(std::size_t b) const { return is_meshed(body(b).spec); }

  std::size_t group_of(std::size_t b, const std::string& plain, bool response) {
    const std::string name = whole_name(body(b).spec), label = label_of_piece(body(b).spec, plain);
    for (std::size_t i = 0; i < columns.size(); ++i)
      if (columns[i].body == name && columns[i].label == label) return i;
    columns.push_back({name, label, response, body(b).spec.piece});
    return columns.size() - 1;
  }

  void add(std::size_t b, petsc::VecHandle column, reduction::ColumnOrigin origin, bool response) {
    Source& source = sources[b];
    source.group.push_back(group_of(b, origin.label, response));
    source.columns.push_back(std::move(column));
    source.origins.push_back(std::move(origin));
  }

  const ReducedBody& reduced_body(std::size_t b, const std::vector<char>& taken) const;
  std::shared_ptr<Offline> offline_of(const std::vector<char>& made_rigid) const;
  std::vector<char> taken_of(std::size_t b, const Selection& selection) const {
    std::vector<char> taken;
    for (const std::size_t group : sources[b].group) taken.push_back(selection.taken[group]);
    return taken;
  }
  std::vector<char> made_rigid(const Selection& selection) const {
    std::vector<char> all(sources.size(), 0);
    for (std::size_t b = 0; b < sources.size(); ++b) {
      const std::vector<char> taken = taken_of(b, selection);
      all[b] = flexible(b) && !starts_deformed(body(b)) && std::find(taken.begin(), taken.end(), 1) == taken.end();
    }
    for (std::size_t b = 0; b < sources.size(); ++b)  // of a split body all pieces or none
      for (std::size_t other = 0; other < sources.size(); ++other)
        if (!all[other] && whole_name(body(b).spec) == whole_name(body(other).spec)) all[b] = 0;
    return all;
  }
  std::shared_ptr<Offline> offline_of(const Selection& selection) const {
    const std::vector<char> all = made_rigid(selection);
    return std::find(all.begin(), all.end(), 1) == all.end() ? offline : offline_of(all);
  }
  /// Bodies of the scene that begin deformed.
  std::set<std::string> deformed() const;
  bool shares_frames(const Selection& selection) const { return offline_of(selection)->scene.share_frames; }
  reduction::Pairs leading_pairs(std::size_t b, const std::vector<EnergyContribution>& order) const;
  void add_derivatives(std::size_t b, const std::set<std::string>& offered);
};

}  // namespace floe::assess
