#include "read/column_names.hpp"

#include <algorithm>
#include <optional>
#include <string>

#include "read/text.hpp"

namespace ahm::io {
namespace {

using Words = std::vector<std::string_view>;
using Names = std::array<std::string_view, 3>;

constexpr Names position = {"x", "y", "z"};
constexpr std::pair<ColumnRole, Names> others[] = {
    {ColumnRole::normals, {"nx", "ny", "nz"}},
    {ColumnRole::colors, {"red", "green", "blue"}},
    {ColumnRole::colors, {"r", "g", "b"}},
    {ColumnRole::colors, {"rf", "gf", "bf"}},
};

auto has_name(std::string_view name) {
  return [name](std::string_view word) { return equals_ignoring_case(word, name); };
}

std::optional<std::array<std::size_t, 3>> find(const Input& in, std::int64_t line, const Words& words,
                                               const Names& names) {
  std::array<std::size_t, 3> columns{};
  bool complete = true;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto at = std::ranges::find_if(words, has_name(names[k]));
    if (std::ranges::count_if(words, has_name(names[k])) > 1)
      fail_at_line(in, line, "two columns are named '" + std::string(names[k]) + "'");
    complete = complete && at != words.end();
    columns[k] = static_cast<std::size_t>(at - words.begin());
  }
  return complete ? std::optional(columns) : std::nullopt;
}

}  // namespace

bool names_position(const Words& words) {
  return std::ranges::all_of(position, [&](auto name) { return std::ranges::any_of(words, has_name(name)); });
}

ColumnNames find_columns(const Input& in, std::int64_t line, const Words& words) {
  for (const std::string_view name : position)
    if (std::ranges::none_of(words, has_name(name)))
      fail_at_line(in, line, "no column is named '" + std::string(name) + "'");
  ColumnNames result{*find(in, line, words, position), {}};
  for (const auto& [role, names] : others) {
    const auto same = [role = role](const auto& triple) { return triple.first == role; };
    if (std::ranges::any_of(result.triples, same)) continue;
    if (const auto columns = find(in, line, words, names)) result.triples.emplace_back(role, *columns);
  }
  return result;
}

}  // namespace ahm::io
