// Reads the XML with pugixml and decodes the arrays itself. VTK's own readers (9.1) return uninitialized memory after an invalid number
// ("1,5"), read 1e400 as the largest double, and do not check corners. They report no error in these cases.
#include "read/vtp_reader.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/util/text.hpp"
#include "read/bytes.hpp"
#include "read/gunzip.hpp"
#include "read/text.hpp"
#include "read/vtk_data.hpp"

namespace ahm::io {

/// Encoding of the binary arrays of a file.
struct VtpEncoding {
  bool big_endian = false;
  bool wide_header = false;  ///< lengths have 8 bytes instead of 4
  bool compressed = false;   ///< compressed with zlib, block by block
};

/// Decodes the array at the beginning of `text`; other arrays may follow.
/// @param base64  whether the encoding is base64, else raw
/// @param what    the array's name, for messages
/// @throws IoError if the array does not fit into the text, or is damaged
/// @throws ResourceExhausted if the unpacked array would use more than a third of the free memory
std::string decode_vtp_array(const Input& in, std::string_view text, bool base64, const VtpEncoding& encoding,
                             const std::string& what);

namespace {

/// Reads bytes sequentially, raw or in base64. Padding may occur inside base64 text, at the end of a separately encoded part.
class Bytes {
 public:
  Bytes(const Input& in, std::string_view text, bool base64, const std::string& what)
      : in_(in), text_(text), base64_(base64), what_(what) {}

  /// Maximum number of bytes that can follow.
  std::uint64_t left() const { return base64_ ? spare_.size() + text_.size() / 4 * 3 : text_.size(); }

  std::string take(std::uint64_t count) {
    if (count > left()) fail_short();
    std::string bytes;
    if (!base64_) {
      bytes = text_.substr(0, count);
      text_.remove_prefix(count);
      return bytes;
    }
    bytes = std::move(spare_);
    bytes.reserve(count + 2);
    while (bytes.size() < count) decode_four(bytes);
    spare_ = bytes.substr(count);
    bytes.resize(count);
    return bytes;
  }

  std::uint64_t take_length(const VtpEncoding& encoding) {
    const VtkType type = *find_vtk_type(encoding.wide_header ? "UInt64" : "UInt32");
    const double length = type.load(take(type.size), 0, encoding.big_endian);
    constexpr double most = 9007199254740992;  // 2^53: no file is larger
    if (length > most) fail_short();
    return static_cast<std::uint64_t>(length);
  }

  [[noreturn]] void fail_short() const { fail(in_, what_ + " is cut short, or its length is wrong"); }

 private:
  void decode_four(std::string& bytes) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::uint32_t bits = 0;
    std::size_t count = 0, padding = 0;
    for (; count < 4 && !text_.empty(); text_.remove_prefix(1)) {
      const char c = text_.front();
      if (c == ' ' || (c >= '\t' && c <= '\r')) continue;
      const std::size_t digit = c == '=' && count >= 2 ? 0 : digits.find(c);
      if (digit == std::string_view::npos || (padding > 0 && c != '='))
        fail(in_, what_ + " is not base64: it contains " + in_quotes(std::string_view(&c, 1)));
      padding += c == '=';
      bits = bits << 6 | static_cast<std::uint32_t>(digit);
      ++count;
    }
    if (count < 4) fail_short();
    for (std::size_t k = 0; k + padding < 3; ++k) bytes += static_cast<char>(bits >> (16 - 8 * k));
  }

  const Input& in_;
  std::string_view text_;
  bool base64_;
  const std::string& what_;
  std::string spare_;  ///< decoded bytes that have not been taken
};

/// Unpacks a compressed array. Its format: number of blocks, size of a block, size of the last block (0 if equal), compressed sizes of
/// the blocks, and the blocks.
std::string unpack(const Input& in, Bytes& bytes, const VtpEncoding& encoding, const std::string& what) {
  const std::uint64_t count = bytes.take_length(encoding), size = bytes.take_length(encoding),
                      last = bytes.take_length(encoding);
  if (count == 0) return {};
  constexpr std::uint64_t most_packed = 1032;  // maximum compression ratio of zlib
  const std::uint64_t most = free_memory() / 3;
  if (count > bytes.left() || last > size || (size > 0 && count - 1 > most_packed * bytes.left() / size))
    bytes.fail_short();
  if (size > 0 && count > most / size)
    throw ResourceExhausted("cannot read " + quoted_path(in.path) + ": " + what +
                            " would use more than a third of the free memory");
  const std::uint64_t all = (count - 1) * size + (last == 0 ? size : last);
  if (all > most_packed * bytes.left()) bytes.fail_short();
  std::vector<std::uint64_t> packed(count);
  for (std::uint64_t& length : packed) length = bytes.take_length(encoding);
  std::string result(all, '\0');
  for (std::uint64_t b = 0; b < count; ++b) {
    const std::uint64_t begin = b * size;
    inflate_block(in, bytes.take(packed[b]),
                  std::span(result).subspan(begin, std::min<std::uint64_t>(size, result.size() - begin)), what);
  }
  return result;
}

}  // namespace

