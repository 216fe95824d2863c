// Requests as command lines that give the same.
#pragma once

#include <filesystem>
#include <functional>
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

/// ahm NAME INPUT ARGUMENTS SETTINGS INPUT-OPTIONS
std::string command(const SessionOptions& session, const std::string& name, const std::vector<std::string>& arguments,
                    const Settings& settings);

/// What is looked at, what can be asked for, and what is asked for unless a request says otherwise.
nlohmann::json session_info(const Surface& surface, const io::Geometry& geometry, const SessionOptions& options);

/// The bytes that `write` puts into a file with this ending. @throws IoError, what `write` throws
std::string exported(const std::string& format, const std::function<void(const std::filesystem::path&)>& write);

/// A PNG or JPEG file in base64. @throws InvalidArgument: no such text, no such image
Image image_of(const std::string& base64);

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
