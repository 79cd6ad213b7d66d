// What a model's `draw` says, in a picture.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

#include <apps/continuo/pictures/picture_parts.hpp>
#include <apps/continuo/pictures/recorder.hpp>

#include <continuo/live/live_model.hpp>

namespace continuo::app {

/// Without what gnuplot would take for its own.
std::string safe_text(std::string_view text);

/// "t = 1.500 s".
std::string title_of(double t, const live::LiveModel& shown);

/// All that is ever drawn, so that it is within the frame.
void take_scene(const live::LiveModel& shown, const Recorder::Slices& slices, PictureFrame& frame);
/// The picture of that number.
void draw_scene(const live::LiveModel& shown, const Recorder::Slices& slices, std::size_t number,
                const PictureFrame& frame, PictureParts& parts);

}  // namespace continuo::app
