/// \file
/// The ranks of an MPI run as a march team, each with its own tiles.
#pragma once

#include <vector>

#include "ahm-mpi/petsc.hpp"
#include "ahm-mpi/traffic.hpp"
#include "ahm/tiles/tiled_graph.hpp"
#include "maps/march.hpp"

namespace ahm::tiles::mpi {

/// The team of all ranks of a communicator.
class MpiTeam final : public MarchTeam {
 public:
  /// @param owner_of_tile  rank that owns each tile
  /// @param accuracy       `HeatOptions::accuracy`
  MpiTeam(MPI_Comm ranks, const TiledGraph& graph, std::vector<int> owner_of_tile, double accuracy);

  int rank() const { return rank_; }
  int size() const { return size_; }

  bool owns(Index vertex) const override { return owner(vertex) == rank_; }
  double least(double value) override { return -greatest(-value); }
  double greatest(double value) override;
  std::int64_t sum(std::int64_t value) override;
  std::vector<Crossing> cross(std::span<const Crossing> leaving) override;
  std::vector<HaloVertex> share(std::span<const Index> vertices) override;
  double reach() const override { return reach_; }
  std::unique_ptr<const HeatSystem> system(BandPart part, const HeatOptions& options) override;

  const Traffic& traffic() const { return traffic_; }
  /// Largest number of vertices of this rank in a band, and their sum over all bands.
  std::int64_t largest_part() const { return largest_part_; }
  std::int64_t solved() const { return solved_; }

 private:
  int owner(Index vertex) const { return owner_of_tile_[graph_.tile_of(vertex)]; }
  template <class T>
  std::vector<T> exchange(const std::vector<std::vector<T>>& to);

  MPI_Comm ranks_;
  const TiledGraph& graph_;
  std::vector<int> owner_of_tile_;
  int rank_ = 0, size_ = 1;
  double reach_;
  Traffic traffic_;
  std::int64_t largest_part_ = 0, solved_ = 0;
};

}  // namespace ahm::tiles::mpi
