// Arrays of many megabytes that are read in the order of something else. Each access then needs a page that the
// processor has not seen for long, and looking up where it lies costs as much as reading it; with pages of 2 MiB
// instead of 4 KiB there are few enough to remember. The system gives such pages to who asks for them.
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
    // A wish: where the system does not grant it, the memory is as good.
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
