// continuo/live/server/gzip.cpp
// RFC 1952 round the deflate of Boost.Beast.
#include <algorithm>
#include <array>
#include <cstdint>

#include <boost/beast/zlib/inflate_stream.hpp>
#include <boost/crc.hpp>

#include <continuo/live/server/gzip.hpp>

namespace continuo::live {

namespace {

namespace zlib = boost::beast::zlib;

/// Where the deflated bytes begin; nothing where this is no gzip.
std::size_t header_length(std::string_view bytes) {
  enum : unsigned { has_check = 2, has_extra = 4, has_name = 8, has_comment = 16 };
  const auto byte = [&](std::size_t i) { return i < bytes.size() ? static_cast<unsigned char>(bytes[i]) : 0U; };
  if (bytes.size() < 18 || byte(0) != 0x1f || byte(1) != 0x8b || byte(2) != 8) return std::string_view::npos;
  const unsigned flags = byte(3);
  std::size_t at = 10;
  if (flags & has_extra) at += 2 + byte(at) + 256 * byte(at + 1);
  for (const unsigned text : {has_name, has_comment}) {
    if (flags & text) at = bytes.find('\0', at) + 1;
  }
  if (flags & has_check) at += 2;
  return at + 8 <= bytes.size() ? at : std::string_view::npos;
}

std::string number(std::uint32_t value) {
  std::string bytes;
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(value >> shift & 0xff);
  return bytes;
}

}  // namespace

std::string unzipped(std::string_view bytes) {
  const std::size_t begin = header_length(bytes);
  if (begin == std::string_view::npos) return {};
  zlib::inflate_stream stream;
  zlib::z_params state;
  state.next_in = bytes.data() + begin;
  state.avail_in = bytes.size() - begin - 8;
  std::string out;
  std::array<char, 65536> part{};
  boost::system::error_code error;
  do {
    state.next_out = part.data();
    state.avail_out = part.size();
    stream.write(state, zlib::Flush::sync, error);
    out.append(part.data(), part.size() - state.avail_out);
  } while (!error && state.avail_out == 0);
  const bool ended = !error || error == zlib::error::end_of_stream || error == zlib::error::need_buffers;
  return ended ? out : std::string();
}

std::string stored(std::string_view bytes) {
  std::string out("\x1f\x8b\x08\0\0\0\0\0\0\xff", 10);
  std::string_view rest = bytes;
  do {
    const std::string_view part = rest.substr(0, 65535);
    rest.remove_prefix(part.size());
    const auto length = static_cast<std::uint32_t>(part.size());
    out += rest.empty() ? '\1' : '\0';
    out += number(length | (~length & 0xffff) << 16);
    out += part;
  } while (!rest.empty());
  boost::crc_32_type check;
  check.process_bytes(bytes.data(), bytes.size());
  return out + number(check.checksum()) + number(static_cast<std::uint32_t>(bytes.size()));
}

}  // namespace continuo::live
