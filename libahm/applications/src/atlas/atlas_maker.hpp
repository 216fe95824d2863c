/// \file
/// Atlases of one surface with more and more sources.
#pragma once

#include <memory>
#include <span>

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
  Atlas make(std::span<const Vertex> sources);

 private:
  std::vector<double> reach(const VoronoiCells& cells, std::size_t sources) const;

  MapMaker maps_;
  FaceList faces_;
  FaceNeighbors neighbors_;
  Regions regions_;
  std::shared_ptr<const UnfoldingFront::Stars> stars_;  ///< for cells by heat
};

}  // namespace ahm
