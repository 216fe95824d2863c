/// \file
/// Input files in memory, and error messages about them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <istream>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "ahm/io/formats.hpp"

namespace ahm::io {

/// A file in memory. Readers work on this copy, so the file may change, and check counts against its size.
struct Input {
  std::filesystem::path path;
  std::string bytes;
  std::uint64_t beyond = 0;  ///< number of bytes of the file that are not in `bytes`

  /// Size of the file, bytes.
  std::uint64_t size() const { return bytes.size() + beyond; }
};

/// Reads a regular file. Unpacks it if it is compressed with gzip, independently of its name, and converts UTF-16 to UTF-8.
/// @throws IoError with the system's reason, or if the file is empty
Input load(const std::filesystem::path& path);

/// Reads a stream to its end, under the name "-", and unpacks or converts it like a file.
/// @throws IoError, also if the stream is empty
Input load(std::istream& stream);
/// Reads standard input to its end, like a stream. @throws IoError with the system's reason
Input load_standard_input();

/// Whether the bytes are text in UTF-16, of either byte order, after a byte order mark.
bool is_utf16(std::string_view bytes) noexcept;

/// Checks that a file with the extension .gz is compressed with gzip. @throws IoError
void check_gzip_name(const Input& in);

/// Throws IoError "cannot read 'path': what".
[[noreturn]] void fail(const Input& in, const std::string& what);
/// Throws ResourceExhausted "cannot read 'path': what is larger than ... MB".
/// @param most  limit, bytes: `room_for_input`
[[noreturn]] void fail_too_large(const Input& in, const std::string& what, std::uint64_t most);
/// Throws IoError "cannot read 'path', line 12: what".
[[noreturn]] void fail_at_line(const Input& in, std::int64_t line, const std::string& what);
/// Throws IoError "cannot read 'path', byte 345: what".
[[noreturn]] void fail_at_byte(const Input& in, std::size_t byte, const std::string& what);

/// @throws IoError when `count` vertices cannot be numbered with `Index`
void check_vertex_count(const Input& in, std::uint64_t count);

/// The text in quotes for a message: long texts are shortened, and unprintable bytes become '?'.
std::string in_quotes(std::string_view text);
/// The path in quotes, for a message.
std::string quoted_path(const std::filesystem::path& path);

}  // namespace ahm::io
