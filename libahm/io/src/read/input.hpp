/// \file
/// How much memory there is to take.
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

/// A whole file in memory: readers see one unchanging state of it, and know its size before they believe a count.
struct Input {
  std::filesystem::path path;
  std::string bytes;
  std::uint64_t beyond = 0;  ///< where only the beginning was loaded: bytes that follow

  /// Bytes of the file.
  std::uint64_t size() const { return bytes.size() + beyond; }
};

/// Reads a regular file, and unpacks what is compressed with gzip, whatever its name. @throws IoError with the system's
/// reason; empty files are refused here
Input load(const std::filesystem::path& path);

/// The same of all that a stream holds, under the name "-". @throws IoError; an empty stream is refused here
Input load(std::istream& stream);
/// Standard input. @throws IoError with the system's reason
Input load_standard_input();

/// That a file whose name says that gzip compressed it is. @throws IoError
void check_gzip_name(const Input& in);

/// Throws IoError "cannot read 'path': what".
[[noreturn]] void fail(const Input& in, const std::string& what);
/// Throws ResourceExhausted "cannot read 'path': what is larger than ... MB". @param most  `room_for_input`
[[noreturn]] void fail_too_large(const Input& in, const std::string& what, std::uint64_t most);
/// Throws IoError "cannot read 'path', line 12: what".
[[noreturn]] void fail_at_line(const Input& in, std::int64_t line, const std::string& what);
/// Throws IoError "cannot read 'path', byte 345: what".
[[noreturn]] void fail_at_byte(const Input& in, std::size_t byte, const std::string& what);

/// @throws IoError when `count` vertices cannot be numbered with `Index`
void check_vertex_count(const Input& in, std::uint64_t count);

/// The text in quotes, shortened and with unprintable bytes shown as '?', fit for a message.
std::string in_quotes(std::string_view text);
/// The path in quotes, fit for a message.
std::string quoted_path(const std::filesystem::path& path);

}  // namespace ahm::io
