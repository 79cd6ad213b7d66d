// continuo/live/server/serve.cpp
// One request of HTTP: the page, a refusal, or the way to a socket.
#include <memory>
#include <string>
#include <utility>

#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <fmt/format.h>

#include <continuo/live/server/client.hpp>
#include <continuo/live/server/gzip.hpp>

namespace continuo::live {

namespace {

namespace beast = boost::beast;
namespace http = boost::beast::http;
using boost::system::error_code;

struct Refusal {
  http::status status;
  const char* answer;
  const char* log;
};

Refusal refusal_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::wrong_token:
      return {http::status::forbidden, "This address lacks the token that `continuo view` printed.\n",
              "refused: a request without the token"};
    case Verdict::wrong_origin:
      return {http::status::forbidden, "Not from another page.\n", "refused: a request from another page"};
    case Verdict::wrong_host:
      return {http::status::forbidden, "Not by that name.\n", "refused: a request by another host's name"};
    case Verdict::wrong_method:
      return {http::status::method_not_allowed, "GET only.\n", "refused: a request other than GET"};
    default:
      return {http::status::not_found, "There is nothing here.\n", "refused: a request for what is not there"};
  }
}

class Door : public std::enable_shared_from_this<Door> {
 public:
  Door(std::shared_ptr<Server::Parts> parts, boost::asio::ip::tcp::socket socket)
      : parts_(std::move(parts)), stream_(std::move(socket)) {
    ++parts_->connections;
    parser_.header_limit(8192);
    parser_.body_limit(0);
  }
  ~Door() { --parts_->connections; }
  Door(const Door&) = delete;
  Door& operator=(const Door&) = delete;

  void read() {
    expire();
    http::async_read(stream_, buffer_, parser_, [self = shared_from_this()](error_code error, std::size_t) {
      if (!error) return self->answer();
      if (error == http::error::end_of_stream || error == beast::error::timeout) return;
      if (error == boost::asio::error::connection_reset || error == http::error::partial_message) return;
      self->parts_->once("refused: a request that is none");
      self->send(http::status::bad_request, "text/plain", "This is no request.\n");
    });
  }

 private:
  void expire() {
    stream_.expires_after(std::chrono::duration_cast<std::chrono::steady_clock::duration>(
        std::chrono::duration<double>(parts_->options.patience)));
  }

  void answer() {
    const auto& request = parser_.get();
    const auto text = [](beast::string_view part) { return std::string_view(part.data(), part.size()); };
    const Verdict verdict = parts_->origin_guard->judge({.method = text(request.method_string()),
                                                         .target = text(request.target()),
                                                         .host = text(request[http::field::host]),
                                                         .origin = text(request[http::field::origin]),
                                                         .upgrade = beast::websocket::is_upgrade(request)});
    if (verdict == Verdict::live) return upgrade();
    if (verdict == Verdict::page) return send_page(text(request[http::field::accept_encoding]));
    const Refusal refusal = refusal_of(verdict);
    parts_->once(refusal.log);
    send(refusal.status, "text/plain", refusal.answer);
  }

  void upgrade() {
    // The door stays for as long as the client does: it is what counts as a connection.
    struct Kept : Client {
      Kept(std::shared_ptr<Door> door_, std::shared_ptr<Server::Parts> parts, boost::asio::ip::tcp::socket socket,
           std::uint64_t number)
          : Client(std::move(parts), std::move(socket), number), door(std::move(door_)) {}
      std::shared_ptr<Door> door;
    };
    const std::uint64_t number = ++parts_->last_client;
    const auto client = std::make_shared<Kept>(shared_from_this(), parts_, stream_.release_socket(), number);
    client->begin(parser_.get());
  }

  void send_page(std::string_view accepted) {
    const std::string& page = parts_->options.page;
    if (page.empty()) {
      return send(
          http::status::ok, "text/plain",
          "This build of Continuo has no page. Build it with -DCONTINUO_PAGE=ON (needs npm), or give --page FILE.\n");
    }
    const bool compressed = accepted.find("gzip") != std::string_view::npos;
    if (compressed) response_.set(http::field::content_encoding, "gzip");
    send(http::status::ok, "text/html; charset=utf-8", compressed ? page : unzipped(page));
  }

  void send(http::status status, const char* type, std::string body) {
    expire();
    response_.result(status);
    response_.version(11);
    response_.keep_alive(false);
    response_.set(http::field::content_type, type);
    response_.set(http::field::cache_control, "no-store");
    response_.set("X-Content-Type-Options", "nosniff");
    response_.set("Referrer-Policy", "no-referrer");
    response_.set("Content-Security-Policy",
                  "default-src 'none'; script-src 'unsafe-inline' blob:; style-src 'unsafe-inline'; "
                  "img-src data: blob:; media-src blob:; font-src data:; connect-src 'self' ws: data: blob:; "
                  "worker-src blob:; base-uri 'none'; form-action 'none'");
    response_.body() = std::move(body);
    response_.prepare_payload();
    http::async_write(stream_, response_, [self = shared_from_this()](error_code, std::size_t) {
      error_code ignored;
      self->stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
    });
  }

  std::shared_ptr<Server::Parts> parts_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{16384};
  http::request_parser<http::empty_body> parser_;
  http::response<http::string_body> response_;
};

}  // namespace

void serve(std::shared_ptr<Server::Parts> parts, boost::asio::ip::tcp::socket socket) {
  std::make_shared<Door>(std::move(parts), std::move(socket))->read();
}

}  // namespace continuo::live
