// Hand-made cases of RFC 6455: what a client sends after its hello, and the code that the server closes with.
#include <gtest/gtest.h>

#include <chrono>
#include <ostream>
#include <string>
#include <vector>

#include "served.hpp"

namespace kith::testing {
namespace {

struct SocketCase {
  const char* name;
  std::string bytes;
  int code;            // 0: the connection goes on
  std::string answer;  // the next text, where it goes on
};
void PrintTo(const SocketCase& one, std::ostream* out) { *out << one.name; }

std::vector<SocketCase> socket_cases() {
  const auto close_frame = [](int code, const std::string& reason = {}) {
    return frame_of(0x88, std::string{static_cast<char>(code >> 8), static_cast<char>(code & 0xFF)} + reason);
  };
  const std::string depth_32 = std::string(32, '[') + std::string(32, ']');
  const std::string depth_33 = std::string(33, '[') + std::string(33, ']');
  return {
      {"Text", text_frame("hi"), 0, "hi"},
      {"TwoFragments", frame_of(0x01, "hel") + frame_of(0x80, "lo"), 0, "hello"},
      {"APingBetweenFragments", frame_of(0x01, "hel") + frame_of(0x89, "?") + frame_of(0x80, "lo"), 0, "hello"},
      {"EmptyFragments", frame_of(0x01, "") + frame_of(0x00, "") + frame_of(0x80, "x"), 0, "x"},
      {"Ping", frame_of(0x89, "?") + text_frame("on"), 0, "on"},
      {"AnUnaskedPong", frame_of(0x8A, "!") + text_frame("on"), 0, "on"},
      {"LongestPing", frame_of(0x89, std::string(125, 'p')) + text_frame("on"), 0, "on"},
      {"CharacterAcrossFragments", frame_of(0x01, "\xC3") + frame_of(0x80, "\xA9"), 0, "\xC3\xA9"},
      {"LongestMessage", text_frame(std::string(16384, 'a')), 0, std::string(16384, 'a')},
      {"DeepEnough", text_frame(depth_32), 0, depth_32},
      {"BracketsInAString", text_frame("\"" + depth_33 + "\""), 0, "\"" + depth_33 + "\""},
      {"NotMasked", frame_of(0x81, "hi", false), 1002, {}},
      {"ReservedBit1", frame_of(0xC1, "hi"), 1002, {}},
      {"ReservedBit2", frame_of(0xA1, "hi"), 1002, {}},
      {"ReservedBit3", frame_of(0x91, "hi"), 1002, {}},
      {"ReservedOpcode3", frame_of(0x83, "hi"), 1002, {}},
      {"ReservedOpcode7", frame_of(0x87, "hi"), 1002, {}},
      {"ReservedControl", frame_of(0x8B, "hi"), 1002, {}},
      {"PingInFragments", frame_of(0x09, "?"), 1002, {}},
      {"PingTooLong", frame_of(0x89, std::string(126, 'p')), 1002, {}},
      {"ContinuationOfNothing", frame_of(0x80, "lo"), 1002, {}},
      {"NewMessageInsideAnother", frame_of(0x01, "a") + frame_of(0x81, "b"), 1002, {}},
      {"LengthNotMinimal", std::string("\x81\xFE\x00\x02\x00\x00\x00\x00hi", 10), 1002, {}},
      {"LengthWithTopBit", std::string("\x81\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\x00\x00\x00\x00", 14), 1009, {}},
      {"InvalidUtf8", text_frame("\xFF\xFE"), 1007, {}},
      {"OverlongUtf8", text_frame("\xC0\xAF"), 1007, {}},
      {"SurrogateInUtf8", text_frame("\xED\xA0\x80"), 1007, {}},
      {"HalfACharacter", text_frame("a\xC3"), 1007, {}},
      {"Binary", frame_of(0x82, "hi"), 1003, {}},
      {"TooLong", text_frame(std::string(16385, 'a')), 1009, {}},
      {"TooLongInFragments",
       frame_of(0x01, std::string(10000, 'a')) + frame_of(0x80, std::string(10000, 'a')),
       1009,
       {}},
      {"TooLongAnnounced", std::string("\x81\xFF\x00\x00\x00\x00\x7F\xFF\xFF\xFF\x00\x00\x00\x00", 14), 1009, {}},
      {"TooDeep", text_frame(depth_33), 1008, {}},
      {"ClosedByTheClient", close_frame(1000, "bye"), 1000, {}},
      {"ClosedByTheClientGoingAway", close_frame(1001), 1001, {}},
      {"ClosedWithoutACode", frame_of(0x88, ""), 1000, {}},
      {"CloseOfOneByte", frame_of(0x88, "x"), 1002, {}},
      {"CloseCodeOfNobody", close_frame(1006), 1002, {}},
      {"CloseCodeTooSmall", close_frame(999), 1002, {}},
      {"CloseReasonIsNoText", close_frame(1000, "\xFF"), 1002, {}},
      {"ApplicationFails", text_frame("throw"), 1011, {}},
      {"ApplicationCloses", text_frame("leave"), 1000, {}},
  };
}

class SocketCases : public ::testing::TestWithParam<SocketCase> {};

TEST_P(SocketCases, EndWithTheRightCode) {
  const auto& one = GetParam();
  Served served;
  RawWebSocket socket{served.port()};
  ASSERT_EQ(socket.reply().status, 101);
  socket.say(kHello);
  ASSERT_EQ(socket.hear(), R"({"t":"welcome"})");
  socket.send(one.bytes);
  if (one.code == 0) {
    EXPECT_TRUE(socket.hear() == one.answer);
  } else {
    EXPECT_EQ(socket.close_code(), one.code) << socket.reason();
    socket.raw().close();
    EXPECT_TRUE(served.application.wait_until_all_closed());
  }
}

// Beast's read would wait for its close and the other way round.
TEST(WebSocket, LeavesNothingBehindWhenTheProtocolIsBrokenWhileItCloses) {
  Served served{{.limits = {.close_time = std::chrono::milliseconds{100}}}};
  for (int i = 0; i < 20; ++i) {
    RawWebSocket socket{served.port()};
    socket.send(frame_of(0x82, "binary") + frame_of(0x83, "reserved") + std::string(200, '\x7F'));
    EXPECT_EQ(socket.close_code(), 1003);
  }
  EXPECT_TRUE(all_gone(served.server));
}

INSTANTIATE_TEST_SUITE_P(Rfc6455, SocketCases, ::testing::ValuesIn(socket_cases()),
                         [](const auto& one) { return std::string{one.param.name}; });

}  // namespace
}  // namespace kith::testing
