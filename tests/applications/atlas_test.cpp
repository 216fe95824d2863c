// Atlases of charts, the distortion of maps, and the texture that contains all charts.
#include "ahm/applications/atlas.hpp"

#include <map>
#include <set>

#include "ahm/applications/cells.hpp"
#include "ahm/conformance/polygon_meshes.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "mapped_surfaces.hpp"
#include "support/solved_mesh.hpp"

namespace ahm::test {
namespace {

struct MeshWithFaces : SolvedMesh {
  using SolvedMesh::SolvedMesh;
  FaceList faces() const { return surface.faces(); }
  std::vector<Vertex> sources(Index first, Index count) const {
    return farthest_points(surface.graph(), Vertex(first), count);
  }
  Atlas atlas(std::span<const Vertex> sources) const { return make_atlas(solver, sources, faces()); }
  Atlas refined(std::span<const Vertex> sources, const RefineOptions& options = {}) const {
    return make_atlas(solver, sources, faces(), surface.positions(), options);
  }
  AtlasDistortion distortion_of(const Atlas& atlas) const { return distortion(atlas, faces(), surface.positions()); }
};

/// A tube of unit radius, open at both ends.
Mesh tube_mesh(Index rings, Index around) {
  Mesh mesh;
  const double step = 2 * pi / around;
  for (Index r = 0; r < rings; ++r)
    for (Index a = 0; a < around; ++a) {
      mesh.positions.push_back({step * r, std::cos(step * (a + 0.5 * r)), std::sin(step * (a + 0.5 * r))});
      const Index i = r * around + a, j = r * around + (a + 1) % around;
      if (r + 1 < rings) mesh.faces.insert(mesh.faces.end(), {{i, i + around, j}, {j, i + around, j + around}});
    }
  return mesh;
}

Index uncharted(const Atlas& atlas) { return static_cast<Index>(std::ranges::count(atlas.chart_of_face, -1)); }

/// Expects every face in one chart, that of `chart_of_face`, or in none, and charts that are connected through sides.
void expect_partition(const Atlas& atlas, const FaceList& faces) {
  std::vector<int> uses(faces.size(), 0);
  for (std::size_t k = 0; k < atlas.charts.size(); ++k) {
    const Chart& chart = atlas.charts[k];
    ASSERT_FALSE(chart.faces.empty());
    ASSERT_TRUE(std::ranges::is_sorted(chart.faces));
    std::map<std::pair<Index, Index>, std::vector<Index>> faces_of_side;
    for (Index f : chart.faces) {
      ++uses[f];
      EXPECT_EQ(atlas.chart_of_face[f], static_cast<Index>(k));
      const auto face = faces[f];
      for (std::size_t c = 0; c < face.size(); ++c)
        faces_of_side[std::minmax(face[c], face[(c + 1) % face.size()])].push_back(f);
    }
    std::set<Index> reached{chart.faces.front()};
    for (std::size_t before = 0; before < reached.size();) {
      before = reached.size();
      for (const auto& [side, of] : faces_of_side)
        if (std::ranges::any_of(of, [&](Index f) { return reached.contains(f); })) reached.insert(of.begin(), of.end());
    }
    EXPECT_EQ(reached.size(), chart.faces.size()) << "chart " << k << " is not connected";
  }
  for (std::size_t f = 0; f < faces.size(); ++f) {
    EXPECT_EQ(uses[f], atlas.chart_of_face[f] >= 0);
    for (Offset c = faces.begin[f]; c < faces.begin[f + 1]; ++c)
      EXPECT_EQ(std::isfinite(atlas.corner(c)[0]), atlas.chart_of_face[f] >= 0);
  }
}

TEST(Atlas, OfAPlaneIsIsometricForAllTriangles) {
  const MeshWithFaces plane(sliver_square(500));
  for (Index count : {1, 7}) {
    const Atlas atlas = plane.atlas(plane.sources(3, count));
    expect_partition(atlas, plane.faces());
    EXPECT_EQ(uncharted(atlas), 0);
    EXPECT_NEAR(plane.distortion_of(atlas).all.percentile_95, 1, 1e-9);
    EXPECT_EQ(plane.distortion_of(atlas).all.flipped_area, 0);
  }
}

TEST(Atlas, HasTheLogMapsOfTheSourcesNearestToTheFaces) {
  const MeshWithFaces sphere(icosphere(16));
  const auto sources = sphere.sources(5, 12);
  const Atlas atlas = sphere.atlas(sources);
  expect_partition(atlas, sphere.faces());
  EXPECT_EQ(atlas.sources, sources);
  std::vector<LogMap> maps;
  for (Vertex s : sources) maps.push_back(sphere.solver.solve(Source::at_vertex(s)));
  std::size_t different = 0;
  for (std::size_t f = 0; f < sphere.faces().size(); ++f) {
    const auto source = to_size(atlas.charts[atlas.chart_of_face[f]].source);
    std::vector<double> mean(maps.size(), 0.0);
    for (std::size_t c = 0; c < 3; ++c) {
      const Vertex v(sphere.faces()[f][c]);
      const Vec2 corner = atlas.corner(static_cast<Offset>(3 * f + c));
      for (std::size_t a : {0, 1}) EXPECT_NEAR(corner[a], maps[source].coordinates(v)[a], 1e-9);
      for (std::size_t s = 0; s < maps.size(); ++s) mean[s] += maps[s].distance(v) / 3;
    }
    different += mean[source] != std::ranges::min(mean);
    // Heat selects the sources that are compared.
    EXPECT_LT(mean[source], std::ranges::min(mean) + edge_length(sphere.surface.graph()));
  }
  EXPECT_LT(different, sphere.faces().size() / 50);
}

TEST(Atlas, OfASphereImprovesWithTheNumberOfCharts) {
  const MeshWithFaces sphere(icosphere(20));
  double before = INFINITY;
  for (Index count : {4, 12, 40}) {
    const Atlas atlas = sphere.atlas(sphere.sources(0, count));
    double radius = 0;
    for (std::size_t c = 0; c < sphere.faces().vertices.size(); ++c)
      radius = std::max(radius, length(atlas.corner(static_cast<Offset>(c))));
    const DistortionSummary d = sphere.distortion_of(atlas).all;
    EXPECT_EQ(d.flipped, 0);
    EXPECT_LT(d.percentile_95, 1.05 * radius / std::sin(radius));  // that of the exact map at the rim
    EXPECT_LT(d.mean, before);
    before = d.mean;
  }
}

TEST(Atlas, HasCounterClockwiseChartsAlsoForMirroredFrames) {
  const FlatGraph plane = planar_triangulation(20, TransportKind::block, true);
  const CsrGraph graph(plane.data);
  const LogMapSolver solver(graph);
  std::vector<Offset> begin{0};
  std::vector<Index> vertices;
  for (const Triangle& t : star_triangles(graph, solver.solve(Source::at_vertex(Vertex{0}), {.frames = true}))) {
    vertices.insert(vertices.end(), t.begin(), t.end());
    begin.push_back(begin.back() + 3);
  }
  std::vector<Vec3> positions;
  for (std::size_t i = 0; i < to_size(graph.size()); ++i)
    positions.push_back({plane.positions[2 * i], plane.positions[2 * i + 1], 0});
  const Atlas atlas = make_atlas(solver, farthest_points(graph, Vertex{0}, 10), {begin, vertices});
  expect_partition(atlas, {begin, vertices});
  const AtlasDistortion d = distortion(atlas, {begin, vertices}, positions);
  EXPECT_EQ(d.all.flipped, 0);
  EXPECT_NEAR(d.all.largest, 1, 1e-9);
}

TEST(Atlas, DoesNotCutPolygons) {
  const Polygons quads = quad_grid(15);
  const auto mesh = polymesh::PolygonMeshSurface::build(quads.positions, quads.begin, quads.corners,
                                                        {.discretization = polymesh::Discretization::polygons});
  const LogMapSolver solver(mesh.graph());
  const Atlas atlas = make_atlas(solver, farthest_points(mesh.graph(), Vertex{0}, 6), mesh.faces());
  expect_partition(atlas, mesh.faces());
  const AtlasDistortion d = distortion(atlas, mesh.faces(), quads.positions);
  EXPECT_NEAR(d.all.largest, 1, 1e-9);
  EXPECT_EQ(d.all.measured, 2 * 15 * 15);
}

TEST(Atlas, OmitsComponentsWithoutASourceUnlessRefined) {
  const Mesh one = icosphere(4);
  const MeshWithFaces two(joined(one, one, {3, 0, 0}));
  const std::array sources{Vertex{0}, Vertex{7}};
  const Atlas atlas = two.atlas(sources), whole = two.refined(sources);
  expect_partition(atlas, two.faces());
  const std::size_t half = one.faces.size();
  for (std::size_t f = 0; f < 2 * half; ++f) EXPECT_EQ(atlas.chart_of_face[f] >= 0, f < half);
  EXPECT_EQ(two.distortion_of(atlas).all.unmeasured, static_cast<Offset>(half));
  expect_partition(whole, two.faces());
  EXPECT_EQ(uncharted(whole), 0);
}

TEST(AtlasRefinement, OpensATubeAndPreservesTheSources) {
  const MeshWithFaces tube(tube_mesh(60, 24));
  const std::array source{Vertex{24 * 30}};
  EXPECT_GT(tube.distortion_of(tube.atlas(source)).all.flipped, 0);  // opposite to the source
  const Atlas open = tube.refined(source, {.max_distortion = 1.5});
  expect_partition(open, tube.faces());
  EXPECT_EQ(open.sources.front(), source[0]);
  EXPECT_LT(open.sources.size(), 40U);
  for (const DistortionSummary& chart : tube.distortion_of(open).charts) {
    EXPECT_LE(chart.flipped_area, 0.01);
    EXPECT_LE(chart.percentile_95, 1.5);
  }
  // Maps are reused during the refinement. They are those of a new atlas.
  const Atlas fresh = tube.atlas(open.sources);
  EXPECT_EQ(fresh.chart_of_face, open.chart_of_face);
  for (std::size_t k = 0; k < open.coordinates.size(); ++k)
    EXPECT_NEAR(fresh.coordinates[k], open.coordinates[k], 1e-9);
}

TEST(AtlasRefinement, AddsNothingToAGoodAtlasAndNoMoreThanAllowed) {
  const std::array source{Vertex{4}};
  EXPECT_EQ(MeshWithFaces(sliver_square(300)).refined(source).sources.size(), 1U);
  EXPECT_EQ(MeshWithFaces(tube_mesh(60, 24)).refined(source, {.max_sources = 3}).sources.size(), 3U);
}

TEST(ChartBoxes, AreTheSmallestOfAllRotations) {
  const MeshWithFaces sphere(icosphere(10));
  const Atlas atlas = sphere.atlas(sphere.sources(0, 8));
  const auto boxes = chart_boxes(atlas, sphere.faces());
  ASSERT_EQ(boxes.size(), atlas.charts.size());
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    const ChartBox& box = boxes[k];
    /// The box of the chart with the x axis along `axis`.
    const auto box_along = [&](const Vec2& axis) {
      ChartBox result{.low = {1e9, 1e9}, .high = {-1e9, -1e9}};
      for (Index f : atlas.charts[k].faces)
        for (Offset corner = 3 * f; corner < 3 * f + 3; ++corner) {
          const Vec2 q = atlas.corner(corner), p{axis[0] * q[0] + axis[1] * q[1], axis[0] * q[1] - axis[1] * q[0]};
          for (std::size_t a : {0, 1})
            result.low[a] = std::min(result.low[a], p[a]), result.high[a] = std::max(result.high[a], p[a]);
        }
      return result;
    };
    const auto area = [](const ChartBox& b) { return (b.high[0] - b.low[0]) * (b.high[1] - b.low[1]); };
    EXPECT_NEAR(length(box.turn), 1, 1e-12);
    EXPECT_GE(box.high[0] - box.low[0], box.high[1] - box.low[1]);
    const ChartBox own = box_along(box.turn);
    for (std::size_t a : {0, 1}) {
      EXPECT_GE(own.low[a], box.low[a] - 1e-12);
      EXPECT_LE(own.high[a], box.high[a] + 1e-12);
    }
    for (int degree = 0; degree < 180; ++degree)
      EXPECT_LE(area(box), area(box_along({std::cos(degree * pi / 180), std::sin(degree * pi / 180)})) * (1 + 1e-12));
  }
  const MeshWithFaces other(icosphere(3));
  EXPECT_THROW(chart_boxes(atlas, other.faces()), InvalidArgument);
}

TEST(Atlas, RefusesInvalidArguments) {
  const MeshWithFaces sphere(icosphere(2));
  const std::array source{Vertex{0}}, outside{Vertex{1000}};
  const std::vector<Offset> triangle{0, 3};
  const std::vector<Index> outside_corners{0, 1, 1000};
  const FaceList one_face{triangle, sphere.faces().vertices.first(3)};
  EXPECT_THROW(sphere.atlas({}), InvalidArgument);
  EXPECT_THROW(sphere.atlas(outside), InvalidArgument);
  EXPECT_THROW(make_atlas(sphere.solver, source, {sphere.faces().begin.first(3), sphere.faces().vertices}),
               InvalidArgument);
  EXPECT_THROW(make_atlas(sphere.solver, source, {triangle, outside_corners}), InvalidArgument);
  EXPECT_THROW(sphere.refined(source, {.max_distortion = 1}), InvalidArgument);
  EXPECT_THROW(sphere.refined(source, {.share = 1}), InvalidArgument);
  EXPECT_THROW(make_atlas(sphere.solver, source, sphere.faces(), sphere.surface.positions().first(4), {}),
               InvalidArgument);
  EXPECT_THROW(distortion(sphere.atlas(source), one_face, sphere.surface.positions()), InvalidArgument);
  const CsrGraph solid(lattice3(3).data);
  EXPECT_THROW(make_atlas(LogMapSolver(solid), source, one_face), InvalidArgument);
}

/// The coordinates of a patch after a linear map of the plane.
std::vector<double> mapped(const Patch& patch, const std::array<double, 4>& A) {
  std::vector<double> q = patch.coordinates;
  for (std::size_t i = 0; i + 1 < q.size(); i += 2) {
    const double u = q[i], v = q[i + 1];
    q[i] = A[0] * u + A[1] * v, q[i + 1] = A[2] * u + A[3] * v;
  }
  return q;
}

TEST(Distortion, OfALinearMapAreItsSingularValues) {
  // A tilted plane, so that positions differ from (u, v).
  const Patch plane = patch(20, 1, [](double u, double v) {
    return std::array{Vec3{3 + 0.6 * u, v - 7, 0.8 * u}, Vec3{-0.8, 0, 0.6}};
  });
  const double c = std::cos(0.7), s = std::sin(0.7);
  for (const double turn : {0.0, 1.0, 2.5})
    for (const auto& [a, b] : {Vec2{1, 1}, {3, 0.5}, {0.2, 0.9}, {4, 2}, {2, -1.5}}) {
      const double C = std::cos(turn), S = std::sin(turn);  // stretched by a and b between two rotations
      const auto triangles = distortion(plane.positions, plane.triangles,
                                        mapped(plane, {C * a * c - S * b * s, -C * a * s - S * b * c,
                                                       S * a * c + C * b * s, -S * a * s + C * b * c}));
      const double least = std::min(std::abs(a), std::abs(b)), most = std::max(std::abs(a), std::abs(b));
      double area = 0;
      for (const TriangleDistortion& t : triangles) {
        EXPECT_NEAR(t.sigma1, least, 1e-12);
        EXPECT_NEAR(t.sigma2, most, 1e-12);
        EXPECT_NEAR(t.value(), std::max(1 / least, most), a == b ? 1e-12 : 1e-11);
        EXPECT_EQ(t.flipped, a * b < 0);
        area += t.side * t.side;
      }
      EXPECT_NEAR(area, 4, 1e-12);
      EXPECT_EQ(summary(triangles).flipped, a * b < 0 ? 1 : 0);
      if (a == b) EXPECT_NEAR(summary(triangles).mean, 1, 1e-13);
    }
}

TEST(Distortion, IsInfiniteForACollapseAndNanForMissingCoordinates) {
  const std::vector<Vec3> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}};
  const std::vector<Triangle> triangles{{0, 1, 2}, {0, 1, 3}};  // the second has no area
  const auto collapsed = distortion(positions, triangles, std::vector<double>{0, 0, 1, 0, 2, 0, 0, 0});
  EXPECT_EQ(collapsed[0].value(), INFINITY);
  EXPECT_TRUE(std::isnan(collapsed[1].value()));
  const auto missing = distortion(positions, triangles, std::vector<double>{0, 0, 1, 0, NAN, 0, 0, 0});
  EXPECT_TRUE(std::isnan(missing[0].value()));
  const DistortionSummary s = summary(missing);
  EXPECT_EQ(s.measured, 0);
  EXPECT_EQ(s.unmeasured, 2);
  EXPECT_TRUE(std::isnan(s.mean) && std::isnan(s.percentile_95) && std::isnan(s.flipped));
}

