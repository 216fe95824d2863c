/// \file
/// Sequential reading of binary data whose items have different sizes.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "read/bytes.hpp"
#include "read/input.hpp"

namespace ahm::io {

/// Bytes of binary data, from a file in memory or block by block.
class BinarySource {
 public:
  BinarySource(const Input& in, std::size_t begin)
      : in_(in), window_(std::string_view(in.bytes).substr(begin)), position_(begin) {}
  BinarySource(const ByteStream& file, std::size_t begin)
      : in_(file.head()), file_(std::make_unique<ByteStream>(file, begin)), position_(begin) {}

  std::uint64_t position() const { return position_; }
  std::uint64_t left() const { return in_.size() - position_; }

  /// The next bytes, valid until the next call. @param size  at most 8, and at most `left()`
  const char* take(std::size_t size) {
    if (window_.size() < size) refill(size);
    const char* bytes = window_.data();
    window_.remove_prefix(size);
    position_ += size;
    return bytes;
  }
  /// @param size  at most `left()`
  void skip(std::uint64_t size) {
    position_ += size;
    const std::uint64_t here = std::min<std::uint64_t>(size, window_.size());
    window_.remove_prefix(here);
    if (file_) file_->skip(size - here);
  }

 private:
  void refill(std::size_t size) {
    constexpr std::size_t block = std::size_t{1} << 18;
    std::string next(window_);
    const std::size_t kept = next.size();
    next.resize(kept + block);
    next.resize(kept + file_->read(std::span(next).subspan(kept)));
    buffer_ = std::move(next);
    window_ = buffer_;
    if (window_.size() < size) fail_at_byte(in_, position_, "the file became shorter while it was read");
  }

  const Input& in_;
  std::unique_ptr<ByteStream> file_;  ///< null: the file is in memory
  std::string buffer_;                ///< current block of the file
  std::string_view window_;           ///< bytes that have not been taken
  std::uint64_t position_;            ///< position of the next byte in the file
};

}  // namespace ahm::io
