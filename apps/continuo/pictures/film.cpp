// Draws pictures into a folder of its own and makes a film of them, under another name until it is whole.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include <apps/continuo/pictures/film.hpp>
#include <apps/continuo/pictures/gif.hpp>
#include <apps/continuo/pictures/pictures.hpp>
#include <apps/continuo/terminal/interrupt.hpp>
#include <apps/continuo/terminal/own_process.hpp>
#include <apps/continuo/terminal/program.hpp>
#include <apps/continuo/terminal/progress.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>

namespace continuo::app {
namespace {

constexpr double share_of_drawing = 0.7;  // of the time that a film takes

std::string ending_of(const std::string& path) {
  return std::filesystem::path(path).extension().string();
}

std::string picture_in(const std::string& folder, std::size_t number) {
  return fmt::format("{}/{:05d}.png", folder, number + 1);
}

ExitCode write_mp4(const std::string& part, double rate, const std::string& folder) {
  const int exit = run_program({"ffmpeg", "-y", "-framerate", fmt::format("{}", rate), "-i", folder + "/%05d.png",
                                "-pix_fmt", "yuv420p", "-movflags", "+faststart", "-f", "mp4", part});
  if (exit == 0) return done;
  if (interrupt_flag().load()) return interrupted;
  say(exit == -1 ? "ffmpeg was ended before it had written the film; --record FOLDER writes pictures"
                 : "ffmpeg could not write the film; --record FOLDER writes pictures");
  return usage;
}

/// The palette comes from so many pictures of the whole film.
std::vector<std::uint32_t> palette_for(const std::string& folder, std::size_t count) {
  constexpr std::size_t samples = 12;
  std::vector<Image> images;
  for (std::size_t k = 0; k < std::min(samples, count); ++k) {
    const std::size_t number = count > samples ? k * (count - 1) / (samples - 1) : k;
    if (auto image = read_png(contents_of(picture_in(folder, number)))) images.push_back(*std::move(image));
  }
  return palette_of(images);
}

ExitCode write_gif(const std::string& part, double rate, const std::string& folder, std::size_t count,
                   const std::function<void(double)>& progress) {
  std::ofstream file(part, std::ios::binary | std::ios::trunc);
  std::optional<Gif> gif;
  const auto time = [&](std::size_t k) { return std::lround(100 * static_cast<double>(k) / rate); };
  for (std::size_t k = 0; k < count; ++k) {
    if (interrupt_flag().load()) return interrupted;
    const auto image = read_png(contents_of(picture_in(folder, k)));
    if (!image) {
      say(fmt::format("cannot read picture {} of the film", k + 1));
      return usage;
    }
    if (!gif) gif.emplace(file, palette_for(folder, count), image->width, image->height);
    const bool is_last = k + 1 == count;
    gif->add(*image, static_cast<int>(is_last ? 100 : time(k + 1) - time(k)));  // the end stays for a second
    if (progress) progress(static_cast<double>(k + 1) / static_cast<double>(count));
  }
  if (gif) gif->end();
  file.close();
  if (file) return done;
  say("the film could not be written whole: the disk may be full");
  return usage;
}

}  // namespace

bool is_film(const std::string& path) {
  return ending_of(path) == ".mp4" || ending_of(path) == ".gif";
}

bool can_film(const std::string& path) {
  if (ending_of(path) != ".mp4" || run_program({"ffmpeg", "-version"}) == 0) return true;
  say("an MP4 needs ffmpeg, which is not installed (apt-get install ffmpeg); a .gif needs nothing more");
  return false;
}

ExitCode write_film(const std::string& path, double rate, const live::Session& session,
                    const Recorder::Slices& slices) {
  const ScratchFolder scratch;
  if (!scratch.exists()) {
    say("cannot make a folder for the pictures of the film");
    return usage;
  }
  const std::string folder = scratch.file("pictures"), part = path + ".part";
  std::optional<Progress> progress(std::in_place);
  const Status drawn = draw_pictures(folder, session, slices, progress->parts(0, share_of_drawing));
  if (!drawn) progress.reset();  // its line goes before the message comes
  if (!written(drawn)) return drawn.ending == Ending::interrupted ? interrupted : usage;
  ExitCode exit = ending_of(path) == ".gif" ? write_gif(part, rate, folder, slices.size(),
                                                        progress->parts(share_of_drawing, 1 - share_of_drawing))
                                            : write_mp4(part, rate, folder);
  progress.reset();
  std::error_code error;
  if (exit == done) std::filesystem::rename(part, path, error);
  if (error) {
    say(fmt::format("cannot write {}: {}", path, error.message()));
    exit = usage;
  }
  if (exit != done) std::filesystem::remove(part, error);
  if (exit == interrupted) say(fmt::format("interrupted: {} was not written", path));
  return exit;
}

}  // namespace continuo::app
