// The server under malicious clients. The sockets are written by hand, since a library would not send such requests.
#include <atomic>
#include <cerrno>
#include <chrono>
#include <memory>
#include <mutex>
#include <random>
#include <string>
#include <thread>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <continuo/live/loop.hpp>
#include <continuo/live/server.hpp>
#include <continuo/live/server/gzip.hpp>

namespace continuo::live {
namespace {

class Wire {
 public:
  explicit Wire(unsigned short port, int receive_buffer = 0) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const timeval patience{5, 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    ::setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
    if (receive_buffer > 0) ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    connected_ = ::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
  }
  Wire(const Wire&) = delete;
  Wire& operator=(const Wire&) = delete;
  ~Wire() { ::close(socket_); }

  bool connected() const { return connected_; }
  /// By the other side, whatever it has sent before.
  bool is_closed() {
    char part[4096];
    ssize_t got = 1;
    while (got > 0) got = ::recv(socket_, part, sizeof part, MSG_DONTWAIT);
    return got == 0 || errno == ECONNRESET;
  }
  bool send(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
  }
  /// Receives until there are that many bytes, or the other side has closed the connection.
  std::string receive(std::size_t count = 1 << 20) {
    std::string all;
    while (all.size() < count) {
      char part[4096];
      const ssize_t got = ::recv(socket_, part, std::min(sizeof part, count - all.size()), 0);
      if (got <= 0) break;
      all.append(part, static_cast<std::size_t>(got));
    }
    return all;
  }

 private:
  int socket_;
  bool connected_ = false;
};

std::string message(unsigned char opcode, std::string_view payload, bool masked = true) {
  std::string bytes;
  bytes += static_cast<char>(0x80 | opcode);
  const char mask_bit = masked ? static_cast<char>(0x80) : '\0';
  if (payload.size() < 126) {
    bytes += static_cast<char>(static_cast<char>(payload.size()) | mask_bit);
  } else {  // in as few bytes as can be, as RFC 6455 wants it
    const bool is_short = payload.size() < 65536;
    bytes += static_cast<char>((is_short ? 126 : 127) | mask_bit);
    for (int shift = is_short ? 8 : 56; shift >= 0; shift -= 8)
      bytes += static_cast<char>(payload.size() >> shift & 0xff);
  }
  if (masked) bytes += std::string(4, '\0');
  return bytes + std::string(payload);
}

class LiveServer : public ::testing::Test {
 protected:
  void SetUp() override {
    ServerOptions options{.page = stored("<p>page"),
                          .most_viewers = 10,
                          .most_presenters = 40,
                          .most_strangers = 8,
                          .patience = 1,
                          .idle = 2,
                          .most_messages = 1'000'000};
    server = std::make_unique<Server>(options, [this](const std::string& text) {
      const std::lock_guard lock(mutex);
      said.push_back(text);
    });
    session = std::make_unique<Session>(steady_seconds, *server,
                                        Place{.path = std::string(CONTINUO_SOURCE_DIR) + "/models/pendulum.sim"});
    ASSERT_EQ(server->listen(), Status{});
    ASSERT_TRUE(session->open_file().model);
    session->play();
    loop = std::make_unique<Loop>(
        *session, [this](std::uint64_t client, const std::string& problem) { server->complain(client, problem); });
    server->start(
        {.command = [this](Command command, std::uint64_t client) { return loop->post(std::move(command), client); },
         .rate = [this](double pictures) { loop->set_rate(pictures); }});
    loop->start();
    const std::string url = server->url();
    token = url.substr(url.find("token=") + 6);
  }
  void TearDown() override {
    loop->stop();
    server->stop();
  }

