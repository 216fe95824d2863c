/// \file
/// Parses numbers, sources and lists of the command line. Strict: the whole text must be a finite number in range, with a decimal point
/// in any locale.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "ahm/io/geometry.hpp"
#include "ahm/types.hpp"

namespace ahm::app {

/// Parses a finite number.
/// @throws std::invalid_argument with a message about the text
double parse_number(std::string_view text);

/// Parses a finite number > 0.
/// @throws std::invalid_argument
double parse_positive(std::string_view text);

/// Parses a finite number of degrees. @return radians
/// @throws std::invalid_argument
double parse_degrees(std::string_view text);

/// Parses a whole number in [low, high].
/// @throws std::invalid_argument
std::int64_t parse_integer(std::string_view text, std::int64_t low,
                           std::int64_t high = std::numeric_limits<Index>::max());

/// Parses finite numbers separated by commas, at least one.
/// @throws std::invalid_argument
std::vector<double> parse_numbers(std::string_view text);

/// Parses three finite numbers separated by commas.
/// @throws std::invalid_argument
Vec3 parse_triple(std::string_view text);

/// Parses three finite numbers separated by commas, not all zero.
/// @throws std::invalid_argument
Vec3 parse_direction(std::string_view text);

/// A vector in space, or an angle from the u axis, radians.
using Direction = std::variant<Vec3, double>;

/// Parses a vector X,Y,Z that is not zero, or an angle in degrees.
/// @throws std::invalid_argument
Direction parse_vector_or_angle(std::string_view text);

/// `123`: a vertex of the input.
struct SourceVertex {
  Index index;
};

/// `x,y,z`: the vertex nearest to a position.
struct SourcePosition {
  Vec3 position;
};

/// `face:F:b0,b1,b2...`: a point in a face, in barycentric coordinates.
struct SourceFace {
  Index face;
  std::vector<double> weights;  ///< one per corner, >= 0, with sum 1
};

using SourceSpec = std::variant<SourceVertex, SourcePosition, SourceFace>;

/// Parses one of the three forms.
/// @throws std::invalid_argument with a message about the text
SourceSpec parse_source(std::string_view text);

/// The text that `parse_source` parses to this spec.
std::string to_string(const SourceSpec& spec);

/// Checks that a file exists, for options whose value is always a file.
/// @param what  contents of the file, for the message
/// @throws std::invalid_argument (there is no such file)
void require_file(const std::string& path, const std::string& what);

/// Calls `parse` with every line of a file. Skips empty lines and lines that begin with #.
/// @param name  name of the file, for messages
/// @param what  contents of the file, for messages: "entries"
/// @throws InvalidArgument (`parse` throws std::invalid_argument: names the line; no lines), IoError
void for_each_line(const std::string& path, const std::string& name, const std::string& what,
                   const std::function<void(const std::string&)>& parse);

/// The files that `for_each_line` has read. No output may replace them.
const std::vector<std::string>& lists_read();

/// Parses a list of sources (`parse_source`) separated by blanks, or the file with this name, with one source per line. In a file, a
/// position may also be three numbers separated by blanks; empty lines and lines that begin with # are skipped.
/// @throws std::invalid_argument (a list), InvalidArgument naming file and line, IoError
std::vector<SourceSpec> parse_sources(const std::string& text);

/// Parses numbers separated by blanks, or a file with one number per line. @throws as `parse_sources`
std::vector<double> parse_weights(const std::string& text);

/// Parses points u,v of the map separated by blanks, or a file with one point per line, where a point may also be two numbers separated
/// by blanks. @throws as `parse_sources`
std::vector<std::array<double, 2>> parse_plane_points(const std::string& text);

/// The position of a source in space. Checks that the input has the vertex or face.
/// @param option  name of the option, for messages: "--source"
/// @throws InvalidArgument
Vec3 position_in(const io::Geometry& input, const SourceSpec& spec, const std::string& option);

}  // namespace ahm::app
