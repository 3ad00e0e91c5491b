#pragma once
#include <memory>
#include <string>
#include <vector>

#include "floe/assess/estimate.h"

namespace floe::assess {

/// A basis vector that the bodies of a scene may have; of the k-th piece of a split body (frames: N) with the label
/// `#k LABEL`.
struct CandidateVector {
  std::string body, label;  ///< `beam`, `derivative 1,2`
  bool response = false;    ///< of the error estimate: no scene names this one
  int piece = 0;            ///< of a body in several frames: of which one, from 1
};

/// A model on some basis vectors of a candidate basis. A body without any is rigid.
struct Selection {
  std::vector<char> taken;  ///< of each column of the candidate basis
  bool linear = false;      ///< elastic forces by the linear stiffness alone
  /// Above 0: in place of the correction vectors taken, so many times as many residual responses of the scene that
  /// text() writes (reduction.responses); no model of a candidate basis.
  double responses = 0;
  std::size_t count() const;
};

/// How much of a motion a column carries: the share of the elastic energy, summed over the instants, that it adds to
/// those before it.
struct EnergyContribution {
  std::size_t column;
  double share;
};

/// Candidate basis vectors of every body with a mesh, made once, and models of the scene on any of them.
///
/// Modes (as many as the scene says, or the default), attachment modes at all joints and loads, derivatives of the
/// generators that take part most in the linear motion, and the responses that estimates add. Bodies from files and
/// rigid ones are as the scene has them.
class CandidateBasis {
 public:
  /// @throws InputError, RunError  as build(). Collective; so is all that follows.
  CandidateBasis(const Scene& scene, MPI_Comm comm);
  ~CandidateBasis();
  const std::vector<CandidateVector>& columns() const;
  Selection whole() const;
  /// @param keep_offline  for an estimate of its error. The model does not outlive the candidate basis.
  Model model(const Selection& selection, bool keep_offline = false) const;
  /// The basis vectors W that an estimate of a model of this candidate basis found, in all bodies. @return how many
  /// there are
  int add_responses(const Estimate& estimate);
  /// Without the columns after the first `count`: responses that were added.
  void keep(std::size_t count);
  /// All columns that the motion of model(whole()) needs, the most important first: at each place the one that adds
  /// most to what the ones before it carry (orthogonal matching pursuit, in the norm of K). Columns within the span of
  /// those before are not among them.
  std::vector<EnergyContribution> energy_contribution(const Model& whole,
                                                      const std::vector<solve::State>& states) const;
  /// The scene with `columns` (and `rigid`, `elastic_force`) in its bodies and the steps of a motion, as text of a
  /// scene file; with responses among the basis vectors, without words for these.
  std::string text(const Selection& selection, const Motion& motion) const;
  /// Bodies that begin deformed: without a column that is taken they have their first one, and are not made rigid.
  std::vector<std::string> deformed() const;
  /// Whether it has correction vectors that no scene names.
  bool has_responses(const Selection& selection) const;
  /// That text into a file. Bodies with responses are written beside it, NAME-BODY.h5, and read from there.
  /// @return what was written, the scene first
  /// @throws InputError  a file exists and `overwrite` is not given; a split body with responses; RunError
  std::vector<std::string> write(const Selection& selection, const Motion& motion, const std::string& path,
                                 bool overwrite) const;

 private:
  /// Of all columns so far along the linear motion. @throws InputError  its start does not meet the joints
  std::vector<EnergyContribution> linear_energy_contribution(const Scene& scene) const;

  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// A scene with its own basis vectors into a file, in the steps of scene.motion and without `accuracy`.
/// @throws InputError  the file exists and `overwrite` is not given; RunError. Collective.
void write_scene(const Scene& scene, const std::string& path, bool overwrite, MPI_Comm comm);

}  // namespace floe::assess
