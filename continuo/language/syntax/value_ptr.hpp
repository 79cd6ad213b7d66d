// continuo/language/syntax/value_ptr.hpp
// One T on the heap with the manners of a value: copying a ValuePtr copies what is in it. For types that hold
// themselves.
#pragma once
#include <memory>
#include <utility>

namespace continuo::model {

template <class T>
class ValuePtr {
 public:
  ValuePtr(T value) : pointer_(std::make_unique<T>(std::move(value))) {}
  ValuePtr(const ValuePtr& other) : pointer_(other.pointer_ ? std::make_unique<T>(*other.pointer_) : nullptr) {}
  ValuePtr(ValuePtr&&) noexcept = default;
  ValuePtr& operator=(const ValuePtr& other) {
    ValuePtr copy(other);
    pointer_ = std::move(copy.pointer_);
    return *this;
  }
  ValuePtr& operator=(ValuePtr&&) noexcept = default;
  ~ValuePtr() = default;

  const T& operator*() const { return *pointer_; }
  T& operator*() { return *pointer_; }
  const T* operator->() const { return pointer_.get(); }
  T* operator->() { return pointer_.get(); }

 private:
  std::unique_ptr<T> pointer_;  // never null but in a moved-from box
};

}  // namespace continuo::model
