// tests/live/spectator.hpp
// A session without threads: the test provides the clock and the audience.
#pragma once
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <continuo/live/session.hpp>

namespace continuo::live {

class Spectator final : public Audience {
 public:
  void see(std::shared_ptr<const Slice> slice) override { slices.push_back(std::move(slice)); }
  void hear(Topic, std::string json) override { texts.push_back(nlohmann::json::parse(json)); }

  /// The messages of this kind.
  std::vector<nlohmann::json> said(const std::string& what) const {
    std::vector<nlohmann::json> found;
    for (const auto& text : texts) {
      if (text["say"] == what) found.push_back(text);
    }
    return found;
  }

  std::vector<std::shared_ptr<const Slice>> slices;
  std::vector<nlohmann::json> texts;
};

/// A model of the test's own, or of the gallery, with its clock.
class Stage {
 public:
  explicit Stage(const std::string& text_or_name, Keys keys = Keys::are_pressed) : path(file_of(text_or_name)) {
    session = std::make_unique<Session>(
        [this] {
          wall += cost;
          return wall;
        },
        audience, Place{.path = path, .keys = keys});
    const model::Loaded loaded = session->open_file();
    EXPECT_TRUE(loaded.model) << loaded.text();
  }

  /// Runs the session at 60 pictures a second for this wall time.
  void run(double seconds) {
    for (const double end = wall + seconds; wall < end - 1e-9;) {
      const double due = wall + 1.0 / 60;
      session->turn();
      wall = std::max(wall, due);
    }
    session->turn();
  }
  void play(double seconds) {
    session->play();
    run(seconds);
  }

  std::size_t column(const std::string& name) const {
    const auto& columns = session->shown().columns;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (columns[i].name == name) return i;
    }
    ADD_FAILURE() << "no column " << name;
    return 0;
  }
  /// Of the last moment in the history, in double.
  double state(const std::string& name) const { return session->history().back().main.x[column(name)]; }
  /// As a client gets it, of the newest row.
  double shown(const std::string& name) const {
    for (auto slice = audience.slices.rbegin(); slice != audience.slices.rend(); ++slice) {
      const std::size_t columns = session->shown().columns.size(), rows = (*slice)->row_t.size();
      if (rows > 0) return static_cast<double>((*slice)->rows[(rows - 1) * columns + column(name)]);
    }
    return std::nan("");
  }

  std::string path;  // of the model
  Spectator audience;
  double wall = 100, cost = 0;  // cost: seconds that each reading of the clock takes
  std::unique_ptr<Session> session;

 private:
  static std::string file_of(const std::string& text_or_name);
};

}  // namespace continuo::live
