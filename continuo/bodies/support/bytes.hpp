// continuo/bodies/support/bytes.hpp
// Values as bytes and back: little-endian on every machine, numbers by their bits. Input is not trusted: after a fault
// a reader has the position of the fault in its status, and returns only zeros; it never allocates more than the bytes
// could contain.
#pragma once
#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <continuo/numerics/vector.hpp>
#include <continuo/status/status.hpp>

namespace continuo {

using Bytes = std::vector<std::byte>;

namespace detail {

template <std::size_t Size>
using UnsignedOf = std::conditional_t<
    Size == 1, std::uint8_t,
    std::conditional_t<Size == 2, std::uint16_t, std::conditional_t<Size == 4, std::uint32_t, std::uint64_t>>>;

/// A type with several parts has a member `template <class Archive> void transfer(Archive&)`, for writing and reading.
template <class T, class Archive>
concept Transferable = requires(T& value, Archive& archive) { value.transfer(archive); };

template <class T>
concept Number = std::is_arithmetic_v<T> || std::is_enum_v<T>;

}  // namespace detail

class ByteWriter {
 public:
  static constexpr bool reads = false;

  template <detail::Number T>
  void operator()(const T& value) {
    put(std::bit_cast<detail::UnsignedOf<sizeof(T)>>(value), sizeof(T));
  }
  void operator()(const Bytes& bytes) {
    (*this)(static_cast<std::uint64_t>(bytes.size()));
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }
  template <class T, std::size_t Size>
  void operator()(const std::array<T, Size>& values) {
    for (const T& value : values) (*this)(value);
  }
  template <class Real, int Size>
  void operator()(const Vector<Real, Size>& v) {
    (*this)(v.components);
  }
  template <class T, class Allocator>
  void operator()(const std::vector<T, Allocator>& values) {
    (*this)(static_cast<std::uint64_t>(values.size()));
    for (const T& value : values) (*this)(value);
  }
  template <class T>
    requires detail::Transferable<T, ByteWriter>
  void operator()(const T& value) {
    const_cast<T&>(value).transfer(*this);  // a writer only reads it
  }

  [[nodiscard]] const Bytes& bytes() const { return bytes_; }
  [[nodiscard]] Bytes take() { return std::move(bytes_); }

 private:
  void put(std::uint64_t bits, std::size_t size);

  Bytes bytes_;
};

class ByteReader {
 public:
  static constexpr bool reads = true;

  explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <detail::Number T>
  void operator()(T& value) {
    const std::uint64_t bits = get(sizeof(T));
    if constexpr (std::is_same_v<T, bool>) {
      if (bits > 1) fail("a truth value that is neither 0 nor 1");
      value = bits == 1;
    } else {
      value = std::bit_cast<T>(static_cast<detail::UnsignedOf<sizeof(T)>>(bits));
    }
  }
  template <class T, std::size_t Size>
  void operator()(std::array<T, Size>& values) {
    for (T& value : values) (*this)(value);
  }
  template <class Real, int Size>
  void operator()(Vector<Real, Size>& v) {
    (*this)(v.components);
  }
  template <class T, class Allocator>
  void operator()(std::vector<T, Allocator>& values) {
    values.clear();
    for (std::uint64_t i = 0, count = list_size(); i < count && ok(); ++i) (*this)(values.emplace_back());
  }
  void operator()(Bytes& bytes) {
    const auto taken = take(list_size());
    bytes.assign(taken.begin(), taken.end());
  }
  template <class T>
    requires detail::Transferable<T, ByteReader>
  void operator()(T& value) {
    value.transfer(*this);
  }

  [[nodiscard]] bool ok() const { return error_.empty(); }
  /// Unreadable, with the place of the first fault; a success where there is none.
  [[nodiscard]] Status status() const {
    return ok() ? Status{} : Status{.ending = Ending::unreadable, .message = error_};
  }
  [[nodiscard]] std::size_t position() const { return at_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }
  /// The first fault counts.
  void fail(const std::string& what);
  void expect(bool is_right, const char* what) {
    if (!is_right) fail(what);
  }
  void expect_end() { expect(left() == 0, "bytes after the end"); }
  [[nodiscard]] std::span<const std::byte> take(std::uint64_t count);

 private:
  [[nodiscard]] bool takes(std::uint64_t count);
  /// The number in the next bytes; 0 where too few are left.
  [[nodiscard]] std::uint64_t get(std::size_t size);
  /// The size of a list: at most the number of bytes left, since an element has at least one byte.
  [[nodiscard]] std::uint64_t list_size();

  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
  std::string error_;
};

/// FNV-1a, 64 bits (G. Fowler, L. Noll, K.-P. Vo): detects accidental changes.
[[nodiscard]] std::uint64_t checksum(std::span<const std::byte> bytes);

}  // namespace continuo
