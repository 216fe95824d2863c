#include "read/lzf.hpp"

#include <algorithm>

namespace ahm::io {
namespace {

constexpr std::size_t block = std::size_t{1} << 18, window = 8192;  // the farthest that a repetition reaches back

}  // namespace

LzfStream::LzfStream(const ByteStream& file, std::uint64_t begin, std::uint64_t packed, std::uint64_t plain)
    : file_(file, begin), packed_left_(packed), plain_left_(plain) {
  plain_.reserve(window + block);
}

void LzfStream::damaged() const { fail(file_.head(), "its compressed data (LZF) is damaged"); }

unsigned char LzfStream::next() {
  if (at_packed_ == packed_.size()) {
    packed_.resize(std::min<std::uint64_t>(block, packed_left_));
    if (packed_.empty() || file_.read(packed_) < packed_.size()) damaged();
    packed_left_ -= packed_.size();
    at_packed_ = 0;
  }
  return static_cast<unsigned char>(packed_[at_packed_++]);
}

/// Unpacks a block behind the window; false at the end.
bool LzfStream::unpack() {
  if (plain_left_ == 0) return false;
  if (plain_.size() > window) plain_.erase(0, plain_.size() - window);
  at_ = plain_.size();
  constexpr std::size_t longest = 264;  // of a repetition
  while (plain_left_ > 0 && plain_.size() - at_ + longest < block) {
    const unsigned control = next();
    if (control < 32) {  // literal bytes
      if (control + 1 > plain_left_) damaged();
      plain_left_ -= control + 1;
      for (unsigned k = 0; k <= control; ++k) plain_ += static_cast<char>(next());
      continue;
    }
    std::size_t length = control >> 5;
    if (length == 7) length += next();
    length += 2;
    const std::size_t back = ((control & 31U) << 8) + next() + 1;
    if (back > plain_.size() || length > plain_left_) damaged();
    plain_left_ -= length;
    for (; length > 0; --length) plain_ += plain_[plain_.size() - back];
  }
  return true;
}

void LzfStream::read(std::span<char> room) {
  while (!room.empty()) {
    if (at_ == plain_.size() && !unpack()) damaged();
    const std::size_t count = std::min(room.size(), plain_.size() - at_);
    std::copy_n(plain_.data() + at_, count, room.data());
    at_ += count;
    room = room.subspan(count);
  }
}

void LzfStream::skip(std::uint64_t bytes) {
  while (bytes > 0) {
    if (at_ == plain_.size() && !unpack()) damaged();
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(bytes, plain_.size() - at_));
    at_ += count;
    bytes -= count;
  }
}

void LzfStream::finish() {
  if (at_ != plain_.size() || plain_left_ > 0 || packed_left_ > 0 || at_packed_ != packed_.size()) damaged();
}

}  // namespace ahm::io
