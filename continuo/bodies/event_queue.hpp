// continuo/bodies/event_queue.hpp
// The next event of each of N bodies, the earliest first: a heap of four children a node whose entries know their
// place, so that an event changes in O(log N). Equal times go by number, whatever the history: the order of events that
// happen at one instant is that of the bodies.
#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace continuo {

template <class Real>
class EventQueue {
 public:
  explicit EventQueue(std::size_t size = 0) : heap_(size), place_(size) {
    for (std::uint32_t i = 0; i < size; ++i) {
      heap_[i] = {std::numeric_limits<Real>::infinity(), i};
      place_[i] = i;
    }
  }

  std::uint32_t first() const { return heap_.front().body; }
  Real time() const { return heap_.front().time; }
  bool empty() const { return heap_.empty(); }

  void set(std::uint32_t body, const Real& time) {
    const Entry entry{time, body};
    const std::size_t at = place_[body];
    const bool earlier = before(entry, heap_[at]);
    heap_[at] = entry;
    earlier ? rise(at, entry) : sink(at, entry);
  }

 private:
  struct Entry {
    Real time;
    std::uint32_t body;
  };
  static bool before(const Entry& a, const Entry& b) {
    return a.time < b.time || (a.time == b.time && a.body < b.body);
  }
  void put(std::size_t at, const Entry& entry) {
    heap_[at] = entry;
    place_[entry.body] = static_cast<std::uint32_t>(at);
  }
  void rise(std::size_t at, const Entry& entry) {
    while (at > 0) {
      const std::size_t parent = (at - 1) / 4;
      if (!before(entry, heap_[parent])) break;
      put(at, heap_[parent]);
      at = parent;
    }
    put(at, entry);
  }
  void sink(std::size_t at, const Entry& entry) {
    for (;;) {
      const std::size_t begin = 4 * at + 1, end = begin + 4 < heap_.size() ? begin + 4 : heap_.size();
      if (begin >= heap_.size()) break;
      std::size_t child = begin;
      for (std::size_t i = begin + 1; i < end; ++i)
        if (before(heap_[i], heap_[child])) child = i;
      if (!before(heap_[child], entry)) break;
      put(at, heap_[child]);
      at = child;
    }
    put(at, entry);
  }

  std::vector<Entry> heap_;
  std::vector<std::uint32_t> place_;
};

}  // namespace continuo
