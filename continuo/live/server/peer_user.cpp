// continuo/live/server/peer_user.cpp
// Reads /proc/net/tcp and /proc/net/tcp6 (proc(5)).
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

#include <continuo/live/server/peer_user.hpp>

namespace continuo::live {

namespace {

using boost::asio::ip::tcp;

template <std::size_t N>
std::string words_of(const std::array<unsigned char, N>& bytes) {
  std::string text;
  for (std::size_t at = 0; at < N; at += 4) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + at, sizeof word);
    text += fmt::format("{:08X}", word);
  }
  return text;
}

}  // namespace

std::string listed_name(const tcp::endpoint& endpoint) {
  const auto address = endpoint.address();
  const std::string words =
      address.is_v4() ? words_of(address.to_v4().to_bytes()) : words_of(address.to_v6().to_bytes());
  return fmt::format("{}:{:04X}", words, endpoint.port());
}

bool is_of_own_user(const tcp::socket& socket) {
  boost::system::error_code error;
  const tcp::endpoint here = socket.local_endpoint(error), there = socket.remote_endpoint(error);
  if (error) return false;
  // As its owner sees the connection: from there to here. A socket of IPv6 that reaches an address of IPv4 is listed
  // with what stands before such an address.
  const std::string from = listed_name(there), to = listed_name(here);
  const std::string before = words_of(boost::asio::ip::make_address_v6("::ffff:0.0.0.0").to_bytes()).substr(0, 24);
  for (const char* list : {"/proc/net/tcp", "/proc/net/tcp6"}) {
    std::ifstream file(list);
    for (std::string line; std::getline(file, line);) {
      std::istringstream words(line);
      std::string skipped, local, remote;
      unsigned user = 0;
      // sl local remote st queues timer retransmissions uid
      words >> skipped >> local >> remote >> skipped >> skipped >> skipped >> skipped >> user;
      const bool is_it = (local == from && remote == to) || (local == before + from && remote == before + to);
      if (words && is_it) return user == ::geteuid() || user == 0;
    }
  }
  return false;
}

}  // namespace continuo::live
