#include "build_reduce.h"

namespace floe::scene {

std::vector<BodyReport> body_modes(const Scene& whole, MPI_Comm comm) {
  const Scene scene = split_frames(whole);
  const Prepared prepared = prepare(scene, comm);
  return modes_of_bodies(prepared);
}

}  // namespace floe::scene
