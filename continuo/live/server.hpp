// continuo/live/server.hpp
// Shows a session to whoever has the address: HTTP for the page, WebSocket for the rest, one thread. Each client gets
// the newest picture when it has read the last one; what it has not read does not pile up. There are two addresses: the
// presenter's, and that of viewers, who see.
//
//   Server server({.page = page}, say);
//   if (const Status status = server.listen(); !status) std::cerr << describe(status) << '\n';
//   server.start();  open_browser(server.first_url());
//   session.turn();                                 // server is the session's Audience
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <continuo/live/audience.hpp>
#include <continuo/live/loop.hpp>
#include <continuo/live/session/commands.hpp>
#include <continuo/status/status.hpp>

namespace continuo::live {

/// Where the server listens, and its limits.
struct ServerOptions {
  std::string address = "127.0.0.1";
  unsigned short port = 0;    // 0: any free one
  std::string page{};         // the page, compressed by gzip; empty: none in this build
  std::string model_path{};   // texts are checked as if they stood there: where files beside it are found
  bool may_save = true;       // the presenter: the file of the model
  bool own_sessions = false;  // viewers may have sessions of their own
  // Connections at a time: of viewers, of presenters, and of those who have not shown a token yet.
  std::size_t most_viewers = 64, most_presenters = 8, most_strangers = 16;
  double patience = 10, idle = 20;  // seconds: for a request to come; for a client that does not answer
  std::size_t most_messages = 500;  // a second, of one client: who says more is read from later
};

/// A viewer who asks for a session of their own: the connection, the request that came over it, and what is shown now.
struct OwnSession {
  int socket;  // to be duplicated
  std::string request, path, text;
  std::string address;  // of their computer
};

/// What the server needs of who runs the model; called on the server's thread.
struct ServerHooks {
  std::function<bool(Command, std::uint64_t client)> command{};  // false: too much to do already
  std::function<void(double pictures)> rate{};                   // a second: the most any client wants
  std::function<void(std::size_t clients)> attached{};           // of those whose session it is
  std::function<std::optional<Work>()> watch{};                  // what takes long, if anything
  std::function<bool(const OwnSession&)> own_session{};          // false: there are too many
  std::function<void()> acted{};                                 // somebody gave a command, or types a text
};

/// A server of one session.
class Server final : public Audience {
 public:
  /// Gets messages for the terminal.
  using Say = std::function<void(const std::string&)>;

  /// Nothing is opened yet. `say` gets messages for the terminal, on the server's thread.
  Server(ServerOptions options, Say say);
  /// Closes all connections.
  ~Server() override;

  /// Invalid input where the address is none; cannot continue where nobody can listen there.
  Status listen();
  /// In place of `listen`: serves one client, as the owner of the session, by a connection that was accepted elsewhere
  /// and the request that came over it. `start` comes first.
  void adopt(int socket, const std::string& request);
  /// Accepts clients from now on, on a thread of its own. `listen` must have succeeded.
  void start(ServerHooks hooks);
  /// Says goodbye to all and returns when the thread has ended.
  void stop();

  /// The port, after `listen`.
  [[nodiscard]] unsigned short port() const;
  /// The address of the page, after `listen`: the presenter's.
  [[nodiscard]] std::string url() const;
  /// An address that leads to the presenter's once, and no other user of this computer: a browser that is started with
  /// it has it on its command line, which everybody here can read.
  [[nodiscard]] std::string first_url() const;
  /// That of viewers, as short as can be.
  [[nodiscard]] std::string viewers_url() const;
  /// The number of clients that are connected.
  [[nodiscard]] std::size_t clients() const;

  // From any thread.
  /// Sends a part of the picture to all clients that have read the last one.
  void see(std::shared_ptr<const Slice> slice) override;
  /// Sends a message to all clients.
  void hear(Topic topic, std::string json) override;
  /// Tells one client what was wrong with its message.
  void complain(std::uint64_t client, const std::string& problem);

  struct Parts;  // server_parts.hpp

 private:
  std::shared_ptr<Parts> parts_;
};

}  // namespace continuo::live
