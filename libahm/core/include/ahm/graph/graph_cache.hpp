/// \file
/// Keeps data that is computed from an immutable graph, so that all solvers of the graph share it.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <mutex>

namespace ahm {

/// Data computed from one graph, at most once per kind. May be used from many threads at once.
class GraphCache {
 public:
  enum class Kind { one_rings, one_rings_with_midpoints };

  GraphCache() = default;
  /// A copy of a graph computes its own data.
  GraphCache(const GraphCache&) : GraphCache() {}
  GraphCache& operator=(const GraphCache& other) {
    if (this != &other) state_ = std::make_unique<State>();
    return *this;
  }
  GraphCache(GraphCache&&) noexcept = default;
  GraphCache& operator=(GraphCache&&) noexcept = default;
  ~GraphCache() = default;

  /// The data of a kind; the first call makes it. `make` may request another kind.
  template <class T>
  std::shared_ptr<const T> get(Kind kind, const std::function<std::shared_ptr<const T>()>& make) const {
    const std::scoped_lock lock(state_->mutex);
    std::shared_ptr<const void>& data = state_->data[static_cast<std::size_t>(kind)];
    if (!data) data = make();
    return std::static_pointer_cast<const T>(data);
  }

 private:
  struct State {
    std::recursive_mutex mutex;
    std::array<std::shared_ptr<const void>, 2> data;
  };
  std::unique_ptr<State> state_ = std::make_unique<State>();
};

}  // namespace ahm