  std::string host() const { return "127.0.0.1:" + std::to_string(server->port()); }
  std::string upgrade(const std::string& target, const std::string& more = "") const {
    return "GET " + target + " HTTP/1.1\r\nHost: " + host() + "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n" +
           "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n" + more + "\r\n";
  }
  std::string live() const { return upgrade("/live?token=" + token); }
  std::string viewers_token() const {
    const std::string url = server->viewers_url();
    return url.substr(url.rfind('/') + 1);
  }
  /// A client that is let in gets its picture: the server lives.
  void expect_alive() {
    Wire wire(server->port());
    ASSERT_TRUE(wire.send(live()));
    EXPECT_TRUE(wire.receive(12).starts_with("HTTP/1.1 101"));
    EXPECT_EQ(wire.receive(5000).size(), 5000U);
  }

  std::mutex mutex;
  std::vector<std::string> said;
  std::unique_ptr<Server> server;
  std::unique_ptr<Session> session;
  std::unique_ptr<Loop> loop;
  std::string token;
};

TEST_F(LiveServer, RefusesByTheHundredsAndSaysEachKindOnce) {
  const std::vector<std::pair<std::string, std::string>> hostile = {
      {upgrade("/live?token=0123"), "403"},
      {upgrade("/live"), "403"},
      {upgrade("/live?token=" + token, "Origin: http://evil.example\r\n"), "403"},
      {"GET /?token=" + token + " HTTP/1.1\r\nHost: evil.example\r\n\r\n", "403"},
      {"GET /../../../etc/passwd HTTP/1.1\r\nHost: " + host() + "\r\n\r\n", "404"},
      {"GET /%2e%2e%2fetc/passwd HTTP/1.1\r\nHost: " + host() + "\r\n\r\n", "404"},
      {"GET /live?token=" + token + " HTTP/1.1\r\nHost: " + host() + "\r\n\r\n", "404"},
      {"POST /?token=" + token + " HTTP/1.1\r\nHost: " + host() + "\r\nContent-Length: 9\r\n\r\n123456789", "4"},
      {"DELETE / HTTP/1.1\r\nHost: " + host() + "\r\n\r\n", "405"},
      {"GET /" + std::string(9000, 'a') + " HTTP/1.1\r\nHost: " + host() + "\r\n\r\n", "400"},
      {std::string("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", 11) + std::string(300, '\xaa'), "400"},
      {std::string("\0\0\0\0\0\0\0\0\r\n\r\n", 12), "400"},
  };
  for (int round = 0; round < 50; ++round) {
    for (const auto& [request, status] : hostile) {
      Wire wire(server->port());
      ASSERT_TRUE(wire.connected());
      wire.send(request);
      const std::string answer = wire.receive();
      EXPECT_TRUE(answer.empty() || answer.starts_with("HTTP/1.1 " + status)) << request.substr(0, 60) << "\n"
                                                                              << answer;
    }
  }
  expect_alive();
  const std::lock_guard lock(mutex);
  EXPECT_LE(said.size(), 7U);
}

TEST_F(LiveServer, GivesThePageToThoseWhoKnow) {
  Wire wire(server->port());
  wire.send("GET /?token=" + token + " HTTP/1.1\r\nHost: " + host() + "\r\n\r\n");
  EXPECT_TRUE(wire.receive().ends_with("<p>page"));
}

// Ten thousand messages that are none, by chance but the same in every run, over connections that begin well.
TEST_F(LiveServer, SurvivesTenThousandMalformedMessages) {
  std::mt19937 chance(7);
  const auto any = [&](std::size_t below) { return chance() % below; };
  const std::vector<std::string> texts = {"",
                                          "{",
                                          "[]",
                                          "null",
                                          R"({"do":1})",
                                          R"({"do":"seek"})",
                                          R"({"do":"seek","t":"x"})",
                                          R"({"do":"drag","item":-1,"to":[1,2]})",
                                          R"({"do":"drag","item":1e300,"to":[]})",
                                          R"({"do":"set","parameter":"l"})",
                                          R"({"do":"rate","fps":1e9})",
                                          R"({"do":"method","name":"rk4","step":"a"})",
                                          std::string(5000, '['),
                                          "\xff\xfe\xfd"};
  const std::vector<std::string> commands = {R"({"do":"seek","t":1e308})",
                                             R"({"do":"drag","item":1,"to":[1e300,-1e300]})",
                                             R"({"do":"drag","item":99,"to":[1,2]})",
                                             R"({"do":"set","parameter":"l","value":0})",
                                             R"({"do":"set","parameter":"nothing","value":1})",
                                             R"({"do":"undo"})",
                                             R"({"do":"speed","value":1e308})",
                                             R"({"do":"speed","value":1})",
                                             R"({"do":"method","name":"nonsense"})",
                                             R"({"do":"ghost","name":"rk4","step":1e-9})",
                                             R"({"do":"ghost","name":null})",
                                             R"({"do":"open","model":"../../etc/passwd"})",
                                             R"({"do":"run","text":"x' = = ="})",
                                             R"({"do":"check","id":1,"text":"\u0000"})",
                                             R"({"do":"input","name":"F","value":1})",
                                             R"({"do":"reset"})",
                                             R"({"do":"back"})",
                                             R"({"do":"release"})",
                                             R"({"do":"play"})"};
  int sent = 0;
  while (sent < 10'000) {
    Wire wire(server->port());
    ASSERT_TRUE(wire.connected());
    if (!wire.send(live())) continue;
    for (int k = 0; k < 150; ++k, ++sent) {
      bool fine = true;
      switch (any(6)) {
        case 0:
        case 1:
          fine = wire.send(message(1, texts[any(texts.size())]));
          break;
        case 2:
        case 3:
          fine = wire.send(message(1, commands[any(commands.size())]));
          break;
        case 4: {
          std::string frame = message(static_cast<unsigned char>(any(16)), std::string(any(200), '\x5a'), any(3) != 0);
          if (any(3) == 0) frame[0] = static_cast<char>(frame[0] & 0x7f);  // a part of a message
          fine = wire.send(frame);
          break;
        }
        default: {
          std::string noise(1 + any(40), '\0');
          for (char& c : noise) c = static_cast<char>(any(256));
          if (any(8) == 0) fine = wire.send(noise);
        }
      }
      if (!fine) break;
    }
  }
  expect_alive();
}

TEST_F(LiveServer, AnOversizedMessageEndsItsSender) {
  Wire wire(server->port());
  wire.send(live());
  wire.send(message(1, std::string((1 << 20) + 1, ' ')));
  wire.receive(1 << 26);  // until it is closed
  expect_alive();
}

TEST_F(LiveServer, HalfOpenSocketsAreClosed) {
  Wire silent(server->port()), half(server->port());
  half.send("GET / HTT");
  const auto begin = std::chrono::steady_clock::now();
  silent.receive();
  half.receive();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));  // the time limit is 1 s
  expect_alive();
}

