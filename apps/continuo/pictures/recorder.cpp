// apps/continuo/pictures/recorder.cpp
// Keeps the slices and frames of a session, and writes them into the element of a page.
#include <cstdint>
#include <cstring>
#include <utility>

#include <apps/continuo/pictures/recorder.hpp>
#include <apps/continuo/terminal/base64.hpp>
#include <fmt/format.h>

#include <continuo/live/session/messages.hpp>

namespace continuo::app {
namespace {

std::string list_of(const std::vector<std::string>& items) {
  return fmt::format("[{}]", fmt::join(items, ","));
}

}  // namespace

void Recorder::see(std::shared_ptr<const live::Slice> slice) {
  log_.add(slice, {&mark_});
  const auto frame = log_.frame(mark_);
  const auto length = static_cast<std::uint32_t>(frame->size());
  frames_.append(reinterpret_cast<const char*>(&length), sizeof length);
  frames_ += *frame;
  for (const live::LiveEvent& event : slice->events) events_.push_back(live::event_json(event));
  slices_.push_back(std::move(slice));
}

void Recorder::hear(live::Topic topic, std::string json) {
  if (topic == live::Topic::model) {
    model_ = std::move(json);
  } else if (topic == live::Topic::message) {
    messages_.push_back(std::move(json));
  }
}

void Recorder::begin() {
  log_ = {};
  mark_ = {};
  events_.clear();
  messages_.clear();
  frames_.clear();
  slices_.clear();
}

std::string Recorder::element() const {
  std::string json = fmt::format(R"({{"model":{},"events":{},"messages":{},"frames":"{}"}})", model_, list_of(events_),
                                 list_of(messages_), base64(frames_));
  // In texts alone there can be a `<`, and it must not end the element.
  std::string safe;
  safe.reserve(json.size());
  for (const char c : json) c == '<' ? safe += "\\u003c" : safe += c;
  return "<script type=\"application/json\" id=\"recording\">" + safe + "</script>";
}

}  // namespace continuo::app
