// Corrects the checksums of a changed recording, so that the reader is tested beyond them.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include <continuo/bodies/support/bytes.hpp>

namespace continuo {

/// The last bytes of a snapshot.
inline void put_sum_right(std::span<std::byte> bytes) {
  if (bytes.size() < sizeof(std::uint64_t)) return;
  const auto body = bytes.first(bytes.size() - sizeof(std::uint64_t));
  ByteWriter sum;
  sum(checksum(body));
  for (std::size_t i = 0; i < sizeof(std::uint64_t); ++i) bytes[body.size() + i] = sum.bytes()[i];
}

/// Of the blocks after a head of so many bytes; each is first given to `inside(kind, bytes of it)`.
template <class Inside>
void put_sums_right(std::span<std::byte> file, std::size_t head, Inside&& inside) {
  constexpr std::size_t before = 9, after = 8;  // kind and size; the checksum
  for (std::size_t at = head; at + before + after <= file.size();) {
    ByteReader reader(file.subspan(at));
    std::uint8_t kind = 0;
    std::uint64_t size = 0;
    reader(kind), reader(size);
    if (size > file.size() - at - before - after) return;
    const auto block = file.subspan(at + before, static_cast<std::size_t>(size));
    inside(kind, block);
    ByteWriter sum;
    sum(checksum(block));
    for (std::size_t i = 0; i < after; ++i) file[at + before + block.size() + i] = sum.bytes()[i];
    at += before + block.size() + after;
  }
}

}  // namespace continuo
