// apps/continuo/pictures/recording.hpp
// A view without anybody who looks: as one page that replays it, as pictures, as a film.
#pragma once
#include <functional>
#include <optional>
#include <string>

#include <apps/continuo/terminal/exit_codes.hpp>

#include <continuo/live/session.hpp>

namespace continuo::app {

struct RecordingRequest {
  std::string page, pictures;
  std::string model;            // its file
  std::optional<double> until;  // else as long as the text says
  double rate = 30;             // pictures a second
  bool wanted() const { return !page.empty() || !pictures.empty(); }
};

/// Opens the model of the session and sets what the command line asks for; says what is wrong.
using SetUp = std::function<ExitCode(live::Session&)>;

/// `page`: that of the live view, compressed.
ExitCode record(const RecordingRequest& request, const SetUp& set_up, const std::string& page);

}  // namespace continuo::app
