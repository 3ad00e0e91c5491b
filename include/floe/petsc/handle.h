#pragma once
#include <petscts.h>
#include <slepceps.h>

#include <utility>

#include "floe/petsc/error.h"

namespace floe::petsc {

/// Owns one PETSc or SLEPc object; moves, never copies, destroys at the end of its life.
///
/// A bare Vec, Mat, ... in an argument list is borrowed; a function that makes an object returns its handle.
template <class Object, PetscErrorCode (*destroy)(Object*)>
class Handle {
 public:
  Handle() = default;
  explicit Handle(Object object) : object_(object) {}
  Handle(Handle&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(object_, other.object_);
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (object_) destroy(&object_);
  }
  operator Object() const { return object_; }
  Object get() const { return object_; }
  /// Where a PETSc ...Create function puts the object; what was held before is destroyed.
  Object* out() {
    if (object_) destroy(&object_);
    object_ = nullptr;
    return &object_;
  }

 private:
  Object object_ = nullptr;
};

using VecHandle = Handle<Vec, VecDestroy>;
using MatHandle = Handle<Mat, MatDestroy>;
using KspHandle = Handle<KSP, KSPDestroy>;
using SnesHandle = Handle<SNES, SNESDestroy>;
using TsHandle = Handle<TS, TSDestroy>;
using IsHandle = Handle<IS, ISDestroy>;
using ScatterHandle = Handle<VecScatter, VecScatterDestroy>;
using MappingHandle = Handle<ISLocalToGlobalMapping, ISLocalToGlobalMappingDestroy>;
using BvHandle = Handle<BV, BVDestroy>;
using EpsHandle = Handle<EPS, EPSDestroy>;
using ViewerHandle = Handle<PetscViewer, PetscViewerDestroy>;

}  // namespace floe::petsc
