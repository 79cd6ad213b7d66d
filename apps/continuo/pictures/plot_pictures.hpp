// The plots of a model as pictures, for those that draw nothing: each with the curves as far as its time.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <apps/continuo/pictures/recorder.hpp>

#include <continuo/live/live_model.hpp>

namespace continuo::app {

class PlotPictures {
 public:
  PlotPictures(const live::LiveModel& shown, const Recorder::Slices& slices);

  /// All rows, once for all pictures of a script.
  const std::string& data() const { return data_; }
  std::string commands(std::size_t number) const;

 private:
  struct Extremes {
    double low = INFINITY, high = -INFINITY;
    void take(double value) { low = std::min(low, value), high = std::max(high, value); }
    void take(const Extremes& other) { low = std::min(low, other.low), high = std::max(high, other.high); }
  };
  std::string ranges_of(const live::LivePlot& plot) const;

  const live::LiveModel& shown_;
  std::string data_;
  std::vector<Extremes> extremes_;  // of each column, over the whole film
  std::vector<std::size_t> rows_;   // until each picture
  std::vector<double> t_;           // of each
  double end_ = 0;
};

}  // namespace continuo::app
