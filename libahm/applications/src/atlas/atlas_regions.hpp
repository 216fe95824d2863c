/// \file
/// What an atlas keeps of the maps of its sources.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include "ahm/applications/atlas.hpp"
#include "ahm/util/small_math.hpp"

namespace ahm {

/// For every source the vertices of all faces that touch its cell, and their coordinates there.
class Regions {
 public:
  Regions() = default;
  Regions(const FaceList& faces, std::span<const Index> label, std::size_t sources) : begin_(sources + 1, 0) {
    // The sources of every vertex first: gone over in order, they have their vertices in order.
    std::vector<Offset> first(label.size() + 1, 0);
    for_entries(faces, label, [&](Index, Index vertex) { ++first[at(vertex) + 1]; });
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<Index> of_vertex(at(first.back()));
    std::vector<Offset> end(first.begin(), first.end() - 1);
    for_entries(faces, label, [&](Index source, Index vertex) { of_vertex[end[vertex]++] = source; });
    for (std::size_t v = 0; v < label.size(); ++v) {
      const auto from = of_vertex.begin() + first[v];
      std::sort(from, of_vertex.begin() + end[v]);
      end[v] = std::unique(from, of_vertex.begin() + end[v]) - of_vertex.begin();
      for (Offset k = first[v]; k < end[v]; ++k) ++begin_[at(of_vertex[k]) + 1];
    }
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    vertices_.resize(at(begin_.back()));
    std::vector<Offset> next(begin_.begin(), begin_.end() - 1);
    for (std::size_t v = 0; v < label.size(); ++v)
      for (Offset k = first[v]; k < end[v]; ++k) vertices_[next[of_vertex[k]]++] = Vertex(v);
    coordinates_.resize(2 * vertices_.size(), std::numeric_limits<double>::quiet_NaN());
    known_.assign(sources, 0);
  }

  /// Takes over from `before`, whose sources come first here, what it has of them.
  /// @return the sources of which anything is missing
  std::vector<Index> adopt(const Regions& before) {
    std::vector<Index> missing;
    for (std::size_t s = 0; s + 1 < begin_.size(); ++s) {
      bool complete = s + 1 < before.begin_.size();
      for (Offset k = begin_[s]; k < begin_[s + 1] && complete; ++k) {
        const Offset there = before.find(s, vertices_[k]);
        complete = there >= 0;
        for (std::size_t c = 0; c < 2 && complete; ++c)
          coordinates_[2 * at(k) + c] = before.coordinates_[2 * at(there) + c];
      }
      if (complete)
        known_[s] = all_known(static_cast<Index>(s));
      else
        missing.push_back(static_cast<Index>(s));
    }
    return missing;
  }

  /// The vertices of a source.
  std::span<const Vertex> of(Index source) const {
    return std::span(vertices_).subspan(at(begin_[source]), at(begin_[source + 1] - begin_[source]));
  }
  /// @param coordinates  of the vertices of these sources, one after the other
  void keep(std::span<const Index> sources, std::span<const double> coordinates) {
    auto next = coordinates.begin();
    for (Index source : sources) {
      const auto end = next + 2 * std::ssize(of(source));
      std::copy(next, end, coordinates_.begin() + 2 * begin_[source]);
      known_[source] = all_known(source);
      next = end;
    }
  }

  /// Whether the map of a source has coordinates of all of its vertices.
  bool is_known(Index source) const { return known_[source] != 0; }
  /// NaN where unknown.
  std::array<double, 2> coordinates(Index source, Index vertex) const {
    const Offset k = find(at(source), Vertex(vertex));
    if (k < 0) return {std::nan(""), std::nan("")};
    return {coordinates_[2 * at(k)], coordinates_[2 * at(k) + 1]};
  }

 private:
  /// -1 where the region does not hold the vertex.
  Offset find(std::size_t source, Vertex vertex) const {
    const auto first = vertices_.begin() + begin_[source], last = vertices_.begin() + begin_[source + 1];
    const auto found = std::lower_bound(first, last, vertex);
    return found == last || *found != vertex ? -1 : found - vertices_.begin();
  }

  bool all_known(Index source) const {
    return all_finite(
        std::span(coordinates_).subspan(2 * at(begin_[source]), 2 * at(begin_[source + 1] - begin_[source])));
  }
  static std::size_t at(Offset i) { return static_cast<std::size_t>(i); }

  template <class Visit>
  static void for_entries(const FaceList& faces, std::span<const Index> label, const Visit& visit) {
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const auto face = faces[f];
      for (std::size_t c = 0; c < face.size(); ++c) {
        const Index source = label[face[c]];  // -1: none
        const bool seen = std::any_of(face.begin(), face.begin() + static_cast<std::ptrdiff_t>(c),
                                      [&](Index v) { return label[v] == source; });
        if (source < 0 || seen) continue;
        for (Index v : face) visit(source, v);
      }
    }
  }

  std::vector<Offset> begin_{0};
  std::vector<Vertex> vertices_;
  std::vector<double> coordinates_;
  std::vector<std::uint8_t> known_;  ///< of every source
};

}  // namespace ahm
