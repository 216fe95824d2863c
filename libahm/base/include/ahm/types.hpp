/// \file
/// Types used by all parts of libahm.
///
/// \code
/// ahm::Source here = ahm::Source::at_vertex(ahm::Vertex{42});            // vertex 42 of a graph
/// auto there = surface.source(ahm::Row{42});                             // row 42 of the user's own points
/// \endcode
#pragma once

#if !defined(__cpp_exceptions) && !defined(__EXCEPTIONS)
#error "libahm reports errors by exceptions: compile without -fno-exceptions"
#endif

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>

namespace ahm {

/// Number of a vertex, point or face, from 0.
using Index = std::int32_t;

/// Position in an array that may outgrow `Index` (edges, matrix entries).
using Offset = std::int64_t;

/// A vertex of a graph. Vertex numbers differ from row numbers: vertices of a point cloud are sorted along a space-filling curve,
/// equal points share a vertex, and points without a neighborhood have none. `Surface::vertex` returns the vertex of a row.
/// `Vertex` and `Row` do not convert into each other, and numbers do not convert into either implicitly.
struct Vertex {
  Index index = 0;

  constexpr Vertex() = default;
  constexpr explicit Vertex(Index number) : index(number) {}
  friend constexpr auto operator<=>(Vertex, Vertex) = default;
};

/// A row of the input: a point of a cloud or a vertex of a mesh, in the order of the input.
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

/// A view of polygons in compressed rows: the corners of face f are vertices[begin[f]] to vertices[begin[f + 1] - 1].
struct FaceList {
  std::span<const Offset> begin;    ///< faces + 1 entries, ascending from 0; empty if there are no faces
  std::span<const Index> vertices;  ///< one vertex or row number per corner

  std::size_t size() const { return begin.empty() ? 0 : begin.size() - 1; }
  std::span<const Index> operator[](std::size_t f) const {
    return vertices.subspan(static_cast<std::size_t>(begin[f]), static_cast<std::size_t>(begin[f + 1] - begin[f]));
  }
};

}  // namespace ahm
