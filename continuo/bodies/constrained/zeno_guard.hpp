// The rule against inelastic collapse under forces of any kind: it decides when flights are so short, or so expensive,
// that time steps through the contacts replace them.
#pragma once
#include <algorithm>
#include <cstdint>

namespace continuo {

/// A flight shorter than a step adds 1 to the count, a longer one subtracts its duration in steps. (Not counted are
/// flights that end where bodies meet fast: many of them are no sign of a collapse, and steps would locate them less
/// well.) At `full` some steps follow, and then flights are tried again. Each time that this fails, twice as many steps
/// follow.
class ZenoGuard {
 public:
  [[nodiscard]] bool is_in_steps() const { return steps_ > 0; }
  void has_stepped() { --steps_; }
  template <class Real>
  void has_flown(const Real& duration, const Real& step) {
    if (duration < step) {
      if (++count_ >= full) go_by_steps();
      return;
    }
    count_ = static_cast<std::int32_t>(std::max(Real(0), Real(static_cast<Real>(count_) - duration / step)));
    if (count_ == 0) next_ = fewest;
  }
  void go_by_steps() {
    steps_ = next_;
    next_ = std::min(2 * next_, most);
    count_ = full - 4;
  }

  [[nodiscard]] bool is_possible() const {
    return steps_ >= 0 && steps_ <= most && next_ >= fewest && next_ <= most && count_ >= 0 && count_ < full;
  }
  template <class Archive>
  void transfer(Archive& archive) {
    archive(steps_), archive(next_), archive(count_);
  }

 private:
  static constexpr std::int32_t full = 16, fewest = 16, most = 4096;
  std::int32_t steps_ = 0, next_ = fewest, count_ = 0;
};

}  // namespace continuo
