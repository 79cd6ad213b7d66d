// continuo/live/server/peer_user.hpp
#pragma once
#include <string>

#include <boost/asio/ip/tcp.hpp>

namespace continuo::live {

/// Whether the other end of this connection is a program of our own user, or of root, on this computer: the kernel
/// keeps a list of connections with their users. False where it is not listed, as from another computer or container.
[[nodiscard]] bool is_of_own_user(const boost::asio::ip::tcp::socket& socket);

/// What that list calls an address: its words as this computer reads them, in hexadecimal digits, and the port.
[[nodiscard]] std::string listed_name(const boost::asio::ip::tcp::endpoint& endpoint);

}  // namespace continuo::live
