#include <fmt/format.h>

#include <algorithm>

#include "floe/scene/places.h"
#include "readers.h"

namespace floe::scene {
namespace {

std::optional<Point> checked_point(Document& document, const Body& body, const Place& place) {
  try {
    return place_point(body.mesh, place);
  } catch (const InputError& error) {
    document.fault(place.where, error);
    return {};
  }
}

void check_frame(Document& document, const Body& body) {
  const FrameSpec& frame = body.frame;
  const Point &start = body.mesh.points.front(), &end = body.mesh.points.back();
  if (frame.kind == FrameSpec::Kind::clamped) {
    const auto at = checked_point(document, body, frame.at);
    if (at && body.frames > 1 && *at != start && *at != end) {
      document.fault(frame.at.where, "lies inside the body", "start or end when there are several frames");
    }
  }
  if (frame.kind == FrameSpec::Kind::pinned) {
    const auto from = checked_point(document, body, frame.from), to = checked_point(document, body, frame.to);
    if (!from || !to) return;
    if (*from == *to) {
      document.fault(frame.where, "from and to are the same node, so that the frame's rotation is undetermined",
                     "two different places");
    } else if (body.frames > 1 && (*from != start || *to != end)) {
      document.fault(frame.where, "does not run from start to end", "start and end when there are several frames");
    }
  }
}

void refuse_interface(Document& document, const Body& body) {
  for (const Place& place : body.reduction.interface)
    document.fault(place.where, "cannot be combined with several frames", "an interface of a body in one frame");
}

void check_interface(Document& document, const Body& body) {
  for (const Place& place : body.reduction.interface) checked_point(document, body, place);
  if (body.frames > 1) refuse_interface(document, body);
}

void check_frames(Document& document, const Body& body) {
  if (body.frames == 1) return;
  Where where = body.where;
  where.key += ".frames";
  const bool line = body.mesh.segments.size() == 1;
  if (document.dimension == 2 && !line)
    document.fault(where, fmt::format("is {} for a planar mesh of several segments", body.frames),
                   "1, a single line, or a scene in space");
  else if (line && body.mesh.elements[0] % body.frames != 0)
    document.fault(where, fmt::format("is {} for {} elements", body.frames, body.mesh.elements[0]),
                   "a divisor of the number of elements");
  if (document.dimension == 3 && !line && body.frame.given && body.frame.kind != FrameSpec::Kind::mean_axis)
    document.fault(body.frame.where,
                   fmt::format("is given for {} frames of a mesh that is not a single line", body.frames),
                   "mean-axis, or no frame");
}

void check_modes(Document& document, const Body& body) {
  const ModesSpec& modes = body.reduction.modes;
  const int elastic = 3 * ((node_count(body.mesh) - 1) / body.frames);
  const auto check = [&](int count, const char* what) {
    if (count <= elastic) return;
    document.fault(modes.where, fmt::format("has {} modes{}", count, what),
                   fmt::format("at most {}, the elastic dofs of {}{}", elastic, body.name,
                               body.frames > 1 ? " in one of its frames" : ""));
  };
  check(modes.count, "");
  check(modes.alone, " alone");
  const int ratios = static_cast<int>(body.damping.modal.size());
  if (ratios > std::max(modes.count, modes.alone)) {
    document.fault(body.damping.where, fmt::format("modal has {} ratios", ratios),
                   fmt::format("at most {}, one for each mode", std::max(modes.count, modes.alone)));
  }
}

void check_initial(Document& document, const Body& body) {
  const auto check = [&](const auto& formulas, const char* key) {
    if (!formulas) return;
    Where where = body.initial.where;
    where.key += std::string(".") + key;
    try {
      for (const Point& p : body.mesh.points) {
        for (const auto& formula : *formulas) formula(p[0], p[1], p[2]);
      }
    } catch (const math::FormulaError& error) {
      document.fault(where, error.what(), "a finite number at every point of the body");
    }
  };
  check(body.initial.deformation, "deformation");
  check(body.initial.deformation_rate, "deformation_rate");
  check(body.initial.spatial_deformation, "deformation");
  check(body.initial.spatial_deformation_rate, "deformation_rate");
}

}  // namespace

void check_body(Document& document, const Body& body) {
  check_initial(document, body);
  if (body.rigid) return;
  const std::size_t before = document.fault_count();
  check_frames(document, body);
  if (document.fault_count() != before) return;
  if (document.dimension == 3) {  // the rest is checked on the mesh itself
    if (body.frames > 1 && body.frame.given && body.mesh.segments.size() == 1) check_frame(document, body);
    if (body.frames > 1) refuse_interface(document, body);
    return;
  }
  check_frame(document, body);
  check_interface(document, body);
  check_modes(document, body);
}

}  // namespace floe::scene
