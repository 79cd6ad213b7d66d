// Diagnostics and notes as messages of the protocol.
#include <utility>

#include <continuo/live/session/messages.hpp>
#include <continuo/live/session/notices.hpp>

namespace continuo::live {

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
