#pragma once
#include <vector>

#include "campbell.h"

namespace floe::app {

/// Follows vibrations from speed to speed by their shapes (solve::modal_assurance): each vibration belongs to the track
/// whose last shape has the greatest assurance with its own, from the greatest on, down to `least_assurance`. What has
/// no shape (rigid-body modes) is followed by order among what is left of the speed before. Others begin a track.
class CampbellTracks {
 public:
  static constexpr double least_assurance = 0.2;

  /// Sets `track` and `assurance` of the vibrations at the next speed; their shapes move here.
  void follow(CampbellPoint& next);

 private:
  struct Track {
    solve::Vibration last;
    std::size_t seen = 0;  ///< number of the point
  };
  std::vector<Track> tracks_;
  std::size_t points_ = 0;
};

}  // namespace floe::app
