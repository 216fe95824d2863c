#include "ahm/surface/surface_triangles.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "ahm/error.hpp"
#include "ahm/graph/components.hpp"
#include "ahm/surface/detail/unfolded_corners.hpp"
#include "ahm/surface/exact/flat_triangles.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"

namespace ahm {
namespace {

void check(const char* function, const TangentGraph& graph, const LogMap& map) {
  const std::string name = std::string(function) + ": ";
  if (graph.dimension() != 2)
    throw InvalidArgument(name + "the graph has dimension " + std::to_string(graph.dimension()) + ", not 2");
  if (map.size() != graph.size() || map.dimension() != 2)
    throw InvalidArgument(name + "the map has " + detail::counted(map.size(), "vertex") + ", the graph " +
                          std::to_string(graph.size()));
  if (map.frames().size() != 4 * to_size(graph.size()))
    throw InvalidArgument("map_without_frames", name + "the map has no frames", "solve with MapOptions::frames = true");
}

/// Whether transport from the source to the vertex includes a reflection.
bool is_mirrored(const LogMap& map, Index vertex) {
  const auto U = map.frames().subspan(4 * to_size(vertex), 4);
  return U[0] * U[3] - U[1] * U[2] < 0;
}

/// Sorted neighbors with coordinates, each once.
struct Neighbors {
  std::vector<Offset> begin{0};
  std::vector<Index> all;

  Neighbors(const TangentGraph& graph, const LogMap& map) {
    for (Index i = 0; i < graph.size(); ++i) {
      const auto first = static_cast<std::ptrdiff_t>(all.size());
      if (map.status(Vertex(i)) == Status::ok)
        for (Index j : graph.star(i).neighbors)
          if (map.status(Vertex(j)) == Status::ok) all.push_back(j);
      std::sort(all.begin() + first, all.end());
      all.erase(std::unique(all.begin() + first, all.end()), all.end());
      begin.push_back(static_cast<Offset>(all.size()));
    }
  }

  std::span<const Index> of(Index i) const {
    return std::span(all).subspan(static_cast<std::size_t>(begin[i]),
                                  static_cast<std::size_t>(begin[to_size(i) + 1] - begin[i]));
  }

