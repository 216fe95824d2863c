/// \file
/// The few types every part of libahm shares.
///
/// \code
/// ahm::Source here = ahm::Source::at_vertex(ahm::Vertex{42});            // vertex 42 of a graph
/// auto there = surface.source(ahm::Row{42});                             // row 42 of the user's own points
/// \endcode
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>

namespace ahm {

/// Number of a vertex, point or face. 0-based.
using Index = std::int32_t;

/// Position in an array that may outgrow `Index` (edges, matrix entries).
using Offset = std::int64_t;

/// A vertex of a graph. Not a row of the input: a cloud's vertices are sorted along a space-filling curve, equal points
/// share one, and points without a neighbourhood have none. `Surface::vertex` turns a row into its vertex; neither turns
/// into the other, or comes from a plain number, unasked.
struct Vertex {
  Index index = 0;

  constexpr Vertex() = default;
  constexpr explicit Vertex(Index number) : index(number) {}
  friend constexpr auto operator<=>(Vertex, Vertex) = default;
};

/// A row of the input: a point of a cloud or a vertex of a mesh, as the user numbers them.
struct Row {
  Index index = 0;

  constexpr Row() = default;
  constexpr explicit Row(Index number) : index(number) {}
  friend constexpr auto operator<=>(Row, Row) = default;
};

/// A point or vector of the plane.
using Vec2 = std::array<double, 2>;

/// A point or vector of ambient 3-space.
using Vec3 = std::array<double, 3>;

/// Vertex or row numbers of the three corners of a face.
using Triangle = std::array<Index, 3>;

/// Polygons in compressed rows: face f has the corners begin[f] .. begin[f + 1]. Views only.
struct FaceList {
  std::span<const Offset> begin;    ///< faces + 1, from 0, rising; or empty: no faces
  std::span<const Index> vertices;  ///< one per corner

  std::size_t size() const { return begin.empty() ? 0 : begin.size() - 1; }
  std::span<const Index> operator[](std::size_t f) const {
    return vertices.subspan(static_cast<std::size_t>(begin[f]), static_cast<std::size_t>(begin[f + 1] - begin[f]));
  }
};

}  // namespace ahm
