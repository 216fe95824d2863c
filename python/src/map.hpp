/// \file
/// Solvers, what else makes maps, and log maps, as Python holds them.
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

struct Solver {
  BodyPtr body;
  LogMapSolver solver;
};
using SolverPtr = std::shared_ptr<Solver>;

struct PolarSolver {
  BodyPtr body;
  PolarMapSolver solver;
  unsigned threads;
};
using PolarSolverPtr = std::shared_ptr<PolarSolver>;

/// What makes maps for an application: a solver, or the exact geodesics of a body.
class Maker {
 public:
  /// @param given  a Solver, a PolarSolver, or a Body and the tolerance of its exact maps
  explicit Maker(const py::object& given);

  const BodyPtr& body() const { return solver_ ? solver_->body : polar_ ? polar_->body : body_; }
  /// Null where maps are polar or exact.
  const Solver* solver() const { return solver_.get(); }
  /// Null where maps are by heat or exact.
  const PolarSolver* polar() const { return polar_.get(); }
  /// @throws as `Body::geodesics`
  AnySolver maps() const {
    if (solver_) return {solver_->solver};
    if (polar_) return {polar_->solver, polar_->threads};
    return {body_->geodesics(), exact()};
  }
  /// Of exact maps: the tolerance.
  ExactMapOptions exact() const { return {.tolerance = tolerance_, .progress = {}}; }

 private:
  SolverPtr solver_;
  PolarSolverPtr polar_;
  BodyPtr body_;
  double tolerance_ = 0;
};

/// A map, and what it is on the rows.
struct Map {
  /// @param given  the map by rows; none: as the surface has it
  Map(BodyPtr on, SurfaceSource from, LogMap made, unsigned threads, std::optional<RowLogMap> given = {});

  BodyPtr body;
  SurfaceSource source;
  LogMap map;
  unsigned threads;        ///< of whatever is computed from it; 0: one per core
  RowLogMap rows;          ///< empty of grids and graphs, whose rows are their vertices
  std::vector<double> uv;  ///< rows x 2; empty of grids and graphs

  const Surface& surface() const { return body->surface_for("this"); }
};
using MapPtr = std::shared_ptr<Map>;

/// A curve through these points; errors name them.
/// @param positions  empty, or (u, v) of every point
SurfaceCurve draw_stroke(const Body& body, const Places& points, std::span<const Vec2> positions,
                         const StrokeOptions& shape);

}  // namespace ahm::python
