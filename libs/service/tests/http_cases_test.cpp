// Hand-made cases of RFC 9112 and RFC 9110: what a request gets, and whether the connection goes on.
#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

#include "served.hpp"

namespace kith::testing {
namespace {

enum class After { kOpen, kClosed };

struct HttpCase {
  const char* name;
  std::string request;
  int status;  // 0: no reply
  After after = After::kClosed;
};
void PrintTo(const HttpCase& one, std::ostream* out) { *out << one.name; }

const std::string kHost = "Host: localhost\r\n";

std::vector<HttpCase> http_cases() {
  const auto get = [](const std::string& target, const std::string& fields = {}) {
    return "GET " + target + " HTTP/1.1\r\n" + kHost + fields + "\r\n";
  };
  const auto post = [](const std::string& fields, const std::string& body) {
    return "POST /api/a HTTP/1.1\r\n" + kHost + "Content-Type: application/json\r\n" + fields + "\r\n" + body;
  };
  const auto length = [](std::size_t n) { return "Content-Length: " + std::to_string(n) + "\r\n"; };
  const std::string upgrade = "Connection: Upgrade\r\nUpgrade: websocket\r\n";
  const std::string version = "Sec-WebSocket-Version: 13\r\n";
  const std::string key = "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";
  return {
      {"APage", get("/j"), 200, After::kOpen},
      {"APageWithAQuery", get("/j?PROLIFIC_PID=1"), 200, After::kOpen},
      {"ALineBeforeTheRequest", "\r\n" + get("/j"), 200, After::kOpen},
      {"AbsoluteForm", "GET http://localhost:1/j HTTP/1.1\r\n" + kHost + "\r\n", 200, After::kOpen},
      {"AbsoluteFormOfAnother", "GET http://evil.example/j HTTP/1.1\r\n" + kHost + "\r\n", 421},
      {"AnOldVersion", "GET /j HTTP/1.0\r\n" + kHost + "\r\n", 200, After::kClosed},
      {"AskedToClose", get("/j", "Connection: close\r\n"), 200, After::kClosed},
      {"HeadOfAPage", "HEAD /j HTTP/1.1\r\n" + kHost + "\r\n", 200, After::kOpen},
      {"HeadOfApi", "HEAD /api/a HTTP/1.1\r\n" + kHost + "\r\n", 200, After::kOpen},
      {"NothingThere", get("/nothing"), 404, After::kOpen},
      {"NoWayUp", get("/assets/live/../../etc/passwd"), 404, After::kOpen},
      {"NoEncodedWayUp", get("/assets/live/%2e%2e/app.js"), 404, After::kOpen},
      {"AssetsAreRead", "POST /j HTTP/1.1\r\n" + kHost + "Content-Length: 0\r\n\r\n", 405, After::kOpen},
      {"ApiIsNotDeleted", "DELETE /api/a HTTP/1.1\r\n" + kHost + "\r\n", 405, After::kOpen},
      {"TraceIsOff", "TRACE /j HTTP/1.1\r\n" + kHost + "\r\n", 405, After::kOpen},
      {"OptionsOfTheServer", "OPTIONS * HTTP/1.1\r\n" + kHost + "\r\n", 405, After::kOpen},
      {"ConnectIsNoProxy", "CONNECT evil.example:443 HTTP/1.1\r\n" + kHost + "\r\n", 400},
      {"UnknownMethod", "BREW /j HTTP/1.1\r\n" + kHost + "\r\n", 501},
      {"NoHost", "GET /j HTTP/1.1\r\n\r\n", 400},
      {"NoHostInAnOldVersion", "GET /j HTTP/1.0\r\n\r\n", 400},
      {"TwoHosts", "GET /j HTTP/1.1\r\n" + kHost + kHost + "\r\n", 400},
      {"AnotherHost", "GET /j HTTP/1.1\r\nHost: evil.example\r\n\r\n", 421},
      {"HostIsNoHost", "GET /j HTTP/1.1\r\nHost: local host\r\n\r\n", 400},
      {"HostWithAPath", "GET /j HTTP/1.1\r\nHost: localhost/x\r\n\r\n", 400},
      {"HostWithAPort", "GET /j HTTP/1.1\r\nHost: LOCALHOST:9999\r\n\r\n", 200, After::kOpen},
      {"HostIpv6", "GET /j HTTP/1.1\r\nHost: [::1]:8642\r\n\r\n", 200, After::kOpen},
      {"NewerVersion", "GET /j HTTP/2.0\r\n" + kHost + "\r\n", 505},
      {"NoVersion", "GET /j\r\n\r\n", 400},
      {"NoSuchProtocol", "GET /j HTCPCP/1.1\r\n\r\n", 400},
      {"SpaceBeforeAColon", "GET /j HTTP/1.1\r\nHost : localhost\r\n\r\n", 400},
      {"NoColon", "GET /j HTTP/1.1\r\n" + kHost + "nonsense\r\n\r\n", 400},
      {"ControlInAField", "GET /j HTTP/1.1\r\n" + kHost + "X: a\x01z\r\n\r\n", 400},
      {"TabInATarget", "GET /\tj HTTP/1.1\r\n" + kHost + "\r\n", 400},
      {"TwoSpaces", "GET  /j HTTP/1.1\r\n" + kHost + "\r\n", 400},
      {"TargetWithoutASlash", "GET j HTTP/1.1\r\n" + kHost + "\r\n", 400},
      {"TargetBeyondAscii", "GET /j\xC3\xA9 HTTP/1.1\r\n" + kHost + "\r\n", 400},
      {"LongTarget", get("/" + std::string(3000, 'a')), 414},
      {"EndlessRequestLine", "GET /" + std::string(9000, 'a'), 414},
      {"LongHeader", get("/j", "X: " + std::string(9000, 'a') + "\r\n"), 431},
      {"Expectation", post("Expect: tea\r\n" + length(2), "{}"), 417},
      {"BodyOfAnApiCall", post(length(2), "{}"), 200, After::kOpen},
      {"LongestBody", post(length(65536), "[" + std::string(65534, ' ') + "]"), 200, After::kOpen},
      {"BodyTooLong", post(length(65537), ""), 413},
      {"AbsurdLength", post("Content-Length: 99999999999999999999\r\n", ""), 400},
      {"NegativeLength", post("Content-Length: -1\r\n", ""), 400},
      {"LengthInWords", post("Content-Length: two\r\n", "{}"), 400},
      {"LengthsThatDiffer", post(length(2) + length(3), "{}"), 400},
      {"LengthAndChunks", post(length(2) + "Transfer-Encoding: chunked\r\n", "{}"), 400},
      {"ChunksAndLength", post("Transfer-Encoding: chunked\r\n" + length(2), "{}"), 400},
      {"Chunks", post("Transfer-Encoding: chunked\r\n", "1\r\n{\r\n1\r\n}\r\n0\r\n\r\n"), 200, After::kOpen},
      {"ChunkedTwice", post("Transfer-Encoding: chunked\r\nTransfer-Encoding: chunked\r\n", ""), 400},
      {"OtherEncoding", post("Transfer-Encoding: gzip\r\n", ""), 501},
      {"ChunkedNotLast", post("Transfer-Encoding: chunked, gzip\r\n", ""), 501},
      {"ChunkSizeInWords", post("Transfer-Encoding: chunked\r\n", "zz\r\n{}\r\n"), 400},
      {"ChunksTooLong", post("Transfer-Encoding: chunked\r\n", "FFFFFFFF\r\n"), 413},
      {"ChunksInAnOldVersion",
       "POST /api/a HTTP/1.0\r\n" + kHost + "Content-Type: application/json\r\nTransfer-Encoding: chunked\r\n\r\n",
       400},
      {"BodyOfAnotherType", "POST /api/a HTTP/1.1\r\n" + kHost + "Content-Type: text/plain\r\n" + length(2) + "\r\n{}",
       415},
      {"DeepJson", post(length(66), std::string(33, '[') + std::string(33, ']')), 400},
      {"JsonDeepEnough", post(length(64), std::string(32, '[') + std::string(32, ']')), 200, After::kOpen},
      {"PostOfAnotherSite", post("Origin: https://evil.example\r\n" + length(2), "{}"), 403},
      {"PostOfOurPage", post("Origin: http://localhost\r\n" + length(2), "{}"), 200, After::kOpen},
      {"AFailureOfTheApplication", get("/api/throw"), 500, After::kOpen},
      {"SocketWithoutUpgrade", get("/ws"), 426, After::kOpen},
      {"SocketByPost", "POST /ws HTTP/1.1\r\n" + kHost + "Content-Length: 0\r\n\r\n", 405, After::kOpen},
      {"SocketOfAnOldVersion", "GET /ws HTTP/1.0\r\n" + kHost + upgrade + version + key + "\r\n", 426},
      {"SocketWithoutAKey", get("/ws", upgrade + version), 400},
      {"SocketWithAShortKey", get("/ws", upgrade + version + "Sec-WebSocket-Key: YQ==\r\n"), 400},
      {"SocketVersion8", get("/ws", upgrade + "Sec-WebSocket-Version: 8\r\n" + key), 426, After::kOpen},
      {"SocketOfAnotherSite", get("/ws", upgrade + version + key + "Origin: https://evil.example\r\n"), 403},
      {"SocketOfNoSite", get("/ws", upgrade + version + key + "Origin: null\r\n"), 403},
      {"SocketOfOurPage", get("/ws", upgrade + version + key + "Origin: http://localhost\r\n"), 101, After::kOpen},
      {"SocketWithABody", get("/ws", upgrade + version + key + length(2)) + "{}", 400},
      {"FramesBeforeTheReply", get("/ws", upgrade + version + key) + text_frame("early"), 400},
      {"NotHttpAtAll", "\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\r\n\r\n", 400},
  };
}

class HttpCases : public ::testing::TestWithParam<HttpCase> {};

TEST_P(HttpCases, GetTheRightReply) {
  const auto& one = GetParam();
  const Served served;
  RawClient client{served.port()};
  client.send(one.request);
  const auto reply = read_reply(client, one.request.compare(0, 5, "HEAD ") == 0);
  EXPECT_EQ(reply.status, one.status) << reply.head << reply.body;
  if (one.status != 101) {
    EXPECT_FALSE(reply.field("Content-Security-Policy").empty());
    EXPECT_EQ(reply.field("X-Content-Type-Options"), "nosniff");
  }
  if (one.after == After::kClosed) {
    EXPECT_EQ(reply.field("Connection"), "close");
    EXPECT_TRUE(client.is_ended());
  } else if (one.status != 101) {
    client.send("GET /j HTTP/1.1\r\nHost: localhost\r\n\r\n");
    EXPECT_EQ(read_reply(client).status, 200) << "the connection should have gone on";
  }
}

INSTANTIATE_TEST_SUITE_P(Rfc9112, HttpCases, ::testing::ValuesIn(http_cases()),
                         [](const auto& one) { return std::string{one.param.name}; });

}  // namespace
}  // namespace kith::testing
