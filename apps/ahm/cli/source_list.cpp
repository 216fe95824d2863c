#include "cli/source_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <numeric>
#include <sstream>
#include <stdexcept>

#include "ahm/error.hpp"
#include "ahm/util/from_chars.hpp"

namespace ahm::app {
namespace {

[[noreturn]] void refuse(std::string_view text, std::string_view expected) {
  throw std::invalid_argument(fmt::format("'{}' is not {}", text, expected));
}

std::string_view without_plus(std::string_view text) {
  return text.size() > 1 && text[0] == '+' && text[1] != '-' ? text.substr(1) : text;
}

}  // namespace

double parse_number(std::string_view text) {
  const std::string_view digits = without_plus(text);
  double value = 0;
  const auto [end, error] = detail::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range) refuse(text, "a number that fits double precision");
  if (error != std::errc{} || end != digits.data() + digits.size()) refuse(text, "a number");
  if (!std::isfinite(value)) refuse(text, "a finite number");
  return value;
}

double parse_positive(std::string_view text) {
  const double value = parse_number(text);
  if (!(value > 0)) refuse(text, "a number > 0");
  return value;
}

double parse_degrees(std::string_view text) { return parse_number(text) * std::numbers::pi / 180; }

std::int64_t parse_integer(std::string_view text, std::int64_t low, std::int64_t high) {
  const std::string_view digits = without_plus(text);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool whole = end == digits.data() + digits.size();
  if (error == std::errc::invalid_argument || !whole) refuse(text, "a whole number");
  if (error != std::errc{} || value < low || value > high)
    refuse(text, high == std::numeric_limits<Index>::max() ? fmt::format("a whole number >= {}", low)
                                                           : fmt::format("a whole number from {} to {}", low, high));
  return value;
}

std::vector<double> parse_numbers(std::string_view text) {
  std::vector<double> result;
  for (std::string_view rest = text;;) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    result.push_back(parse_number(rest.substr(0, comma)));
    if (comma == rest.size()) return result;
    rest.remove_prefix(comma + 1);
  }
}

Vec3 parse_triple(std::string_view text) {
  if (std::count(text.begin(), text.end(), ',') != 2) refuse(text, "three numbers separated by commas");
  const std::vector<double> numbers = parse_numbers(text);
  return {numbers[0], numbers[1], numbers[2]};
}

Vec3 parse_direction(std::string_view text) {
  const Vec3 v = parse_triple(text);
  if (v == Vec3{0, 0, 0}) refuse(text, "a direction, because it is zero");
  return v;
}

Direction parse_vector_or_angle(std::string_view text) {
  if (text.find(',') == std::string_view::npos) return parse_degrees(text);
  return parse_direction(text);
}

namespace {

SourceFace parse_face(std::string_view text) {
  const std::string_view rest = text.substr(5);
  const std::size_t colon = rest.find(':');
  if (colon == std::string_view::npos)
    throw std::invalid_argument(fmt::format("'{}' has no barycentric coordinates; write face:F:b0,b1,b2", text));
  SourceFace result{static_cast<Index>(parse_integer(rest.substr(0, colon), 0)), parse_numbers(rest.substr(colon + 1))};
  const auto& weights = result.weights;
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  if (weights.size() < 3)
    throw std::invalid_argument(fmt::format(
        "'{}': expected one barycentric coordinate per corner of the face, found {}", text, weights.size()));
  if (*std::min_element(weights.begin(), weights.end()) < 0 || std::abs(sum - 1) > 1e-6)
    throw std::invalid_argument(
        fmt::format("'{}': barycentric coordinates must be >= 0 and have the sum 1; their sum is {}", text, sum));
  return result;
}

}  // namespace

SourceSpec parse_source(std::string_view text) {
  if (text.starts_with("face:")) return parse_face(text);
  if (text.find(',') != std::string_view::npos) return SourcePosition{parse_triple(text)};
  try {
    return SourceVertex{static_cast<Index>(parse_integer(text, 0))};
  } catch (const std::invalid_argument&) {
    throw std::invalid_argument(
        fmt::format("'{}' is not a source; write a vertex index (from 0), x,y,z or face:F:b0,b1,b2", text));
  }
}

std::string to_string(const SourceSpec& spec) {
  struct Visitor {
    std::string operator()(const SourceVertex& s) const { return fmt::format("{}", s.index); }
    std::string operator()(const SourcePosition& s) const {
      return fmt::format("{},{},{}", s.position[0], s.position[1], s.position[2]);
    }
    std::string operator()(const SourceFace& s) const {
      return fmt::format("face:{}:{}", s.face, fmt::join(s.weights, ","));
    }
  };
  return std::visit(Visitor{}, spec);
}

