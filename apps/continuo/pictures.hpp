// apps/continuo/pictures.hpp
// The drawing of a model as pictures, by gnuplot: what the page shows, flat and without a browser.
#pragma once
#include <string>
#include <vector>

#include <apps/continuo/recorder.hpp>

#include <continuo/live/live_model.hpp>

namespace continuo::app {

/// Writes FOLDER/00001.png, ... Empty, or what went wrong.
std::string draw_pictures(const std::string& folder, const live::LiveModel& shown,
                          const std::vector<Recorder::Scene>& scenes);

}  // namespace continuo::app
