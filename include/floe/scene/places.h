#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "floe/scene/scene.h"

namespace floe::scene {

/// Nodes of a mesh: points that several segments share count once.
int node_count(const MeshSpec& mesh);

/// Sum of the lengths of the segments. [m]
double total_length(const MeshSpec& mesh);

/// Segment i runs from point i to point i + 1: a line or an unbranched polyline, where `middle` has a meaning.
bool unbranched(const MeshSpec& mesh);

/// Whether it is unbranched and has a node between its start and half its length.
bool has_middle(const MeshSpec& mesh);

/// The names that a place of every such mesh has: start, end, middle (has_middle); beside them p1, p2, ... points.
std::vector<std::string> place_names(const MeshSpec& mesh);

/// The node nearest to a point. O(segments).
Point nearest_node(const MeshSpec& mesh, const Point& point);

/// Coordinates of a place's node in the axes of the mesh. [m]
///
/// start, end: first and last point; pN: N-th point; middle: the node at half the total length, or the last one before
/// it; coordinates: the node within 1e-6 of its element's length.
/// @param place  of the body that has this mesh, not of the ground
/// @throws InputError (with place.where) when there is no such node; names the nearest. So where `middle` would be the
/// first point
Point place_point(const MeshSpec& mesh, const Place& place);
/// Likewise; on a rigid body any point is a place, and `middle` is at half the total length.
Point place_point(const Body& body, const Place& place);

/// How far before half the total length the node `middle` is, along the line; 0 but for round-off: it is there. [m]
double short_of_middle(const MeshSpec& mesh);

/// Words about a probe of the deflection at a place where the body never deflects from its floating frame.
std::string never_deflects(const Probe& probe, const Body& body);

/// Words about every place `middle` of the scene that has no node at half the length.
std::vector<std::string> middles_beside_nodes(const Scene& scene);

}  // namespace floe::scene