  bool are_neighbors(Index i, Index j) const {
    const auto row = of(i);
    return std::binary_search(row.begin(), row.end(), j);
  }
};

struct Spoke {
  double angle;
  Index neighbor;
  std::array<double, 2> log;
};

/// Sorts the edges of a star to vertices with coordinates by angle. Of parallel edges only the first is kept.
void sort_spokes(const Star& star, const LogMap& map, std::vector<Spoke>& spokes) {
  spokes.clear();
  for (std::size_t e = 0; e < star.degree(); ++e) {
    const auto log = star.log(e);
    if (map.status(Vertex(star.neighbors[e])) == Status::ok && (log[0] != 0 || log[1] != 0))
      spokes.push_back({std::atan2(log[1], log[0]), star.neighbors[e], {log[0], log[1]}});
  }
  std::sort(spokes.begin(), spokes.end(), [](const Spoke& a, const Spoke& b) {
    return a.neighbor != b.neighbor ? a.neighbor < b.neighbor : a.angle < b.angle;
  });
  const auto end = std::unique(spokes.begin(), spokes.end(),
                               [](const Spoke& a, const Spoke& b) { return a.neighbor == b.neighbor; });
  spokes.erase(end, spokes.end());
  std::sort(spokes.begin(), spokes.end(), [](const Spoke& a, const Spoke& b) { return a.angle < b.angle; });
}

/// Whether i, j, m, k form a quadrilateral for some m, counterclockwise in frame i. m must be a neighbor of both j and k, with
/// an interior angle at j below 180 degrees.
bool close_a_quadrilateral(const TangentGraph& graph, const LogMap& map, const Neighbors& neighbors, Index i, Index j,
                           Index k) {
  const Star star = graph.star(j);
  const double side = is_mirrored(map, i) == is_mirrored(map, j) ? 1 : -1;
  const auto back = std::find(star.neighbors.begin(), star.neighbors.end(), i);
  if (back == star.neighbors.end()) return false;
  const auto e_ji = star.log(static_cast<std::size_t>(back - star.neighbors.begin()));
  for (std::size_t e = 0; e < star.degree(); ++e) {
    const Index m = star.neighbors[e];
    const auto e_jm = star.log(e);
    if (m != i && side * (e_jm[0] * e_ji[1] - e_jm[1] * e_ji[0]) > 0 && neighbors.are_neighbors(k, m)) return true;
  }
  return false;
}

}  // namespace

std::vector<Triangle> star_triangles(const TangentGraph& graph, const LogMap& map) {
  check("star_triangles", graph, map);
  const Neighbors neighbors(graph, map);
  std::vector<Triangle> result;
  std::vector<Spoke> spokes;
  for (Index i = 0; i < graph.size(); ++i) {
    if (map.status(Vertex(i)) != Status::ok) continue;
    sort_spokes(graph.star(i), map, spokes);
    for (std::size_t s = 0; s < spokes.size(); ++s) {
      const Spoke &a = spokes[s], &b = spokes[(s + 1) % spokes.size()];
      if (!(a.log[0] * b.log[1] - a.log[1] * b.log[0] > 0)) continue;
      if (!neighbors.are_neighbors(a.neighbor, b.neighbor) &&
          !close_a_quadrilateral(graph, map, neighbors, i, a.neighbor, b.neighbor))
        continue;
      Triangle t{i, a.neighbor, b.neighbor};
      if (is_mirrored(map, i)) std::swap(t[1], t[2]);
      std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
      result.push_back(t);
    }
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

std::vector<Vec3> source_side_normals(const TangentGraph& graph, const LogMap& map) {
  check("source_side_normals", graph, map);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Vec3> normals(to_size(graph.size()), Vec3{nan, nan, nan});
  for (Index i = 0; i < graph.size(); ++i) {
    if (map.status(Vertex(i)) != Status::ok) continue;
    const auto frame = graph.frame(i);
    if (!frame)
      throw InvalidArgument("source_side_normals: vertex " + std::to_string(i) +
                            " has no frame in space; use a backend that provides frames");
    normals[i] = frame->normal;
    if (is_mirrored(map, i))
      for (double& x : normals[i]) x = -x;
  }
  return normals;
}

namespace {

/// A source of the first vertex in each component.
Source source_of_each_component(const TangentGraph& graph, std::span<const Vertex> sources) {
  const Components components = connected_components(graph);
  std::vector<bool> has_source(components.count, false);
  Source source(2);
  constexpr double offset[] = {0, 0}, axes[] = {1, 0, 0, 1};
  for (Vertex vertex : sources) {
    const Index component = components.of_vertex[vertex.index];
    if (!has_source[component]) source.add(vertex, 1, offset, axes);
    has_source[component] = true;
  }
  return source;
}

SurfaceFaces triangles_of_map(const TangentGraph& graph, const LogMap& map) {
  SurfaceFaces result;
  result.normals = source_side_normals(graph, map);
  for (Index v = 0; v < graph.size(); ++v) result.points.push_back(graph.frame(v)->origin);
  for (const Triangle& t : star_triangles(graph, map)) {
    result.corner_vertices.insert(result.corner_vertices.end(), t.begin(), t.end());
    result.begin.push_back(static_cast<Offset>(result.corner_vertices.size()));
  }
  result.corner_points = result.corner_vertices;
  return result;
}

/// Positive where the vector area of a face points to the same side as the normals of its corners.
double side(std::span<const Vec3> points, std::span<const Index> face, std::span<const Vec3> normals) {
  Vec3 area{}, normal{};
  const auto corner = [&](std::size_t c) { return points[face[c % face.size()]] - points[face[0]]; };
  double size = 0;
  for (std::size_t c = 0; c < face.size(); ++c) size = std::max(size, largest(corner(c)));
  const double scale = 1 / power_of_two_below(size);
  for (std::size_t c = 0; c < face.size(); ++c) {
    area = area + cross(scale * corner(c), scale * corner(c + 1));
    normal = normal + normals[face[c]];
  }
  return dot(area, normal);
}

}  // namespace

SurfaceFaces surface_faces(const Surface& surface) {
  if (surface.faces().size() == 0) return {};
  const auto positions = surface.positions();
  const FaceList faces = surface.faces();
  const auto corners = surface.corner_vertices();
  SurfaceFaces result{{positions.begin(), positions.end()},
                      surface.normals(),
                      {faces.begin.begin(), faces.begin.end()},
                      {},
                      {corners.begin(), corners.end()}};
  for (Index vertex : corners) result.corner_points.push_back(surface.rows().row(Vertex(vertex))->index);
  return result;
}

SurfaceFaces surface_faces(const Surface& surface, const LogMapSolver& solver, std::span<const Vertex> sources) {
  if (surface.faces().size() > 0) return surface_faces(surface);
  const Source source = source_of_each_component(surface.graph(), sources);
  return triangles_of_map(surface.graph(), solver.solve(source, {.frames = true}));
}

SurfaceFaces surface_faces(const Surface& surface, const PolarMapSolver& solver, std::span<const Vertex> sources) {
  if (surface.faces().size() > 0) return surface_faces(surface);
  const Source source = source_of_each_component(surface.graph(), sources);
  return triangles_of_map(surface.graph(), solver.log_map(source, {.frames = true}));
}

std::vector<Triangle> turned_triangles(const Surface& surface, std::span<const Vec3> normals) {
  const FaceList faces = surface.faces();
  std::vector<Triangle> result;
  std::vector<Index> corners;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    corners.assign(faces[f].begin(), faces[f].end());
    if (side(surface.positions(), corners, normals) < 0) std::reverse(corners.begin() + 1, corners.end());
    for (std::size_t c = 1; c + 1 < corners.size(); ++c) result.push_back({corners[0], corners[c], corners[c + 1]});
  }
  return result;
}

namespace {

/// With fewer vertices than this per vertex without a triangle, the triangles do not represent the cloud.
constexpr Index min_vertices_per_unused = 50;

}  // namespace

std::vector<Vec3> mapped_positions(const Surface& surface) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Vec3> result(surface.positions().begin(), surface.positions().end());
  for (std::size_t r = 0; r < result.size(); ++r) {
    const auto vertex = surface.rows().vertex(Row(static_cast<Index>(r)));
    if (!vertex)
      result[r] = {nan, nan, nan};
    else if (const auto frame = surface.graph().frame(vertex->index))
      result[r] = frame->origin;
  }
  return result;
}

RowFaces mapped_triangles(const Surface& surface) try {
  if (surface.faces().size() > 0) return {};
  const FlatTriangles flat = surface.flat_approximation();
  const Index vertices = flat.surface.vertex_count();
  Index unused = 0;
  std::vector<Index> rows;
  for (Index v = 0; v < vertices; ++v) {
    unused += flat.surface.first_corner(v).half < 0;
    const auto row = surface.rows().row(Vertex(v));
    if (!row) return {};
    rows.push_back(row->index);
  }
  if (min_vertices_per_unused * unused > vertices) return {};
  RowFaces triangles{{0}, {}};
  for (Index f = 0; f < flat.surface.face_count(); ++f) {
    const exact::HalfRecord side = flat.surface.record(3 * f);
    triangles.rows.insert(triangles.rows.end(), {rows[side.tail], rows[side.head], rows[side.apex]});
    triangles.begin.push_back(static_cast<Offset>(triangles.rows.size()));
  }
  return triangles;
} catch (const InvalidArgument&) {  // no triangles
  return {};
} catch (const InvalidGeometry&) {
  return {};
}
}  // namespace ahm

