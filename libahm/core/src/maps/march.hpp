/// \file
/// The march, a banded solve: the affine heat method by thin bands in the order of heat distance, so that time and memory grow
/// linearly and nothing underflows at any distance (docs/march.md).
///
/// A band is the part of the graph just ahead of the front. It is cut out with its natural boundary and solved by the same
/// operators and the same elimination as a whole graph; the accepted values behind the front enter as Dirichlet data. What
/// lies near the band's far end is dropped again, since the graph beyond would have influenced it.
#pragma once

#include <cstdint>
#include <vector>

#include "ahm/maps/log_map_solver.hpp"
#include "maps/affine_heat.hpp"

namespace ahm {

class March {
 public:
  /// @param operators  t_coef, ordering, kind of factorization; the graph must have been checked
  March(const TangentGraph& graph, const OperatorOptions& operators, Variant variant, double accuracy, double radius,
        unsigned threads, Progress progress);

  /// Marches from a checked source.
  void run(const Source& source);
  /// Marches on from where a solve on the whole graph ended, source number `s` of `heat`.
  void run_on(const AffineHeat& heat, std::size_t s, std::span<const double> solution);

  /// Coordinates, n x d in world units; NaN where `accepted` is false or too little heat arrived.
  std::vector<double>& coordinates() { return coordinates_; }
  /// Whether the march came to the vertex.
  bool accepted(Index vertex) const { return accepted_[vertex] != 0; }
  /// U_i as d x d numbers, row major.
  void axes(Index vertex, double* out) const;
  const MarchStatistics& statistics() const { return statistics_; }

 private:
  /// lambda, U~ and x or Y of a vertex, as mantissas with exponents of their own: lambda and x are to be multiplied by
  /// 2^heat_exponent, U~ by 2^frame_exponent.
  struct Solutions {
    std::vector<double> lambda, solution, frame;  ///< 1, d, and 2 or d x d numbers per vertex
    std::vector<std::int32_t> heat_exponent, frame_exponent;
  };
  struct Band {
    std::vector<Index> vertices;
    std::vector<Index> edge;  ///< places in `vertices` at the far end: with neighbours ahead of the band
  };
  struct Link {  ///< an edge from a vertex of the band back to an accepted one
    Index place;
    std::size_t edge;
  };

  void march(const Source* source);
  bool advance(const Source* source, double depth);
  Band find_band(const Source* source, double depth);
  Inflow inflow_behind(const Band& band, std::span<const Link> links, double scaling, std::int32_t& heat_exponent,
                       std::int32_t& frame_exponent) const;
  void accept(Index vertex, Index place, const AffineHeat& heat, std::size_t s, std::span<const double> solution,
              std::int32_t heat_exponent, std::int32_t frame_exponent);
  void update_front(std::span<const Index> added);
  double level(Index vertex) const;
  bool sends_heat(Index vertex) const;
  double diagonal(Index vertex) const;

  const TangentGraph& graph_;
  OperatorOptions options_;
  Variant variant_;
  bool iterative_;  ///< volumes: the factors of a band would fill the memory
  double margin_, step_, radius_, tau_;
  Progress progress_;
  unsigned threads_;
  std::size_t d_, width_;

  std::vector<std::uint8_t> accepted_;
  std::vector<Index> place_;      ///< in the band at hand, or -1
  std::vector<float> tentative_;  ///< heat distance on the way, less that of the front
  std::vector<Index> front_;      ///< accepted vertices with neighbours that are not
  Solutions at_;
  std::vector<double> coordinates_;
  MarchStatistics statistics_;
  Offset accepted_count_ = 0;
};

}  // namespace ahm
