// continuo/live/server.cpp
// Listens, accepts connections, and hands slices and messages to all clients.
#include <algorithm>
#include <utility>
#include <vector>

#include <boost/asio/post.hpp>
#include <boost/asio/strand.hpp>
#include <fmt/format.h>
#include <pthread.h>
#include <sys/socket.h>

#include <continuo/language/load_confined.hpp>
#include <continuo/live/server/client.hpp>
#include <continuo/live/server/peer_user.hpp>
#include <continuo/live/server/reachable_name.hpp>
#include <continuo/live/session/messages.hpp>

namespace continuo::live {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

// ---- from any thread ------------------------------------------------------------------------------------------------

Server::Server(ServerOptions options, Say say) : parts_(std::make_shared<Parts>(std::move(options), std::move(say))) {}

Server::~Server() {
  stop();
}

Status Server::listen() {
  error_code error;
  const auto address = asio::ip::make_address(parts_->options.address, error);
  if (error)
    return invalid_input(
        fmt::format("{} is no address of a computer, such as 127.0.0.1 or 0.0.0.0", parts_->options.address));
  const tcp::endpoint endpoint(address, parts_->options.port);
  parts_->acceptor->open(endpoint.protocol(), error);
  if (!error) parts_->acceptor->set_option(tcp::acceptor::reuse_address(true), error);
  if (!error) parts_->acceptor->bind(endpoint, error);
  if (!error) parts_->acceptor->listen(asio::socket_base::max_listen_connections, error);
  if (error)
    return {.ending = Ending::cannot_continue,
            .message =
                fmt::format("cannot listen at {}:{}: {}", parts_->options.address, endpoint.port(), error.message())};
  parts_->port = parts_->acceptor->local_endpoint().port();
  parts_->origin_guard.emplace(parts_->tokens, parts_->options.address, parts_->port);
  return {};
}

void Server::start(ServerHooks hooks) {
  parts_->hooks = std::move(hooks);
  if (parts_->acceptor->is_open()) parts_->accept();
  if (parts_->hooks.watch) parts_->watch_work();
  parts_->keeps_running.emplace(parts_->io.get_executor());
  parts_->thread = std::thread([parts = parts_] { parts->io.run(); });
  pthread_setname_np(parts_->thread.native_handle(), "server");
}

void Server::stop() {
  if (!parts_->thread.joinable()) return;
  asio::post(parts_->io, [parts = parts_] {
    parts->stopping = true;
    parts->keeps_running.reset();
    parts->work_timer.cancel();
    error_code ignored;
    parts->acceptor->close(ignored);
    for (const auto& [number, client] : parts->clients) client->close();
    // Who does not say goodbye in this time is left.
    auto timer = std::make_shared<asio::steady_timer>(parts->io, std::chrono::milliseconds(300));
    timer->async_wait([parts, timer](error_code) { parts->io.stop(); });
  });
  parts_->thread.join();
  parts_->checker.stop();
  parts_->checker.join();
  parts_->clients.clear();
  parts_->hooks = {};
  parts_->acceptor.reset();
  parts_->context.reset();
}

unsigned short Server::port() const {
  return parts_->port;
}

std::string Server::url() const {
  return fmt::format("http://{}/?token={}", parts_->host(), parts_->tokens.presenter);
}

std::string Server::first_url() const {
  return fmt::format("http://{}/{}", parts_->host(), parts_->tokens.first);
}

std::string Server::viewers_url() const {
  return parts_->viewers_address();
}

void Server::adopt(int socket, const std::string& request) {
  asio::post(parts_->io, [parts = parts_, socket, request] {
    tcp::socket connection(parts->io);
    error_code error;
    sockaddr_storage name{};
    socklen_t size = sizeof name;
    ::getsockname(socket, reinterpret_cast<sockaddr*>(&name), &size);
    connection.assign(name.ss_family == AF_INET6 ? tcp::v6() : tcp::v4(), socket, error);
    if (!error) serve_owner(parts, std::move(connection), request);
  });
}

std::size_t Server::clients() const {
  return parts_->client_count.load();
}

void Server::see(std::shared_ptr<const Slice> slice) {
  asio::post(parts_->io, [parts = parts_.get(), slice = std::move(slice)] { parts->see(slice); });
}

void Server::hear(Topic topic, std::string json) {
  asio::post(parts_->io,
             [parts = parts_.get(), topic, json = std::move(json)]() mutable { parts->hear(topic, std::move(json)); });
}

void Server::complain(std::uint64_t client, const std::string& problem) {
  asio::post(parts_->io, [parts = parts_.get(), client, problem] {
    const auto found = parts->clients.find(client);
    if (found != parts->clients.end()) found->second->complain(problem);
  });
}

// ---- on the server's thread -----------------------------------------------------------------------------------------

void Server::Parts::accept() {
  acceptor->async_accept([self = shared_from_this()](error_code error, tcp::socket socket) {
    if (self->stopping || error == asio::error::operation_aborted) return;
    if (error) {  // out of descriptors, most likely: those that end make room
      self->once("cannot accept: " + error.message());
      auto timer = std::make_shared<asio::steady_timer>(self->io, std::chrono::milliseconds(100));
      timer->async_wait([self, timer](error_code) { self->accept(); });
      return;
    }
    error_code ignored;
    socket.set_option(tcp::no_delay(true), ignored);
    serve(self, std::move(socket));
    self->accept();
  });
}

std::string Server::Parts::host() const {
  const std::string name = reachable_name(options.address);
  return name.find(':') == std::string::npos ? fmt::format("{}:{}", name, port) : fmt::format("[{}]:{}", name, port);
}

std::string Server::Parts::viewers_address() const {
  return fmt::format("http://{}/{}", host(), tokens.viewers);
}

/// Everybody on this computer can read it in the list of processes: it is good for one request, of the own user.
bool Server::Parts::admits_first(const tcp::socket& socket) {
  if (first_used || !is_of_own_user(socket)) return false;
  first_used = true;
  return true;
}

void Server::Parts::add(const std::shared_ptr<Client>& client) {
  clients.emplace(client->number(), client);
  client_count = clients.size();
  tell_owners();
  tell_rate();
  for (const PastEvent& event : events) client->give_event(event.json);
  if (model) client->give(Topic::model, model);
  if (state) client->give(Topic::state, state);
  if (!rows.empty()) client->picture();
}

void Server::Parts::remove(std::uint64_t client) {
  if (clients.erase(client) == 0) return;
  client_count = clients.size();
  if (stopping) return;
  tell_owners();
  tell_rate();
}

/// How many there are: to who runs the session, and to the presenters.
void Server::Parts::tell_owners() {
  const auto is_viewer = [](const auto& client) { return client.second->rights().role == Role::viewer; };
  const auto viewers = static_cast<std::size_t>(std::ranges::count_if(clients, is_viewer));
  if (hooks.attached) hooks.attached(clients.size() - viewers);
  const auto room = std::make_shared<const std::string>(room_json(viewers));
  const auto now = clients;
  for (const auto& [number, client] : now)
    if (client->rights().role == Role::presenter) client->give_room(room);
}

void Server::Parts::tell_rate() {
  double most = 0;
  for (const auto& [number, client] : clients) {
    const double usual = 60;  // what viewers may cost the presenter's computer
    most = std::max(most, client->rights().role == Role::viewer ? std::min(client->rate(), usual) : client->rate());
  }
  if (hooks.rate && most > 0) hooks.rate(most);
}

/// Twenty times a second: whether the session is at something that takes long.
void Server::Parts::watch_work() {
  work_timer.expires_after(std::chrono::milliseconds(50));
  work_timer.async_wait([self = shared_from_this()](error_code error) {
    if (error || self->stopping) return;
    const std::optional<Work> work = self->hooks.watch();
    const double seconds = work ? work->seconds : 0;
    constexpr double least = 0.25, every = 0.5;
    const bool begins = seconds >= least && (seconds >= self->busy_told + every || self->busy_told == 0);
    const bool ends = self->busy_told > 0 && seconds < self->busy_told;
    if (begins || ends) {
      const bool long_one = seconds >= least;
      self->busy_told = long_one ? seconds : 0;
      const std::string_view with = !long_one ? "" : work->kind == Work::Kind::motion ? "motion" : "commands";
      const auto json = std::make_shared<const std::string>(busy_json(with, self->busy_told));
      const auto now = self->clients;
      for (const auto& [number, client] : now) client->give_busy(json);
    }
    self->watch_work();
  });
}

void Server::Parts::see(const std::shared_ptr<const Slice>& slice) {
  std::vector<ReadMark*> marks;
  for (const auto& [number, client] : clients) marks.push_back(&client->mark());
  rows.add(slice, marks);
  if (slice->run != run) events.clear();
  run = slice->run;
  if (slice->rewound_to) std::erase_if(events, [&](const PastEvent& event) { return event.t > *slice->rewound_to; });
  for (const LiveEvent& event : slice->events) {
    events.push_back({event.t, std::make_shared<const std::string>(event_json(event))});
    if (events.size() > most_events) events.pop_front();
    for (const auto& [number, client] : clients) client->give_event(events.back().json);
  }
  // A client that ends while it is given something leaves the list.
  const auto now = clients;
  for (const auto& [number, client] : now) client->picture();
}

void Server::Parts::hear(Topic topic, std::string json) {
  const auto text = std::make_shared<const std::string>(std::move(json));
  if (topic == Topic::model) {
    model = text;
    state = nullptr;  // of the one before, as what follows
    events.clear();
    std::vector<ReadMark*> marks;
    for (const auto& [number, client] : clients) {
      client->forget_events();
      marks.push_back(&client->mark());
    }
    rows.forget(marks);
  }
  if (topic == Topic::state) state = text;
  const auto now = clients;
  for (const auto& [number, client] : now) client->give(topic, text);
}

void Server::Parts::check(std::uint64_t client, Asked asked) {
  asio::post(checker, [self = shared_from_this(), client, asked = std::move(asked)] {
    const model::Loaded loaded = model::load_confined(model::Source(self->options.model_path, asked.text));
    auto json = std::make_shared<const std::string>(checked_json(asked.number, loaded.diagnostics, loaded.source));
    asio::post(self->io, [self, client, json] {
      const auto found = self->clients.find(client);
      if (found != self->clients.end()) found->second->checked(json);
    });
  });
}

}  // namespace continuo::live
