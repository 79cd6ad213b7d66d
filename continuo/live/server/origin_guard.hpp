// continuo/live/server/origin_guard.hpp
// Who is let in, and as whom: the page and the socket, to those who know the presenter's token or the viewers', at the
// address the server goes by, from no page but its own. A page of somebody else's, open in the same browser, can reach
// 127.0.0.1 as well.
#pragma once
#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include <continuo/live/session/commands.hpp>

namespace continuo::live {

/// The parts of a request that decide.
struct Request {
  std::string_view method{}, target{}, host{}, origin{};  // origin empty where there is none: no browser
  bool upgrade = false;
};

enum class Verdict {
  page,
  live,
  short_address,
  first_address,
  wrong_token,
  wrong_origin,
  wrong_host,
  not_found,
  wrong_method
};

/// What is decided of a request.
struct Admission {
  Verdict verdict;
  Role role = Role::viewer;  // owner: a viewer who asks for a session of their own
};

/// What the two kinds of guests show.
struct Tokens {
  std::string presenter;  // 128 bits from the operating system, in hexadecimal digits
  std::string viewers;    // 49 bits, in ten letters and digits that a class can copy from a blackboard
  std::string first{};    // of an address that leads to the presenter's once: for the browser's command line
};
Tokens make_tokens();

class OriginGuard {
 public:
  /// `address`, `port`: where the server listens. At an address that only this computer reaches, the names it goes by
  /// are known, and a request by another name was led here by somebody's name server.
  OriginGuard(Tokens tokens, std::string address, unsigned port);

  Admission judge(const Request& request) const;

 private:
  bool knows_host(std::string_view host) const;

  Tokens tokens_;
  std::string address_;
  unsigned port_;
};

/// Logs each kind of refusal once and counts the others, so that a flood of requests does not flood the log.
class SayOnce {
 public:
  using Say = std::function<void(const std::string&)>;
  explicit SayOnce(Say say) : say_(std::move(say)) {}
  void operator()(const std::string& kind);
  const std::map<std::string, std::size_t>& counts() const { return counts_; }

 private:
  Say say_;
  std::map<std::string, std::size_t> counts_;
};

}  // namespace continuo::live
