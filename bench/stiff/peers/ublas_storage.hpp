// bench/stiff/peers/ublas_storage.hpp
// uBLAS of Boost 1.74 does not compile as C++20, which has no std::allocator::construct any more; odeint's rosenbrock4
// takes no other state. So its storage is given an allocator that still has it. Nothing else changes.
#pragma once
#include <memory>
#include <new>

#include <boost/numeric/ublas/storage.hpp>

namespace continuo::bench {

template <class T>
struct ConstructingAllocator : std::allocator<T> {
  template <class Other>
  struct rebind {
    using other = ConstructingAllocator<Other>;
  };
  using pointer = T*;
  using const_pointer = const T*;
  using reference = T&;
  using const_reference = const T&;
  void construct(T* at, const T& value) { ::new (static_cast<void*>(at)) T(value); }
  void destroy(T* at) { at->~T(); }
};

}  // namespace continuo::bench

namespace boost::numeric::ublas {

template <>
class unbounded_array<double, std::allocator<double>>
    : public unbounded_array<double, continuo::bench::ConstructingAllocator<double>> {
 public:
  using unbounded_array<double, continuo::bench::ConstructingAllocator<double>>::unbounded_array;
};
template <>
class unbounded_array<std::size_t, std::allocator<std::size_t>>
    : public unbounded_array<std::size_t, continuo::bench::ConstructingAllocator<std::size_t>> {
 public:
  using unbounded_array<std::size_t, continuo::bench::ConstructingAllocator<std::size_t>>::unbounded_array;
};

}  // namespace boost::numeric::ublas
