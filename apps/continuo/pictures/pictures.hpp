// What the page shows as pictures, by gnuplot: flat and without a browser.
#pragma once
#include <string>

#include <apps/continuo/pictures/recorder.hpp>

#include <continuo/live/session.hpp>
#include <continuo/status/status.hpp>

namespace continuo::app {

/// Writes FOLDER/00001.png, ...: drawing and bodies of the model, or its plots where it has neither.
Status draw_pictures(const std::string& folder, const live::Session& session, const Recorder::Slices& slices);

}  // namespace continuo::app
