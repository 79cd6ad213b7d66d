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

  /// `place` is given back when it ends.
  Client(std::shared_ptr<Server::Parts> parts, boost::asio::ip::tcp::socket socket, Rights rights,
         std::unique_ptr<Places::Place> place);

  void begin(const Upgrade& upgrade);
  void close();
  /// Without a word.
  void end();

  std::uint64_t number() const { return number_; }
  const Rights& rights() const { return rights_; }
  double rate() const { return rate_; }
  ReadMark& mark() { return mark_; }

  /// A model or a state stands for those before it.
  void give(Topic topic, const Text& json);
  void give_event(const Text& json);
  /// Each stands for those before it.
  void give_room(const Text& json);
  void give_busy(const Text& json);
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
  bool is_too_fast();

  static constexpr std::size_t most_text = std::size_t{1} << 20, most_waiting = 1000, most_wrong = 100;
  static constexpr std::size_t most_text_of_viewers = 4096;  // who may say little

  std::shared_ptr<Server::Parts> parts_;
  Stream stream_;
  Rights rights_;
  std::unique_ptr<Places::Place> place_;
  std::uint64_t number_;
  boost::beast::flat_buffer buffer_;
  boost::asio::steady_timer later_, again_;
  double rate_ = 60;
  ReadMark mark_;
  Text role_, model_, state_, room_, busy_;
  std::deque<Text> events_, messages_;
  bool open_ = false, writing_ = false, picture_ = false, waiting_ = false, checking_ = false, gone_ = false;
  bool closing_ = false;
  bool knows_state_ = false;  // of the model: the first one goes before the pictures, later ones when those leave room
  std::optional<Asked> next_check_;
  Clock::time_point due_{}, tenth_{};
  std::size_t in_tenth_ = 0;
  std::size_t wrong_ = 0;
};

}  // namespace continuo::live
