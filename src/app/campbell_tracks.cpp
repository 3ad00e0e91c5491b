#include "campbell_tracks.h"

#include <algorithm>

namespace floe::app {
namespace {

struct Pair {
  std::size_t track, vibration;
  double assurance;
};

/// Neither a growth nor a decay without oscillation.
bool is_followed(const solve::Vibration& one) { return one.omega != 0 || one.zero; }

}  // namespace

void CampbellTracks::follow(CampbellPoint& next) {
  if (next.vibrations.empty()) return;
  std::vector<Pair> pairs;
  for (std::size_t t = 0; t < tracks_.size(); ++t)
    for (std::size_t v = 0; v < next.vibrations.size(); ++v)
      if (const double found = solve::modal_assurance(tracks_[t].last, next.vibrations[v]); found >= least_assurance)
        pairs.push_back({t, v, found});
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.assurance > b.assurance; });

  ++points_;
  const auto assign = [&](std::size_t track, TrackedVibration& vibration, double assurance) {
    vibration.track = static_cast<int>(track) + 1, vibration.assurance = assurance;
    tracks_[track] = {std::move(static_cast<solve::Vibration&>(vibration)), points_};
    vibration.shape.resize(0), vibration.momentum.resize(0);
  };
  for (const Pair& pair : pairs)
    if (TrackedVibration& one = next.vibrations[pair.vibration]; one.track == 0 && tracks_[pair.track].seen < points_)
      assign(pair.track, one, pair.assurance);
  for (TrackedVibration& one : next.vibrations) {
    if (one.track != 0 || !is_followed(one)) continue;
    const auto left = std::find_if(tracks_.begin(), tracks_.end(), [&](const Track& track) {
      return track.seen + 1 == points_ && (track.last.shape.size() == 0 || one.shape.size() == 0);
    });
    const auto track = static_cast<std::size_t>(left - tracks_.begin());
    if (left == tracks_.end()) tracks_.emplace_back();
    assign(track, one, 0);
  }
}

}  // namespace floe::app
