// continuo/live/motion/history.hpp
// The moments that were shown, each with what it takes to go on from there: the last minutes, in bounded memory.
#pragma once
#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include <continuo/live/live_model.hpp>
#include <continuo/live/motion/track.hpp>

namespace continuo::live {

struct Sample {
  Instant main;
  std::optional<Instant> ghost;
  Variables variables;      // as they were
  double first_energy = 0;  // what the drift is measured from
};

class History {
 public:
  explicit History(std::size_t most_bytes = std::size_t{64} << 20, std::size_t most_samples = 60 * 60 * 10)
      : most_bytes_(most_bytes), most_samples_(most_samples) {}

  void add(Sample sample);
  void clear();
  /// Forgets what is at or after t.
  void cut_from(double t);

  bool empty() const { return samples_.empty(); }
  std::size_t size() const { return samples_.size(); }
  const Sample& operator[](std::size_t i) const { return samples_[i]; }
  const Sample& back() const { return samples_.back(); }
  double first_time() const { return samples_.front().main.t; }
  double last_time() const { return samples_.back().main.t; }
  /// The last sample not after t; the first where there is none.
  std::size_t index_at(double t) const;
  std::size_t bytes() const { return bytes_; }

 private:
  static std::size_t bytes_of(const Sample& sample);
  void forget_last();
  void thin();

  std::size_t most_bytes_, most_samples_, bytes_ = 0;
  std::deque<Sample> samples_;
};

}  // namespace continuo::live
