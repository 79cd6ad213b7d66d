// continuo/live/motion/bends.hpp
// The plotted values of one instant, and whether a curve would miss one that is left out.
#pragma once
#include <cstddef>
#include <vector>

#include <continuo/live/live_model.hpp>

namespace continuo::live {

struct Row {
  double t;
  std::vector<float> values, ghost, path, ghost_path;  // as frames have them, the latter two of trails
};

/// Watches rows as they come: how far the curves and trails of a model reach, and whether they bend.
class Bends {
 public:
  Bends() = default;
  explicit Bends(const LiveModel& shown);

  /// Where there is so much in a row that more of them than pictures are not worth it.
  bool too_wide() const { return too_wide_; }
  void see(const Row& row);
  /// The straight line from `a` to `b` passes the row between them by more than can be overlooked.
  bool between(const Row& a, const Row& middle, const Row& b) const;

 private:
  struct Range {
    float low, high;
    void take(float value);
    float width() const { return high > low ? high - low : 0; }
    float largest() const;
  };

  bool too_wide_ = true;
  std::vector<std::size_t> columns_;  // those of the plots
  std::vector<Range> ranges_;         // theirs
  std::vector<Range> reach_;          // of the paths
};

}  // namespace continuo::live
