/// \file
/// A solver and a log map, as Python holds them.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "ahm/maps/log_map_solver.hpp"
#include "ahm/surface/row_log_map.hpp"
#include "body.hpp"

namespace ahm::python {

struct Solver {
  BodyPtr body;
  LogMapSolver solver;
};
using SolverPtr = std::shared_ptr<Solver>;

/// A map, and what it is on the rows.
struct Map {
  Map(BodyPtr on, PlacedSource from, LogMap made);

  BodyPtr body;
  PlacedSource source;
  LogMap map;
  RowLogMap rows;          ///< empty of grids and graphs, whose rows are their vertices
  std::vector<double> uv;  ///< rows x 2; empty of grids and graphs

  const Surface& surface() const { return body->surface_for("this"); }
};
using MapPtr = std::shared_ptr<Map>;

}  // namespace ahm::python