TEST_F(LiveServer, WhoReadsNothingHoldsNobodyUpAndIsLeft) {
  Wire deaf(server->port(), 4096);
  deaf.send(live());
  std::atomic<bool> done = false;
  for (int i = 0; i < 60 && !done; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    if (i > 5 && server->clients() == 0) done = true;
  }
  EXPECT_TRUE(done) << "idle: 2 s without an answer to a ping";
  expect_alive();
}

// Strangers are few, and the oldest goes first: whoever knows the token comes in at once, before any time limit.
TEST_F(LiveServer, IdleStrangersLockNobodyOut) {
  std::vector<std::unique_ptr<Wire>> idle;
  for (int i = 0; i < 64; ++i) {
    idle.push_back(std::make_unique<Wire>(server->port()));
    if (i % 3 == 0) idle.back()->send("GET / HTTP/1.1\r\nHost: ");
    if (i % 3 == 1) idle.back()->send(upgrade("/live?token=wrong"));
  }
  expect_alive();
  std::size_t closed = 0;
  for (const auto& wire : idle) closed += wire->is_closed() ? 1 : 0;
  EXPECT_GE(closed, 64U - 8U - 64U / 3) << "of those who have said nothing, eight may stay";
}

TEST_F(LiveServer, AViewerMayDoNothingButSee) {
  for (const std::string_view name : all_commands()) {
    const bool allowed_to_all = name == "ping" || name == "rate";
    EXPECT_EQ(may({.role = Role::viewer, .may_save = true}, name), allowed_to_all) << name;
    EXPECT_EQ(may({.role = Role::presenter}, name), name != "save") << name;
    EXPECT_EQ(may({.role = Role::owner, .may_save = true}, name), name != "save") << name;
    EXPECT_TRUE(may({.role = Role::presenter, .may_save = true}, name)) << name;
  }
  EXPECT_FALSE(may({.role = Role::presenter, .may_save = true}, "format_disk"));
  Wire wire(server->port());
  ASSERT_TRUE(wire.send(upgrade("/live?token=" + viewers_token())));
  std::string heard;
  const auto hear = [&](const std::string& word) {
    for (std::string more; heard.find(word) == std::string::npos; heard += more) {
      more = wire.receive(4096);
      if (more.empty()) return;
    }
  };
  hear(R"("say":"model")");  // a client speaks when it has been let in
  for (const std::string_view name : all_commands())
    wire.send(message(1, R"({"do":")" + std::string(name) +
                             R"(","id":1,"fps":30,"t":0,"value":0,"parameter":"l","name":"rk4","text":"x' = 1",)" +
                             R"("item":0,"body":0,"to":[0,0],"model":"spring"})"));
  wire.send(message(1, R"({"do":"ping","id":77})"));
  hear(R"("id":77)");
  for (const std::string_view name : all_commands()) {
    const bool refused = heard.find("`" + std::string(name) + "` is the presenter's") != std::string::npos;
    EXPECT_EQ(refused, name != "ping" && name != "rate") << name;
  }
  EXPECT_NE(heard.find(R"("role":"viewer")"), std::string::npos);
}

