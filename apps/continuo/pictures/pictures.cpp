// Runs gnuplot for all pictures of a view, and keeps those that were written in full.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include <apps/continuo/pictures/body_pictures.hpp>
#include <apps/continuo/pictures/pictures.hpp>
#include <apps/continuo/pictures/plot_pictures.hpp>
#include <apps/continuo/pictures/scene_pictures.hpp>
#include <apps/continuo/terminal/interrupt.hpp>
#include <apps/continuo/terminal/own_process.hpp>
#include <apps/continuo/terminal/program.hpp>
#include <fmt/format.h>

#include <continuo/results/output_file.hpp>

namespace continuo::app {
namespace {

constexpr int width = 960, height = 720;  // pixels

Status unwritable(std::string message) {
  return {.ending = Ending::unwritable, .message = std::move(message)};
}

/// With a margin, and as wide and high as the picture, so that what moves along a line has room to move. What is left
/// over upwards goes above a floor on which the scene stands, as on the page.
PictureFrame with_margin(const PictureFrame& scene) {
  constexpr double aspect = static_cast<double>(width) / height, margin = 1.16, below_floor = 0.14;
  const double high = margin * std::max({scene.high - scene.low, (scene.right - scene.left) / aspect, 1e-9});
  const double middle = (scene.left + scene.right) / 2;
  PictureFrame frame = scene;
  frame.left = middle - aspect * high / 2, frame.right = middle + aspect * high / 2;
  frame.low = (scene.low + scene.high - high) / 2;
  if (scene.low >= scene.floor - 0.02 * high) frame.low = std::max(frame.low, scene.floor - below_floor * high);
  frame.high = frame.low + high;
  return frame;
}

/// The drawing of a model and its bodies.
class ScenePictures {
 public:
  ScenePictures(const live::Session& session, const Recorder::Slices& slices)
      : shown_(session.shown()), slices_(slices) {
    PictureFrame frame;
    take_scene(shown_, slices, frame);
    if (session.world()) {
      bodies_.emplace(*session.world());
      for (const auto& slice : slices) bodies_->take(*slice->bodies, frame);
      bodies_->take_meshes(frame);
    }
    if (!frame.empty()) frame_ = with_margin(frame);
  }
  bool is_empty() const { return frame_.empty(); }

  std::string set_up() const {
    return fmt::format(
        "set size ratio -1\nset xrange [{}:{}]\nset yrange [{}:{}]\nset grid lc rgb '#e6eaef'\n"
        "set border lc rgb '#c8d0d8'\nset tics textcolor rgb '#5c6b7a'\n",
        frame_.left, frame_.right, frame_.low, frame_.high);
  }
  std::string commands(std::size_t number) const {
    PictureParts parts;
    if (bodies_) {
      bodies_->draw_walls(frame_, parts);
      bodies_->draw_meshes(frame_, parts);
      bodies_->draw(*slices_[number]->bodies, parts);
    }
    draw_scene(shown_, slices_, number, frame_, parts);
    return fmt::format("unset object\nunset label\nunset arrow\n{}set title '{}'\nplot {}\n{}", parts.objects,
                       title_of(slices_[number]->t, shown_), parts.curves.empty() ? "NaN notitle" : parts.curves,
                       parts.data);
  }

