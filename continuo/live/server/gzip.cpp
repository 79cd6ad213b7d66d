// continuo/live/server/gzip.cpp
// The gzip format (RFC 1952) by zlib.
#include <array>
#include <cstddef>

#include <zlib.h>

#include <continuo/live/server/gzip.hpp>

namespace continuo::live {

namespace {

// The longest window; the 16 asks for the header and the check of gzip (zlib.h, inflateInit2).
constexpr int gzip_format = MAX_WBITS + 16;

z_stream stream_of(std::string_view bytes) {
  z_stream stream{};
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));  // only read
  stream.avail_in = static_cast<uInt>(bytes.size());
  return stream;
}

/// Appends what `convert`, which is inflate or deflate, makes of the stream. Returns Z_STREAM_END where that was all.
int convert_all(z_stream& stream, int (*convert)(z_streamp, int), int flush, std::string& out) {
  std::array<char, 65536> part{};
  int result = Z_OK;
  while (result == Z_OK) {
    stream.next_out = reinterpret_cast<Bytef*>(part.data());
    stream.avail_out = static_cast<uInt>(part.size());
    result = convert(&stream, flush);
    out.append(part.data(), part.size() - stream.avail_out);
  }
  return result;
}

}  // namespace

std::string unzipped(std::string_view bytes) {
  z_stream stream = stream_of(bytes);
  if (inflateInit2(&stream, gzip_format) != Z_OK) return {};
  std::string out;
  const int result = convert_all(stream, inflate, Z_NO_FLUSH, out);
  inflateEnd(&stream);
  return result == Z_STREAM_END ? out : std::string();
}

std::string stored(std::string_view bytes) {
  constexpr int memory = 8;  // of 1 to 9, zlib's own choice
  z_stream stream = stream_of(bytes);
  if (deflateInit2(&stream, Z_NO_COMPRESSION, Z_DEFLATED, gzip_format, memory, Z_DEFAULT_STRATEGY) != Z_OK) return {};
  std::string out;
  convert_all(stream, deflate, Z_FINISH, out);
  deflateEnd(&stream);
  return out;
}

}  // namespace continuo::live