namespace ahm::detail {
namespace {

/// Strain above that of the sheet: in torn faces (log 2), and in stretched or shrunk faces next to them (log 1.4).
constexpr double torn = 0.693147, blended = 0.336472;
/// Maximum change of the sheet's strain from face to face, and the number of faces over which a map blends two sheets.
constexpr double max_strain_change = 0.05;
constexpr int blend = 3;

Vec2 times(const Vec2& a, const Vec2& b) { return {a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]}; }

class Unfolding {
 public:
  Unfolding(const HalfEdges& edges, const FlatCorners& faces, const LogMap& map)
      : edges_(edges),
        faces_(faces),
        phi_(faces.places.size()),
        state_(face_count(), unvisited),
        sheet_strain_(state_.size()),
        at_source_(state_.size()) {
    read(map);
    find_source(map.source());
    classify_faces();
    if (map.method() == Method::heat) add_blended_faces();
    unfold();
  }

  std::vector<Vec2> result() && {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    for (Index f = 0; f < face_count(); ++f)
      for (Half h = begin(f); h < begin(f + 1); ++h)
        phi_[h] = state_[f] == laid_out ? faces_.unit * phi_[h] : Vec2{nan, nan};
    return std::move(phi_);
  }

 private:
  enum : std::uint8_t { unvisited, masked, to_lay_out, laid_out };

