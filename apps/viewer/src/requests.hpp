// Parsing of requests, and command lines that reproduce their results.
#pragma once

#include <nlohmann/json.hpp>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ahm/applications/coverage.hpp"
#include "ahm/image.hpp"
#include "ahm/viewer/session.hpp"

namespace ahm::viewer {

/// The shortest decimals that read back to the same number.
std::string number(double x);

/// The command line: ahm NAME INPUT ARGUMENTS SETTINGS INPUT-OPTIONS
std::string command(const SessionOptions& session, const std::string& name, const std::vector<std::string>& arguments,
                    const Settings& settings);

/// The answer to "info": a description of the surface, the supported choices, and the initial settings.
nlohmann::json session_info(const Surface& surface, const io::Geometry& geometry, const SessionOptions& options);

/// Decodes a PNG or JPEG file in base64. @throws InvalidArgument (invalid base64, invalid image)
Image image_of(const std::string& base64);

/// The point; for a row that was removed before the graph of a cloud was built, the nearest row with a vertex.
SurfacePoint standing_for(const Surface& surface, const SurfacePoint& point);

/// The JSON object of a request. All functions throw InvalidArgument with the name of the invalid member.
class Request {
 public:
  /// @throws InvalidArgument (not JSON, not an object)
  explicit Request(std::string_view body);

  std::string client() const;
  std::optional<Index> number() const;  ///< number of the request, if the client numbers them
  SurfacePoint point(const char* name) const;
  std::vector<SurfacePoint> points(const char* name) const;
  /// @param usual  default values
  Settings settings(const Settings& usual) const;
  double positive(const char* name) const;
  double finite(const char* name) const;
  std::string text(const char* name) const;
  /// The options in "coverage_radius", "spacing" and "pattern".
  CoverageOptions coverage() const;
  /// A string member. @param allowed  allowed values
  std::string word(const char* name, const std::vector<std::string>& allowed) const;
  /// Whether the member exists and is not null.
  bool has(const char* name) const;

 private:
  const nlohmann::json& at(const char* name) const;

  nlohmann::json json_;
};

}  // namespace ahm::viewer
