// What a page asks for, read from JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "ahm/applications/coverage.hpp"
#include "ahm/viewer/session.hpp"

namespace ahm::viewer {

/// The point, or for a row that was left out before the graph of a cloud was built the row nearest to it.
SurfacePoint standing_for(const Surface& surface, const SurfacePoint& point);

/// The members of a request's object. All members throw InvalidArgument that names the one that does not fit.
class Request {
 public:
  /// @throws InvalidArgument: no JSON, no object
  explicit Request(std::string_view body);

  std::string client() const;
  std::optional<Index> number() const;  ///< by which the client counts its requests
  SurfacePoint point(const char* name) const;
  std::vector<SurfacePoint> points(const char* name) const;
  /// @param usual  of what is not given
  Settings settings(const Settings& usual) const;
  double positive(const char* name) const;
  double finite(const char* name) const;
  std::string text(const char* name) const;
  /// "cover", "spacing", "pattern"
  CoverageOptions cover() const;
  /// @param allowed  words
  std::string word(const char* name, const std::vector<std::string>& allowed) const;
  /// Whether there is such a member, not null.
  bool has(const char* name) const;

 private:
  const nlohmann::json& at(const char* name) const;

  nlohmann::json json_;
};

}  // namespace ahm::viewer
