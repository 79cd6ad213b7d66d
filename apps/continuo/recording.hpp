// apps/continuo/recording.hpp
// A view without anybody who looks: as one page that replays it, as pictures, as a film.
#pragma once
#include <optional>
#include <string>

#include <apps/continuo/exit_codes.hpp>
#include <apps/continuo/experiment_options.hpp>

namespace continuo::app {

struct RecordingRequest {
  std::string page, pictures;
  double rate = 30;  // pictures a second
  bool wanted() const { return !page.empty() || !pictures.empty(); }
};

/// `page`: that of the live view, compressed.
ExitCode record(const RecordingRequest& request, const ExperimentOptions& experiment, const std::string& page);

}  // namespace continuo::app
