#pragma once
#include <petsclog.h>

#include "floe/petsc/error.h"

namespace floe::petsc {

/// A stage of the log (-log_view) for as long as it lives; made at its first use. Stages may be nested: the inner one
/// takes the time. Collective.
class Stage {
 public:
  explicit Stage(const char* name) {
    PetscLogStage stage = -1;
    check(PetscLogStageGetId(name, &stage));
    if (stage < 0) check(PetscLogStageRegister(name, &stage));
    check(PetscLogStagePush(stage));
  }
  Stage(const Stage&) = delete;
  ~Stage() { PetscLogStagePop(); }
};

}  // namespace floe::petsc