  Index face_count() const {
    return static_cast<Index>(edges_.face_of.empty() ? edges_.tail.size() / 3 : edges_.face_begin.size() - 1);
  }
  Half begin(Index f) const { return static_cast<Half>(edges_.face_of.empty() ? 3 * f : edges_.face_begin[f]); }
  Index face_of(Half h) const { return edges_.face_of.empty() ? h / 3 : edges_.face_of[h]; }

  void read(const LogMap& map) {
    for (Index f = 0; f < face_count(); ++f)
      for (Half h = begin(f); h < begin(f + 1); ++h) {
        const Vertex v(faces_.vertices[h]);
        if (std::isnan(faces_.places[h][0]) || map.status(v) != Status::ok) {
          state_[f] = masked;
          continue;
        }
        const auto phi = map.coordinates(v);
        phi_[h] = {phi[0] / faces_.unit, phi[1] / faces_.unit};
      }
  }

  /// Calls visit(length, mapped length) for the sides and for the diagonals (c, c + 2).
  template <class Visit>
  void for_each_pair(Index f, const Visit& visit) const {
    for (Half h = begin(f); h < begin(f + 1); ++h) {
      const Half one = edges_.next(h), two = edges_.next(one);
      visit(norm(faces_.places[one] - faces_.places[h]), norm(phi_[one] - phi_[h]));
      if (edges_.next(two) != h) visit(norm(faces_.places[two] - faces_.places[h]), norm(phi_[two] - phi_[h]));
    }
  }

  /// The largest log(mapped length / length), its largest absolute value, and the largest length.
  struct Strain {
    double stretch = 0, either = 0, longest = 0;
  };

  Strain strain(Index f) const {
    Strain result;
    for_each_pair(f, [&](double length, double) { result.longest = std::max(result.longest, length); });
    const double half = 0.5 * result.longest;
    for_each_pair(f, [&](double length, double mapped) {
      const double strained = std::log(mapped / std::max(length, half));
      result.stretch = std::max(result.stretch, strained);
      if (length >= half) result.either = std::max(result.either, std::abs(strained));
    });
    result.either = std::max(result.either, result.stretch);
    return result;
  }

  /// Twice the area of a face in the map; negative where the map reverses the face.
  double area(Index f) const {
    const Half first = begin(f);
    double sum = 0;
    for (Half h = first + 1; h + 1 < begin(f + 1); ++h) sum += cross(phi_[h] - phi_[first], phi_[h + 1] - phi_[first]);
    return sum;
  }

  /// Whether a face lies on the sheet. If so, the sheet's strain follows that of the face.
  bool is_on_sheet(Index f) {
    const Strain own = strain(f);
    if (!(own.stretch <= sheet_strain_[f] + torn)) return false;
    if (faces_.orientable && area(f) < -0.1 * own.longest * own.longest) return false;
    sheet_strain_[f] =
        std::clamp(own.stretch, sheet_strain_[f] - max_strain_change, sheet_strain_[f] + max_strain_change);
    return true;
  }

  void find_source(const Source& source) {
    std::vector<bool> is_source(static_cast<std::size_t>(std::ranges::max(faces_.vertices)) + 1);
    for (const Vertex v : source.vertices()) is_source[v.index] = true;
    for (Half h = 0; h < edges_.size(); ++h)
      if (is_source[faces_.vertices[h]]) at_source_[face_of(h)] = true;
  }

  /// Classifies all faces, outward from the source. Faces that are not reached from there start from any face. At the source
  /// the map is on the sheet, however coarse, unless it reverses a face.
  void classify_faces() {
    std::vector<Index> front;
    const auto visit = [&](Index f, double before) {
      if (state_[f] != unvisited) return;
      sheet_strain_[f] = before;
      state_[f] = is_on_sheet(f) || (at_source_[f] && area(f) > 0) ? laid_out : to_lay_out;
      front.push_back(f);
    };
    for (Index f = 0; f < face_count(); ++f)
      if (at_source_[f]) visit(f, 0);
    std::size_t at = 0;
    for (Index f = 0; f < face_count(); ++f) {
      for (; at < front.size(); ++at)
        for (Half h = begin(front[at]); h < begin(front[at] + 1); ++h)
          if (const Half t = edges_.twin[h]; t >= 0) visit(face_of(t), sheet_strain_[front[at]]);
      visit(f, 0);
    }
  }

