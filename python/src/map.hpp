/// \file
/// The solvers and log maps that Python objects refer to.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "ahm/applications/any_solver.hpp"
#include "ahm/applications/stroke.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/surface/polar_map_solver.hpp"
#include "ahm/surface/row_log_map.hpp"
#include "body.hpp"

namespace ahm::python {

/// A solver by the heat method, and its surface.
struct Solver {
  BodyPtr body;
  LogMapSolver solver;
};
using SolverPtr = std::shared_ptr<Solver>;

/// A solver for polar maps, and its surface.
struct PolarSolver {
  BodyPtr body;
  PolarMapSolver solver;
  unsigned threads;
};
using PolarSolverPtr = std::shared_ptr<PolarSolver>;

/// Computes maps for applications: by a solver, or by the exact geodesics of a body.
class Maker {
 public:
  /// @param given  a Solver, a PolarSolver, or a Body for exact maps
  explicit Maker(const py::object& given);

  const BodyPtr& body() const { return solver_ ? solver_->body : polar_ ? polar_->body : body_; }
  /// Null if maps are polar or exact.
  const Solver* solver() const { return solver_.get(); }
  /// Null if maps are by heat or exact.
  const PolarSolver* polar() const { return polar_.get(); }
  /// @throws as `Body::geodesics`
  AnySolver maps() const {
    if (solver_) return {solver_->solver};
    if (polar_) return {polar_->solver, polar_->threads};
    return body_->geodesics();
  }

 private:
  SolverPtr solver_;
  PolarSolverPtr polar_;
  BodyPtr body_;
};

/// A log map by vertices and by rows.
struct Map {
  /// @param given  the map by rows; none: computed by `Surface::to_rows`
  Map(BodyPtr on, SurfaceSource from, LogMap made, unsigned threads, std::optional<RowLogMap> given = {});

  BodyPtr body;
  SurfaceSource source;
  LogMap map;
  unsigned threads;        ///< threads for computations on the map; 0: one per core
  RowLogMap rows;          ///< empty for grids and graphs, whose rows are their vertices
  std::vector<double> uv;  ///< (u, v) of each row; empty for grids and graphs

  const Surface& surface() const { return body->surface_for("this operation"); }
};
using MapPtr = std::shared_ptr<Map>;

/// Draws a curve through points on the surface. Errors name the point.
/// @param positions  empty, or (u, v) of every point
SurfaceCurve draw_stroke(const Body& body, const Places& points, std::span<const Vec2> positions,
                         const StrokeOptions& shape);

}  // namespace ahm::python
