// continuo/live/server/origin_guard.cpp
// Compares token, host and origin of a request.
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <sys/random.h>

#include <continuo/live/server/origin_guard.hpp>

namespace continuo::live {

namespace {

std::string random_text(std::string_view letters, std::size_t length) {
  std::string text;
  while (text.size() < length) {
    unsigned char byte = 0;
    if (::getrandom(&byte, 1, 0) != 1) throw std::runtime_error("the operating system gives no random numbers");
    const std::size_t whole = 256 - 256 % letters.size();  // beyond it some letters would be likelier than others
    if (byte < whole) text += letters[byte % letters.size()];
  }
  return text;
}

/// In a time that does not depend on how much of it is right.
bool is_token(std::string_view given, std::string_view token) {
  unsigned difference = given.size() == token.size() ? 0 : 1;
  for (std::size_t i = 0; i < token.size(); ++i) {
    const char other = i < given.size() ? given[i] : '\0';
    difference |= static_cast<unsigned>(static_cast<unsigned char>(token[i]) ^ static_cast<unsigned char>(other));
  }
  return difference == 0;
}

struct Query {
  std::string_view token{};
  bool own = false;
};
Query read_query(std::string_view query) {
  Query read;
  while (!query.empty()) {
    const std::size_t end = query.find('&');
    const std::string_view part = query.substr(0, end);
    if (part.starts_with("token=")) read.token = part.substr(6);
    if (part == "own" || part == "own=") read.own = true;
    query = end == std::string_view::npos ? "" : query.substr(end + 1);
  }
  return read;
}

}  // namespace

Tokens make_tokens() {
  // Without letters and digits that look alike.
  constexpr std::string_view digits = "0123456789abcdef";
  return {random_text(digits, 32), random_text("23456789abcdefghjkmnpqrstuvwxyz", 10), random_text(digits, 32)};
}

OriginGuard::OriginGuard(Tokens tokens, std::string address, unsigned port)
    : tokens_(std::move(tokens)), address_(std::move(address)), port_(port) {}

bool OriginGuard::knows_host(std::string_view host) const {
  const bool only_here = address_.starts_with("127.") || address_ == "::1";
  if (!only_here) return !host.empty();
  const std::string port = fmt::format(":{}", port_);
  for (const std::string_view name : {"127.0.0.1", "localhost", "[::1]"}) {
    if (host == std::string(name) + port) return true;
  }
  return host == address_ + port;
}

Admission OriginGuard::judge(const Request& request) const {
  if (request.method != "GET") return {Verdict::wrong_method};
  const std::size_t question = request.target.find('?');
  const std::string_view path = request.target.substr(0, question);
  const Query query = read_query(question == std::string_view::npos ? "" : request.target.substr(question + 1));
  const auto is_address_of = [&](const std::string& name) {
    return path.size() == name.size() + 1 && is_token(path.substr(1), name) && knows_host(request.host);
  };
  if (is_address_of(tokens_.viewers)) return {Verdict::short_address};
  if (!tokens_.first.empty() && is_address_of(tokens_.first)) return {Verdict::first_address};
  const bool live = path == "/live";
  if (!live && path != "/") return {Verdict::not_found};
  if (!knows_host(request.host)) return {Verdict::wrong_host};
  if (!request.origin.empty() && request.origin != fmt::format("http://{}", request.host))
    return {Verdict::wrong_origin};
  const bool presents = is_token(query.token, tokens_.presenter);
  if (!presents && !is_token(query.token, tokens_.viewers)) return {Verdict::wrong_token};
  if (live != request.upgrade) return {Verdict::not_found};
  const Role role = presents ? Role::presenter : query.own ? Role::owner : Role::viewer;
  return {live ? Verdict::live : Verdict::page, role};
}

void SayOnce::operator()(const std::string& kind) {
  if (counts_[kind]++ == 0) say_(kind);
}

}  // namespace continuo::live
