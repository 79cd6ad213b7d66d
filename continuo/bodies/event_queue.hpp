// continuo/bodies/event_queue.hpp
// The next event of each of N bodies, the earliest first, in O(1): the near future is cut into buckets, lists that a
// body enters and leaves in a few writes; only the bodies of the present bucket, about one, are in order, in a heap.
// What is further off waits apart until the buckets are used up, and is then shared out anew, with buckets of a width
// that suits it. G. Paul, "A complexity O(1) priority queue for event driven molecular dynamics simulations", J. Comp.
// Phys. 221 (2007) 615-625.
//
// Equal times go by the numbers that bodies have for this, whatever the history: the order of events that happen at one
// instant is that of the numbers.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace continuo {

template <class Real>
class EventQueue {
 public:
  /// Nobody has an event yet; numbers[body] decides between equal times.
  explicit EventQueue(std::vector<std::uint32_t> numbers = {}) : nodes_(numbers.size()) {
    for (std::size_t i = 0; i < numbers.size(); ++i) nodes_[i].number = numbers[i];
    first_.assign(numbers.size() / 2 + 1, none);
    heap_.reserve(64);
  }

  /// Infinity: no event.
  void set(std::uint32_t body, const Real& time) {
    Node& node = nodes_[body];
    if (node.bucket == in_heap) {
      take_from_heap(body);
    } else if (node.bucket != nowhere) {
      unlink(node);
    }
    node.time = time;
    put(body);
  }

  /// The earliest time, infinity where there is none; `first` is the body it belongs to.
  Real time() {
    if (heap_.empty()) fill_heap();
    return heap_.empty() ? never : heap_.front().time;
  }
  std::uint32_t first() const { return heap_.front().body; }

 private:
  static constexpr Real never = std::numeric_limits<Real>::infinity();
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max(), nowhere = none, in_heap = none - 1,
                                 later = none - 2;
  struct Node {
    Real time = never;
    std::uint32_t number = 0, bucket = nowhere;
    std::uint32_t next = none, before = none;  // in its list; in the heap, `before` is its place
  };
  struct Entry {
    Real time;
    std::uint32_t number, body;
    bool operator<(const Entry& other) const {
      return time < other.time || (time == other.time && number < other.number);
    }
  };

  void put(std::uint32_t body) {
    Node& node = nodes_[body];
    node.bucket = bucket_of(node.time);
    if (node.bucket == nowhere) return;
    if (node.bucket == in_heap) {
      heap_.push_back({});
      rise(heap_.size() - 1, {node.time, node.number, body});
      return;
    }
    std::uint32_t& first = node.bucket == later ? later_ : first_[node.bucket];
    node.before = none;
    node.next = first;
    if (first != none) nodes_[first].before = body;
    first = body;
  }
  std::uint32_t bucket_of(const Real& time) const {
    if (!(time < never)) return nowhere;
    if (!(time > begin_)) return in_heap;
    const Real at = (time - begin_) * buckets_per_time_;
    if (!(at < static_cast<Real>(first_.size()))) return later;
    const auto bucket = static_cast<std::uint32_t>(at);
    return bucket < first_.size() ? (bucket < present_ ? in_heap : bucket) : later;
  }
  void unlink(const Node& node) {
    if (node.before != none) {
      nodes_[node.before].next = node.next;
    } else {
      (node.bucket == later ? later_ : first_[node.bucket]) = node.next;
    }
    if (node.next != none) nodes_[node.next].before = node.before;
  }

  /// The bodies of the next bucket that has any come into the heap. Buckets before `present_` are used up.
  void fill_heap() {
    while (present_ < first_.size() && first_[present_] == none) ++present_;
    if (present_ == first_.size()) return share_out();
    std::uint32_t body = std::exchange(first_[present_], none);
    ++present_;
    while (body != none) {
      const std::uint32_t next = nodes_[body].next;
      put(body);
      body = next;
    }
  }
  /// Half of those that wait get into buckets, the first of all into the heap.
  void share_out() {
    std::vector<std::uint32_t> waiting;
    for (std::uint32_t body = later_; body != none; body = nodes_[body].next) waiting.push_back(body);
    if (waiting.empty()) return;
    std::vector<Real> times(waiting.size());
    for (std::size_t i = 0; i < times.size(); ++i) times[i] = nodes_[waiting[i]].time;
    const auto half = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
    std::nth_element(times.begin(), half, times.end());
    begin_ = *std::min_element(times.begin(), half + 1);
    buckets_per_time_ = static_cast<Real>(first_.size()) / (*half - begin_);  // infinite where half come at once
    present_ = 0;
    later_ = none;
    for (const std::uint32_t body : waiting) put(body);
  }

  void set_heap(std::size_t at, const Entry& entry) {
    heap_[at] = entry;
    nodes_[entry.body].before = static_cast<std::uint32_t>(at);
  }
  void take_from_heap(std::uint32_t body) {
    const std::size_t at = nodes_[body].before;
    const Entry last = heap_.back();
    heap_.pop_back();
    if (at == heap_.size()) return;
    last < heap_[at] ? rise(at, last) : sink(at, last);
  }
  void rise(std::size_t at, const Entry& entry) {
    while (at > 0 && entry < heap_[(at - 1) / 2]) {
      set_heap(at, heap_[(at - 1) / 2]);
      at = (at - 1) / 2;
    }
    set_heap(at, entry);
  }
  void sink(std::size_t at, const Entry& entry) {
    for (std::size_t child = 2 * at + 1; child < heap_.size(); child = 2 * at + 1) {
      if (child + 1 < heap_.size() && heap_[child + 1] < heap_[child]) ++child;
      if (!(heap_[child] < entry)) break;
      set_heap(at, heap_[child]);
      at = child;
    }
    set_heap(at, entry);
  }

  std::vector<Node> nodes_;
  std::vector<Entry> heap_;
  std::vector<std::uint32_t> first_;  // of each bucket
  std::uint32_t later_ = none, present_ = 0;
  Real begin_ = std::numeric_limits<Real>::lowest(), buckets_per_time_ = never;  // until shared out: all wait
};

}  // namespace continuo
