// continuo/live/session/interaction.hpp
// What somebody at the page chooses while the motion goes on: parameters, inputs, methods, a ghost; and what of it can
// be undone.
#pragma once
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <continuo/live/motion/clock.hpp>
#include <continuo/live/session/notices.hpp>
#include <continuo/live/session/playback.hpp>
#include <continuo/live/settings.hpp>

namespace continuo::live {

/// Whether a change has taken effect, or the text has to be checked anew with it: parameters may decide how many
/// equations there are.
enum class Change { made, needs_check };

class Interaction {
 public:
  /// The arguments outlive the interaction. `on_new_program` is called when the program of the run that is shown has
  /// been made anew.
  Interaction(const WallClock& now, const ModelText& text, Playback& playback, Notices& notices, Keys keys,
              std::function<void()> on_new_program)
      : now_(now),
        text_(text),
        playback_(playback),
        notices_(notices),
        keys_(keys),
        on_new_program_(std::move(on_new_program)) {}

  const Settings& settings() const { return settings_; }
  std::size_t undo_count() const { return undo_.size(); }
  void set_settings(Settings settings) { settings_ = std::move(settings); }
  /// For another model: nothing is chosen, and nothing can be undone.
  void forget_all() { settings_ = {}, undo_.clear(); }
  /// For another text of the same model, which may lack some parameters.
  void forget_unknown_parameters(const model::Model& model);
  /// For a ghost that could not begin or has come to its end.
  void forget_ghost() { settings_.ghost.reset(); }

  [[nodiscard]] Change set_parameter(const std::string& name, double value);
  [[nodiscard]] Change restore_parameters();
  [[nodiscard]] Change undo();
  void move_input(const std::string& name, double value);
  /// False where the model cannot be run by this method: the notices keep the reason.
  bool take_method(MethodChoice choice);
  void take_ghost(std::optional<MethodChoice> choice);

 private:
  struct Undo {
    std::string what;
    double wall;
    Settings settings;
  };

  void remember_for_undo(const std::string& what, bool for_long = false);
  void keep_undo(Undo undo);
  Change apply(const Settings& settings);
  bool differ_in_structure(const model::Overrides& a, const model::Overrides& b) const;
  void use_settings();
  Variables present_variables(const model::Model& model) const;
  void prepare_anew();
  std::unique_ptr<Track> track_by(const MethodChoice& choice) const;
  bool change_method(MethodChoice choice);
  bool change_ghost(std::optional<MethodChoice> choice);
  const model::Model& model() const { return playback_.shown()->model(); }

  const WallClock& now_;
  const ModelText& text_;
  Playback& playback_;
  Notices& notices_;
  Keys keys_;
  std::function<void()> on_new_program_;
  Settings settings_;
  std::vector<Undo> undo_;
};

}  // namespace continuo::live
