// continuo/language/load.hpp
// A model file in, a checked model out.
//
//   Loaded loaded = load("models/bouncing_ball.sim");
//   if (!loaded) { std::cerr << loaded.text(); return 2; }
//   simulate(*loaded.model);
#pragma once
#include <optional>
#include <string>
#include <vector>

#include <continuo/language/check/check_options.hpp>
#include <continuo/language/model.hpp>
#include <continuo/language/text/diagnostic.hpp>
#include <continuo/language/text/source.hpp>

namespace continuo::model {

/// A model that was read, with its messages.
struct Loaded {
  Source source;
  std::optional<Model> model;           // there iff no diagnostic is an error
  std::vector<Diagnostic> diagnostics;  // errors of the parser and the checks, or warnings

  /// Whether there is a model.
  explicit operator bool() const { return model.has_value(); }
  /// All diagnostics as shown on a terminal.
  [[nodiscard]] std::string text(const RenderOptions& options = {}) const {
    return render(diagnostics, source, options);
  }
};

/// Reads, parses and checks. Files of tables and inputs are found relative to the model's folder.
[[nodiscard]] Loaded load(const std::string& path, const CheckOptions& options = {});
/// The same for a text that is in memory already.
[[nodiscard]] Loaded load(Source source, const CheckOptions& options = {});

}  // namespace continuo::model
