// Arrays of many megabytes with random access. Each access needs a page that the processor has not used for long, so
// that translating its address costs as much as reading the data. With pages of 2 MiB instead of 4 KiB, the address
// cache of the processor (TLB) suffices. The system provides such pages on request.
#pragma once
#include <cstddef>
#include <new>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace continuo {

template <class T>
struct LargePages {
  using value_type = T;

  static constexpr std::size_t page = std::size_t{1} << 21;
  // Smaller arrays are left as they are: clearing a whole page for a part of one costs more than it brings.
  static constexpr std::size_t smallest = 2 * page;

  LargePages() = default;
  template <class Other>
  LargePages(const LargePages<Other>&) {}

  [[nodiscard]] T* allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    void* memory = ::operator new(bytes, alignment(bytes));
#ifdef __linux__
    // Only a hint: where the system does not follow it, the memory is usable all the same.
    if (bytes >= smallest) static_cast<void>(madvise(memory, bytes / page * page, MADV_HUGEPAGE));
#endif
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    ::operator delete(memory, bytes, alignment(bytes));
  }
  bool operator==(const LargePages&) const { return true; }

 private:
  static std::align_val_t alignment(std::size_t bytes) {
    return std::align_val_t{bytes >= smallest ? page : alignof(T)};
  }
};

template <class T>
using LargeArray = std::vector<T, LargePages<T>>;

}  // namespace continuo
