// continuo/live/server/server_parts.hpp
// The inside of the server: what its connections share. Everything here belongs to the server's thread.
#pragma once
#include <atomic>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>

#include <continuo/live/server.hpp>
#include <continuo/live/server/origin_guard.hpp>
#include <continuo/live/server/places.hpp>
#include <continuo/live/server/row_log.hpp>

namespace continuo::live {

class Client;

struct Server::Parts : std::enable_shared_from_this<Parts> {
  Parts(ServerOptions options_, Say say_) : options(std::move(options_)), once(say_) {}

  void accept();
  std::string host() const;
  std::string viewers_address() const;
  bool admits_first(const boost::asio::ip::tcp::socket& socket);
  void add(const std::shared_ptr<Client>& client);
  void remove(std::uint64_t client);
  void tell_rate();
  void tell_owners();
  void watch_work();
  void see(const std::shared_ptr<const Slice>& slice);
  void hear(Topic topic, std::string json);
  void check(std::uint64_t client, Asked asked);

  ServerOptions options;
  SayOnce once;
  Tokens tokens = make_tokens();
  bool first_used = false;  // the address for the browser's command line, which is good for once
  std::optional<OriginGuard> origin_guard;
  ServerHooks hooks;

  // Ends before the rest does: what still waits in it holds on to its connection, and through that to all of this.
  std::unique_ptr<boost::asio::io_context> context = std::make_unique<boost::asio::io_context>(1);
  boost::asio::io_context& io = *context;
  std::optional<boost::asio::ip::tcp::acceptor> acceptor{io};
  // What keeps the thread where nothing is accepted.
  std::optional<boost::asio::executor_work_guard<boost::asio::io_context::executor_type>> keeps_running;
  boost::asio::thread_pool checker{1};  // a text is checked while its author types: not in the way of the pictures
  std::thread thread;
  unsigned short port = 0;
  Places places{
      {.strangers = options.most_strangers, .viewers = options.most_viewers, .presenters = options.most_presenters}};
  bool stopping = false;
  boost::asio::steady_timer work_timer{io};
  double busy_told = 0;  // seconds of the work that clients know of

  std::uint64_t last_client = 0;
  std::map<std::uint64_t, std::shared_ptr<Client>> clients;
  std::atomic<std::size_t> client_count{0};
  std::shared_ptr<const std::string> model, state;  // the newest
  struct PastEvent {
    double t;
    std::shared_ptr<const std::string> json;
  };
  static constexpr std::size_t most_events = 1000;
  std::deque<PastEvent> events;
  std::uint32_t run = 0;
  RowLog rows;
};

/// Serves one connection: a request, then the page, a refusal, or a client for as long as it stays.
void serve(std::shared_ptr<Server::Parts> parts, boost::asio::ip::tcp::socket socket);
/// The same from the request on, which was read elsewhere, for the owner of the session.
void serve_owner(std::shared_ptr<Server::Parts> parts, boost::asio::ip::tcp::socket socket, const std::string& request);

}  // namespace continuo::live
