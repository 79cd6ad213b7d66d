// continuo/live/session/pending_slice.hpp
// The slice that the audience gets next, as it grows: rows, events, and from when on earlier rows are void.
#pragma once
#include <cstddef>
#include <memory>

#include <continuo/live/audience.hpp>
#include <continuo/live/motion/bends.hpp>

namespace continuo::live {

class PendingSlice {
 public:
  /// A run begins: nothing of the one before.
  void clear() { slice_ = std::make_shared<Slice>(); }
  void add(const Row& row);
  /// Keeps the first few hundred events of a slice.
  void add(LiveEvent event);
  /// Rows at t or later, and events after t, are void. A row has `columns` values, and `paths` numbers of trails.
  void rewind_to(double t, std::size_t columns, std::size_t paths);

  /// Whether the next picture differs from the last one.
  bool has_changed() const { return changed_; }
  void mark_changed() { changed_ = true; }
  /// The slice itself, for the values that are known only when it is published.
  Slice& slice() { return *slice_; }
  std::shared_ptr<const Slice> take();

 private:
  std::shared_ptr<Slice> slice_ = std::make_shared<Slice>();
  bool changed_ = false;
};

}  // namespace continuo::live