// Polar coordinates stretch circles by r / sin r and nothing else.
TEST(Distortion, OfTheLogMapOfASphereIsRadiusOverSine) {
  const Patch cap = patch(81, 1.2, on_sphere);
  const auto triangles = distortion(cap.positions, cap.triangles, cap.coordinates);
  std::vector<double> corners;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    Vec2 center{};
    for (Index i : cap.triangles[t]) {
      const Vec2 p = cap.plane(to_size(i));
      center = center + 1.0 / 3 * p;
      corners.insert(corners.end(), p.begin(), p.end());
    }
    const double r = length(center);
    EXPECT_NEAR(triangles[t].sigma2, r > 0 ? r / std::sin(r) : 1, cap.longest_edge);
    EXPECT_NEAR(triangles[t].sigma1, 1, cap.longest_edge);
  }
  const auto by_corner = corner_distortion(cap.positions, cap.triangles, corners);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    EXPECT_EQ(triangles[t].sigma1, by_corner[t].sigma1);
    EXPECT_EQ(triangles[t].sigma2, by_corner[t].sigma2);
  }
}

TEST(Distortion, DoesNotDependOnPowersOfTwo) {
  const Patch cap = patch(9, 1, on_sphere);
  const auto original = distortion(cap.positions, cap.triangles, cap.coordinates);
  for (int exponent : {-400, -30, 30, 400}) {
    const Patch scaled = cap.scaled(exponent);
    const auto triangles = distortion(scaled.positions, scaled.triangles, scaled.coordinates);
    for (std::size_t t = 0; t < triangles.size(); ++t) EXPECT_EQ(triangles[t].value(), original[t].value());
    EXPECT_EQ(summary(triangles).percentile_95, summary(original).percentile_95);
  }
}