namespace {

constexpr const char* blanks = " \t\r";

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

/// Whether a text contains letters that numbers do not have.
bool looks_like_a_name(const std::string& text) {
  return !text.starts_with("face:") &&
         std::ranges::any_of(text, [](unsigned char c) { return std::isalpha(c) != 0 && c != 'e' && c != 'E'; });
}

/// Calls `parse` for every entry: the words of the text, or the lines of the file with this name.
void for_each_entry(const std::string& text, const std::function<void(const std::string&)>& parse) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(text, ignored)) return for_each_line(text, text, "entries", parse);
  const std::vector<std::string> words = words_of(text);
  if (words.empty()) throw std::invalid_argument("the list is empty");
  try {
    for (const std::string& word : words) parse(word);
  } catch (const std::invalid_argument& e) {
    if (words.size() > 1 || !looks_like_a_name(text)) throw;
    throw std::invalid_argument(fmt::format("there is no file '{}', and {}", text, e.what()));
  }
}

std::vector<std::string>& lists() {
  static std::vector<std::string> paths;
  return paths;
}

SourceSpec parse_entry(const std::string& text) {
  const std::vector<std::string> words = words_of(text);
  return parse_source(words.size() == 3 ? words[0] + "," + words[1] + "," + words[2] : text);
}

}  // namespace

const std::vector<std::string>& lists_read() { return lists(); }

void require_file(const std::string& path, const std::string& what) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored))
    throw std::invalid_argument(fmt::format("there is no file '{}'; write the name of a file with {}", path, what));
}

void for_each_line(const std::string& path, const std::string& name, const std::string& what,
                   const std::function<void(const std::string&)>& parse) {
  std::ifstream file(path);
  if (!file) throw IoError(name + ": the file cannot be read");
  lists().push_back(path);
  std::size_t number = 0, entries = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    const std::size_t first = line.find_first_not_of(blanks);
    if (first == std::string::npos || line[first] == '#') continue;
    try {
      parse(line.substr(first, line.find_last_not_of(blanks) - first + 1));
    } catch (const std::invalid_argument& e) {
      throw InvalidArgument(fmt::format("{}, line {}: {}", name, number, e.what()));
    }
    ++entries;
  }
  if (entries == 0) throw InvalidArgument(name + ": the file contains no " + what);
}

std::vector<SourceSpec> parse_sources(const std::string& text) {
  std::vector<SourceSpec> result;
  for_each_entry(text, [&](const std::string& entry) { result.push_back(parse_entry(entry)); });
  return result;
}

std::vector<double> parse_weights(const std::string& text) {
  std::vector<double> result;
  for_each_entry(text, [&](const std::string& entry) { result.push_back(parse_number(entry)); });
  return result;
}

std::vector<std::array<double, 2>> parse_plane_points(const std::string& text) {
  std::vector<std::array<double, 2>> result;
  for_each_entry(text, [&](const std::string& entry) {
    const std::vector<std::string> words = words_of(entry);
    const std::vector<double> numbers = parse_numbers(words.size() == 2 ? words[0] + "," + words[1] : entry);
    if (numbers.size() != 2) throw std::invalid_argument(fmt::format("'{}' is not of the form u,v", entry));
    result.push_back({numbers[0], numbers[1]});
  });
  return result;
}

Vec3 position_in(const io::Geometry& input, const SourceSpec& spec, const std::string& option) {
  const auto within = [&](Index index, std::size_t count, const char* what) {
    if (static_cast<std::size_t>(index) < count) return static_cast<std::size_t>(index);
    throw InvalidArgument(
        fmt::format("{} {}: out of range; the input has {} {}, counted from 0", option, to_string(spec), count, what));
  };
  if (const auto* position = std::get_if<SourcePosition>(&spec)) return position->position;
  if (const auto* vertex = std::get_if<SourceVertex>(&spec)) {
    const Vec3& point =
        input.points[within(vertex->index, input.points.size(), input.face_count() > 0 ? "vertices" : "points")];
    for (double x : point)
      if (!std::isfinite(x))
        throw InvalidArgument(fmt::format("{} {}: a coordinate of this point is {}", option, vertex->index, x));
    return point;
  }
  const auto& [face, weights] = std::get<SourceFace>(spec);
  const auto corners = input.face(within(face, input.face_count(), "faces"));
  if (weights.size() != corners.size())
    throw InvalidArgument(fmt::format("{} {}: this face has {} corners and requires as many barycentric coordinates",
                                      option, to_string(spec), corners.size()));
  Vec3 result{};
  for (std::size_t c = 0; c < corners.size(); ++c)
    for (std::size_t a = 0; a < 3; ++a) result[a] += weights[c] * input.points[corners[c]][a];
  return result;
}

}  // namespace ahm::app