 private:
  const live::LiveModel& shown_;
  const Recorder::Slices& slices_;
  std::optional<BodyPictures> bodies_;
  PictureFrame frame_;
};

Status run_gnuplot(const ScratchFolder& scratch, const std::string& folder, const std::string& script) {
  const std::string program = scratch.file("pictures.gnuplot");
  if (Status status = results::write_file(program, script); !status) return status;
  const int exit = run_program({"gnuplot", program});
  if (exit == -1) return unwritable("pictures are drawn by gnuplot, which is not installed");
  return exit == 0 ? Status() : unwritable(fmt::format("gnuplot could not draw into {}", folder));
}

std::filesystem::path picture_of(const std::string& folder, std::size_t number) {
  return std::filesystem::path(folder) / fmt::format("{:05d}.png", number + 1);
}
std::filesystem::path part_of(const std::filesystem::path& picture) {
  return picture.string() + ".part";
}

/// Whether its last chunk is there.
bool is_whole(const std::filesystem::path& picture) {
  static constexpr std::string_view end("\0\0\0\0IEND\xAE\x42\x60\x82", 12);
  std::ifstream file(picture, std::ios::binary);
  std::string last(end.size(), ' ');
  file.seekg(-static_cast<std::streamoff>(end.size()), std::ios::end);
  return file.read(last.data(), static_cast<std::streamsize>(last.size())) && last == end;
}

/// Gives the pictures from `first` to before `end` their names, or says which could not be written: gnuplot does not
/// see that a disk is full. What stood there before is replaced by whole pictures alone.
Status keep_whole(const std::string& folder, std::size_t first, std::size_t end) {
  Status status;
  for (std::size_t k = first; k < end; ++k) {
    const std::filesystem::path picture = picture_of(folder, k), part = part_of(picture);
    std::error_code error;
    const bool whole = status && is_whole(part);
    if (whole) std::filesystem::rename(part, picture, error);
    if (whole && !error) continue;
    if (status)
      status = unwritable(fmt::format(
          "cannot write {}{}; {}", picture.string(), error ? ": " + error.message() : " whole: the disk may be full",
          k == 0 ? "no picture was written" : fmt::format("those up to {:05d}.png are there", k)));
    std::filesystem::remove(part, error);
  }
  return status;
}

/// So many pictures at a time as fit into memory well.
template <class Pictures>
Status draw_all(const std::string& folder, const std::string& set_up, const Pictures& pictures, std::size_t count,
                const std::function<void(double part)>& progress) {
  constexpr std::size_t much = std::size_t{32} << 20;  // bytes
  constexpr std::size_t many = 50;                     // pictures: then somebody hears how far it is
  const ScratchFolder scratch;
  if (!scratch.exists()) return unwritable("cannot make a folder for what gnuplot reads");
  const std::string head = fmt::format("cd '{}'\nset terminal pngcairo size {},{} font ',11' noenhanced\n{}",
                                       std::filesystem::absolute(folder).string(), width, height, set_up);
  std::string script;
  std::size_t first = 0;
  for (std::size_t k = 0; k < count; ++k) {
    script += fmt::format("set output '{}'\n{}", part_of(picture_of("", k)).string(), pictures.commands(k));
    if (script.size() < much && k + 1 < std::min(count, first + many)) continue;
    // The last picture is written when the next one begins, or gnuplot ends.
    Status drawn = run_gnuplot(scratch, folder, head + script), kept = keep_whole(folder, first, k + 1);
    if (interrupt_flag().load())
      return {.ending = Ending::interrupted,
              .message = fmt::format("interrupted after {} of {} pictures", first, count)};
    if (Status status = first_failure(std::move(drawn), std::move(kept)); !status) return status;
    if (progress) progress(static_cast<double>(k + 1) / static_cast<double>(count));
    script.clear();
    first = k + 1;
  }
  return {};
}

}  // namespace

Status draw_pictures(const std::string& folder, const live::Session& session, const Recorder::Slices& slices,
                     const std::function<void(double part)>& progress) {
  if (folder.find('\'') != std::string::npos || folder.find('\n') != std::string::npos)
    return invalid_input(fmt::format("gnuplot cannot write into a folder of this name: {}", folder));
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return unwritable(fmt::format("cannot make {}: {}", folder, error.message()));
  if (session.shown().drawing.empty() && !session.world()) {
    const PlotPictures pictures(session.shown(), slices);
    return draw_all(folder, pictures.data(), pictures, slices.size(), progress);
  }
  const ScenePictures pictures(session, slices);
  if (pictures.is_empty()) return invalid_input("nothing of the drawing has a place");
  return draw_all(folder, pictures.set_up(), pictures, slices.size(), progress);
}

}  // namespace continuo::app
