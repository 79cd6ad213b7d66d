// continuo/live/server/origin_guard.cpp
// Compares token, host and origin of a request.
#include <array>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <sys/random.h>

#include <continuo/live/server/origin_guard.hpp>

namespace continuo::live {

std::string make_token() {
  std::array<unsigned char, 16> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw std::runtime_error("the operating system gives no random numbers");
  std::string token;
  for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

OriginGuard::OriginGuard(std::string token, std::string address, unsigned port)
    : token_(std::move(token)), address_(std::move(address)), port_(port) {}

/// In a time that does not depend on how much of it is right.
bool OriginGuard::is_token(std::string_view given) const {
  unsigned difference = given.size() == token_.size() ? 0 : 1;
  for (std::size_t i = 0; i < token_.size(); ++i) {
    const char other = i < given.size() ? given[i] : '\0';
    difference |= static_cast<unsigned>(static_cast<unsigned char>(token_[i]) ^ static_cast<unsigned char>(other));
  }
  return difference == 0;
}

bool OriginGuard::knows_host(std::string_view host) const {
  const bool only_here = address_.starts_with("127.") || address_ == "::1";
  if (!only_here) return !host.empty();
  const std::string port = fmt::format(":{}", port_);
  for (const std::string_view name : {"127.0.0.1", "localhost", "[::1]"}) {
    if (host == std::string(name) + port) return true;
  }
  return host == address_ + port;
}

Verdict OriginGuard::judge(const Request& request) const {
  if (request.method != "GET") return Verdict::wrong_method;
  const std::size_t question = request.target.find('?');
  const std::string_view path = request.target.substr(0, question);
  std::string_view query = question == std::string_view::npos ? "" : request.target.substr(question + 1);
  const bool live = path == "/live";
  if (!live && path != "/") return Verdict::not_found;
  if (!knows_host(request.host)) return Verdict::wrong_host;
  if (!request.origin.empty() && request.origin != fmt::format("http://{}", request.host)) return Verdict::wrong_origin;
  std::string_view token;
  while (!query.empty()) {
    const std::size_t end = query.find('&');
    const std::string_view part = query.substr(0, end);
    if (part.starts_with("token=")) token = part.substr(6);
    query = end == std::string_view::npos ? "" : query.substr(end + 1);
  }
  if (!is_token(token)) return Verdict::wrong_token;
  if (live != request.upgrade) return Verdict::not_found;
  return live ? Verdict::live : Verdict::page;
}

void SayOnce::operator()(const std::string& kind) {
  if (counts_[kind]++ == 0) say_(kind);
}

}  // namespace continuo::live
