/// \file
/// What to do with a point of a surface, by the kind of place it names.
#pragma once

#include "ahm/error.hpp"
#include "ahm/surface/surface_point.hpp"
#include "ahm/util/vec.hpp"

namespace ahm {

template <class... Visits>
struct Overloaded : Visits... {
  using Visits::operator()...;
};
template <class... Visits>
Overloaded(Visits...) -> Overloaded<Visits...>;

inline void check_finite(const Vec3& position) {
  if (!is_finite(position)) throw InvalidArgument("a position is not finite");
}

inline void check_finite(const TangentPoint& point) { check_finite(point.position); }

}  // namespace ahm
