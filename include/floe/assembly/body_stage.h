#pragma once
#include "floe/assembly/reduce_bodies.h"
#include "floe/reduction/reduce.h"

namespace floe::assembly {

/// What one body carries through the stages of its reduction.
struct Stage {
  fem::Holding for_modes, for_statics;
  std::unique_ptr<reduction::Statics> statics;
  std::unique_ptr<reduction::ModeSolver> solver;
  std::vector<reduction::Attachment> attachments;
  reduction::Generators generators;
  std::optional<reduction::Modes> damped;  ///< modes_for_damping()
  reduction::Pairs pairs;
  std::vector<char> left_out;  ///< of the generators; empty: none
  /// Those that damping.modal refers to.
  const reduction::Modes& modes_of_damping() const { return damped ? *damped : generators.modes; }
};

/// In place of a count of modes: the default, or fewer where the body has fewer under its conditions.
constexpr int as_the_body_has = -1;
int count_of_modes(const PlannedBody& body);

/// How the body is constrained when it vibrates in its modes. Collective.
fem::Holding holding_of_modes(const Plan& plan, int index);

/// Factors, modes and attachment modes. @param modes  how many, or as_the_body_has. Collective.
void begin_stage(const Plan& plan, int index, int modes, Stage& stage, BodyReport& report);

/// (Re)makes the generators, with the lowest `modes` modes. Collective.
void generate(const Plan& plan, int index, int modes, Stage& stage, BodyReport& report);

/// Pairs of generators that the scene asks derivatives of; those by count come later.
/// @throws InputError  a mode that the body does not have
reduction::Pairs pairs_of(const DerivativesSpec& spec, const reduction::Generators& generators);

/// Of the body as the user wrote it, which `frames` may have split into pieces (split_frames).
const std::string& whole_name(const Body& body);
/// A label among those of all pieces: `#2 mode 1` of beam#2, as it is of a body in one frame.
std::string label_of_piece(const Body& body, const std::string& label);
/// The labels of reduction.columns that refer to the body: those without a piece, and those of its own (`#2 mode 1`).
std::vector<std::string> named_columns(const Body& body);

/// Leaves the stage those generators and pairs that reduction.columns names and that there are. A body's pieces differ
/// in their attachment modes: each takes what it has.
/// @return  the labels of all that there are
std::vector<std::string> keep_named(const PlannedBody& body, Stage& stage);

/// @param labels  of each body what keep_named gave; none: it has no reduction.columns
/// @throws InputError  columns that no piece of the body has, with the nearest
void refuse_unknown(const Plan& plan, const std::vector<std::vector<std::string>>& labels);

/// Collective.
reduction::DerivativeColumns derivatives_of(const PlannedBody& body, const Stage& stage, const reduction::Pairs& pairs,
                                            bool full);

/// The body on generators and derivatives. Collective.
void end_stage(const PlannedBody& body, const Stage& stage, reduction::DerivativeColumns derivatives,
               ReducedBody& reduced);

/// The body on a basis, with its modal damping; `reduced` gets all but statics and what the report knows of modes.
/// Collective.
void project_onto(const PlannedBody& body, std::shared_ptr<reduction::Basis> basis, const reduction::Statics& statics,
                  const reduction::Modes& modes, ReducedBody& reduced);

/// The displacements over which the energy of the body is to be condensed (ReducedBody::relief), of one that was
/// projected with all products. Collective.
void find_relief(const PlannedBody& body, const reduction::Statics& statics, ReducedBody& reduced);

/// The elasticity condensed over what `relief` has (reduction::condensed). Collective.
void condense(const PlannedBody& body, ReducedBody& reduced);

/// reduction.elastic_force, condense() and reduction.products, of a body that was projected with all products.
/// Collective.
void finish_elasticity(const PlannedBody& body, ReducedBody& reduced);

}  // namespace floe::assembly
