/// \file
/// Vectors whose new elements are not initialized.
#pragma once

#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace ahm::detail {

/// An allocator that default-initializes new elements, which leaves numbers unset. The system clears a page of memory on its first
/// write, so the threads that fill a large array share this cost.
template <class T>
struct DefaultInitAllocator : std::allocator<T> {
  static_assert(std::is_trivially_destructible_v<T>);
  template <class U>
  struct rebind {  // NOLINT(readability-identifier-naming): the name in the standard
    using other = DefaultInitAllocator<U>;
  };
  DefaultInitAllocator() = default;
  template <class U>
  explicit(false) DefaultInitAllocator(const DefaultInitAllocator<U>& /*other*/) noexcept {}
  template <class U>
  void construct(U* place) noexcept {
    ::new (static_cast<void*>(place)) U;
  }
  template <class U, class... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
  }
};

/// A vector whose constructor `UnsetVector<T>(n)` and `resize(n)` do not initialize elements.
template <class T>
using UnsetVector = std::vector<T, DefaultInitAllocator<T>>;

}  // namespace ahm::detail
