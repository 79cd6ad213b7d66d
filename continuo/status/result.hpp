// continuo/status/result.hpp
// A value, or the reason why there is none:
//
//   const continuo::Result<World<double, 2>> world = read(path);
//   if (!world) return world.status();
//   advance(*world);
#pragma once
#include <optional>
#include <utility>

#include <continuo/status/status.hpp>

namespace continuo {

/// A value of type T where the operation succeeded, else its Status alone. Costs a T and a Status.
template <class T>
class [[nodiscard]] Result {
 public:
  /// A success with this value. It may be written as `return value;`.
  Result(T value) : value_(std::move(value)) {}  // NOLINT(google-explicit-constructor): `return value;` is meant
  /// Why there is no value. A status that succeeded gives no reason: it counts as a failure, so that nobody who passes
  /// it on reports a success.
  Result(Status status) : status_(std::move(status)) {  // NOLINT(google-explicit-constructor)
    if (status_) status_ = {.ending = Ending::cannot_continue, .message = "there is no value", .place = {}};
  }

  /// Whether there is a value.
  explicit operator bool() const { return value_.has_value(); }
  /// Whether there is a value.
  [[nodiscard]] bool has_value() const { return value_.has_value(); }

  /// The value, which must be there.
  T& operator*() & { return *value_; }
  const T& operator*() const& { return *value_; }
  T&& operator*() && { return *std::move(value_); }
  /// Access to the value, which must be there.
  T* operator->() { return &*value_; }
  const T* operator->() const { return &*value_; }

  /// How the operation ended.
  [[nodiscard]] const Status& status() const { return status_; }

 private:
  std::optional<T> value_;
  Status status_;
};

}  // namespace continuo