TEST_F(LiveServer, TheShortAddressLeadsToTheLongOne) {
  Wire wire(server->port());
  wire.send("GET /" + viewers_token() + " HTTP/1.1\r\nHost: " + host() + "\r\n\r\n");
  const std::string answer = wire.receive();
  EXPECT_TRUE(answer.starts_with("HTTP/1.1 303"));
  EXPECT_NE(answer.find("/?token=" + viewers_token()), std::string::npos);
  EXPECT_EQ(answer.find(token), std::string::npos) << "the presenter's token is nobody else's";
}

TEST_F(LiveServer, ViewersHaveTheirNumberAndPresentersTheirOwn) {
  std::vector<std::unique_ptr<Wire>> many;
  for (int i = 0; i < 14; ++i) {
    many.push_back(std::make_unique<Wire>(server->port()));
    many.back()->send(upgrade("/live?token=" + viewers_token()));
    const std::string status = many.back()->receive(12);
    EXPECT_EQ(status, i < 10 ? "HTTP/1.1 101" : "HTTP/1.1 503") << i;
  }
  expect_alive();
}

TEST_F(LiveServer, ClientsComeAndGo) {
  std::mt19937 chance(3);
  std::vector<std::unique_ptr<Wire>> here(20);
  for (int i = 0; i < 300; ++i) {
    auto& wire = here[chance() % here.size()];
    wire = std::make_unique<Wire>(server->port());
    wire->send(live());
    if (chance() % 3 == 0) wire->send(message(1, R"({"do": "step"})"));
    if (chance() % 3 == 0) wire->receive(chance() % 5000);
  }
  here.clear();
  expect_alive();
}

TEST_F(LiveServer, AFloodOfCommandsWaitsInItsSender) {
  Wire wire(server->port());
  wire.send(live());
  std::string flood;
  for (int i = 0; i < 20'000; ++i) flood += message(1, R"({"do":"drag","item":1,"to":[0.5,0.5]})");
  wire.send(flood);
  expect_alive();
}

}  // namespace
}  // namespace continuo::live
