// continuo/live/server/serve.cpp
// One request of HTTP: the page, a refusal, or the way to a socket.
#include <memory>
#include <sstream>
#include <string>
#include <utility>

#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

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
    parser_.header_limit(8192);
    parser_.body_limit(0);
    error_code error;
    const auto other = stream_.socket().remote_endpoint(error);
    if (!error) address_ = other.address().to_string();
  }

  void read() {
    take_place(Guest::stranger);
    expire();
    http::async_read(stream_, buffer_, parser_, [self = shared_from_this()](error_code error, std::size_t) {
      if (!error) return self->answer();
      if (error == http::error::end_of_stream || error == beast::error::timeout) return;
      if (error == boost::asio::error::connection_reset || error == http::error::partial_message) return;
      if (error == boost::asio::error::operation_aborted || error == boost::asio::error::bad_descriptor) return;
      self->parts_->once("refused: a request that is none");
      self->send(http::status::bad_request, "text/plain", "This is no request.\n");
    });
  }

  /// The request was read elsewhere.
  void take(const std::string& request) {
    error_code error;
    parser_.eager(true);
    parser_.put(boost::asio::buffer(request), error);
    if (error || !parser_.is_done()) return;
    become_client({.role = Role::owner});
  }

 private:
  /// False where there is none.
  bool take_place(Guest guest) {
    place_ = parts_->places.enter(guest, address_, [weak = weak_from_this()] {
      if (const auto self = weak.lock()) self->close();
    });
    return place_ != nullptr;
  }
  void close() {
    error_code ignored;
    stream_.socket().close(ignored);
  }

  void expire() {
    stream_.expires_after(std::chrono::duration_cast<std::chrono::steady_clock::duration>(
        std::chrono::duration<double>(parts_->options.patience)));
  }

  void answer() {
    const auto& request = parser_.get();
    const auto text = [](beast::string_view part) { return std::string_view(part.data(), part.size()); };
    const Admission admission = parts_->origin_guard->judge({.method = text(request.method_string()),
                                                             .target = text(request.target()),
                                                             .host = text(request[http::field::host]),
                                                             .origin = text(request[http::field::origin]),
                                                             .upgrade = beast::websocket::is_upgrade(request)});
    if (admission.verdict == Verdict::short_address) {
      response_.set(http::field::location, "/?token=" + parts_->tokens.viewers);
      return send(http::status::see_other, "text/plain", "");
    }
    if (admission.verdict == Verdict::first_address) {
      if (!parts_->admits_first(stream_.socket())) {
        parts_->once("refused: the address that the browser was started with, for the second time or by somebody else");
        return send(http::status::forbidden, "text/plain",
                    "This address is good for one time, and for who began the view. Open the one that `continuo view` "
                    "printed.\n");
      }
      response_.set(http::field::location, "/?token=" + parts_->tokens.presenter);
      return send(http::status::see_other, "text/plain", "");
    }
    const bool lets_in = admission.verdict == Verdict::page || admission.verdict == Verdict::live;
    if (!lets_in) {
      const Refusal refusal = refusal_of(admission.verdict);
      parts_->once(refusal.log);
      return send(refusal.status, "text/plain", refusal.answer);
    }
    if (admission.verdict == Verdict::live && admission.role == Role::owner) return begin_own_session();
    if (!take_place(admission.role == Role::presenter ? Guest::presenter : Guest::viewer)) {
      parts_->once(fmt::format("more than {} viewers: the others are turned away", parts_->options.most_viewers));
      take_place(Guest::stranger);
      return send(http::status::service_unavailable, "text/plain", "There is no room for more viewers.\n");
    }
    if (admission.verdict == Verdict::page) return send_page(text(request[http::field::accept_encoding]));
    become_client({.role = admission.role, .may_save = parts_->options.may_save});
  }

  void become_client(Rights rights) {
    place_.reset();
    const Guest guest = rights.role == Role::viewer ? Guest::viewer : Guest::presenter;
    auto leave = std::make_shared<std::function<void()>>();
    auto place = parts_->places.enter(guest, address_, [leave] { (*leave)(); });
    if (!place) return close();
    const auto client = std::make_shared<Client>(parts_, stream_.release_socket(), rights, std::move(place));
    *leave = [other = std::weak_ptr<Client>(client)] {
      if (const auto self = other.lock()) self->end();
    };
    client->begin(parser_.get());
  }

  /// By whoever runs sessions: the connection is theirs from here on.
  void begin_own_session() {
    const auto& hooks = parts_->hooks;
    if (!parts_->options.own_sessions || !hooks.own_session || !parts_->model || buffer_.size() > 0)
      return send(http::status::forbidden, "text/plain", "The presenter shows; sessions of one's own are off.\n");
    std::ostringstream request;
    request << parser_.get();
    const auto shown = nlohmann::json::parse(*parts_->model);
    const OwnSession own{.socket = stream_.socket().native_handle(),
                         .request = request.str(),
                         .path = shown["path"],
                         .text = shown["text"],
                         .address = address_};
    if (!hooks.own_session(own))
      return send(http::status::service_unavailable, "text/plain", "There are too many sessions already.\n");
    // Released before it is closed: the connection lives on in the other process, and would go on to report here.
    ::close(stream_.release_socket().release());
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
  std::string address_;
  std::unique_ptr<Places::Place> place_;
  beast::flat_buffer buffer_{16384};
  http::request_parser<http::empty_body> parser_;
  http::response<http::string_body> response_;
};

}  // namespace

void serve(std::shared_ptr<Server::Parts> parts, boost::asio::ip::tcp::socket socket) {
  std::make_shared<Door>(std::move(parts), std::move(socket))->read();
}

void serve_owner(std::shared_ptr<Server::Parts> parts, boost::asio::ip::tcp::socket socket,
                 const std::string& request) {
  std::make_shared<Door>(std::move(parts), std::move(socket))->take(request);
}

}  // namespace continuo::live
