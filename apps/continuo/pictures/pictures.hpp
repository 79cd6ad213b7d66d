// What the page shows as pictures, by gnuplot: flat and without a browser.
#pragma once
#include <functional>
#include <string>

#include <apps/continuo/pictures/recorder.hpp>

#include <continuo/live/session.hpp>
#include <continuo/status/status.hpp>

namespace continuo::app {

/// Writes FOLDER/00001.png, ...: drawing and bodies of the model, or its plots where it has neither. `progress`, if
/// any, hears which part is done. Ends early where the user interrupts.
Status draw_pictures(const std::string& folder, const live::Session& session, const Recorder::Slices& slices,
                     const std::function<void(double part)>& progress);

}  // namespace continuo::app
