// The pictures of a view as one file that moves: GIF by itself, MP4 by ffmpeg.
#pragma once
#include <string>

#include <apps/continuo/pictures/recorder.hpp>
#include <apps/continuo/terminal/exit_codes.hpp>

#include <continuo/live/session.hpp>

namespace continuo::app {

/// Whether the name's ending is that of a film: .gif or .mp4.
bool is_film(const std::string& path);

/// False, after saying why, where the program for such a film is not there.
bool can_film(const std::string& path);

/// The film is there whole, or not at all: interrupted, it leaves what was there before.
ExitCode write_film(const std::string& path, double rate, const live::Session& session, const Recorder::Slices& slices);

}  // namespace continuo::app