std::string decode_vtp_array(const Input& in, std::string_view text, bool base64, const VtpEncoding& encoding,
                             const std::string& what) {
  Bytes bytes(in, text, base64, what);
  if (encoding.compressed) return unpack(in, bytes, encoding, what);
  const std::uint64_t length = bytes.take_length(encoding);
  return bytes.take(length);
}

namespace {

class VtpReader {
 public:
  explicit VtpReader(const Input& in) : in_(in) {}

  Geometry read() {
    parse();
    const pugi::xml_node file = document_.child("VTKFile");
    if (!file) fail(in_, "it has no element VTKFile");
    if (const std::string kind = file.attribute("type").value(); kind != "PolyData")
      fail(in_, "it contains " + in_quotes(kind) + "; only PolyData can be read; save its surface as .vtp or .ply");
    read_encoding(file);
    std::vector<VtkPiece> pieces;
    for (const pugi::xml_node piece : file.child("PolyData").children("Piece")) pieces.push_back(read_piece(piece));
    Geometry g = join_vtk_pieces(in_, std::move(pieces));
    g.format = "VTK XML PolyData";
    return g;
  }

 private:
  /// Parses the file up to the appended data, which is not XML if it is raw.
  void parse() {
    std::string_view text = in_.bytes;
    std::string closed;
    if (const std::size_t tag = text.find("<AppendedData"); tag != std::string_view::npos) {
      const std::size_t end = text.find('>', tag), begin = text.find('_', end);
      if (begin == std::string_view::npos)
        fail_at_byte(in_, tag, "the appended data is missing; is the file cut short?");
      appended_ = text.substr(begin + 1);
      closed = std::string(text.substr(0, end + 1)) + "</AppendedData></VTKFile>";
      text = closed;
    }
    const pugi::xml_parse_result result = document_.load_buffer(text.data(), text.size());
    if (!result)
      fail_at_byte(
          in_, static_cast<std::size_t>(result.offset),
          std::string("this is not valid XML: ") + result.description() + "; the file is damaged or cut short");
  }

  void read_encoding(const pugi::xml_node& file) {
    const std::string order = file.attribute("byte_order").as_string("LittleEndian");
    const std::string header = file.attribute("header_type").as_string("UInt32");
    compressor_ = file.attribute("compressor").value();
    if (order != "LittleEndian" && order != "BigEndian")
      fail(in_, "byte_order " + in_quotes(order) + " is not supported");
    if (header != "UInt32" && header != "UInt64") fail(in_, "header_type " + in_quotes(header) + " is not supported");
    encoding_ = {order == "BigEndian", header == "UInt64", !compressor_.empty()};
    const std::string appended = file.child("AppendedData").attribute("encoding").as_string("base64");
    if (appended != "raw" && appended != "base64")
      fail(in_, "the encoding " + in_quotes(appended) + " of the appended data is not supported");
    appended_base64_ = appended == "base64";
  }

  std::uint64_t whole(const pugi::xml_node& node, const char* attribute, std::uint64_t none) const {
    const pugi::xml_attribute found = node.attribute(attribute);
    if (!found) return none;
    const std::optional<std::int64_t> value = to_whole(found.value());
    if (!value || *value < 0) fail(in_, std::string(attribute) + " is " + in_quotes(found.value()) + ", not a count");
    return static_cast<std::uint64_t>(*value);
  }

  VtkPiece read_piece(const pugi::xml_node& node) const {
    VtkPiece piece;
    piece.points = whole(node, "NumberOfPoints", 0);
    check_vertex_count(in_, piece.points);
    if (piece.points == 0) return piece;
    piece.lines = whole(node, "NumberOfLines", 0);
    piece.has_cell_data = !node.child("CellData").child("DataArray").empty();
    piece.positions =
        read_array(node.child("Points").child("DataArray"), "the array of points", piece.points, 3).values;
    piece.polygons = read_cells(node, "Polys", whole(node, "NumberOfPolys", 0));
    piece.strips = read_cells(node, "Strips", whole(node, "NumberOfStrips", 0));
    const pugi::xml_node data = node.child("PointData");
    piece.normals = data.attribute("Normals").value();
    for (const pugi::xml_node array : data.children()) {
      const std::string name = array.attribute("Name").value(), element = array.name();
      if (element != "DataArray" && element != "Array") continue;
      if (element == "Array" || !find_vtk_type(array.attribute("type").value()))
        piece.arrays.push_back({name, 0, false, {}});
      else
        piece.arrays.push_back(read_array(array, "array " + in_quotes(name), piece.points, 0));
    }
    return piece;
  }

