// Files that grow while a run goes on: blocks, each its kind, its size, its bytes and their checksum. A file that ends
// within a block was cut off there, and holds what came before.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <ostream>
#include <span>

#include <continuo/bodies/support/bytes.hpp>

namespace continuo {

class BlockWriter {
 public:
  /// The stream must be binary and stay; whether writing went well is for the caller to ask of it.
  explicit BlockWriter(std::ostream& out) : out_(out) {}

  /// As they are, without a checksum: the head of a file.
  void write(const Bytes& bytes) {
    out_.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    at_ += bytes.size();
  }
  template <class Kind>
  void write(Kind kind, const Bytes& bytes) {
    ByteWriter head, tail;
    head(kind), head(static_cast<std::uint64_t>(bytes.size()));
    tail(checksum(bytes));
    write(head.bytes());
    write(bytes);
    write(tail.bytes());
  }
  void flush() { out_.flush(); }
  /// How much has been written.
  std::uint64_t position() const { return at_; }

 private:
  std::ostream& out_;
  std::uint64_t at_ = 0;
};

template <class Kind>
struct Block {
  Kind kind{};
  std::span<const std::byte> bytes;
};
/// None at the end, or where the file was cut off; where the block is another than was written the reader says so.
template <class Kind>
std::optional<Block<Kind>> next_block(ByteReader& reader) {
  if (!reader.ok() || reader.left() == 0) return std::nullopt;
  const ByteReader before = reader;
  Block<Kind> block;
  std::uint64_t size = 0, sum = 0;
  reader(block.kind), reader(size);
  block.bytes = reader.take(size);
  reader(sum);
  if (!reader.ok()) {
    reader = before;
    return std::nullopt;
  }
  reader.expect(sum == checksum(block.bytes), "the checksum does not fit the block before");
  if (!reader.ok()) return std::nullopt;
  return block;
}

}  // namespace continuo
