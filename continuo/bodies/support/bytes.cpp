// Numbers as little-endian bytes and back, with bounds checked.
#include <algorithm>

#include <continuo/bodies/support/bytes.hpp>

namespace continuo {

void ByteWriter::put(std::uint64_t bits, std::size_t size) {
  std::array<std::byte, sizeof bits> bytes;
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(bits >> (8 * i) & 0xff);
  bytes_.insert(bytes_.end(), bytes.data(), bytes.data() + size);
}

std::uint64_t ByteReader::get(std::size_t size) {
  std::array<std::byte, sizeof(std::uint64_t)> bytes{};
  std::ranges::copy(take(size), bytes.begin());
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) bits |= std::to_integer<std::uint64_t>(bytes[i]) << (8 * i);
  return bits;
}

std::span<const std::byte> ByteReader::take(std::uint64_t count) {
  if (!takes(count)) return {};
  at_ += static_cast<std::size_t>(count);
  return bytes_.subspan(at_ - static_cast<std::size_t>(count), static_cast<std::size_t>(count));
}

bool ByteReader::takes(std::uint64_t count) {
  if (!ok()) return false;
  if (count <= left()) return true;
  fail("the bytes end too early");
  return false;
}

std::uint64_t ByteReader::list_size() {
  const std::uint64_t count = get(sizeof count);
  if (count <= left()) return count;
  fail("a list longer than the bytes that are left");
  return 0;
}

void ByteReader::fail(const std::string& what) {
  if (ok()) error_ = "byte " + std::to_string(at_) + ": " + what;
}

std::uint64_t checksum(std::span<const std::byte> bytes) {
  std::uint64_t hash = 14695981039346656037u;
  for (const std::byte byte : bytes) hash = (hash ^ std::to_integer<std::uint64_t>(byte)) * 1099511628211u;
  return hash;
}

}  // namespace continuo