  VtkCells read_cells(const pugi::xml_node& piece, const char* kind, std::uint64_t count) const {
    VtkCells cells;
    if (count == 0) return cells;
    const pugi::xml_node node = piece.child(kind);
    const auto array = [&](const char* name) { return node.find_child_by_attribute("DataArray", "Name", name); };
    const std::string of = std::string(" of ") + kind;
    cells.corners = read_array(array("connectivity"), "the connectivity" + of, {}, 1).values;
    const std::vector<double> ends = read_array(array("offsets"), "the array of offsets" + of, count, 1).values;
    cells.begin.insert(cells.begin.end(), ends.begin(), ends.end());
    return cells;
  }

  /// @param tuples  required number of tuples; nullopt: any number
  /// @param width   required number of components; 0: any number
  VtkArray read_array(const pugi::xml_node& node, const std::string& what, std::optional<std::uint64_t> tuples,
                      std::size_t width) const {
    if (!node) fail(in_, what + " is missing");
    const std::optional<VtkType> type = find_vtk_type(node.attribute("type").value());
    if (!type)
      fail(in_, what + " has the type " + in_quotes(node.attribute("type").value()) + ", which is not supported");
    VtkArray array{node.attribute("Name").value(), whole(node, "NumberOfComponents", 1), type->whole, {}};
    if (width != 0 && array.width != width)
      fail(in_, what + " has the wrong number of components: expected " + std::to_string(width) + ", found " +
                    std::to_string(array.width));
    const std::string format = node.attribute("format").as_string("ascii");
    if (format == "ascii")
      array.values = read_text(node, *type, what);
    else
      array.values = load_vtk_numbers(read_bytes(node, format, *type, what), *type, encoding_.big_endian);
    const std::uint64_t count = array.values.size();
    if (tuples && (array.width == 0 || count % array.width != 0 || count / array.width != *tuples))
      fail(in_, what + " has " + detail::counted(count, "number") + ", not " + std::to_string(array.width) +
                    " for each of " + std::to_string(*tuples));
    return array;
  }

  std::string read_bytes(const pugi::xml_node& node, const std::string& format, const VtkType& type,
                         const std::string& what) const {
    if (encoding_.compressed && compressor_ != "vtkZLibDataCompressor")
      fail(in_, what + " is compressed by " + in_quotes(compressor_) + "; only vtkZLibDataCompressor is supported");
    std::string bytes;
    if (format == "appended") {
      const std::uint64_t offset = whole(node, "offset", appended_.size());
      if (offset >= appended_.size())
        fail(in_, what + " begins at byte " + std::to_string(offset) + " of the appended data, which has " +
                      std::to_string(appended_.size()) + "; the file is cut short");
      bytes = decode_vtp_array(in_, appended_.substr(offset), appended_base64_, encoding_, what);
    } else if (format == "binary") {
      bytes = decode_vtp_array(in_, node.child_value(), true, encoding_, what);
    } else {
      fail(in_, what + " has the format " + in_quotes(format) + "; ascii, binary and appended are supported");
    }
    if (bytes.size() % type.size != 0)
      fail(in_,
           what + " has " + detail::counted(bytes.size(), "byte") + ", not a multiple of " + std::to_string(type.size));
    return bytes;
  }

  std::vector<double> read_text(const pugi::xml_node& node, const VtkType& type, const std::string& what) const {
    std::vector<double> values;
    std::string_view rest = node.child_value();
    for (std::string_view word = next_vtk_word(rest); !word.empty(); word = next_vtk_word(rest)) {
      const std::optional<double> value = to_vtk_number(word, type);
      if (!value)
        fail(in_, what + " contains " + in_quotes(word) + ", which is not a number of its type" + hint_at_comma(word));
      values.push_back(*value);
    }
    return values;
  }

  const Input& in_;
  pugi::xml_document document_;
  std::string_view appended_;
  bool appended_base64_ = true;
  VtpEncoding encoding_;
  std::string compressor_;
};

}  // namespace

Geometry read_vtp(const Input& in) { return VtpReader(in).read(); }

}  // namespace ahm::io
