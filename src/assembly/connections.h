#pragma once
#include <map>
#include <memory>
#include <vector>

#include "floe/dynamics/connection.h"
#include "floe/scene/scene.h"

namespace floe::assembly {

/// The terms of each joint, by its index: rows, what locks it, stops, springs. On the rank that has them.
using Connections = std::map<std::size_t, std::vector<const dynamics::Connection*>>;

/// Those of the joint that a probe measures; none of a probe of a place. Rank-local.
std::vector<const dynamics::Connection*> measured(const Connections& all, const scene::Scene& scene,
                                                  const scene::Probe& probe);

/// What the connections exert together on their second place, which they have in common. Rank-local.
/// @param q, v  local coordinates and rates of the system
dynamics::Wrench exerted(const std::vector<const dynamics::Connection*>& connections, double t,
                         const Eigen::VectorXd& q, const Eigen::VectorXd& v);

/// Unstretched length of a spring: as given, or that of its tension at the start, `apart` the distance there.
/// @throws InputError  a preload of places that coincide
double relaxed_length(const scene::Joint& joint, double apart, double extent);

/// @throws InputError  a probe measures one of the joints, whose multipliers are not determined
void refuse_undetermined(const scene::Scene& scene, const std::vector<int>& joints);

}  // namespace floe::assembly
