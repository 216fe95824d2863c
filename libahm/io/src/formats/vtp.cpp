// VTK's XML PolyData is not written with VTK, which is large and not part of most builds. The file is a header of fixed layout,
// followed by the arrays as in memory (VTK file formats, "appended", "raw").
#include <string>
#include <string_view>

#include "formats/format.hpp"
#include "little_endian.hpp"
#ifdef AHM_WITH_PUGIXML
#include "read/vtp_reader.hpp"
#endif

namespace ahm::io {
namespace {

const char* type_of(const Column& column) {
  if (std::holds_alternative<std::span<const double>>(column.values)) return "Float64";
  return std::holds_alternative<std::span<const Index>>(column.values) ? "Int32" : "UInt8";
}

std::size_t bytes_of(const Column& column) {
  const std::string_view type = type_of(column);
  return column.rows() * column.names.size() * (type == "Float64" ? 8 : type == "Int32" ? 4 : 1);
}

/// The name of the array: for a vector, the name of its first component without the x; for normals and colors, VTK's names.
std::string name_of(const Column& column) {
  const std::string& first = column.names.front();
  if (column.names.size() == 1) return first;
  if (first == "nx") return "Normals";
  if (first == "red") return "colors";
  return first.ends_with('x') && first.size() > 1 ? first.substr(0, first.size() - 1) : first;
}

bool is_position(const Column& column) { return column.names == std::vector<std::string>{"x", "y", "z"}; }

/// The XML header. Computes the offset of every array in the appended data.
class Header {
 public:
  void add(const std::string& type, const std::string& name, std::size_t components, std::size_t bytes) {
    text_ += "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
             std::to_string(components) + "\" format=\"appended\" offset=\"" + std::to_string(offset_) + "\"/>\n";
    offset_ += sizeof(std::uint64_t) + bytes;
  }
  void add(const Column& column) { add(type_of(column), name_of(column), column.names.size(), bytes_of(column)); }
  void add_cells(const std::string& kind, std::size_t cells, std::size_t corners) {
    text_ += "<" + kind + ">\n";
    add("Int32", "connectivity", 1, 4 * corners);
    add("Int64", "offsets", 1, 8 * cells);
    text_ += "</" + kind + ">\n";
  }
  Header& operator+=(const std::string& more) {
    text_ += more;
    return *this;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
  std::uint64_t offset_ = 0;
};

/// Writes one array of the appended data: its length in bytes, then the bytes.
class Block {
 public:
  Block(AtomicFile& file, std::size_t bytes) : file_(file) { append(bytes_, static_cast<std::uint64_t>(bytes)); }
  template <class T>
  void add(T value) {
    append(bytes_, value);
    if (bytes_.size() >= std::size_t{1} << 20) flush();
  }
  void flush() {
    file_.write(bytes_);
    bytes_.clear();
  }

 private:
  AtomicFile& file_;
  std::string bytes_;
};

void write_column(AtomicFile& file, const Column& column) {
  Block block(file, bytes_of(column));
  for (std::size_t row = 0; row < column.rows(); ++row) visit_row(column, row, [&](auto value) { block.add(value); });
  block.flush();
}

/// Writes cells with the corners `corner(k)`. The corners of a cell end before k = `end(cell)`.
template <class Corner, class End>
void write_cells(AtomicFile& file, std::size_t cells, std::size_t corners, const Corner& corner, const End& end) {
  Block connectivity(file, 4 * corners);
  for (std::size_t k = 0; k < corners; ++k) connectivity.add(static_cast<std::int32_t>(corner(k)));
  connectivity.flush();
  Block offsets(file, 8 * cells);
  for (std::size_t c = 0; c < cells; ++c) offsets.add(static_cast<std::int64_t>(end(c)));
  offsets.flush();
}

/// Number of points that are cells: all points if there are no faces and no edges, else none.
std::size_t single_points(const Table& table) {
  return table.faces.size() > 0 || !table.edges.empty() ? 0 : table.rows();
}

std::string header_of(const Table& table, const Column& points) {
  Header header;
  header += "<?xml version=\"1.0\"?>\n";
  for (const Column& column : table.columns)
    if (const auto* words = std::get_if<CodedWords>(&column.values)) {
      header += "<!-- " + column.names.front() + ":";
      for (std::size_t code = 0; code < words->words.size(); ++code)
        header += (code > 0 ? ", " : " ") + std::to_string(code) + " " + words->words[code];
      header += " -->\n";
    }
  const auto count = [](std::size_t number) { return "\"" + std::to_string(number) + "\""; };
  header +=
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\n";
  header += "<Piece NumberOfPoints=" + count(table.rows()) + " NumberOfVerts=" + count(single_points(table)) +
            " NumberOfLines=" + count(table.edges.size()) +
            " NumberOfStrips=\"0\" NumberOfPolys=" + count(table.faces.size()) + ">\n<Points>\n";
  header.add("Float64", "Points", 3, bytes_of(points));
  header += "</Points>\n<PointData>\n";
  for (const Column& column : table.columns)
    if (!is_position(column)) header.add(column);
  header += "</PointData>\n";
  header.add_cells("Verts", single_points(table), single_points(table));
  header.add_cells("Lines", table.edges.size(), 2 * table.edges.size());
  header.add_cells("Polys", table.faces.size(), table.faces.vertices.size());
  header += "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";
  return header.text();
}

void write(AtomicFile& file, const Table& table) {
  const auto points = std::ranges::find_if(table.columns, is_position);
  if (points == table.columns.end() || !std::holds_alternative<std::span<const double>>(points->values))
    throw InvalidArgument("a .vtp file needs the columns x, y, z; write .csv");
  file.write(header_of(table, *points));
  write_column(file, *points);
  for (const Column& column : table.columns)
    if (!is_position(column)) write_column(file, column);
  const std::size_t singles = single_points(table), edges = table.edges.size();
  write_cells(
      file, singles, singles, [](std::size_t k) { return k; }, [](std::size_t c) { return c + 1; });
  write_cells(
      file, edges, 2 * edges, [&](std::size_t k) { return table.edges[k / 2][k % 2]; },
      [](std::size_t c) { return 2 * (c + 1); });
  write_cells(
      file, table.faces.size(), table.faces.vertices.size(), [&](std::size_t k) { return table.faces.vertices[k]; },
      [&](std::size_t c) { return table.faces.begin[c + 1]; });
  file.write("\n</AppendedData>\n</VTKFile>\n");
}

}  // namespace

Format vtp_format() {
  Format format{.extensions = {".vtp"}, .signatures = {"<?xml", "<VTKFile"}, .write = write};
#ifdef AHM_WITH_PUGIXML
  format.read = read_vtp;
#endif
  return format;
}

}  // namespace ahm::io
