#pragma once
#include <map>

#include "tradeoff.h"

namespace floe::app {

/// What distinguishes the full-order model (nlffr) of a scene from others of the hierarchy: mesh, frames, strains,
/// step and integrator.
std::string full_order_key(const scene::Scene& scene);

/// Simulates members of a hierarchy and measures their errors.
class TradeoffRun {
 public:
  /// @param own         the full-order model (nlffr) of the scene's own mesh and step
  /// @param no_cfr      why formulation cfr is not simulated; empty: it is
  TradeoffRun(const scene::Scene& scene, const TradeoffRequest& request, const TradeoffReference& reference,
              const RunResult& own, const std::string& no_cfr, MPI_Comm comm);

  /// Full-order members first: reduced ones are compared with them. Every rank takes each so many of the members; all
  /// ranks get all model variants, in the order of the members. Collective.
  std::vector<ModelVariant> evaluate_all(const std::vector<Candidate>& members);

 private:
  struct Climbed {
    ModelVariant variant;
    Series series;  // of full-order models
  };
  std::vector<Climbed> climb_some(const std::vector<const Candidate*>& members);
  Climbed evaluate(const Candidate& member, MPI_Comm comm) const;
  Climbed simulated(const Candidate& member, MPI_Comm comm) const;
  Climbed selected(const Candidate& member, MPI_Comm comm) const;
  ModelVariant measured(const RunResult& result) const;
  void compare_with_full_order(const scene::Scene& scene, const Series& series, MPI_Comm comm,
                               ModelVariant& variant) const;
  double full_order_seconds(const scene::Scene& scene) const;
  void take_estimate(const nlohmann::ordered_json& estimate, ModelVariant& variant) const;

  const scene::Scene& scene_;
  const TradeoffRequest& request_;
  const TradeoffReference& reference_;
  const RunResult& own_;
  std::string no_cfr_;
  MPI_Comm comm_;
  std::vector<std::string> probes_;
  std::map<std::string, Series> full_;  ///< of full-order models, by key
};

}  // namespace floe::app
