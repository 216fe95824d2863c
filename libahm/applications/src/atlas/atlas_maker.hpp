/// \file
/// Atlases of one surface with more and more sources.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "ahm/applications/atlas.hpp"
#include "atlas/atlas_regions.hpp"
#include "atlas/face_neighbors.hpp"

namespace ahm {

class AtlasMaker {
 public:
  /// @throws as `make_atlas`
  AtlasMaker(const MapMaker& maps, const FaceList& faces);

  /// @param sources  begin with those of the call before: their cells have only shrunk since, so that their maps need
  /// not be made again
  void make(std::span<const Vertex> sources);
  const Atlas& atlas() const { return atlas_; }
  Atlas take() { return std::move(atlas_); }
  /// Whether this chart was not there before the last call, with the same faces in the same places.
  bool is_new(std::size_t chart) const { return is_new_[chart] != 0; }

 private:
  VoronoiCells cells(std::span<const Vertex> sources);
  void update(std::vector<Chart> charts, std::span<const Index> remade);
  std::vector<double> reach(const VoronoiCells& cells, std::size_t sources) const;

  MapMaker maps_;
  FaceList faces_;
  FaceNeighbors neighbors_;
  Regions regions_;
  std::optional<UnfoldingFront> front_;  ///< from all sources so far, for cells by heat
  Atlas atlas_;
  std::vector<std::uint8_t> is_new_;  ///< of every chart
};

}  // namespace ahm
