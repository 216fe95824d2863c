// All experiments at toy size, and laws of their numbers that hold at any size.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "experiments/experiment.hpp"

namespace ahm::bench {
namespace {

/// The table of an experiment at toy size; each experiment runs once.
const Table& toy(std::string_view name) {
  static std::map<std::string_view, Table> made;
  if (const auto at = made.find(name); at != made.end()) return at->second;
  for (const Experiment& e : experiments())
    if (e.name == name) return made.emplace(e.name, e.run({.toy = true})).first->second;
  throw std::logic_error("no experiment " + std::string(name));
}

constexpr const char* affine[] = {"AHM_a", "AHM_l"};

TEST(FlatExperiment, AffineHeatAndDiscreteExponentialAreExact) {
  const Table& table = toy("flat");
  for (const char* method : {"AHM_a", "AHM_l", "DEM"})
    EXPECT_LE(table.where("method", method).largest("largest / diameter"), 1e-11) << method;
  EXPECT_EQ(table.largest("missing"), 0);
}

TEST(MazeExperiment, AffineHeatIsTheIdentity) {
  const Table& table = toy("mazes");
  for (const char* method : affine)
    EXPECT_LE(table.where("method", method).largest("largest / diameter"), 1e-11) << method;
  EXPECT_GT(table.smallest("longest path / diameter"), 1.5);  // otherwise it is no maze
}

TEST(DistortionExperiment, AffineHeatHasNoneOnTheFlatGrid) {
  const Table table = toy("distortion").where("shape", "flat grid");
  for (const char* method : affine) EXPECT_LE(table.where("method", method).largest("95% D"), 1 + 1e-9) << method;
}

TEST(DistortionExperiment, NothingIsLessThanAnIsometry) { EXPECT_GE(toy("distortion").smallest("median D"), 1); }

#ifdef AHM_METHODS_CGAL
TEST(DistanceExperiment, AffineHeatIsNearerThanTheHeatMethodsNearTheSource) {
  const Table near = toy("distance").where("distance / longest", "0.05");
  for (const char* shape : {"sphere", "bumpy sphere", "torus"})
    for (const char* method : affine)
      for (const char* other : {"HM", "HM (graph)", "SHM"}) {
        const Table rows = near.where("shape", shape);
        EXPECT_LT(rows.where("method", method).mean("mean"), rows.where("method", other).mean("mean"))
            << shape << " " << method << " " << other;
      }
}

TEST(DistanceExperiment, UnfoldedDistancesHoldEverywhere) {
  const Table all = toy("distance").where("distance / longest", "all");
  EXPECT_LT(all.where("method", "unfolded").largest("95%"), 0.03);
  for (const char* shape : {"sphere", "bumpy sphere", "torus"})
    for (const char* method : affine)
      EXPECT_LT(all.where("shape", shape).where("method", "unfolded").mean("95%"),
                all.where("shape", shape).where("method", method).mean("95%"))
          << shape << " " << method;
}
#endif

TEST(ConvergenceExperiment, TheAdaptiveVariantIsOfFirstOrder) {
  const Table table = toy("convergence").where("method", "AHM_a");
  for (const char* order : {"order L2", "order L2 inside", "order Linf"})
    EXPECT_GE(table.smallest(order), 0.75) << order;
}

TEST(SmoothSurfacesExperiment, LengthsOfPolarMapsAreOfSecondOrder) {
  const Table& table = toy("smooth_surfaces");
  EXPECT_GE(table.where("method", "polar").smallest("order |vector|"), 1.8);
  EXPECT_LE(table.where("method", "polar").largest("vector 95%"), table.where("method", "heat").largest("vector 95%"));
  // The front uses the curvature of the smooth surface.
  EXPECT_LT(table.where("method", "polar without windows").largest("vector 95%"),
            table.where("method", "exact").largest("vector 95%") / 2);
}

TEST(CostsExperiment, ExactMapsHaveNoErrorAndMemoryIsMeasured) {
  const Table& table = toy("costs");
  EXPECT_EQ(table.where("method", "exact").largest("vector 95%"), 0);
  EXPECT_LT(table.where("method", "CGAL").largest("distance 95%"), 1e-9);
  EXPECT_LT(table.where("method", "distance").largest("distance 95%"), 0.02);
  EXPECT_GT(table.where("method", "Dijkstra").smallest("distance 95%"), 0.02);
  EXPECT_LT(table.where("method", "polar").largest("vector 95%"), 1e-6);  // windows cover small meshes
  EXPECT_GT(table.smallest("added MB"), 0);
}

TEST(ToolpathsExperiment, PathsCoverAllParts) {
  const Table& table = toy("toolpaths");
  EXPECT_GE(table.smallest("covered"), 0.99);
  EXPECT_LE(table.largest("largest gap / spacing"), 1.25);
  EXPECT_LE(table.largest("double"), 0.03);
  EXPECT_EQ(table.largest("missing links"), 0);
}

TEST(TrustExperiment, VectorsThatAreTrustedAreRight) {
  const Table& table = toy("trust");
  EXPECT_GE(table.where("as", "triangles").smallest("area under curve"), 0.9);
  EXPECT_GE(table.where("as", "triangles").smallest("right among kept"), 0.95);
  EXPECT_LE(table.where("as", "triangles").where("method", "polar").largest("vector 95%"), 0.05);
}

TEST(CloudsExperiment, HeatHasTheDistancesOfTheCleanSphere) {
  const Table sphere = toy("clouds").where("cloud", "sphere").where("noise", "0");
  EXPECT_LT(sphere.where("variant", "unfolded").largest("95%"), 0.02);
  EXPECT_LT(sphere.where("variant", "adaptive").largest("95%"), 0.04);
}

TEST(FarExperiment, FlatGraphsAreExactAtAnyDistance) {
  const Table& table = toy("far");
  EXPECT_EQ(table.numbers("ok"), table.numbers("vertices"));
  EXPECT_LE(table.largest("|phi|, line of the source"), 1e-11);
  EXPECT_LE(table.where("shape", "cube").largest("distance"), 1e-11);
}

TEST(VariantsExperiment, DifferLeastAtTheSource) {
  const Table& table = toy("variants");
  for (const char* shape : {"sphere", "ellipsoid", "bumpy sphere", "torus"}) {
    const Table rows = table.where("shape", shape);
    EXPECT_EQ(rows.where("distance / longest", "0.05").mean("median difference"), rows.smallest("median difference"));
  }
}

TEST(CutLocusExperiment, TheBandIsAsManyEdgesWideAtAnyResolution) {
  const Table table = toy("cut_locus").where("method", "AHM_a");
  for (const char* edges : {"1", "2", "3", "4"}) {
    const Table rows = table.where("edges from cut", edges);
    EXPECT_LT(rows.largest("mean / radius"), 1.25 * rows.smallest("mean / radius")) << edges;
  }
  const Table finest = table.where("around", "32");  // away from the band the error decays like the heat across it
  for (int edges = 2; edges <= 12; edges += 2)
    EXPECT_LT(finest.where("edges from cut", std::to_string(edges)).mean("mean / radius"), std::exp(-0.9 * edges) * 4)
        << edges;
}

TEST(TimesExperiment, NoTimeMattersInThePlane) {
  const Table plane = toy("times").where("shape", "plane");
  for (const char* method : affine) EXPECT_LE(plane.where("method", method).largest("largest"), 1e-11) << method;
}

TEST(DelaunayExperiment, FlipsLeaveNoNegativeWeightAndAreNearer) {
  const Table &table = toy("delaunay"), flipped = table.where("triangulation", "intrinsic Delaunay");
  EXPECT_EQ(flipped.largest("clamped weights"), 0);
  for (const char* mesh : {"needles", "slivers"})
    for (const char* method : affine) {
      auto rms = [&](const char* how) {
        return table.where("triangulation", how).where("mesh", mesh).where("method", method).mean("rms");
      };
      EXPECT_LT(rms("intrinsic Delaunay"), rms("as given")) << mesh << " " << method;
    }
}

TEST(TessellationsExperiment, FinerIsNearer) {
  const Table& table = toy("tessellations");
  EXPECT_EQ(table.largest("missing"), 0);
  for (const char* method : affine) {
    auto rms = [&](const char* mesh) { return table.where("mesh", mesh).where("method", method).mean("rms"); };
    EXPECT_GT(rms("icosphere 42"), rms("icosphere 162")) << method;
    EXPECT_GT(rms("icosphere 162"), rms("icosphere 642")) << method;
  }
}

TEST(DemExperiment, AffineHeatConvergesFarFromTheSourceAndPathsOfEdgesDoNot) {
  const Table far = toy("dem").where("distance / pi", "0.75");
  auto gain = [&](const char* method) {
    const Table rows = far.where("method", method);
    return rows.where("vertices", "642").mean("mean") / rows.where("vertices", "2562").mean("mean");
  };
  EXPECT_GT(gain("AHM_a"), 1.7);
  EXPECT_LT(gain("DEM"), 1.4);
}

TEST(BoundaryExperiment, TheRimIsNoFartherOffThanFirstOrder) {
  const Table rim = toy("boundary").where("part", "rim");
  EXPECT_LE(rim.where("method", "AHM_l").largest("distance rms / h"), 0.2);
  EXPECT_LE(rim.where("method", "AHM_a").largest("distance rms / h"), 1.0);
}

TEST(RadialExperiment, AffineDiffusionIsExactInThePlaneHoweverThinTheTriangles) {
  EXPECT_LE(toy("radial").where("mesh", "plane").where("method", "affine").largest("95% angle"), 1e-11);
}

TEST(DiscretizationsExperiment, AllAreOfTheSameSizeOfError) {
  const Table table = toy("discretizations").where("t_coef", "1").where("variant", "adaptive");
  const double triangles = table.where("discretization", "triangles").mean("rms");
  for (const char* how : {"points of the icosphere", "random points", "points on a spiral", "quads", "quads, refined",
                          "hexagons", "hexagons, refined", "Voronoi cells", "Voronoi cells, refined"})
    EXPECT_LE(table.where("discretization", how).mean("rms"), 2 * triangles) << how;
}

TEST(PolygonsExperiment, RefinedIsNearer) {
  const Table table = toy("polygons").where("variant", "adaptive");
  for (const char* mesh : {"quads", "globe", "globe, stretched along", "globe, stretched across", "L and squares",
                           "hexagons", "Voronoi cells"}) {
    const Table rows = table.where("mesh", mesh);
    const Table refined = rows.where("discretization", "refined"), polygons = rows.where("discretization", "polygons");
    EXPECT_LE(refined.mean("rms"), polygons.mean("rms")) << mesh;
    EXPECT_LT(refined.mean("distance rms"), polygons.mean("distance rms")) << mesh;
  }
}

class AnyExperiment : public testing::TestWithParam<std::string> {};

TEST_P(AnyExperiment, FillsItsTableAndSaysWhatIsSeen) {
#ifndef AHM_METHODS_CGAL
  if (GetParam() == "distance") GTEST_SKIP() << "needs CGAL";
#endif
  const Table& table = toy(GetParam());
  EXPECT_FALSE(table.rows().empty());
  EXPECT_FALSE(table.seen.empty());
  for (const auto& row : table.rows())
    for (const Cell& cell : row) EXPECT_TRUE(cell.text() != "nan" && cell.text() != "inf");
}

TEST(BackendsExperiment, FinerIsNearerAndLarger) {
  const Table table = toy("backends").where("part", "backend");
  for (const char* shape : {"sphere", "torus", "bumpy sphere"})
    for (const char* as : {"triangles", "quads", "points"}) {
      const Table rows = table.where("shape", shape).where("as", as);
      for (const char* error : {"mean error", "median error"}) {
        const std::vector<double> errors = rows.numbers(error);
        ASSERT_EQ(errors.size(), 2u) << shape << " " << as;
        EXPECT_LT(errors[1], errors[0]) << shape << " " << as << " " << error;
      }
      const std::vector<double> bytes = rows.numbers("factors MB");
      EXPECT_LT(bytes[0], bytes[1]) << shape << " " << as;
    }
}

TEST(BackendsExperiment, AllComeAboutAsNearOnTheSphere) {
  const Table sphere = toy("backends").where("part", "backend").where("shape", "sphere");
  const std::vector<double> triangles = sphere.where("as", "triangles").numbers("vector error");
  for (const char* as : {"quads", "points"}) {
    const std::vector<double> other = sphere.where("as", as).numbers("vector error");
    ASSERT_EQ(other.size(), triangles.size());
    for (std::size_t k = 0; k < other.size(); ++k) {
      EXPECT_LT(other[k], 1.5 * triangles[k]) << as;
      EXPECT_GT(other[k], triangles[k] / 1.5) << as;
    }
  }
}

TEST(LocalMapsExperiment, WiderMarginsAreNearer) {
  const Table& table = toy("margins");
  for (const char* variant : {"adaptive", "localized"}) {
    const Table rows = table.where("variant", variant).where("R / h", "4");
    EXPECT_LT(rows.where("margin", "4").mean("difference / R"),
              1e-2 * rows.where("margin", "0").mean("difference / R"));
  }
}

TEST(LocalMapsExperiment, PolarMapsAreNearestToExactOnes) {
  const Table& table = toy("local_maps");
  const auto largest = [&](const char* as, const char* method) {
    return table.where("as", as).where("method", method).largest("vector 95%");
  };
  EXPECT_LT(largest("triangles", "polar"), 1e-9);
  EXPECT_LT(largest("points", "polar"), largest("points", "heat"));
}

TEST(MarchExperiment, MapsEveryVertexByBothStrategies) {
  const Table& table = toy("march");
  for (const char* shape : {"cloud", "mesh"}) {
    const Table rows = table.where("shape", shape);
    EXPECT_EQ(rows.smallest("ok"), rows.largest("vertices"));
  }
}

TEST(DirectExperiment, GivesTheMapsOfTheElimination) { EXPECT_LT(toy("direct").largest("apart"), 1e-12); }

std::vector<std::string> names() {
  std::vector<std::string> result;
  for (const Experiment& e : experiments()) result.emplace_back(e.name);
  return result;
}

INSTANTIATE_TEST_SUITE_P(, AnyExperiment, testing::ValuesIn(names()), [](const auto& info) { return info.param; });

}  // namespace
}  // namespace ahm::bench
