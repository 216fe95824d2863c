/// \file
/// Arrays that have no values until they are written.
#pragma once

#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace ahm::detail {

/// Leaves what it makes room for as it is. Whoever writes a page of a large array first waits until the system has cleared it:
/// so it is left to the threads that fill it.
template <class T>
struct LeaveUnset : std::allocator<T> {
  static_assert(std::is_trivially_destructible_v<T>);
  template <class U>
  struct rebind {  // NOLINT(readability-identifier-naming): the name of the standard
    using other = LeaveUnset<U>;
  };
  LeaveUnset() = default;
  template <class U>
  explicit(false) LeaveUnset(const LeaveUnset<U>& /*other*/) noexcept {}
  template <class U>
  void construct(U* place) noexcept {
    ::new (static_cast<void*>(place)) U;
  }
  template <class U, class... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
  }
};

/// `UnsetVector<T>(n)` and `resize(n)` write nothing.
template <class T>
using UnsetVector = std::vector<T, LeaveUnset<T>>;

}  // namespace ahm::detail
