// continuo/live/motion/history.cpp
// Keeps samples within a bound of memory, and thins the older ones.
#include <algorithm>
#include <utility>

#include <continuo/live/motion/history.hpp>

namespace continuo::live {

std::size_t History::bytes_of(const Sample& sample) {
  const auto of_instant = [](const Instant& instant) {
    std::size_t numbers = instant.x.size() + instant.stops.size();
    if (instant.world) numbers += instant.world->equations.size() + instant.world->variables.size();
    return numbers * sizeof(double) + (instant.world ? instant.world->bodies.size() : 0);
  };
  return sizeof(Sample) + of_instant(sample.main) + (sample.ghost ? of_instant(*sample.ghost) : 0);
}

void History::add(Sample sample) {
  bytes_ += bytes_of(sample);
  samples_.push_back(std::move(sample));
  if (bytes_ > most_bytes_) thin();
  while (samples_.size() > 1 && (bytes_ > most_bytes_ || samples_.size() > most_samples_)) {
    bytes_ -= bytes_of(samples_.front());
    samples_.pop_front();
  }
}

/// Deletes every second moment of the older half: the distant past is kept at a lower resolution.
void History::thin() {
  std::deque<Sample> kept;
  const std::size_t half = samples_.size() / 2;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    if (i < half && i % 2 == 1) {
      bytes_ -= bytes_of(samples_[i]);
    } else {
      kept.push_back(std::move(samples_[i]));
    }
  }
  samples_ = std::move(kept);
}

void History::clear() {
  samples_.clear();
  bytes_ = 0;
}

void History::forget_last() {
  bytes_ -= bytes_of(samples_.back());
  samples_.pop_back();
}

void History::cut_from(double t) {
  while (!samples_.empty() && samples_.back().main.t >= t) forget_last();
}

std::size_t History::index_at(double t) const {
  const auto after = std::ranges::upper_bound(samples_, t, {}, [](const Sample& sample) { return sample.main.t; });
  return after == samples_.begin() ? 0 : static_cast<std::size_t>(after - samples_.begin()) - 1;
}

}  // namespace continuo::live
