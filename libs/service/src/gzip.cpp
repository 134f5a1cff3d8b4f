#include "gzip.hpp"

#include <boost/beast/zlib/deflate_stream.hpp>
#include <boost/crc.hpp>
#include <cstdint>

namespace kith {
namespace {

namespace zlib = boost::beast::zlib;

constexpr int kLevel = 6;
constexpr int kWindowBits = 15;
constexpr int kMemoryLevel = 8;

std::string little_endian(std::uint32_t number) {
  std::string bytes;
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>((number >> shift) & 0xFFU);
  return bytes;
}

}  // namespace

std::string gzipped(std::string_view bytes) {
  zlib::deflate_stream stream;
  stream.reset(kLevel, kWindowBits, kMemoryLevel, zlib::Strategy::normal);
  std::string deflated(stream.upper_bound(bytes.size()), '\0');
  zlib::z_params state;
  state.next_in = bytes.data();
  state.avail_in = bytes.size();
  state.next_out = deflated.data();
  state.avail_out = deflated.size();
  boost::system::error_code error;
  stream.write(state, zlib::Flush::finish, error);
  deflated.resize(state.total_out);
  boost::crc_32_type sum;
  sum.process_bytes(bytes.data(), bytes.size());
  const std::string head{"\x1F\x8B\x08\0\0\0\0\0\0\x03", 10};  // deflate, no time, Unix
  return head + deflated + little_endian(sum.checksum()) + little_endian(static_cast<std::uint32_t>(bytes.size()));
}

}  // namespace kith
