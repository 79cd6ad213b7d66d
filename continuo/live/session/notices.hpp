// continuo/live/session/notices.hpp
// Diagnostics and notes to the audience, with their place in the text that is open.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include <continuo/language/load.hpp>
#include <continuo/language/text/diagnostic.hpp>
#include <continuo/live/audience.hpp>

namespace continuo::live {

/// The model's text that is open, and its file. One that did not come over the network is trusted: it may have any
/// files read, and not only those of the model's folder.
struct ModelText {
  std::string path{}, text{};
  bool trusted = false;
};
/// Reads the text as a model, with these values of parameters.
[[nodiscard]] model::Loaded load(const ModelText& text, const model::Overrides& overrides = {});

class Notices {
 public:
  /// The arguments outlive it; the text may change.
  Notices(Audience& audience, const ModelText& text) : audience_(audience), text_(text) {}

  /// `source`: the text that the diagnostic is about, where it is not the open one.
  void say(const model::Diagnostic& problem, const model::Source* source = nullptr);
  void note(std::string text, std::string hint = {});

  /// Why the last run that was asked for could not begin.
  const std::vector<model::Diagnostic>& problems() const { return problems_; }
  void set_problems(std::vector<model::Diagnostic> problems) { problems_ = std::move(problems); }

 private:
  Audience& audience_;
  const ModelText& text_;
  std::vector<model::Diagnostic> problems_;
};

}  // namespace continuo::live
