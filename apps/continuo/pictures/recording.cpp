// apps/continuo/pictures/recording.cpp
// Plays a session from beginning to end and writes it as a page, pictures or a film.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include <apps/continuo/pictures/film.hpp>
#include <apps/continuo/pictures/pictures.hpp>
#include <apps/continuo/pictures/recorder.hpp>
#include <apps/continuo/pictures/recording.hpp>
#include <apps/continuo/terminal/progress.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>

#include <continuo/live/server/gzip.hpp>
#include <continuo/results/output_file.hpp>

namespace continuo::app {
namespace {

constexpr std::string_view marker = "<!--recording-->";

/// At a clock of its own, which moves from picture to picture and never within one.
void play_to(double until, double rate, double& wall, live::Session& session) {
  session.set_rate(rate);
  session.play();
  while (!session.has_ended() && session.shown_time() < until) {
    wall += 1 / rate;
    session.turn();
  }
  session.pause();
  session.turn();
}

ExitCode write_page(const std::string& path, const std::string& compressed, const Recorder& recorder) {
  std::string page = live::unzipped(compressed);
  const std::size_t place = page.find(marker);
  if (place == std::string::npos) {
    say(page.empty() ? "this build has no page to replay a run: build with -DCONTINUO_PAGE=ON, or give --page FILE"
                     : "the page has no place for a recording");
    return usage;
  }
  page.replace(place, marker.size(), recorder.element());
  return written(results::write_file(path, page)) ? done : usage;
}

/// What somebody who wants another format would write.
bool is_one_file(const std::string& path) {
  static constexpr std::array<std::string_view, 9> endings = {".avi", ".mov", ".webm", ".mkv", ".mpg",
                                                              ".m4v", ".png", ".jpg",  ".svg"};
  return std::ranges::find(endings, std::filesystem::path(path).extension().string()) != endings.end();
}

}  // namespace

ExitCode record(const RecordingRequest& request, const SetUp& set_up, const std::string& page) {
  const bool film = is_film(request.pictures);
  if (!film && is_one_file(request.pictures)) {
    say(fmt::format("cannot record {}: pictures need a folder, and the name of a film ends in .gif or .mp4",
                    request.pictures));
    return usage;
  }
  if (film && !can_film(request.pictures)) return usage;
  double wall = 0;
  Recorder recorder;
  live::Session session([&wall] { return wall; }, recorder, {.path = request.model, .keys = live::Keys::rest});
  if (const ExitCode exit = set_up(session); exit != done) return exit;
  recorder.begin();
  session.reset();
  session.turn();
  const double until = request.until.value_or(session.planned_end());
  if (!(until > session.shown_time() && std::isfinite(until))) {
    say(fmt::format("--until must be after the start of the run, t = {:g}", session.shown_time()));
    return usage;
  }
  play_to(until, request.rate, wall, session);
  ExitCode exit = done;
  if (!request.page.empty()) exit = write_page(request.page, page, recorder);
  if (exit != done || request.pictures.empty()) return exit;
  if (film) return write_film(request.pictures, request.rate, session, recorder.slices());
  std::optional<Progress> progress(std::in_place);  // its line goes before a message comes
  const Status status = draw_pictures(request.pictures, session, recorder.slices(), progress->parts());
  progress.reset();
  return written(status) ? done : status.ending == Ending::interrupted ? interrupted : usage;
}

}  // namespace continuo::app
