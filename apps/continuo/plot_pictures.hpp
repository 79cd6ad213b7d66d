// The plots of a model as pictures, for those that draw nothing: each with the curves as far as its time.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include <apps/continuo/recorder.hpp>

#include <continuo/live/live_model.hpp>

namespace continuo::app {

class PlotPictures {
 public:
  PlotPictures(const live::LiveModel& shown, const Recorder::Slices& slices);

  /// All rows, once for all pictures of a script.
  const std::string& data() const { return data_; }
  std::string commands(std::size_t number) const;

 private:
  const live::LiveModel& shown_;
  std::string data_;
  std::vector<std::size_t> rows_;  // until each picture
  std::vector<double> t_;          // of each
  double end_ = 0;
};

}  // namespace continuo::app
