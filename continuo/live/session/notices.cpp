// Diagnostics and notes as messages of the protocol.
#include <utility>

#include <continuo/language/load_confined.hpp>
#include <continuo/live/session/messages.hpp>
#include <continuo/live/session/notices.hpp>

namespace continuo::live {

model::Loaded load(const ModelText& text, const model::Overrides& overrides) {
  model::Source source(text.path, text.text);
  const model::CheckOptions options{.overrides = overrides};
  return text.trusted ? model::load(std::move(source), options) : model::load_confined(std::move(source), options);
}

void Notices::say(const model::Diagnostic& problem, const model::Source* source) {
  const model::Source own(text_.path, text_.text);
  audience_.hear(Topic::message, message_json(problem, source ? *source : own));
}

void Notices::note(std::string text, std::string hint) {
  model::Diagnostic note = model::warning("", {}, std::move(text), {}, std::move(hint));
  note.severity = model::Severity::note;
  say(note);
}

}  // namespace continuo::live
