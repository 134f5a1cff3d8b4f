#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "raw_client.hpp"

namespace kith::testing {

inline constexpr std::string_view kUpgrade =
    "GET /ws HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
    "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";
inline constexpr std::string_view kHello = R"({"t":"hello","v":1,"token":"good","tab":"1"})";

/// A frame of RFC 6455, 5.2. @param head  first byte: FIN, reserved bits, opcode.
[[nodiscard]] inline std::string frame_of(unsigned head, std::string_view payload, bool masked = true) {
  std::string frame(1, static_cast<char>(head));
  const unsigned mask_bit = masked ? 0x80U : 0U;
  const auto size = payload.size();
  if (size < 126) {
    frame += static_cast<char>(mask_bit | size);
  } else if (size < 65536) {
    frame += static_cast<char>(mask_bit | 126U);
    frame += static_cast<char>(size >> 8U);
    frame += static_cast<char>(size & 0xFFU);
  } else {
    frame += static_cast<char>(mask_bit | 127U);
    for (int shift = 56; shift >= 0; shift -= 8) frame += static_cast<char>((size >> shift) & 0xFFU);
  }
  constexpr std::string_view kMask = "\x12\x34\x56\x78";
  if (masked) frame += kMask;
  for (std::size_t i = 0; i < size; ++i) frame += masked ? static_cast<char>(payload[i] ^ kMask[i % 4]) : payload[i];
  return frame;
}

[[nodiscard]] inline std::string text_frame(std::string_view text) { return frame_of(0x81, text); }

/// A WebSocket client that can send what no client may.
class RawWebSocket {
 public:
  struct Frame {
    unsigned head = 0;
    std::string payload;
  };

  explicit RawWebSocket(std::uint16_t port, int receive_buffer = 0) : client_{port, receive_buffer} {
    client_.send(kUpgrade);
    reply_ = read_reply(client_);
  }
  [[nodiscard]] const RawReply& reply() const { return reply_; }
  RawClient& raw() { return client_; }
  bool send(std::string_view bytes) { return client_.send(bytes); }
  bool say(std::string_view text) { return client_.send(text_frame(text)); }

  /// The next frame, or nothing if the connection ended or none came in time.
  std::optional<Frame> read(int milliseconds = 10'000) {
    const auto needs = [](std::string_view in) -> std::size_t {
      if (in.size() < 2) return 2;
      const auto byte = [in](std::size_t i) { return static_cast<std::size_t>(static_cast<unsigned char>(in[i])); };
      const auto size = byte(1) & 0x7FU;
      if (size < 126) return 2 + size;
      if (size == 126) return in.size() < 4 ? 4 : 4 + (byte(2) << 8U) + byte(3);
      if (in.size() < 10) return 10;
      return 10 + (byte(6) << 24U) + (byte(7) << 16U) + (byte(8) << 8U) + byte(9);
    };
    if (!client_.read_until([&](std::string_view in) { return in.size() >= needs(in); }, milliseconds)) return {};
    auto& in = client_.received();
    const auto all = needs(in);
    const auto size = static_cast<unsigned char>(in[1]);
    const std::size_t start = size < 126 ? 2 : (size == 126 ? 4 : 10);
    Frame frame{static_cast<unsigned char>(in[0]), in.substr(start, all - start)};
    in.erase(0, all);
    return frame;
  }
  /// The code of the next close frame; 1006 if the connection ends without one, 0 if it does not end.
  int close_code(int milliseconds = 10'000) {
    for (;;) {
      const auto frame = read(milliseconds);
      if (!frame) return client_.is_ended(0) ? 1006 : 0;
      if ((frame->head & 0x0FU) != 8) continue;
      if (frame->payload.size() < 2) return 1005;
      const auto code =
          (static_cast<unsigned char>(frame->payload[0]) << 8U) | static_cast<unsigned char>(frame->payload[1]);
      reason_ = frame->payload.substr(2);
      return static_cast<int>(code);
    }
  }
  [[nodiscard]] const std::string& reason() const { return reason_; }
  /// The next text.
  std::string hear(int milliseconds = 10'000) {
    for (;;) {
      const auto frame = read(milliseconds);
      if (!frame) return {};
      if ((frame->head & 0x0FU) == 1) return frame->payload;
    }
  }

 private:
  RawClient client_;
  RawReply reply_;
  std::string reason_;
};

}  // namespace kith::testing
