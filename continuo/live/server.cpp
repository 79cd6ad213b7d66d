// continuo/live/server.cpp
// Listens, accepts connections, and hands slices and messages to all clients.
#include <utility>

#include <boost/asio/post.hpp>
#include <boost/asio/strand.hpp>
#include <fmt/format.h>
#include <pthread.h>

#include <continuo/language/load.hpp>
#include <continuo/live/server/client.hpp>
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
  parts_->origin_guard.emplace(parts_->token, parts_->options.address, parts_->port);
  return {};
}

void Server::start(ServerHooks hooks) {
  parts_->hooks = std::move(hooks);
  parts_->accept();
  parts_->thread = std::thread([parts = parts_] { parts->io.run(); });
  pthread_setname_np(parts_->thread.native_handle(), "server");
}

void Server::stop() {
  if (!parts_->thread.joinable()) return;
  asio::post(parts_->io, [parts = parts_] {
    parts->stopping = true;
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
  const std::string& address = parts_->options.address;
  const bool six = address.find(':') != std::string::npos;
  return fmt::format("http://{}:{}/?token={}", six ? "[" + address + "]" : address, parts_->port, parts_->token);
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
    if (self->connections >= self->options.most_clients) {
      self->once(fmt::format("more than {} connections: the others are turned away", self->options.most_clients));
    } else {
      error_code ignored;
      socket.set_option(tcp::no_delay(true), ignored);
      serve(self, std::move(socket));
    }
    self->accept();
  });
}

void Server::Parts::add(const std::shared_ptr<Client>& client) {
  clients.emplace(client->number(), client);
  client_count = clients.size();
  if (hooks.attached) hooks.attached(clients.size());
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
  if (hooks.attached) hooks.attached(clients.size());
  tell_rate();
}

void Server::Parts::tell_rate() {
  double most = 0;
  for (const auto& [number, client] : clients) most = std::max(most, client->rate());
  if (hooks.rate && most > 0) hooks.rate(most);
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
    events.clear();
    for (const auto& [number, client] : clients) client->forget_events();
  }
  if (topic == Topic::state) state = text;
  const auto now = clients;
  for (const auto& [number, client] : now) client->give(topic, text);
}

void Server::Parts::check(std::uint64_t client, Asked asked) {
  asio::post(checker, [self = shared_from_this(), client, asked = std::move(asked)] {
    const model::Loaded loaded = model::load(model::Source(self->options.model_path, asked.text));
    auto json = std::make_shared<const std::string>(checked_json(asked.number, loaded.diagnostics, loaded.source));
    asio::post(self->io, [self, client, json] {
      const auto found = self->clients.find(client);
      if (found != self->clients.end()) found->second->checked(json);
    });
  });
}

}  // namespace continuo::live
