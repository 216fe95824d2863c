#include "polygon_edges.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "ahm/error.hpp"
#include "ahm/maps/cost.hpp"
#include "ahm/util/component_lengths.hpp"
#include "ahm/util/disjoint_sets.hpp"
#include "ahm/util/parallel.hpp"
#include "polygon.hpp"

namespace ahm::polymesh {
namespace {

using Eigen::Vector3d;

constexpr double largest_weight = 1e4;

/// Of a sliver on the boundary, so that vertices in nothing else stay joined.
constexpr double least_conductance = 1e-3;

/// Stiffness and mass of every face, and what is worth telling about them.
class FaceMatrices {
 public:
  FaceMatrices(const PolygonMesh& mesh, const PolygonOptions& options) : mesh_(mesh), begin_(1, 0) {
    for (Index f = 0; f < mesh.face_count(); ++f) {
      const auto m = static_cast<Offset>(mesh.face(f).size());
      begin_.push_back(begin_.back() + m * m);
    }
    check_memory();
    weights_.resize(begin_.back());
    masses_.resize(mesh.corners().size());
    shape_.resize(mesh.face_count());
    detail::parallel_chunks(mesh.face_count(), 4096, options.threads, [&](Offset first, Offset last) {
      Polygon polygon;
      for (Offset f = first; f < last; ++f) fill(polygon, static_cast<Index>(f));
    });
  }

  /// -K_cd for the corner number `corner` and place d of its face.
  double weight(Offset corner, std::size_t d) const {
    const Index f = mesh_.face_of(corner);
    const Offset c = corner - mesh_.face_begin()[f], m = mesh_.face_begin()[f + 1] - mesh_.face_begin()[f];
    return weights_[static_cast<std::size_t>(begin_[f] + c * m) + d];
  }
  double mass(Offset corner) const { return masses_[corner]; }

  /// Triangles that are slivers on the boundary conduct along their outer side only, as those of triangle meshes: a side whose
  /// weight is negative balances the other two.
  void flatten_slivers() {
    const detail::HalfEdges edges = mesh_.topology().half_edges();
    std::vector<std::uint8_t> flat(shape_.size(), 0);
    std::vector<detail::Half> outer;
    for (detail::Half h = 0; h < edges.size(); ++h)
      if (edges.twin[h] < 0) outer.push_back(h);
    while (!outer.empty()) {
      const detail::Half base = outer.back(), beyond = edges.twin[base];
      outer.pop_back();
      const Index f = mesh_.face_of(base);
      if (mesh_.face(f).size() != 3 || flat[f]) continue;
      if (!((beyond >= 0 ? side_weight(beyond) : 0) + side_weight(base) < 0)) continue;
      flat[f] = 1;
      const detail::Half a = edges.next(base), b = edges.previous(base);
      const double weight_a = side_weight(a), weight_b = side_weight(b);
      set_side_weight(base, 0);
      set_side_weight(a, std::max(0.25 / weight_b, least_conductance));
      set_side_weight(b, std::max(0.25 / weight_a, least_conductance));
      for (const detail::Half side : {a, b})
        if (edges.twin[side] >= 0) outer.push_back(edges.twin[side]);
    }
  }

  /// Takes what a face gives too little along a side from what the face beyond gives: what counts is their sum.
  void balance_sides() {
    const detail::HalfEdges edges = mesh_.topology().half_edges();
    for (detail::Half h = 0; h < edges.size(); ++h) {
      const detail::Half beyond = edges.twin[h];
      if (beyond < h) continue;
      const double here = side_weight(h), there = side_weight(beyond);
      if ((here < 0) == (there < 0)) continue;
      set_side_weight(here < 0 ? h : beyond, 0);
      set_side_weight(here < 0 ? beyond : h, std::max(here + there, 0.0));
    }
  }

  void summarize(bool clamp, PolygonDetails& report) const {
    for (Index f = 0; f < mesh_.face_count(); ++f) {
      const auto m = static_cast<Index>(mesh_.face(f).size());
      report.triangles += m == 3;
      report.nonplanar_faces += shape_[f] == Shape::nonplanar;
      report.degenerate_faces += shape_[f] == Shape::degenerate;
      for (Index c = 0; c < m; ++c)
        for (Index d = c + 1; d < m; ++d) {
          const double w = weights_[begin_[f] + Offset{c} * m + d];
          report.negative_weights += w < -1e-12;
          report.capped_weights += clamp && w > largest_weight;
        }
      report.edges += Offset{m} * (m - 1) / 2;
    }
  }

