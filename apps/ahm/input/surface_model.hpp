/// \file
/// Any surface of the library as a model of the program.
#pragma once

#include "ahm/surface/surface.hpp"
#include "input/backend.hpp"

namespace ahm::app {

class SurfaceModel : public Model {
 public:
  explicit SurfaceModel(std::unique_ptr<const ahm::Surface> surface) : surface_(std::move(surface)) {}

  const TangentGraph& graph() const override { return surface_->graph(); }
  const Surface& surface() const override { return *surface_; }
  ResolvedSource source(const SourceSpec& spec, const std::optional<Vec3>& u_axis) const override;
  std::vector<RowVertex> row_vertices() const override;
  std::vector<Index> corner_vertices() const override;
  std::vector<Vec3> normals() const override { return surface_->normals(); }
  nlohmann::ordered_json report() const override;
  std::vector<std::string> warnings() const override;

 private:
  std::unique_ptr<const ahm::Surface> surface_;
};

}  // namespace ahm::app
