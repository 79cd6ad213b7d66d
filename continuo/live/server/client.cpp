// continuo/live/server/client.cpp
// Reads and writes one WebSocket.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <continuo/live/server/client.hpp>
#include <continuo/live/session/messages.hpp>

namespace continuo::live {

namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;
using boost::system::error_code;

namespace {

std::string_view word_for(Role role) {
  return role == Role::presenter ? "presenter" : role == Role::owner ? "owner" : "viewer";
}

}  // namespace

Client::Client(std::shared_ptr<Server::Parts> parts, boost::asio::ip::tcp::socket socket, Rights rights,
               std::unique_ptr<Places::Place> place)
    : parts_(std::move(parts)),
      stream_(std::move(socket)),
      rights_(rights),
      place_(std::move(place)),
      number_(++parts_->last_client),
      later_(parts_->io),
      again_(parts_->io) {}

void Client::begin(const Upgrade& upgrade) {
  websocket::stream_base::timeout patience{};
  patience.handshake_timeout =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(parts_->options.patience));
  patience.idle_timeout =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(parts_->options.idle));
  patience.keep_alive_pings = true;  // who has gone without a word does not answer
  stream_.set_option(patience);
  const bool sees_only = rights_.role == Role::viewer;
  stream_.read_message_max(sees_only ? most_text_of_viewers : most_text);
  stream_.auto_fragment(false);
  beast::get_lowest_layer(stream_).expires_never();
  stream_.async_accept(upgrade, [self = shared_from_this()](error_code error) {
    if (error) return self->end();
    self->open_ = true;
    self->role_ = std::make_shared<const std::string>(
        role_json({.role = word_for(self->rights_.role),
                   .may = allowed(self->rights_),
                   .own_sessions = self->parts_->options.own_sessions,
                   .viewers_address = self->rights_.role == Role::presenter ? self->parts_->viewers_address() : ""}));
    self->parts_->add(self);
    self->read();
  });
}

void Client::end() {
  if (gone_) return;
  gone_ = true;
  open_ = false;
  later_.cancel();
  again_.cancel();
  beast::error_code ignored;
  beast::get_lowest_layer(stream_).socket().close(ignored);
  place_.reset();
  parts_->remove(number_);
}

void Client::close() {
  if (!open_ || closing_) return;
  closing_ = true;
  if (writing_) return;  // when that is written
  open_ = false;
  stream_.async_close(wrong_ >= most_wrong ? websocket::close_code::policy_error : websocket::close_code::going_away,
                      [self = shared_from_this()](error_code) { self->end(); });
}

// ---- in -------------------------------------------------------------------------------------------------------------

void Client::read() {
  stream_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
    if (error == websocket::error::message_too_big)
      self->parts_->once("a message that is too large: its sender is shown out");
    if (error) return self->end();
    self->was_read();
  });
}

void Client::was_read() {
  if (closing_) return;
  const bool text = stream_.got_text();
  std::string message = text ? beast::buffers_to_string(buffer_.data()) : std::string();
  buffer_.consume(buffer_.size());
  if (buffer_.capacity() > 65536) buffer_.shrink_to_fit();
  if (!text) {
    complain("a client says text only");
  } else {
    obey(std::move(message));
  }
  if (waiting_ || closing_) return;
  if (!is_too_fast()) return read();
  again_.expires_at(tenth_ + std::chrono::milliseconds(100));
  again_.async_wait([self = shared_from_this()](error_code error) {
    if (!error && !self->gone_) self->read();
  });
}

/// A flood waits in its sender, and costs nobody else their turn.
bool Client::is_too_fast() {
  const Clock::time_point now = Clock::now();
  if (now - tenth_ >= std::chrono::milliseconds(100)) {
    tenth_ = now;
    in_tenth_ = 0;
  }
  return ++in_tenth_ >= parts_->options.most_messages / 10;
}

