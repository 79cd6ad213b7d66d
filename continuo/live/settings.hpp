// continuo/live/settings.hpp
// What somebody at the page may choose, and where the models come from.
#pragma once
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <continuo/language/model.hpp>

namespace continuo::live {

/// What is not set is as the model says; a step takes the place of a tolerance and the other way round.
struct MethodChoice {
  std::optional<std::string> name{};
  std::optional<double> step{}, rtol{};
};

/// What can be undone.
struct Settings {
  model::Overrides parameters{}, inputs{};
  std::set<std::string, std::less<>> taken{};  // inputs that no longer follow their files
  MethodChoice method{};
  std::optional<MethodChoice> ghost{};
};

/// A model that can be opened: its name, the first line of its heading, its file, and the subject it belongs to.
struct GalleryModel {
  std::string name, title, path, subject{};
};

/// Whether somebody may press keys. Inputs that have one do not follow their files then.
enum class Keys : std::uint8_t { are_pressed, rest };

/// Where models come from.
struct Place {
  std::string path;                     // of the model that was named: the only file that is ever written; empty: none
  std::vector<GalleryModel> gallery{};  // what can be opened besides
  bool writable = true;                 // the file of the model
  Keys keys = Keys::are_pressed;        // of inputs
};

/// The models of a folder, each with the first line of its heading. A file `gallery.txt` in the folder gives their
/// order and their subjects: a line is a subject, the indented lines below it are models. Others follow by name.
[[nodiscard]] std::vector<GalleryModel> gallery_in(const std::string& folder);

}  // namespace continuo::live
