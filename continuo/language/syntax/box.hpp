// continuo/language/syntax/box.hpp
// One T on the heap with the manners of a value: copying a Box copies what is in it. For types that hold themselves.
#pragma once
#include <memory>
#include <utility>

namespace continuo::model {

template <class T>
class Box {
 public:
  Box(T value) : pointer_(std::make_unique<T>(std::move(value))) {}
  Box(const Box& other) : pointer_(other.pointer_ ? std::make_unique<T>(*other.pointer_) : nullptr) {}
  Box(Box&&) noexcept = default;
  Box& operator=(const Box& other) {
    Box copy(other);
    pointer_ = std::move(copy.pointer_);
    return *this;
  }
  Box& operator=(Box&&) noexcept = default;
  ~Box() = default;

  const T& operator*() const { return *pointer_; }
  T& operator*() { return *pointer_; }
  const T* operator->() const { return pointer_.get(); }
  T* operator->() { return pointer_.get(); }

 private:
  std::unique_ptr<T> pointer_;  // never null but in a moved-from box
};

}  // namespace continuo::model
