/// \file
/// Keeps data that is computed from an immutable graph, so that all solvers of the graph share it.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>

namespace ahm {

/// Data computed from one graph, one value per kind. May be used from many threads at once. If several threads need a value that does not
/// exist yet, each computes it and the first result is kept. No lock is held meanwhile, so a forked process can compute the value, too.
class GraphCache {
 public:
  enum class Kind { one_rings, one_rings_with_midpoints };

  GraphCache() = default;
  /// A copy of a graph computes its own data.
  GraphCache(const GraphCache&) noexcept {}
  GraphCache(GraphCache&& other) noexcept { take(other); }
  GraphCache& operator=(const GraphCache& other) noexcept {
    if (this != &other) clear();
    return *this;
  }
  GraphCache& operator=(GraphCache&& other) noexcept {
    if (this != &other) clear(), take(other);
    return *this;
  }
  ~GraphCache() { clear(); }

  /// The value of a kind; the first call makes it. `make` may request another kind.
  template <class T>
  std::shared_ptr<const T> get(Kind kind, const std::function<std::shared_ptr<const T>()>& make) const {
    std::atomic<const Value*>& slot = values_[static_cast<std::size_t>(kind)];
    const Value* kept = slot.load(std::memory_order_acquire);
    if (kept == nullptr) {
      auto made = std::make_unique<const Value>(make());
      if (slot.compare_exchange_strong(kept, made.get(), std::memory_order_acq_rel)) kept = made.release();
    }
    return std::static_pointer_cast<const T>(*kept);
  }

 private:
  using Value = std::shared_ptr<const void>;

  void clear() noexcept {
    for (auto& slot : values_) delete slot.exchange(nullptr);
  }
  void take(GraphCache& other) noexcept {
    for (std::size_t k = 0; k < values_.size(); ++k) values_[k] = other.values_[k].exchange(nullptr);
  }

  mutable std::array<std::atomic<const Value*>, 2> values_{};
};

}  // namespace ahm
