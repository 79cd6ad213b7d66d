// continuo/live/server/reachable_name.cpp
// Looks through the network interfaces of this computer.
#include <array>
#include <memory>

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>

#include <continuo/live/server/reachable_name.hpp>

namespace continuo::live {

std::string reachable_name(const std::string& address) {
  if (address != "0.0.0.0" && address != "::") return address;
  ifaddrs* first = nullptr;
  if (::getifaddrs(&first) != 0) return address;
  const std::unique_ptr<ifaddrs, void (*)(ifaddrs*)> all(first, &::freeifaddrs);
  for (const ifaddrs* each = first; each; each = each->ifa_next) {
    const bool usable = (each->ifa_flags & IFF_UP) && !(each->ifa_flags & IFF_LOOPBACK);
    if (!usable || !each->ifa_addr || each->ifa_addr->sa_family != AF_INET) continue;
    std::array<char, INET_ADDRSTRLEN> text{};
    const auto* internet = reinterpret_cast<const sockaddr_in*>(each->ifa_addr);
    if (::inet_ntop(AF_INET, &internet->sin_addr, text.data(), text.size())) return text.data();
  }
  return "127.0.0.1";  // no network: only this computer reaches it
}

}  // namespace continuo::live
