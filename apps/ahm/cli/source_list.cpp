#include "cli/source_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "ahm/error.hpp"
#include "cli/numbers.hpp"

namespace ahm::app {
namespace {

constexpr const char* blanks = " \t\r";

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

/// Holds letters as no number does.
bool looks_like_a_name(const std::string& text) {
  return !text.starts_with("face:") &&
         std::ranges::any_of(text, [](unsigned char c) { return std::isalpha(c) != 0 && c != 'e' && c != 'E'; });
}

/// Hands every entry to `parse`: words of the text, or lines of the file it names.
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
    throw std::invalid_argument(fmt::format("there is no file '{}'; write the name of one with {}", path, what));
}

void for_each_line(const std::string& path, const std::string& name, const std::string& what,
                   const std::function<void(const std::string&)>& parse) {
  std::ifstream file(path);
  if (!file) throw IoError(name + ": cannot be read");
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
  if (entries == 0) throw InvalidArgument(name + ": holds no " + what);
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
        fmt::format("{} {}: the input has {} {}, numbered from 0", option, to_string(spec), count, what));
  };
  if (const auto* position = std::get_if<SourcePosition>(&spec)) return position->position;
  if (const auto* vertex = std::get_if<SourceVertex>(&spec)) {
    const Vec3& point =
        input.points[within(vertex->index, input.points.size(), input.face_count() > 0 ? "vertices" : "points")];
    for (double x : point)
      if (!std::isfinite(x))
        throw InvalidArgument(fmt::format("{} {}: this point has a coordinate that is {}", option, vertex->index, x));
    return point;
  }
  const auto& [face, weights] = std::get<SourceFace>(spec);
  const auto corners = input.face(within(face, input.face_count(), "faces"));
  if (weights.size() != corners.size())
    throw InvalidArgument(fmt::format("{} {}: this face has {} corners, give as many coordinates", option,
                                      to_string(spec), corners.size()));
  Vec3 result{};
  for (std::size_t c = 0; c < corners.size(); ++c)
    for (std::size_t a = 0; a < 3; ++a) result[a] += weights[c] * input.points[corners[c]][a];
  return result;
}

}  // namespace ahm::app