TEST(Distortion, IsSummarizedByArea) {
  const auto triangle = [](double sigma2, double area, bool flipped) {
    return TriangleDistortion{1, sigma2, std::sqrt(area), flipped};
  };
  std::vector<TriangleDistortion> triangles{triangle(2, 90, false), triangle(10, 6, true), triangle(4, 4, false), {}};
  const DistortionSummary s = summary(triangles);
  EXPECT_DOUBLE_EQ(s.mean, (90 * 2 + 6 * 10 + 4 * 4) / 100.0);
  EXPECT_EQ(s.median, 2);
  EXPECT_EQ(s.percentile_95, 10);  // 94 % of the area have at most 4
  EXPECT_EQ(s.largest, 10);
  EXPECT_DOUBLE_EQ(s.flipped, 1.0 / 3);
  EXPECT_DOUBLE_EQ(s.flipped_area, 0.06);
  EXPECT_EQ(s.collapsed_area, 0);
  EXPECT_EQ(s.measured, 3);
  EXPECT_EQ(s.unmeasured, 1);
  // Collapsed triangles are not part of the mean, but of all other numbers.
  triangles.push_back(triangle(1e14, 25, false));
  const DistortionSummary c = summary(triangles);
  EXPECT_DOUBLE_EQ(c.mean, s.mean);
  EXPECT_DOUBLE_EQ(c.collapsed_area, 0.2);
  EXPECT_EQ(c.largest, 1e14);
  EXPECT_EQ(c.measured, 4);
  EXPECT_TRUE(std::isnan(summary(std::vector{triangle(1e14, 25, false)}).mean));
}

