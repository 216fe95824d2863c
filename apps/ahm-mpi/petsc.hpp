/// \file
/// Owning handles for PETSc objects, and exceptions for its error codes.
#pragma once

#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <petscksp.h>

#include <string>
#include <type_traits>
#include <utility>

#include "ahm/error.hpp"

static_assert(std::is_same_v<PetscScalar, double>,
              "this PETSc uses complex or single-precision numbers; select another one with PKG_CONFIG_PATH, or "
              "AHM_WITH_MPI=OFF");

namespace ahm::tiles::mpi {

/// Checks a result of PETSc. @throws ResourceExhausted, Error with the message of PETSc
inline void check(PetscErrorCode code) {
  if (code == 0) return;
  const char* text = nullptr;
  char* detail = nullptr;
  PetscErrorMessage(code, &text, &detail);
  if (code == PETSC_ERR_MEM) throw ResourceExhausted("PETSc: out of memory; use more machines");
  throw Error(std::string("PETSc: ") + (text != nullptr ? text : "error " + std::to_string(code)) +
              (detail != nullptr && *detail != '\0' ? std::string("; ") + detail : ""));
}

/// Owns a Mat, Vec or KSP.
template <class T, PetscErrorCode (*destroy)(T*)>
class Handle {
 public:
  Handle() = default;
  ~Handle() { static_cast<void>(destroy(&object_)); }
  Handle(Handle&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(object_, other.object_);
    return *this;
  }
  T get() const noexcept { return object_; }
  T* out() noexcept { return &object_; }

 private:
  T object_ = nullptr;
};

using Matrix = Handle<Mat, MatDestroy>;
using Vector = Handle<Vec, VecDestroy>;
using Krylov = Handle<KSP, KSPDestroy>;

}  // namespace ahm::tiles::mpi
