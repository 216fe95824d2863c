/// \file
/// Which faces share a side.
#pragma once

#include <algorithm>
#include <numeric>
#include <span>
#include <vector>

#include "ahm/applications/atlas.hpp"

namespace ahm {

/// Two faces are neighbours, once per side, where both have the same two vertices next to each other; at a side of many
/// faces, each with the next.
class FaceNeighbors {
 public:
  explicit FaceNeighbors(const FaceList& faces) : begin_(faces.size() + 1, 0) {
    struct Side {
      Index low, high, face;
    };
    std::vector<Side> sides;
    sides.reserve(faces.vertices.size());
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const auto face = faces[f];
      for (std::size_t c = 0; c < face.size(); ++c) {
        const auto [low, high] = std::minmax(face[c], face[(c + 1) % face.size()]);
        sides.push_back({low, high, static_cast<Index>(f)});
      }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
      if (a.low != b.low) return a.low < b.low;
      return a.high != b.high ? a.high < b.high : a.face < b.face;
    });
    const auto for_pairs = [&](const auto& visit) {
      for (std::size_t k = 1; k < sides.size(); ++k)
        if (sides[k].low == sides[k - 1].low && sides[k].high == sides[k - 1].high &&
            sides[k].face != sides[k - 1].face)
          visit(sides[k - 1].face, sides[k].face), visit(sides[k].face, sides[k - 1].face);
    };
    for_pairs([&](Index f, Index) { ++begin_[static_cast<std::size_t>(f) + 1]; });
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    neighbors_.resize(static_cast<std::size_t>(begin_.back()));
    std::vector<Offset> end(begin_.begin(), begin_.end() - 1);
    for_pairs([&](Index f, Index g) { neighbors_[end[f]++] = g; });
  }

  std::span<const Index> of(Index face) const {
    const auto f = static_cast<std::size_t>(face);
    return {neighbors_.data() + begin_[f], static_cast<std::size_t>(begin_[f + 1] - begin_[f])};
  }

 private:
  std::vector<Offset> begin_;
  std::vector<Index> neighbors_;
};

}  // namespace ahm