TEST(Distortion, RefusesArraysOfAnotherLengthAndCornersOutside) {
  const Patch plane = patch(4, 1, flat);
  EXPECT_THROW(distortion(plane.positions, plane.triangles, std::vector<double>(3)), InvalidArgument);
  EXPECT_THROW(corner_distortion(plane.positions, plane.triangles, plane.coordinates), InvalidArgument);
  EXPECT_THROW(distortion(plane.positions, std::vector<Triangle>{{0, 1, 16}}, plane.coordinates), InvalidArgument);
}

/// Charts of one turned rectangle each, as two triangles, all sizes from 0.02 to 1.
struct Rectangles {
  Atlas atlas;
  std::vector<Offset> begin{0};
  std::vector<Index> vertices;
  std::vector<double> areas;

  explicit Rectangles(Index count) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (Index k = 0; k < count; ++k) {
      const double a = 0.02 + 0.98 * uniform(random), b = 0.02 + 0.5 * uniform(random), turn = pi * uniform(random),
                   c = std::cos(turn), s = std::sin(turn), x = 10 * uniform(random), y = 10 * uniform(random);
      areas.push_back(a * b);
      const Vec2 corners[] = {{0, 0}, {a, 0}, {a, b}, {0, b}};
      atlas.charts.push_back({k, {2 * k, 2 * k + 1}});
      for (int which : {0, 1, 2, 0, 2, 3}) {
        const auto [p, q] = corners[which];
        atlas.coordinates.insert(atlas.coordinates.end(), {x + c * p - s * q, y + s * p + c * q});
        vertices.push_back(4 * k + which);
      }
      begin.insert(begin.end(), {6 * k + 3, 6 * k + 6});
      atlas.chart_of_face.insert(atlas.chart_of_face.end(), {k, k});
    }
  }
  FaceList faces() const { return {begin, vertices}; }
};