void Client::obey(std::string text) {
  Result<Command> read = read_command(std::move(text));
  if (!read) return complain(read.status().message);
  Command& command = *read;
  if (!may(rights_, command.what)) {
    const bool saves = rights_.role == Role::presenter;  // all else is the presenter's
    return complain(
        fmt::format("`{}` is {}", command.what,
                    saves ? "off here: `continuo view --allow-save` lets the page write the file" : "the presenter's"));
  }
  if (parts_->hooks.acted && command.what != "ping" && command.what != "rate") parts_->hooks.acted();
  const bool for_me = command.what == "check" || command.what == "ping" || command.what == "rate";
  if (!for_me) return hand_on(std::move(command));
  Result<Asked> what = asked(command);
  if (!what) return complain(what.status().message);
  if (command.what == "ping") {
    give(Topic::message, std::make_shared<const std::string>(pong_json(what->number)));
  } else if (command.what == "rate") {
    if (!(what->number >= 1 && what->number <= 120)) return complain("a rate lies between 1 and 120");
    rate_ = what->number;
    parts_->tell_rate();
  } else if (checking_) {
    next_check_ = *std::move(what);  // the newest text counts
  } else {
    checking_ = true;
    parts_->check(number_, std::move(*what));
  }
}

/// Where the model's thread has too much to do, this client is not read from for a moment: a flood waits in its sender.
void Client::hand_on(Command command) {
  waiting_ = false;
  if (parts_->hooks.command && parts_->hooks.command(command, number_)) return;
  waiting_ = true;
  again_.expires_after(std::chrono::milliseconds(20));
  again_.async_wait([self = shared_from_this(), command = std::move(command)](error_code error) mutable {
    if (error || self->gone_) return;
    self->hand_on(std::move(command));
    if (!self->waiting_ && !self->closing_) self->read();
  });
}

void Client::complain(const std::string& problem) {
  parts_->once("a malformed message: " + problem);
  ++wrong_;
  give(Topic::message, std::make_shared<const std::string>(note_json("error", problem)));
  if (wrong_ >= most_wrong) close();
}

void Client::checked(const Text& json) {
  checking_ = false;
  give(Topic::message, json);
  if (!next_check_) return;
  checking_ = true;
  parts_->check(number_, *std::exchange(next_check_, std::nullopt));
}

// ---- out ------------------------------------------------------------------------------------------------------------

void Client::give(Topic topic, const Text& json) {
  if (topic == Topic::model) {
    model_ = json;
    state_ = nullptr;  // of the model before, as
    picture_ = false;
    knows_state_ = false;
  } else if (topic == Topic::state) {
    state_ = json;
  } else {
    messages_.push_back(json);
    if (messages_.size() > most_waiting) messages_.pop_front();
  }
  pump();
}

void Client::give_event(const Text& json) {
  events_.push_back(json);
  if (events_.size() > most_waiting) events_.pop_front();
}

void Client::give_room(const Text& json) {
  room_ = json;
  pump();
}

void Client::give_busy(const Text& json) {
  busy_ = json;
  pump();
}

void Client::picture() {
  picture_ = true;
  pump();
}

void Client::pump() {
  if (writing_ || !open_) return;
  for (Text* text : {&role_, &model_, &room_, &busy_})
    if (*text) return write(std::exchange(*text, nullptr), false);
  for (std::deque<Text>* list : {&messages_, &events_}) {
    if (list->empty()) continue;
    Text text = std::move(list->front());
    list->pop_front();
    return write(std::move(text), false);
  }
  if (closing_) {
    closing_ = false;
    return close();
  }
  const auto write_state = [&] {
    knows_state_ = true;
    write(std::exchange(state_, nullptr), false);
  };
  if (state_ && !knows_state_) return write_state();
  const Clock::time_point now = Clock::now();
  const auto interval = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / rate_));
  if (picture_ && now + interval / 4 >= due_) {  // a quarter early rather than a whole picture late
    picture_ = false;
    due_ = std::max(due_ + interval, now + interval / 2);
    return write(parts_->rows.frame(mark_), true);
  }
  if (state_) return write_state();
  if (!picture_) return;
  later_.expires_at(due_);
  later_.async_wait([self = shared_from_this()](error_code error) {
    if (!error) self->pump();
  });
}

void Client::write(Text bytes, bool binary) {
  writing_ = true;
  stream_.binary(binary);
  const auto buffer = boost::asio::buffer(*bytes);
  stream_.async_write(buffer, [self = shared_from_this(), bytes = std::move(bytes)](error_code error, std::size_t) {
    self->writing_ = false;
    if (error) return self->end();
    self->pump();
  });
}

}  // namespace continuo::live
