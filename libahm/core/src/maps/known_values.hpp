/// \file
/// Stores values of some vertices of a graph. The memory is proportional to their number, not to the size of the graph.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/types.hpp"
#include "maps/affine_heat.hpp"

namespace ahm {

/// Numbers vertices in the order of their first use. Numbers of forgotten vertices are reused. The memory is 10 bytes per 256 vertices of
/// the graph, and one page of 1 KB per 256 successive vertices, from the first use of one of them until all of them are forgotten.
class ReachedNumbers {
 public:
  static constexpr Index forgotten = -2;

  explicit ReachedNumbers(Index vertices)
      : vertices_(static_cast<std::size_t>(vertices)), pages_(vertices_ / page_size + 1), gone_(pages_.size()) {}

  /// Number of a vertex; -1: not numbered by `number`, `forgotten`: was numbered and then forgotten.
  Index find(Index vertex) const {
    const std::size_t place = static_cast<std::size_t>(vertex) / page_size;
    const Page* page = pages_[place].get();
    if (page == nullptr) return gone_[place] > 0 ? forgotten : -1;
    return (*page)[static_cast<std::size_t>(vertex) % page_size];
  }
  /// Number of a vertex, a new one if it has none. The vertex must not be forgotten.
  Index number(Index vertex) {
    std::unique_ptr<Page>& page = pages_[static_cast<std::size_t>(vertex) / page_size];
    if (!page) {
      page = std::make_unique<Page>();
      page->fill(-1);
    }
    Index& own = (*page)[static_cast<std::size_t>(vertex) % page_size];
    if (own >= 0) return own;
    if (free_.empty()) return own = count_++;
    own = free_.back();
    free_.pop_back();
    return own;
  }
  /// Frees the number of a vertex that has one. Frees the page, too, if all its vertices are forgotten.
  void forget(Index vertex) {
    const std::size_t place = static_cast<std::size_t>(vertex) / page_size;
    Index& own = (*pages_[place])[static_cast<std::size_t>(vertex) % page_size];
    free_.push_back(own);
    own = forgotten;
    if (++gone_[place] == std::min(page_size, vertices_ - place * page_size)) pages_[place].reset();
  }
  /// Visits the vertices in ascending order: calls each(vertex, number) for those with a number, gone(begin, end) for ranges of forgotten
  /// ones.
  template <class Each, class Gone>
  void visit(const Each& each, const Gone& gone) const {
    for (std::size_t place = 0; place < pages_.size(); ++place) {
      const auto begin = static_cast<Index>(place * page_size),
                 end = static_cast<Index>(std::min(vertices_, (place + 1) * page_size));
      if (!pages_[place] && gone_[place] > 0) gone(begin, end);
      for (Index vertex = begin; pages_[place] && vertex < end; ++vertex)
        if (const Index number = (*pages_[place])[static_cast<std::size_t>(vertex - begin)]; number >= 0)
          each(vertex, number);
        else if (number == forgotten)
          gone(vertex, vertex + 1);
    }
  }
  /// One more than the largest number so far: the largest count of vertices that had a number at the same time.
  Index count() const { return count_; }
  std::size_t bytes() const {
    std::size_t taken = 0;
    for (const auto& page : pages_) taken += page ? 1 : 0;
    return pages_.size() * (sizeof(pages_[0]) + sizeof(gone_[0])) + taken * sizeof(Page) +
           free_.capacity() * sizeof(free_[0]);
  }

 private:
  static constexpr std::size_t page_size = 256;
  using Page = std::array<Index, page_size>;

  std::size_t vertices_;
  std::vector<std::unique_ptr<Page>> pages_;
  std::vector<std::uint16_t> gone_;  ///< number of forgotten vertices of each page
  std::vector<Index> free_;          ///< numbers to reuse
  Index count_ = 0;
};

/// A table of rows of equal width that grows without moving existing rows. New rows are zero.
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

/// Binary exponents: the values of a solve, times 2 to these powers, are the values of the map.
struct HeatExponents {
  std::int32_t heat = 0;   ///< exponent of lambda, the variant's unknown and its second moments
  std::int32_t frame = 0;  ///< exponent of U~
};

/// Values of lambda, U~, the variant's unknown and its second moments at vertices. They are mantissas with an exponent per vertex, so that
/// nothing underflows at any distance. Vertices are identified by the numbers of `ReachedNumbers`.
class KnownValues {
 public:
  /// @param with_frames  false: the solves have no frames
  KnownValues(const TangentGraph& graph, const VariantSystem& system, bool with_frames);

  /// Stores the heat of a vertex.
  void take_heat(Index number, double lambda, std::int32_t exponent);
  /// Stores all other values of a vertex, which is vertex `place` of the solve. Other threads may read the heat at the same time.
  void take_values(Index number, Index place, const AffineHeat& heat, std::size_t source, std::int32_t frame_exponent);

  /// All values of a vertex, without the exponents.
  std::span<const double> row(Index number) const { return {rows_[number], row_width()}; }
  HeatExponents exponents(Index number) const { return *exponents_[number]; }
  std::size_t row_width() const { return 3 + 2 * d_ + width_; }
  void set(Index number, std::span<const double> row, HeatExponents exponents);

  double heat(Index number) const { return *rows_[number]; }
  std::size_t bytes() const { return rows_.bytes() + exponents_.bytes(); }
  /// -log lambda, including the exponent.
  double level(Index number) const;
  /// U_i as d x d numbers, row major.
  void axes(Index number, double* out) const;

  /// The exponent for which the largest lambda of these vertices is about `heat_scale`; very small if there is none.
  std::int32_t heat_exponent_for(std::span<const Index> numbers) const;
  /// The exponent for which the largest entry of U~ at these vertices is about `heat_scale`; very small if there is none.
  std::int32_t frame_exponent_for(std::span<const Index> numbers) const;
  /// Dirichlet term tau w_ij lambda_j of vertex j in the right-hand side of A at its neighbor i.
  double heat_along(Index number, double conductance, std::int32_t exponent) const;
  /// Adds the other Dirichlet terms of vertex j = star.neighbors[edge], which has this number, to the last entry of `in`, the right-hand
  /// sides at the star's vertex i: tau w_ij R_ji U~_j for B, and the corresponding terms of the other systems.
  void add_to(RightHandSide& in, const Star& star, std::size_t edge, Index number, double conductance,
              HeatExponents exponents) const;

 private:
  double square(Index number) const { return rows_[number][1]; }
  double squared_length(Index number) const { return rows_[number][2]; }
  std::span<const double> value(Index number) const { return {rows_[number] + 3, d_}; }
  std::span<const double> radial(Index number) const { return {rows_[number] + 3 + d_, d_}; }
  std::span<const double> frame(Index number) const { return {rows_[number] + 3 + 2 * d_, width_}; }

  const VariantSystem& system_;
  TransportLayout layout_;
  std::size_t d_, width_;     ///< dimension; numbers per frame, 0 without frames
  double to_units_;           ///< graph units -> units of the solution
  GrowingRows<double> rows_;  ///< lambda, both second moments, the unknown, r, U~
  GrowingRows<HeatExponents> exponents_;
};

}  // namespace ahm
