/// \file
/// What the two file formats of VTK's polygonal data have in common.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ahm/io/geometry.hpp"
#include "read/input.hpp"

namespace ahm::io {

/// A type of numbers in binary data.
struct VtkType {
  std::size_t size = 0;
  bool whole = false;
  /// The number at a position, whose bytes are there.
  double (*load)(std::string_view bytes, std::size_t position, bool big_endian) = nullptr;
};

/// The type of a name of VTK XML ("Float32") or of a legacy file ("float"), in any case.
std::optional<VtkType> find_vtk_type(std::string_view name);

/// A word as a number of a type; nullopt when it is none, or a fraction where whole numbers stand.
std::optional<double> to_vtk_number(std::string_view word, const VtkType& type);

/// What to add to a message about a word that is no number.
std::string hint_at_comma(std::string_view word);

/// The next word, across lines; empty at the end.
std::string_view next_vtk_word(std::string_view& rest) noexcept;

/// `width` numbers for each of any number of things.
struct VtkArray {
  std::string name;
  std::size_t width = 1;  ///< 0: of a type that is not read
  bool whole = false;     ///< of a type of whole numbers
  std::vector<double> values;
};

/// `count` numbers of binary data. The caller has checked that they are there.
std::vector<double> load_vtk_numbers(std::string_view bytes, const VtkType& type, bool big_endian);

/// Cells, each a list of corners: cell c = corners[begin[c], begin[c + 1]).
struct VtkCells {
  std::vector<double> begin = {0};
  std::vector<double> corners;
};

/// One piece of a surface.
struct VtkPiece {
  std::uint64_t points = 0;
  std::vector<double> positions;  ///< 3 per point
  std::vector<VtkArray> arrays;   ///< values by point
  std::string normals;            ///< name of the array of normals; empty: one called Normals
  std::uint64_t lines = 0;
  VtkCells polygons, strips;
  bool has_cell_data = false;
};

/// Points and faces of all pieces, one after the other. Arrays that every piece has become normals, colors (red, green and
/// blue, where the name says so) or properties: a vector's are called by its name and x, y, z, others of several numbers by
/// _0, _1 and so on. Arrays of other shapes, and of whole numbers that no double holds, are ignored with a warning. Strips become triangles.
/// @throws IoError where corners name points that there are not, or nothing is there at all
Geometry join_vtk_pieces(const Input& in, std::vector<VtkPiece> pieces);

}  // namespace ahm::io