class Packed : public testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    if (!can_pack()) GTEST_SKIP() << "this build has no stb";
  }
};

TEST_P(Packed, ChartsAreSeparatedInTheSquareAtOneScale) {
  const Rectangles charts(GetParam());
  const PackOptions options{.size = 1024, .margin = 5};
  const TextureAtlas packed = pack(charts.atlas, charts.faces(), options);
  ASSERT_EQ(packed.boxes.size(), charts.areas.size());
  double area = 0;
  int reach = 0;
  for (std::size_t k = 0; k < packed.boxes.size(); ++k) {
    const TextureBox& a = packed.boxes[k];
    EXPECT_GE(std::min(a.x, a.y), options.margin);
    EXPECT_LE(std::max(a.x + a.width, a.y + a.height), options.size - options.margin);
    for (std::size_t l = 0; l < k; ++l) {
      const TextureBox& b = packed.boxes[l];
      const int gap = std::max({a.x - b.x - b.width, b.x - a.x - a.width, a.y - b.y - b.height, b.y - a.y - a.height});
      EXPECT_GE(gap, options.margin) << "charts " << k << " and " << l;
    }
    for (std::size_t c = 6 * k; c < 6 * k + 6; ++c) {
      const double* q = packed.coordinates.data() + 2 * c;
      const double* p = charts.atlas.coordinates.data() + 2 * c;
      const double x = q[0] * options.size, y = q[1] * options.size;
      EXPECT_TRUE(x >= a.x - 1e-9 && x <= a.x + a.width + 1e-9 && y >= a.y - 1e-9 && y <= a.y + a.height + 1e-9);
      if (c + 1 < 6 * k + 6)  // sides have the scale of the atlas
        EXPECT_NEAR(std::hypot(q[2] - q[0], q[3] - q[1]) * options.size,
                    packed.scale * std::hypot(p[2] - p[0], p[3] - p[1]), 1e-9);
    }
    area += packed.scale * packed.scale * charts.areas[k];
    reach = std::max({reach, a.x + a.width, a.y + a.height});
  }
  EXPECT_NEAR(packed.filled, area / (1024 * 1024), 0.1);  // boxes are whole texels
  EXPECT_GT(packed.filled, packed.boxes.size() > 2 ? 0.5 : 0.1);
  EXPECT_GT(reach, 0.97 * (options.size - options.margin));  // the square is filled in one direction at least
  for (std::size_t f = 0; f < charts.faces().size(); ++f) {
    const auto orientation = [&](const std::vector<double>& q) {
      const double* p = q.data() + 6 * f;
      return (p[2] - p[0]) * (p[5] - p[1]) - (p[4] - p[0]) * (p[3] - p[1]);
    };
    EXPECT_GT(orientation(charts.atlas.coordinates) * orientation(packed.coordinates), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Counts, Packed, testing::Values(1, 2, 17, 150));

TEST_F(Packed, ChartsHaveDifferentColors) {
  const Rectangles charts(20);
  const TextureAtlas packed = pack(charts.atlas, charts.faces(), {.size = 512, .margin = 4});
  const Image image = checkerboard(packed, 8);
  ASSERT_EQ(image.width, 512);
  std::set<std::array<int, 3>> colors;
  for (const TextureBox& box : packed.boxes) {
    const std::uint8_t* pixel = image.pixel(box.x, 511 - box.y);
    colors.insert({pixel[0], pixel[1], pixel[2]});
    EXPECT_EQ(pixel[3], 255);
    EXPECT_TRUE(std::equal(pixel, pixel + 3, image.pixel(box.x, 511 - box.y - 1)));
    const std::uint8_t* below = image.pixel(box.x, 511 - box.y + 1);  // in the margin
    EXPECT_LT(below[0] + below[1] + below[2], 3 * 255);
  }
  EXPECT_EQ(colors.size(), packed.boxes.size());
}

TEST_F(Packed, ChartsMustFit) {
  const Rectangles charts(150);
  for (const PackOptions& options : {PackOptions{.size = 32, .margin = 4}, {.size = 8}, {.margin = -1}})
    EXPECT_THROW(pack(charts.atlas, charts.faces(), options), InvalidArgument);
  EXPECT_EQ(pack(Atlas{}, {charts.faces().begin.first(1), {}}).boxes.size(), 0U);
}

}  // namespace
}  // namespace ahm::test
