// Inputs that are wrong in many ways, made from right ones with fixed seeds. The server stays, clients that behave are
// served, and nothing is left behind.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "served.hpp"

namespace kith::testing {
namespace {

const std::vector<std::string>& http_seeds() {
  static const std::vector<std::string> kSeeds{
      "GET /j HTTP/1.1\r\nHost: localhost\r\nAccept-Encoding: gzip\r\nIf-None-Match: \"aaaa\"\r\n\r\n",
      "HEAD /assets/live/app.js HTTP/1.1\r\nHost: localhost:80\r\nConnection: keep-alive, close\r\n\r\n",
      "POST /api/join HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: 15\r\n"
      "Origin: http://localhost\r\n\r\n{\"code\":\"ABCD\"}",
      "POST /api/join HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json; charset=utf-8\r\n"
      "Transfer-Encoding: chunked\r\nExpect: 100-continue\r\n\r\n6;a=b\r\n{\"a\":1\r\n1\r\n}\r\n0\r\nTrailer: "
      "x\r\n\r\n",
      std::string{kUpgrade},
      std::string{kUpgrade} + text_frame(kHello) + text_frame("x"),
      "GET /api/a HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer abc\r\n\r\nGET /j HTTP/1.1\r\nHost: x\r\n\r\n",
      "OPTIONS * HTTP/1.1\r\nHost: localhost\r\n\r\n",
      "GET http://localhost/j?a=%41 HTTP/1.0\r\nHost: [::1]\r\nX-Long: " + std::string(500, 'v') + "\r\n\r\n"};
  return kSeeds;
}

const std::vector<std::string>& frame_seeds() {
  static const std::vector<std::string> kSeeds{
      text_frame(R"({"t":"answer","id":"1","body":{"test":0,"actions":[0,1,2],"keys":[[0,12]],"ms":900}})"),
      frame_of(0x01, "{\"t\":") + frame_of(0x89, "ping") + frame_of(0x80, "\"beat\"}"),
      frame_of(0x82, std::string(300, '\x7F')),
      frame_of(0x88, std::string{"\x03\xE8"} + "bye"),
      frame_of(0x8A, "") + text_frame("[[[[[[[[]]]]]]]]") + text_frame("\xC3\xA9"),
      text_frame(std::string(70'000, 'a')).substr(0, 20'000),
      text_frame("flood 20") + frame_of(0x89, std::string(125, 'p'))};
  return kSeeds;
}

std::string mutated(std::string bytes, const std::vector<std::string>& seeds, std::mt19937& random) {
  static const std::vector<std::string> kPieces{"\r\n",
                                                "\n",
                                                ":",
                                                " ",
                                                std::string(1, 0),
                                                "\xFF",
                                                "\x7F",
                                                "HTTP/1.1",
                                                "chunked",
                                                "Content-Length: 5\r\n",
                                                "Transfer-Encoding: chunked\r\n",
                                                "99999999999999999999",
                                                "0\r\n\r\n",
                                                "\x81\xFE",
                                                "\x88"};
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random()) % n; };
  for (auto changes = 1 + below(4); changes > 0 && !bytes.empty(); --changes) {
    const auto at = below(bytes.size());
    const auto length = 1 + below(std::min<std::size_t>(16, bytes.size() - at));
    switch (below(7)) {
      case 0:
        bytes[at] = static_cast<char>(static_cast<unsigned char>(bytes[at]) ^ (1U << below(8)));
        break;
      case 1:
        bytes[at] = static_cast<char>(below(256));
        break;
      case 2:
        bytes.erase(at, length);
        break;
      case 3:
        bytes.insert(at, bytes.substr(at, length));
        break;
      case 4:
        bytes.insert(at, kPieces[below(kPieces.size())]);
        break;
      case 5:
        bytes.resize(at);
        break;
      default: {
        const auto& other = seeds[below(seeds.size())];
        bytes = bytes.substr(0, at) + other.substr(below(other.size()));
      }
    }
  }
  return bytes;
}

long resident_kilobytes() {
  std::ifstream status{"/proc/self/status"};
  for (std::string line; std::getline(status, line);) {
    if (line.rfind("VmRSS:", 0) == 0) return std::stol(line.substr(6));
  }
  return 0;
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kMemoryIsOurs = false;  // the sanitizer keeps what was freed
#else
constexpr bool kMemoryIsOurs = true;
#endif

// Sends each input, ends its half of the connection, and waits until the server has ended the other.
void send_all(int count, unsigned seed, const std::string& before, const std::vector<std::string>& seeds) {
  Served served;
  served.application.release();
  std::mt19937 random{seed};
  long memory = 0;
  for (int i = 0; i < count; ++i) {
    const auto bytes = before + mutated(seeds[static_cast<std::size_t>(i) % seeds.size()], seeds, random);
    RawClient client{served.port()};
    ASSERT_TRUE(client.is_connected()) << "input " << i;
    client.send(bytes);
    client.end_sending();
    ASSERT_TRUE(client.is_ended()) << "input " << i << " keeps its connection: " << ::testing::PrintToString(bytes);
    if (i % 200 == 199) {
      ASSERT_TRUE(served.serves_well()) << "input " << i;
    }
    if (i == count / 2) memory = resident_kilobytes();
  }
  EXPECT_TRUE(served.serves_well());
  EXPECT_TRUE(all_gone(served.server));
  EXPECT_TRUE(served.application.wait_until_all_closed());
  if (kMemoryIsOurs) {
    EXPECT_LT(resident_kilobytes() - memory, 5'000) << "kilobytes more than halfway";
  }
}

const std::string kBeforeFrames = std::string{kUpgrade};

TEST(Malformed, RequestsLeaveTheServerAsItWas) { send_all(1000, 1, "", http_seeds()); }

// Frames follow the request at once, so most of these are refused with it.
TEST(Malformed, FramesTooEarlyLeaveTheServerAsItWas) { send_all(200, 2, kBeforeFrames, frame_seeds()); }

void send_frames(int count, unsigned seed) {
  // Some end in the middle of a close; nobody needs two seconds here to finish it.
  Served served{{.limits = {.close_time = std::chrono::milliseconds{50}}}};
  std::mt19937 random{seed};
  for (int i = 0; i < count; ++i) {
    const auto bytes =
        mutated(frame_seeds()[static_cast<std::size_t>(i) % frame_seeds().size()], frame_seeds(), random);
    RawWebSocket socket{served.port()};
    ASSERT_EQ(socket.reply().status, 101) << "input " << i;
    if (i % 2 == 0) socket.say(kHello);
    socket.send(bytes);
    socket.raw().end_sending();
    ASSERT_TRUE(socket.raw().is_ended()) << "input " << i
                                         << " keeps its connection: " << ::testing::PrintToString(bytes);
    if (i % 200 == 199) {
      ASSERT_TRUE(served.serves_well()) << "input " << i;
    }
  }
  EXPECT_TRUE(served.serves_well());
  EXPECT_TRUE(all_gone(served.server));
  EXPECT_TRUE(served.application.wait_until_all_closed());
}

TEST(Malformed, FramesLeaveTheServerAsItWas) { send_frames(400, 3); }

TEST(MalformedSlow, RequestsLeaveTheServerAsItWas) { send_all(10'000, 4, "", http_seeds()); }
TEST(MalformedSlow, FramesLeaveTheServerAsItWas) { send_frames(10'000, 5); }

// Hundreds of heads and bodies that arrive a byte at a time, or not at all.
TEST(Malformed, SlowClientsAreEndedAndOthersServed) {
  Served served{{.limits = {.unauthenticated_per_address = 1000,
                            .header_time = std::chrono::milliseconds{500},
                            .body_time = std::chrono::milliseconds{500}}}};
  const std::vector<std::string> beginnings{
      "", "G", "GET /j HTTP/1.1\r\nHost: localhost\r\nX-A: ",
      "POST /api/a HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: 100\r\n\r\n["};
  std::vector<RawClient> slow;
  for (std::size_t i = 0; i < 400; ++i) {
    slow.emplace_back(served.port());
    slow.back().send(beginnings[i % beginnings.size()]);
  }
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(served.serves_well());
  for (auto& client : slow) EXPECT_TRUE(client.is_ended());
  EXPECT_TRUE(all_gone(served.server));
}

}  // namespace
}  // namespace kith::testing