 private:
  /// Place of the weight between the ends of a side, from its tail.
  std::size_t place(detail::Half h) const {
    const Index f = mesh_.face_of(h);
    const auto m = static_cast<Offset>(mesh_.face(f).size()), c = h - mesh_.face_begin()[f];
    return static_cast<std::size_t>(begin_[f] + c * m + (c + 1) % m);
  }
  double side_weight(detail::Half h) const { return weights_[place(h)]; }
  void set_side_weight(detail::Half h, double w) {
    const Index f = mesh_.face_of(h);
    const auto m = static_cast<Offset>(mesh_.face(f).size()), c = h - mesh_.face_begin()[f];
    weights_[place(h)] = weights_[static_cast<std::size_t>(begin_[f] + (c + 1) % m * m + c)] = w;
  }

  /// The number of edges grows with the square of a face's corners: better said than swapped for.
  void check_memory() const {
    const double bytes = 64.0 * static_cast<double>(begin_.back()), memory = machine_memory();
    if (memory > 0 && bytes > memory)
      throw ResourceExhausted("polygons_too_large",
                              "every pair of corners of a face is an edge, which would take " +
                                  std::to_string(static_cast<long>(bytes / 1e9)) + " GB for this mesh",
                              "refine it (PolygonMesh::refined) and map the triangles");
  }

  enum class Shape : std::uint8_t { plain, nonplanar, degenerate };

  void fill(Polygon& polygon, Index f) {
    polygon.read(mesh_, f);
    polygon.stiffness(weights_.data() + begin_[f]);
    polygon.mass(masses_.data() + mesh_.face_begin()[f]);
    double area = 0, perimeter = 0;
    const std::size_t m = polygon.size();
    for (std::size_t c = 0; c < m; ++c) {
      area += masses_[static_cast<std::size_t>(mesh_.face_begin()[f]) + c];
      perimeter += (polygon.corner((c + 1) % m) - polygon.corner(c)).norm();
    }
    if (area < 1e-10 * perimeter * perimeter)
      shape_[f] = Shape::degenerate;
    else if (polygon.vector_area().norm() < 0.99 * area)
      shape_[f] = Shape::nonplanar;
  }

  const PolygonMesh& mesh_;
  std::vector<Offset> begin_;  ///< of the m x m weights of each face
  std::vector<double> weights_, masses_;
  std::vector<Shape> shape_;
};

/// The mean length of the sides of all faces, of all and of each component, and the extremes.
void measure_sides(const PolygonMesh& mesh, CsrGraphData& g, PolygonDetails& report) {
  detail::ComponentLengths lengths(static_cast<std::size_t>(mesh.vertex_count()));
  double sum = 0, shortest = std::numeric_limits<double>::infinity(), longest = 0;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const auto corners = mesh.face(f);
    for (std::size_t c = 0; c < corners.size(); ++c) {
      const Vector3d a(mesh.position(Vertex(corners[c])).data()),
          b(mesh.position(Vertex(corners[(c + 1) % corners.size()])).data());
      const double length = (b - a).norm();
      sum += length;
      lengths.add(corners[c], corners[(c + 1) % corners.size()], length);
      shortest = std::min(shortest, length);
      longest = std::max(longest, length);
    }
  }
  report.shortest_edge = shortest * mesh.length_unit();
  report.longest_edge = longest * mesh.length_unit();
  if (!(longest > 0)) throw InvalidGeometry("all vertices of the mesh are at the same place");
  g.mean_edge_length = sum / static_cast<double>(mesh.corners().size());
  g.component_edge_lengths = lengths.means();
}

/// The chord in a tangent plane, at its own length as far as it leans to that plane at all.
std::complex<double> log_of_chord(const Axes& axes, const Vector3d& chord) {
  const std::complex<double> projected = axes.components(chord);
  const double length = chord.norm(), seen = std::abs(projected);
  return seen > 0.1 * length ? length / seen * projected : 10.0 * projected;
}

/// R_ji as stored, for corners i and j of one face.
void write_transport(std::complex<double> turn_i, bool mirrored_i, std::complex<double> turn_j, bool mirrored_j,
                     TransportKind kind, double* out) {
  const bool reflects = mirrored_i != mirrored_j;
  const std::complex<double> R = std::conj(turn_i) * (reflects ? std::conj(turn_j) : turn_j);
  if (kind == TransportKind::rotation2) {
    out[0] = R.real();
    out[1] = R.imag();
    return;
  }
  out[0] = R.real();
  out[1] = reflects ? R.imag() : -R.imag();
  out[2] = R.imag();
  out[3] = reflects ? -R.real() : R.real();
}

/// Vertices whose faces have no area still need a mass, small against all others of their component.
void raise_masses(const PolygonMesh& mesh, double mean_edge_length, std::vector<double>& masses) {
  detail::DisjointSets parts(masses.size());
  for (Index f = 0; f < mesh.face_count(); ++f)
    for (const Index v : mesh.face(f)) parts.join(mesh.face(f)[0], v);
  std::vector<double> total(masses.size(), 0.0), count = total;
  for (std::size_t v = 0; v < masses.size(); ++v) {
    const Index part = parts.root(static_cast<Index>(v));
    total[part] += masses[v];
    ++count[part];
  }
  for (std::size_t v = 0; v < masses.size(); ++v) {
    const Index part = parts.root(static_cast<Index>(v));
    const double mean = total[part] > 0 ? total[part] / count[part] : mean_edge_length * mean_edge_length;
    masses[v] = std::max(masses[v], 1e-9 * mean);
  }
}

}  // namespace

