// What the server does for clients that behave, how it starts and how it stops.
#include "kith/service/server.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <thread>

#include "gzip.hpp"
#include "kith/core/error.hpp"
#include "served.hpp"

namespace kith::testing {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;

const std::string kGet = "GET /j HTTP/1.1\r\nHost: localhost\r\n";

TEST(Server, ServesPagesApiAndWebSocketsOnOnePort) {
  const Served served;
  EXPECT_TRUE(served.serves_well());
  const auto reply =
      ask(served.port(), "GET /api/a?b=c HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer key\r\n\r\n");
  EXPECT_EQ(reply.status, 200);
  EXPECT_EQ(reply.body, "GET /api/a?b=c [key]  127.0.0.1");
  EXPECT_EQ(reply.field("Cache-Control"), "no-store");
  EXPECT_EQ(reply.field("Content-Type"), "application/json");
}

TEST(Server, SendsTheHeadersThatMakeBrowsersCareful) {
  const Served served;
  const auto reply = ask(served.port(), kGet + "\r\n");
  EXPECT_THAT(reply.field("Content-Security-Policy"), HasSubstr("default-src 'none'; script-src 'self';"));
  EXPECT_THAT(reply.field("Content-Security-Policy"), HasSubstr("require-trusted-types-for 'script'"));
  EXPECT_EQ(reply.field("Referrer-Policy"), "no-referrer");
  EXPECT_EQ(reply.field("Cross-Origin-Opener-Policy"), "same-origin");
  EXPECT_EQ(reply.field("Cross-Origin-Resource-Policy"), "same-origin");
  EXPECT_EQ(reply.field("Set-Cookie"), "");
  const RawWebSocket socket{served.port()};
  EXPECT_EQ(socket.reply().field("X-Content-Type-Options"), "nosniff");
}

TEST(Server, AnswersPipelinedRequestsInOrder) {
  const Served served;
  RawClient client{served.port()};
  client.send(kGet +
              "\r\nGET /api/1 HTTP/1.1\r\nHost: localhost\r\n\r\nGET /api/2 HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_EQ(read_reply(client).body, "<!doctype html><p>page");
  EXPECT_THAT(read_reply(client).body, HasSubstr("/api/1"));
  EXPECT_THAT(read_reply(client).body, HasSubstr("/api/2"));
}

TEST(Server, UnderstandsARequestThatArrivesByteByByte) {
  const Served served;
  RawClient client{served.port()};
  for (const char c : kGet + "\r\n") client.send({&c, 1});
  EXPECT_EQ(read_reply(client).status, 200);
}

TEST(Server, AsksForABodyThatWaitsToBeAskedFor) {
  const Served served;
  RawClient client{served.port()};
  client.send(
      "POST /api/a HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: 2\r\n"
      "Expect: 100-continue\r\n\r\n");
  EXPECT_EQ(read_reply(client).status, 100);
  client.send("{}");
  EXPECT_EQ(read_reply(client).status, 200);
}

TEST(Server, AnswersAClientThatHasEndedItsHalf) {
  const Served served;
  RawClient client{served.port()};
  client.send(kGet + "\r\n");
  client.end_sending();
  EXPECT_EQ(read_reply(client).status, 200);
  EXPECT_TRUE(client.is_ended());
}

TEST(Server, SendsCompressedCopiesAndChecksTags) {
  const Served served;
  const std::string get = "GET /assets/live/app.js HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n";
  const auto plain = ask(served.port(), get + "\r\n");
  EXPECT_EQ(plain.body, "let script = 1;");
  EXPECT_EQ(plain.field("ETag"), "\"bbbb\"");
  EXPECT_EQ(plain.field("Vary"), "Accept-Encoding");
  const auto compressed = ask(served.port(), get + "Accept-Encoding: br, gzip\r\n\r\n");
  EXPECT_EQ(compressed.body, "COMPRESSED");
  EXPECT_EQ(compressed.field("Content-Encoding"), "gzip");
  EXPECT_EQ(compressed.field("ETag"), "\"bbbb-gzip\"");
  EXPECT_EQ(ask(served.port(), get + "Accept-Encoding: gzip;q=0, *\r\n\r\n").body, "let script = 1;");
  EXPECT_EQ(ask(served.port(), get + "Accept-Encoding: *\r\n\r\n").body, "COMPRESSED");
  EXPECT_EQ(ask(served.port(), get + "If-None-Match: \"x\", W/\"bbbb\"\r\n\r\n").status, 304);
  EXPECT_EQ(ask(served.port(), get + "If-None-Match: *\r\n\r\n").status, 304);
  EXPECT_EQ(ask(served.port(), get + "If-None-Match: \"bbbb-gzip\"\r\n\r\n").status, 200);
}

TEST(Server, CompressesLongAnswersOfTheApplication) {
  const Served served;
  const std::string get = "GET /api/long HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n";
  EXPECT_EQ(ask(served.port(), get + "\r\n").body, std::string(5000, 'a'));
  const auto compressed = ask(served.port(), get + "Accept-Encoding: gzip\r\n\r\n");
  EXPECT_EQ(compressed.field("Content-Encoding"), "gzip");
  EXPECT_LT(compressed.body.size(), 100U);
  EXPECT_EQ(compressed.body, gzipped(std::string(5000, 'a')));
}

TEST(Server, SendsTheLengthOfWhatHeadLeavesOut) {
  const Served served;
  RawClient client{served.port()};
  client.send("HEAD /j HTTP/1.1\r\nHost: localhost\r\n\r\n" + kGet + "\r\n");
  EXPECT_EQ(read_reply(client, true).field("Content-Length"), "22");
  EXPECT_EQ(read_reply(client).body, "<!doctype html><p>page");
}

TEST(Server, LetsNoFieldOfTheApplicationBeginAnother) {
  const Served served;
  const auto reply = ask(served.port(), "GET /api/header HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_EQ(reply.field("X-Odd"), "aSet-Cookie: b");
  EXPECT_EQ(reply.field("Set-Cookie"), "");
}

TEST(Server, TellsTheApplicationWhoseClientAProxyPassesOn) {
  Served served{{.behind_proxy = true}};
  const auto reply =
      ask(served.port(), "GET /api/a HTTP/1.1\r\nHost: localhost\r\nX-Forwarded-For: 6.6.6.6, 203.0.113.9\r\n\r\n");
  EXPECT_THAT(reply.body, HasSubstr("203.0.113.9"));
  // A proxy on another machine is believed, and then nobody else is.
  Served other{{.behind_proxy = true, .proxy = "192.0.2.1"}};
  EXPECT_THAT(ask(other.port(), "GET /api/a HTTP/1.1\r\nHost: localhost\r\nX-Forwarded-For: 203.0.113.9\r\n\r\n").body,
              HasSubstr("127.0.0.1"));
  Served named{{.behind_proxy = true, .proxy = "127.0.0.1"}};
  EXPECT_THAT(ask(named.port(), "GET /api/a HTTP/1.1\r\nHost: localhost\r\nX-Forwarded-For: 203.0.113.9\r\n\r\n").body,
              HasSubstr("203.0.113.9"));
  const Served direct;
  EXPECT_THAT(ask(direct.port(), "GET /api/a HTTP/1.1\r\nHost: localhost\r\nX-Forwarded-For: 203.0.113.9\r\n\r\n").body,
              HasSubstr("127.0.0.1"));
}

TEST(Server, KnowsTheNamesThatItIsGiven) {
  const Served served{{.hosts = {"study.example.org"}, .origins = {"https://study.example.org"}}};
  EXPECT_EQ(ask(served.port(), "GET /j HTTP/1.1\r\nHost: Study.Example.org.\r\n\r\n").status, 200);
  auto upgrade = std::string{kUpgrade};
  upgrade.insert(upgrade.size() - 2, "Origin: https://study.example.org\r\n");
  EXPECT_EQ(ask(served.port(), upgrade).status, 101);
}

TEST(Server, RefusesAPortInUse) {
  const Served first;
  FakeApplication application;
  try {
    const Server second{{.port = first.port()}, application};
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kBusy);
    EXPECT_THAT(error.what(), HasSubstr("port " + std::to_string(first.port()) + " of 127.0.0.1 is in use"));
  }
}

TEST(Server, RefusesAnAddressThatIsNone) {
  FakeApplication application;
  EXPECT_THROW(Server({.bind = "localhost"}, application), Error);
}

TEST(Server, SaysGoodbyeWhenItStops) {
  Served served;
  RawWebSocket socket{served.port()};
  socket.say(kHello);
  EXPECT_EQ(socket.hear(), R"({"t":"welcome"})");
  std::thread reader{[&] {
    EXPECT_EQ(socket.hear(), R"({"t":"bye","reason":"server-stops"})");
    EXPECT_EQ(socket.close_code(), 1001);
    socket.send(frame_of(0x88, "\x03\xE9"));
  }};
  served.server.stop(std::chrono::seconds{10});
  reader.join();
  EXPECT_EQ(served.application.num_closed, 1);
  EXPECT_FALSE(RawClient{served.port()}.is_connected());
}

TEST(Server, StopsThoughClientsDoNotAnswer) {
  Served served;
  RawWebSocket silent{served.port()};
  RawClient half{served.port()};
  half.send("GET /j HT");
  RawClient idle{served.port()};
  silent.say(kHello);
  EXPECT_EQ(silent.hear(), R"({"t":"welcome"})");
  served.server.stop(std::chrono::milliseconds{50});
  EXPECT_EQ(served.application.num_closed, 1);
}

TEST(Server, FinishesAnAnswerBeforeItStops) {
  Served served;
  RawClient client{served.port()};
  client.send("GET /api/wait HTTP/1.1\r\nHost: localhost\r\n\r\n");
  while (served.server.status().connections == 0) std::this_thread::yield();
  usleep(20'000);
  std::thread stopper{[&] { served.server.stop(std::chrono::seconds{10}); }};
  usleep(20'000);
  served.application.release();
  EXPECT_EQ(read_reply(client).status, 200);
  stopper.join();
}

TEST(Server, CanBeLeftByItsApplication) {
  std::shared_ptr<LiveApplication::Socket> kept;
  {
    Served served;
    RawWebSocket socket{served.port()};
    socket.say(kHello);
    EXPECT_EQ(socket.hear(), R"({"t":"welcome"})");
    kept = served.application.socket_of(1);
  }
  kept->send(std::make_shared<const std::string>("nobody hears this"));
  kept->close(1000, {});
  kept->authenticated();
}

TEST(Server, HearsManyClientsAtOnce) {
  Served served;
  std::vector<std::thread> clients;
  std::atomic<int> heard{0};
  for (int i = 0; i < 8; ++i) {
    clients.emplace_back([&, i] {
      RawWebSocket socket{served.port()};
      socket.say(kHello);
      socket.hear();
      for (int j = 0; j < 50; ++j) {
        const auto text = std::to_string(i) + ":" + std::to_string(j);
        socket.say(text);
        heard += socket.hear() == text;
      }
    });
  }
  for (auto& client : clients) client.join();
  EXPECT_EQ(heard, 400);
  EXPECT_TRUE(served.application.wait_until_all_closed());
  EXPECT_TRUE(all_gone(served.server));
}

TEST(WebSockets, TellHowFarAwayAClientIs) {
  Served served;
  RawWebSocket socket{served.port()};
  socket.say(kHello);
  EXPECT_EQ(socket.hear(), R"({"t":"welcome"})");
  std::string ping;
  for (int i = 0; i < 100 && ping.empty(); ++i) {  // it is asked once the server knows that the token was good
    socket.say("hello again");
    while (const auto frame = socket.read(50)) {
      if (frame->head == 0x89) ping = frame->payload;
      if (frame->head == 0x81) break;
    }
  }
  ASSERT_FALSE(ping.empty());
  socket.send(frame_of(0x8A, "another"));  // not an answer
  socket.send(frame_of(0x8A, ping));
  const auto round_trip = served.application.wait_for_round_trip();
  ASSERT_TRUE(round_trip);
  EXPECT_GT(round_trip->count(), 0);
  EXPECT_EQ(served.application.round_trips.size(), 1u);
}

}  // namespace
}  // namespace kith::testing