  /// Marks faces next to torn ones as torn where a heat map blends the two sheets.
  void add_blended_faces() {
    std::vector<Index> front, next;
    for (Index f = 0; f < face_count(); ++f)
      if (state_[f] == to_lay_out) front.push_back(f);
    for (int k = 0; k < blend; ++k, front.swap(next), next.clear())
      for (const Index f : front)
        for (Half h = begin(f); h < begin(f + 1); ++h) {
          const Half t = edges_.twin[h];
          if (t < 0 || state_[face_of(t)] != laid_out || at_source_[face_of(t)]) continue;
          if (strain(face_of(t)).either <= sheet_strain_[face_of(t)] + blended) continue;
          state_[face_of(t)] = to_lay_out;
          next.push_back(face_of(t));
        }
  }

  void unfold() {
    std::vector<Index> front;
    for (Index f = 0; f < face_count(); ++f)
      if (state_[f] == laid_out) front.push_back(f);
    for (std::size_t at = 0; at < front.size(); ++at)
      for (Half h = begin(front[at]); h < begin(front[at] + 1); ++h)
        if (const Half t = edges_.twin[h]; t >= 0 && state_[face_of(t)] == to_lay_out && lay_out_next_to(h, t)) {
          state_[face_of(t)] = laid_out;
          front.push_back(face_of(t));
        }
  }

  /// Lays out the face of t next to the face of h without distortion. A corner takes its position in another neighbor where
  /// that is near.
  bool lay_out_next_to(Half h, Half t) {
    const bool is_same_direction = edges_.is_mirrored(h);
    const Half after = edges_.next(t);
    const Vec2 a = phi_[is_same_direction ? h : edges_.next(h)], b = phi_[is_same_direction ? edges_.next(h) : h];
    const Vec2 p = faces_.places[t], q = faces_.places[after];
    if (!(norm(b - a) > 0) || !(norm(q - p) > 0)) return false;
    // The face of h lies to the left of its sides, unless its layout is reversed.
    const bool turned = (area(face_of(h)) > 0) == is_same_direction;
    const Vec2 along = normalized(b - a), side = normalized(q - p), back = {side[0], -side[1]};
    const Half first = begin(face_of(t)), last = begin(face_of(t) + 1);
    for (Half c = first; c < last; ++c) {
      const Vec2 local = times(back, faces_.places[c] - 0.5 * (p + q));
      phi_[c] = 0.5 * (a + b) + times(along, turned ? Vec2{local[0], -local[1]} : local);
    }
    phi_[t] = a, phi_[after] = b;
    double shortest = std::numeric_limits<double>::infinity();
    for_each_pair(face_of(t), [&](double length, double) { shortest = std::min(shortest, length); });
    const double near = 0.2 * shortest;
    for (Half c = first; c < last; ++c) {
      const Half beyond = edges_.twin[c];
      if (c == t || beyond < 0 || state_[face_of(beyond)] != laid_out) continue;
      const Half ends[] = {c, edges_.next(c)}, there[] = {edges_.next(beyond), beyond};
      for (const int e : {0, 1}) {
        const Vec2 neighbor_position = phi_[there[edges_.is_mirrored(c) ? 1 - e : e]];
        if (ends[e] != t && ends[e] != after && norm(neighbor_position - phi_[ends[e]]) <= near)
          phi_[ends[e]] = neighbor_position;
      }
    }
    return true;
  }

  const HalfEdges& edges_;
  const FlatCorners& faces_;
  std::vector<Vec2> phi_;
  std::vector<std::uint8_t> state_;
  std::vector<double> sheet_strain_;  ///< per face: the strain of the sheet there
  std::vector<bool> at_source_;
};

}  // namespace

std::vector<Vec2> unfolded_corners(const HalfEdges& edges, const FlatCorners& faces, const LogMap& map) {
  return Unfolding(edges, faces, map).result();
}

}  // namespace ahm::detail