CsrGraphData polygon_edges(const PolygonMesh& mesh, const Frames& frames, const PolygonOptions& options,
                           PolygonDetails& report) {
  const auto n = static_cast<std::size_t>(mesh.vertex_count());
  CsrGraphData g;
  g.kind = mesh.report().orientable ? TransportKind::rotation2 : TransportKind::block;
  g.length_unit = mesh.length_unit();
  measure_sides(mesh, g, report);
  FaceMatrices matrices(mesh, options);
  matrices.summarize(options.clamp_weights, report);
  if (options.clamp_weights) {
    matrices.flatten_slivers();
    matrices.balance_sides();
  }

  g.row_begin.assign(n + 1, 0);
  for (std::size_t v = 0; v < n; ++v) {
    g.row_begin[v + 1] = g.row_begin[v];
    for (Offset corner : mesh.corners_at(Vertex(v)))
      g.row_begin[v + 1] += static_cast<Offset>(mesh.face(mesh.face_of(corner)).size()) - 1;
  }
  const auto edges = static_cast<std::size_t>(g.row_begin.back());
  const std::size_t width = g.kind == TransportKind::rotation2 ? 2 : 4;
  g.neighbors.resize(edges);
  g.weights.resize(edges);
  g.logs.resize(2 * edges);
  g.transports.resize(width * edges);
  g.masses.resize(n);
  detail::for_each_index(n, options.threads, [&](std::size_t k) {
    const auto v = static_cast<Index>(k);
    const Vector3d origin(mesh.position(Vertex(v)).data());
    auto at = static_cast<std::size_t>(g.row_begin[k]);
    double mass = 0;
    for (Offset corner : mesh.corners_at(Vertex(v))) {
      const Index f = mesh.face_of(corner);
      const auto vertices = mesh.face(f);
      mass += matrices.mass(corner);
      for (std::size_t d = 0; d < vertices.size(); ++d) {
        const Offset other = mesh.face_begin()[f] + static_cast<Offset>(d);
        if (other == corner) continue;
        const double w = matrices.weight(corner, d);
        g.neighbors[at] = vertices[d];
        g.weights[at] = options.clamp_weights ? std::clamp(w, 0.0, largest_weight) : w;
        const auto log = log_of_chord(frames.vertex[k], Vector3d(mesh.position(Vertex(vertices[d])).data()) - origin);
        g.logs[2 * at] = log.real();
        g.logs[2 * at + 1] = log.imag();
        write_transport(frames.turn[corner], mesh.mirrored(corner), frames.turn[other], mesh.mirrored(other), g.kind,
                        g.transports.data() + width * at);
        ++at;
      }
    }
    g.masses[k] = mass;
  });
  raise_masses(mesh, *g.mean_edge_length, g.masses);
  return g;
}

}  // namespace ahm::polymesh
