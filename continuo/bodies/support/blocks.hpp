// continuo/bodies/support/blocks.hpp
// Files that grow while a run goes on: a head with the format and its version, then blocks, each with its kind, its
// size, its bytes and their checksum. A file that ends within a block was cut off there; the blocks before it are
// valid.
//
//   BlockWriter out(stream);
//   ByteWriter head;
//   format.write(head);
//   out.write(head.bytes());
//   out.write(Kind::frame, bytes_of_a_frame);
//
//   ByteReader file(bytes_of_the_file);
//   format.expect(file);
//   while (const auto block = next_block(file, Kind::last))
//     read_block(file, block->bytes, [&](ByteReader& reader) { reader(frame); });
//   if (!file.ok()) return file.status();
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <ostream>
#include <span>
#include <string>

#include <continuo/bodies/support/bytes.hpp>

namespace continuo {

/// The head of a file, and the messages for files with another one.
struct FileFormat {
  std::array<char, 8> name;
  std::uint32_t version;
  const char* no_such_file;   // the message for a file of another name,
  const char* other_version;  // of another version

  void write(ByteWriter& head) const { head(name), head(version); }
  void expect(ByteReader& file) const {
    std::array<char, 8> found{};
    std::uint32_t found_version = 0;
    file(found);
    file.expect(found == name, no_such_file);
    file(found_version);
    file.expect(found_version == version, other_version);
  }
};

class BlockWriter {
 public:
  /// The stream must be binary and outlive this object. The caller checks the stream for failed writes.
  explicit BlockWriter(std::ostream& out) : out_(out) {}

  /// Writes bytes without a checksum: the head of a file.
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
  /// The number of bytes written so far.
  [[nodiscard]] std::uint64_t position() const { return at_; }

 private:
  std::ostream& out_;
  std::uint64_t at_ = 0;
};

template <class Kind>
struct Block {
  Kind kind{};
  std::span<const std::byte> bytes;
};
/// The next block; none at the end, or where the file was cut off. The reader fails where the checksum does not fit, or
/// the kind of the block is after `last`.
template <class Kind>
[[nodiscard]] std::optional<Block<Kind>> next_block(ByteReader& file, Kind last) {
  if (!file.ok() || file.left() == 0) return std::nullopt;
  const ByteReader before = file;
  Block<Kind> block;
  std::uint64_t size = 0, sum = 0;
  file(block.kind), file(size);
  block.bytes = file.take(size);
  file(sum);
  if (!file.ok()) {
    file = before;
    return std::nullopt;
  }
  file.expect(sum == checksum(block.bytes), "the checksum does not fit the block before");
  file.expect(block.kind <= last, "a block of no known kind");
  if (!file.ok()) return std::nullopt;
  return block;
}

/// Lets the reader of the file fail for a fault in the block that was read last.
inline void fail_in_block(ByteReader& file, const std::string& why) {
  file.fail("the block before, " + why);
}
/// `read(reader)` must read all bytes of the block.
template <class Read>
void read_block(ByteReader& file, std::span<const std::byte> block, Read&& read) {
  ByteReader reader(block);
  read(reader);
  if (reader.ok()) reader.expect_end();
  if (!reader.ok()) fail_in_block(file, reader.status().message);
}

}  // namespace continuo
