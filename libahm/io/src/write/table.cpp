#include "ahm/io/table.hpp"

#include <algorithm>
#include <cctype>
#include <limits>

#include "ahm/error.hpp"
#include "ahm/util/text.hpp"
#include "write/writers.hpp"

namespace ahm::io {
namespace {

[[noreturn]] void fail(const std::string& what) { throw InvalidArgument("table: " + what); }

template <class T, class Values>
std::span<const T> flat(Values values) {
  return {values.empty() ? nullptr : values.front().data(), 3 * values.size()};
}

void check_name(const std::string& name) {
  const auto plain = [](unsigned char c) { return c < 128 && (std::isalnum(c) != 0 || c == '_'); };
  if (name.empty() || !std::ranges::all_of(name, plain))
    fail("a column cannot have the name '" + name + "'; use letters, digits and _");
}

void check_row(const std::string& what, Index row, std::size_t rows) {
  if (row >= 0 && static_cast<std::size_t>(row) < rows) return;
  fail(what + " is " + std::to_string(row) + ", but there are " + detail::counted(rows, "row"));
}

void check_faces(const FaceList& faces, std::size_t rows) {
  const auto corners = static_cast<Offset>(faces.vertices.size());
  const bool bounds = faces.begin.empty() ? corners == 0 : faces.begin.front() == 0 && faces.begin.back() == corners;
  if (!bounds || !std::ranges::is_sorted(faces.begin))
    fail("faces.begin must rise from 0 to the length of faces.vertices, " + std::to_string(corners));
  for (std::size_t k = 0; k < faces.vertices.size(); ++k)
    check_row("faces.vertices[" + std::to_string(k) + "]", faces.vertices[k], rows);
}

}  // namespace

std::size_t Column::rows() const {
  const std::size_t values_in_all = std::visit(
      [](const auto& v) {
        if constexpr (requires { v.codes; })
          return v.codes.size();
        else
          return v.size();
      },
      values);
  return names.empty() ? 0 : values_in_all / names.size();
}

void Table::add(std::string name, std::span<const Status> values) {
  CodedWords words{{reinterpret_cast<const std::uint8_t*>(values.data()), values.size()}, {}};
  for (Status status : {Status::ok, Status::disconnected, Status::beyond_radius, Status::unreached, Status::removed})
    words.words.emplace_back(to_string(status));
  columns.push_back({{std::move(name)}, std::move(words)});
}

Column& Table::add(std::array<std::string, 3> names, std::span<const Vec3> values) {
  return columns.emplace_back(Column{{names.begin(), names.end()}, flat<double>(values)});
}

Column& Table::add(std::array<std::string, 3> names, std::span<const std::array<std::uint8_t, 3>> values) {
  return columns.emplace_back(Column{{names.begin(), names.end()}, flat<std::uint8_t>(values)});
}

void check(const Table& table) {
  const std::size_t rows = table.rows();
  if (rows > static_cast<std::size_t>(std::numeric_limits<Index>::max())) fail("more than 2147483647 rows");
  if (table.title.find('\n') != std::string::npos) fail("the title must be one line");
  for (const Column& column : table.columns) {
    for (const std::string& name : column.names) check_name(name);
    if (column.rows() != rows)
      fail(column.names.front() + " has " + detail::counted(column.rows(), "row") + ", but " +
           table.columns.front().names.front() + " has " + std::to_string(rows));
    if (const auto* words = std::get_if<CodedWords>(&column.values); words != nullptr && rows > 0)
      check_row(column.names.front(), *std::ranges::max_element(words->codes), words->words.size());
  }
  if (const auto& seen = table.acquisition) {
    if (seen->height != 0 ? seen->width != rows / seen->height || rows % seen->height != 0 : rows != 0)
      fail("acquisition.width times acquisition.height is not the number of rows, " + std::to_string(rows));
  }
  check_faces(table.faces, rows);
  for (const auto& edge : table.edges)
    for (Index row : edge) check_row("an end of an edge", row, rows);
}

}  // namespace ahm::io
