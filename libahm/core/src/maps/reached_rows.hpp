/// \file
/// Memory for what is known of some of a graph's vertices: it grows with those, not with the graph.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "ahm/types.hpp"

namespace ahm {

/// Numbers vertices in the order in which they are first asked for. Besides one page of 1 KB for every 256 successive
/// vertices of which one was asked for it takes 8 bytes per 256 vertices of the graph.
class ReachedNumbers {
 public:
  explicit ReachedNumbers(Index vertices) : pages_(static_cast<std::size_t>(vertices) / page_size + 1) {}

  /// -1 for a vertex never asked for by `number`.
  Index find(Index vertex) const {
    const Page* page = pages_[static_cast<std::size_t>(vertex) / page_size].get();
    return page == nullptr ? -1 : (*page)[static_cast<std::size_t>(vertex) % page_size];
  }
  Index number(Index vertex) {
    std::unique_ptr<Page>& page = pages_[static_cast<std::size_t>(vertex) / page_size];
    if (!page) {
      page = std::make_unique<Page>();
      page->fill(-1);
    }
    Index& own = (*page)[static_cast<std::size_t>(vertex) % page_size];
    if (own < 0) own = count_++;
    return own;
  }
  Index count() const { return count_; }
  std::size_t bytes() const {
    std::size_t taken = 0;
    for (const auto& page : pages_) taken += page ? 1 : 0;
    return pages_.size() * sizeof(pages_[0]) + taken * sizeof(Page);
  }

 private:
  static constexpr std::size_t page_size = 256;
  using Page = std::array<Index, page_size>;

  std::vector<std::unique_ptr<Page>> pages_;
  Index count_ = 0;
};

/// A table of rows of equal width that grows without moving what it holds. New rows are zero.
template <class T>
class GrowingRows {
 public:
  explicit GrowingRows(std::size_t width) : width_(width) {}

  T* operator[](Index row) { return place(row); }
  const T* operator[](Index row) const { return place(row); }
  void grow_to(Index rows) {
    while (chunks_.size() * chunk_rows < static_cast<std::size_t>(rows))
      chunks_.push_back(std::make_unique<T[]>(chunk_rows * width_));
  }
  std::size_t bytes() const { return chunks_.size() * (chunk_rows * width_ * sizeof(T) + sizeof(chunks_[0])); }

 private:
  static constexpr std::size_t chunk_rows = 1024;
  T* place(Index row) const {
    const auto r = static_cast<std::size_t>(row);
    return chunks_[r / chunk_rows].get() + r % chunk_rows * width_;
  }

  std::size_t width_;
  std::vector<std::unique_ptr<T[]>> chunks_;
};

}  // namespace ahm
