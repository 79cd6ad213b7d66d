// The state of an integration as bytes, and back. What a class keeps from one step to the next it lists in a member
// `transfer(archive)`, which serves both directions:
//
//   template <class Archive>
//   void transfer(Archive& archive) {
//     archive(x_, h_, statistics_);
//     archive.index(order_, greatest_order);
//   }
//
// Bytes are read into an object that has been made for the same model, method and options, so that lists have their
// sizes already: a list of another size is a fault, and so is an index beyond its range.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include <continuo/bodies/support/bytes.hpp>
#include <continuo/numerics/complex_number.hpp>
#include <continuo/simulation/program/model_system.hpp>

namespace continuo::model {

/// `Bytes` is a ByteWriter or a ByteReader.
template <class Bytes>
class StateArchive {
 public:
  static constexpr bool reads = Bytes::reads;

  explicit StateArchive(Bytes& bytes) : bytes_(bytes) {}

  /// The system of the integration, of which structures are made that are not in the bytes.
  void bind(ModelSystem& system) { system_ = &system; }
  [[nodiscard]] ModelSystem& system() { return *system_; }

  template <class... Values>
  void operator()(Values&... values) {
    (one(values), ...);
  }
  /// A number that is at most `most`.
  void index(std::size_t& value, std::size_t most) {
    auto number = static_cast<std::uint64_t>(value);
    bytes_(number);
    if constexpr (reads) {
      bytes_.expect(number <= most, "an index beyond its range");
      value = bytes_.ok() ? static_cast<std::size_t>(number) : 0;
    }
  }
  template <class Number>
  void optional(std::optional<Number>& value) {
    bool is_there = value.has_value();
    bytes_(is_there);
    if (!is_there) return value.reset();
    if (!value) value.emplace();
    one(*value);
  }
  /// A list of any size.
  template <class Value>
  void list(std::vector<Value>& values) {
    auto count = static_cast<std::uint64_t>(values.size());
    bytes_(count);
    if constexpr (reads) {
      bytes_.expect(count <= bytes_.left(), "a list longer than the bytes that are left");
      values.assign(bytes_.ok() ? static_cast<std::size_t>(count) : 0, Value{});
    }
    for (Value& value : values) one(value);
  }
  void fail(const char* what) {
    if constexpr (reads) bytes_.fail(what);
  }

 private:
  template <class Value>
  void one(Value& value) {
    if constexpr (std::is_arithmetic_v<Value> || std::is_enum_v<Value>) {
      bytes_(value);
    } else {
      value.transfer(*this);
    }
  }
  void one(ComplexNumber<double>& value) { (*this)(value.re, value.im); }
  void one(std::string& text) {
    std::vector<char> letters(text.begin(), text.end());
    list(letters);
    if constexpr (reads) text.assign(letters.begin(), letters.end());
  }
  template <class Value, std::size_t Size>
  void one(std::array<Value, Size>& values) {
    for (Value& value : values) one(value);
  }
  template <class Value>
  void one(std::vector<Value>& values) {
    auto count = static_cast<std::uint64_t>(values.size());
    bytes_(count);
    if constexpr (reads) bytes_.expect(count == values.size(), "a list of another size");
    for (Value& value : values) one(value);
  }

  Bytes& bytes_;
  ModelSystem* system_ = nullptr;
};

using StateWriter = StateArchive<ByteWriter>;
using StateReader = StateArchive<ByteReader>;

}  // namespace continuo::model
