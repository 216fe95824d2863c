/// \file
/// Shared by the readers of VTK's two file formats of polygonal data.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ahm/io/geometry.hpp"
#include "read/input.hpp"

namespace ahm::io {

/// A number type in binary data.
struct VtkType {
  std::size_t size = 0;
  bool whole = false;
  /// Loads the number at a position. Does not check the bounds of `bytes`.
  double (*load)(std::string_view bytes, std::size_t position, bool big_endian) = nullptr;
};

/// The type with a name of VTK XML ("Float32") or of a legacy file ("float"), in any case; nullopt if the name is unknown.
std::optional<VtkType> find_vtk_type(std::string_view name);

/// The word as a number of a type; nullopt if it is not a number, or is a fraction and the type is an integer type.
std::optional<double> to_vtk_number(std::string_view word, const VtkType& type);

/// A hint about decimal commas, for a message about a word that is not a number; empty if it does not apply.
std::string hint_at_comma(std::string_view word);

/// The next word, across lines; empty at the end.
std::string_view next_vtk_word(std::string_view& rest) noexcept;

/// An array of tuples of `width` numbers.
struct VtkArray {
  std::string name;
  std::size_t width = 1;  ///< 0: the type of the array is not supported
  bool whole = false;     ///< the type is an integer type
  std::vector<double> values;
};

/// Loads all numbers of binary data.
std::vector<double> load_vtk_numbers(std::string_view bytes, const VtkType& type, bool big_endian);

/// Cells, each a list of corners: cell c is corners[begin[c], begin[c + 1]).
struct VtkCells {
  std::vector<double> begin = {0};
  std::vector<double> corners;
};

/// One piece of a surface.
struct VtkPiece {
  std::uint64_t points = 0;
  std::vector<double> positions;  ///< 3 per point
  std::vector<VtkArray> arrays;   ///< arrays with a value per point
  std::string normals;            ///< name of the array of normals; empty: Normals
  std::uint64_t lines = 0;
  VtkCells polygons, strips;
  bool has_cell_data = false;
};

/// Concatenates the points and faces of all pieces. Strips become triangles.
/// - Arrays that every piece has become normals, colors (red, green and blue, if the name contains color or rgb) or properties.
/// - The properties of a vector have its name and the suffixes x, y, z; those of other tuples have the suffixes _0, _1 and so on.
/// - Arrays of unequal shapes, and integers that doubles cannot represent, are ignored with a warning.
/// @throws IoError if a corner refers to a point that does not exist, or there are no points
Geometry join_vtk_pieces(const Input& in, std::vector<VtkPiece> pieces);

}  // namespace ahm::io
