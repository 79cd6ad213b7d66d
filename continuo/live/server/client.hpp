// continuo/live/server/client.hpp
// One page that looks: a WebSocket with at most one message under way. What waits is bounded: the newest of what is
// replaced by newer things, a list of what is not.
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include <continuo/live/server/server_parts.hpp>

namespace continuo::live {

using Text = std::shared_ptr<const std::string>;

class Client : public std::enable_shared_from_this<Client> {
 public:
  using Stream = boost::beast::websocket::stream<boost::beast::tcp_stream>;
  using Upgrade = boost::beast::http::request<boost::beast::http::empty_body>;

  Client(std::shared_ptr<Server::Parts> parts, boost::asio::ip::tcp::socket socket, std::uint64_t number);

  void begin(const Upgrade& upgrade);
  void close();

  std::uint64_t number() const { return number_; }
  double rate() const { return rate_; }
  ReadMark& mark() { return mark_; }

  /// A model or a state stands for those before it.
  void give(Topic topic, const Text& json);
  void give_event(const Text& json);
  void forget_events() { events_.clear(); }
  /// There is a newer picture.
  void picture();
  /// One thing it said was wrong; after a hundred it is shown out.
  void complain(const std::string& problem);
  void checked(const Text& json);

 private:
  using Clock = std::chrono::steady_clock;

  void read();
  void was_read();
  void obey(std::string text);
  void hand_on(Command command);
  void pump();
  void write(Text bytes, bool binary);
  void end();

  static constexpr std::size_t most_text = std::size_t{1} << 20, most_waiting = 1000, most_wrong = 100;

  std::shared_ptr<Server::Parts> parts_;
  Stream stream_;
  std::uint64_t number_;
  boost::beast::flat_buffer buffer_;
  boost::asio::steady_timer later_, again_;
  double rate_ = 60;
  ReadMark mark_;
  Text model_, state_;
  std::deque<Text> events_, messages_;
  bool open_ = false, writing_ = false, picture_ = false, waiting_ = false, checking_ = false, gone_ = false;
  bool closing_ = false;
  std::optional<Asked> next_check_;
  Clock::time_point due_{};
  std::size_t wrong_ = 0;
};

}  // namespace continuo::live
