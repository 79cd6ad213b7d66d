// continuo/bodies/event_driven/event_queue.hpp
// The next event of each of N bodies, the earliest first, in O(1): the near future is divided into buckets, lists that
// a body enters and leaves with a few writes. Only the bodies of the present bucket, about one, are sorted, in a heap.
// Later events wait in a list of their own until the buckets are used up, and are then distributed among new buckets of
// a suitable width. G. Paul, "A complexity O(1) priority queue for event driven molecular dynamics simulations", J.
// Comp. Phys. 221 (2007) 615-625.
//
// Events at equal times are ordered by numbers that bodies have for this purpose, independently of the history.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <continuo/bodies/support/prefetch.hpp>
#include <continuo/bodies/support/short_lists.hpp>

namespace continuo {

template <class Real>
class EventQueue {
 public:
  /// No body has an event yet; numbers[body] decides between equal times.
  explicit EventQueue(std::vector<std::uint32_t> numbers = {})
      : nodes_(numbers.size()), buckets_(numbers.size() / 2 + 1, numbers.size()) {
    for (std::size_t i = 0; i < numbers.size(); ++i) nodes_[i].number = numbers[i];
    heap_.reserve(64);
  }

  /// Infinity: no event.
  void set(std::uint32_t body, const Real& time) {
    Node& node = nodes_[body];
    const std::uint32_t to = place_for(time);
    node.time = time;
    if (to == later && (node.place & kind) == later) {
      least_later_ = std::min(least_later_, time);
      return;
    }
    leave(body);
    enter(body, to);
  }

  /// The earliest time, infinity where there is none; `first` is the body it belongs to.
  [[nodiscard]] Real time() {
    if (heap_.empty()) fill_heap();
    return heap_.empty() ? never : heap_.front().time;
  }
  [[nodiscard]] std::uint32_t first() const { return heap_.front().body; }
  /// Whether bodies other than these two have events up to a time soon after the earliest.
  [[nodiscard]] bool has_others_until(const Real& t, std::uint32_t a, std::uint32_t b) {
    const std::uint32_t place = place_for(t);
    const std::size_t last = place == later ? buckets_.size() : (place & kind) == in_bucket ? place + 1 : 0;
    while (present_ < last) take_bucket();
    for (const Entry& entry : heap_)
      if (entry.time <= t && entry.body != a && entry.body != b) return true;
    if (place != later || !(least_later_ <= t)) return false;
    least_later_ = never;
    for (const std::uint32_t body : later_) {
      least_later_ = std::min(least_later_, nodes_[body].time);
      if (nodes_[body].time <= t && body != a && body != b) return true;
    }
    return false;
  }

  /// For prefetching. Buckets come one after the other, until they begin again at 0. `coming` writes the bodies of a
  /// later bucket to the front of `found`, and returns their number.
  [[nodiscard]] std::uint32_t present_bucket() const { return present_; }
  [[nodiscard]] std::size_t coming(std::uint32_t bucket, std::vector<std::uint32_t>& found) const {
    if (bucket >= buckets_.size()) return 0;
    found.resize(std::max(found.size(), std::size_t{2}));
    return buckets_.append_to(found, 0, bucket);
  }
  void ask_for(std::uint32_t body) const { prefetch(&nodes_[body]); }

 private:
  static constexpr Real never = std::numeric_limits<Real>::infinity();
  // The place of a body: in a bucket, in the heap, or in the list of waiting bodies.
  static constexpr std::uint32_t kind = 3u << 30, in_bucket = 0, in_heap = 1u << 30, later = 2u << 30, nowhere = kind;
  struct Node {
    Real time = never;
    std::uint32_t number = 0, place = nowhere;
  };
  struct Entry {
    Real time;
    std::uint32_t number, body;
    bool operator<(const Entry& other) const {
      return time < other.time || (time == other.time && number < other.number);
    }
  };

  void enter(std::uint32_t body, std::uint32_t to) {
    Node& node = nodes_[body];
    node.place = to;
    if (to == in_heap) {
      heap_.push_back({});
      rise(heap_.size() - 1, {node.time, node.number, body});
    } else if (to == later) {
      node.place = later | static_cast<std::uint32_t>(later_.size());
      later_.push_back(body);
      least_later_ = std::min(least_later_, node.time);
    } else if (to != nowhere) {
      buckets_.insert(to, body);
    }
  }
  void leave(std::uint32_t body) {
    const std::uint32_t place = nodes_[body].place, at = place & ~kind;
    if ((place & kind) == in_bucket) {
      buckets_.remove(at, body);
    } else if ((place & kind) == in_heap) {
      take_from_heap(at);
    } else if ((place & kind) == later) {
      later_[at] = later_.back();
      nodes_[later_[at]].place = place;
      later_.pop_back();
    }
  }
  [[nodiscard]] std::uint32_t place_for(const Real& time) const {
    if (!(time < never)) return nowhere;
    if (!(time > begin_)) return in_heap;
    const Real at = (time - begin_) * buckets_per_time_;
    if (!(at < static_cast<Real>(buckets_.size()))) return later;
    const auto bucket = static_cast<std::uint32_t>(at);
    return bucket < buckets_.size() ? (bucket < present_ ? in_heap : bucket) : later;
  }

  /// Moves the bodies of the next bucket that is not empty into the heap. Buckets before `present_` are used up.
  void fill_heap() {
    while (present_ < buckets_.size() && buckets_.is_empty(present_)) ++present_;
    if (present_ == buckets_.size()) return share_out();
    take_bucket();
  }
  void take_bucket() {
    const std::size_t count = coming(present_, waiting_);
    buckets_.clear(present_++);
    for (std::size_t i = 0; i < count; ++i) enter(waiting_[i], in_heap);
  }
  /// Distributes the earlier half of the waiting bodies among buckets, and the first of all into the heap.
  void share_out() {
    if (later_.empty()) return;
    waiting_.swap(later_);
    later_.clear();
    least_later_ = never;
    std::vector<Real> times(waiting_.size());
    for (std::size_t i = 0; i < times.size(); ++i) times[i] = nodes_[waiting_[i]].time;
    const auto half = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
    std::nth_element(times.begin(), half, times.end());
    begin_ = *std::min_element(times.begin(), half + 1);
    buckets_per_time_ = static_cast<Real>(buckets_.size()) / (*half - begin_);  // infinite where half come at once
    present_ = 0;
    for (const std::uint32_t body : waiting_) enter(body, place_for(nodes_[body].time));
  }

  void set_heap(std::size_t at, const Entry& entry) {
    heap_[at] = entry;
    nodes_[entry.body].place = in_heap | static_cast<std::uint32_t>(at);
  }
  void take_from_heap(std::size_t at) {
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
  ShortLists buckets_;
  std::vector<std::uint32_t> later_, waiting_;
  std::uint32_t present_ = 0;
  Real begin_ = std::numeric_limits<Real>::lowest(), buckets_per_time_ = never;  // until shared out: all wait
  Real least_later_ = never;                                                     // no waiting body has an earlier event
};

}  // namespace continuo
