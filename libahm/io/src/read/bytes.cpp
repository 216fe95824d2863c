#include "read/bytes.hpp"

#include <algorithm>

#include "ahm/error.hpp"

namespace ahm::io {
namespace {

constexpr std::size_t block = std::size_t{1} << 18, longest_head = std::size_t{1} << 20;

}  // namespace

ByteStream::ByteStream(const std::filesystem::path& path) : file_(std::make_shared<RegularFile>(path)) {
  auto head = std::make_shared<Input>(Input{path, {}});
  head_ = head;
  head->bytes.resize(std::min<std::uint64_t>(file_->size(), longest_head));
  head->bytes.resize(file_->read(0, head->bytes));
  head->beyond = file_->size() - head->bytes.size();
  check_gzip_name(*head);
  is_packed_ = is_gzip(*head);
  begin();
  const auto check_text = [&] {
    if (is_utf16(head->bytes))
      fail(*head, "it is text in UTF-16, which is not read block by block; convert it with iconv -f UTF-16 -t UTF-8");
  };
  if (!is_packed_) {
    check_text();
    return;
  }
  std::string bytes(longest_head, '\0');
  bytes.resize(read(bytes));
  std::string more(block, '\0');
  head->beyond = 0;
  while (const std::size_t count = read(more)) head->beyond += count;
  head->bytes = std::move(bytes);
  if (head->bytes.empty()) fail(*head, "the file is empty (0 bytes) when unpacked");
  check_text();
  begin();
}

ByteStream::ByteStream(const ByteStream& other, std::uint64_t position)
    : file_(other.file_), head_(other.head_), is_packed_(other.is_packed_) {
  begin();
  skip(position);
}

void ByteStream::begin() {
  position_ = 0;
  if (!is_packed_) return;
  block_.resize(block);
  gunzip_ = std::make_unique<Gunzip>(*head_, [this] {
    const std::size_t count = file_->read(position_, block_);
    position_ += count;
    return std::string_view(block_).substr(0, count);
  });
}

std::size_t ByteStream::read(std::span<char> room) {
  if (gunzip_) return gunzip_->read(room);
  const std::size_t count = file_->read(position_, room);
  position_ += count;
  return count;
}

void ByteStream::skip(std::uint64_t bytes) {
  if (!gunzip_) {
    position_ += bytes;
    return;
  }
  std::string room(block, '\0');
  while (bytes > 0) {
    const std::size_t count = read(std::span(room).first(std::min<std::uint64_t>(bytes, block)));
    if (count == 0) return;
    bytes -= count;
  }
}

}  // namespace ahm::io
