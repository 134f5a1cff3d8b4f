// What happens to clients that take more than their share.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <mutex>
#include <string>
#include <vector>

#include "served.hpp"

namespace kith::testing {
namespace {

using std::chrono::milliseconds;
using ::testing::Contains;
using ::testing::HasSubstr;

ServerOptions with(ServerLimits limits) { return {.limits = limits}; }

TEST(Limits, EndARequestThatTrickles) {
  const Served served{with({.header_time = milliseconds{200}})};
  RawClient slow{served.port()};
  slow.send("GET /j HTTP/1.1\r\n");
  EXPECT_TRUE(served.serves_well());
  EXPECT_EQ(read_reply(slow).status, 408);
  EXPECT_TRUE(slow.is_ended());
}

// Bytes that arrive one by one do not extend the time.
TEST(Limits, EndARequestThatNeverEnds) {
  const Served served{with({.header_time = milliseconds{200}})};
  RawClient slow{served.port()};
  bool is_open = slow.send("GET /j HTTP/1.1\r\nX: ");
  for (int i = 0; i < 2000 && is_open; ++i) {
    usleep(10'000);
    is_open = slow.send("a");
  }
  EXPECT_FALSE(is_open);
}

TEST(Limits, EndABodyThatTrickles) {
  const Served served{with({.body_time = milliseconds{200}})};
  RawClient slow{served.port()};
  slow.send("POST /api/a HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: 10\r\n\r\n{");
  EXPECT_EQ(read_reply(slow).status, 408);
}

TEST(Limits, EndAConnectionThatSaysNothing) {
  const Served served{with({.header_time = milliseconds{100}, .keep_alive_time = milliseconds{100}})};
  RawClient silent{served.port()};
  EXPECT_EQ(silent.read_all(), "");
  RawClient kept{served.port()};
  kept.send("GET /j HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_EQ(read_reply(kept).status, 200);
  EXPECT_EQ(kept.read_all(), "");
  EXPECT_TRUE(all_gone(served.server));
}

TEST(Limits, EndAWebSocketWithoutAHello) {
  Served served{with({.hello_time = milliseconds{200}})};
  RawWebSocket silent{served.port()};
  RawWebSocket chatty{served.port()};
  chatty.say("I will not say who I am");
  EXPECT_EQ(silent.close_code(), 1008);
  EXPECT_EQ(chatty.close_code(), 1008);
  EXPECT_EQ(chatty.reason(), "no valid hello arrived in time");
}

TEST(Limits, EndAWebSocketWithABadToken) {
  Served served;
  RawWebSocket socket{served.port()};
  socket.say(R"({"t":"hello","token":"bad"})");
  EXPECT_EQ(socket.hear(), R"({"t":"bye","reason":"bad-token"})");
  EXPECT_EQ(socket.close_code(), 4001);
}

TEST(Limits, KeepAWebSocketOpenThatHasSaidHello) {
  const Served served{with({.hello_time = milliseconds{100}})};
  RawWebSocket socket{served.port()};
  socket.say(kHello);
  EXPECT_EQ(socket.hear(), R"({"t":"welcome"})");
  usleep(300'000);
  socket.say("still here");
  EXPECT_EQ(socket.hear(), "still here");
}

// Beast pings at half of the time.
TEST(Limits, EndAWebSocketWhoseClientIsGone) {
  Served served{with({.idle_time = milliseconds{1000}})};
  RawWebSocket socket{served.port()};
  socket.say(kHello);
  EXPECT_EQ(socket.hear(), R"({"t":"welcome"})");
  EXPECT_TRUE(served.application.wait_until_all_closed());
}

TEST(Limits, EndAClientThatSendsTooMuch) {
  Served served{with({.messages_per_second = 1.0, .message_burst = 5.0})};
  RawWebSocket socket{served.port()};
  socket.say(kHello);
  for (int i = 0; i < 10; ++i) socket.say("x");
  EXPECT_EQ(socket.close_code(), 1008);
  EXPECT_EQ(socket.reason(), "too many messages");
  EXPECT_LE(served.application.received, 6);
}

TEST(Limits, CountPingsAsMessages) {
  Served served{with({.messages_per_second = 1.0, .message_burst = 5.0})};
  RawWebSocket socket{served.port()};
  socket.say(kHello);
  for (int i = 0; i < 10; ++i) socket.send(frame_of(0x89, "?"));
  EXPECT_EQ(socket.close_code(), 1008);
}

TEST(Limits, EndAClientThatDoesNotRead) {
  Served served{with({.close_time = milliseconds{100}})};
  RawWebSocket slow{served.port(), 4096};
  slow.say(kHello);
  EXPECT_EQ(slow.hear(), R"({"t":"welcome"})");
  // What the sockets of both sides hold, and then more than may wait.
  for (int i = 0; i < 50; ++i) slow.say("flood 200");
  EXPECT_TRUE(served.application.wait_until_all_closed());
  EXPECT_GE(served.server.status().slow_clients, 1U);
  EXPECT_TRUE(served.serves_well());
}

TEST(Limits, TellAClientThatReadsTooSlowly) {
  Served served{with({.queued_frames = 4})};
  RawWebSocket slow{served.port()};
  slow.say(kHello);
  EXPECT_EQ(slow.hear(), R"({"t":"welcome"})");
  slow.say("flood 100");
  EXPECT_EQ(slow.close_code(), 1013);
}

TEST(Limits, LetOneLongFrameThrough) {
  Served served{with({.queued_bytes = 1000})};
  RawWebSocket socket{served.port()};
  socket.say(kHello);
  socket.hear();
  socket.say("large 300000");
  EXPECT_EQ(socket.hear().size(), 300'000U);
}

TEST(Limits, TurnAwayWhomThereIsNoRoomFor) {
  std::mutex mutex;
  std::vector<std::string> notices;
  auto options = with({.sockets = 3});
  const auto hello = [](RawWebSocket& socket) {
    socket.say(kHello);
    EXPECT_EQ(socket.hear(), R"({"t":"welcome"})");
  };
  options.on_notice = [&](const ServerNotice& notice) {
    const std::lock_guard lock{mutex};
    notices.push_back(notice.text);
  };
  Served served{options};
  std::vector<RawWebSocket> clients;
  for (int i = 0; i < 3; ++i) {
    clients.emplace_back(served.port());
    hello(clients.back());
  }
  RawClient fourth{served.port()};
  const auto reply = read_reply(fourth);
  EXPECT_EQ(reply.status, 503);
  EXPECT_EQ(reply.field("Retry-After"), "5");
  EXPECT_EQ(served.server.status().turned_away, 1U);
  clients.clear();
  EXPECT_TRUE(all_gone(served.server));
  EXPECT_TRUE(served.serves_well());
  const std::lock_guard lock{mutex};
  EXPECT_THAT(notices, Contains(HasSubstr("too many connections")));
}

// Whoever says nothing gives way to whoever comes; whoever has said who they are does not.
TEST(Limits, LetSocketsGiveWayThatHaveNotSaidWhoTheyAre) {
  Served served{with({.unauthenticated_per_address = 2})};
  RawWebSocket known{served.port()};
  known.say(kHello);
  EXPECT_EQ(known.hear(), R"({"t":"welcome"})");
  RawWebSocket silent{served.port()};
  RawClient slow{served.port()};
  slow.send("GET /j HTTP/1.1\r\n");
  const RawClient third{served.port()}, fourth{served.port()};
  EXPECT_EQ(silent.hear(), "");
  EXPECT_EQ(slow.read_all(), "");
  EXPECT_TRUE(served.serves_well());
  known.say("still here");
  EXPECT_EQ(known.hear(), "still here");
  EXPECT_GE(served.server.status().turned_away, 2U);
}

// Each has made a valid request, and waits for the next.
TEST(Limits, ServeMoreBrowsersThanMayStayConnected) {
  Served served{with({.unauthenticated_per_address = 2})};
  std::vector<RawClient> browsers;
  for (int i = 0; i < 6; ++i) {
    browsers.emplace_back(served.port());
    browsers.back().send("GET /j HTTP/1.1\r\nHost: localhost\r\n\r\n");
    EXPECT_EQ(read_reply(browsers.back()).status, 200);
  }
  EXPECT_TRUE(served.serves_well());
}

TEST(Limits, LetOnlySoManyRequestsWaitForTheApplication) {
  Served served{with({.waiting_requests = 1})};
  std::vector<RawClient> clients;
  for (int i = 0; i < 4; ++i) {
    clients.emplace_back(served.port());
    clients.back().send("GET /api/wait HTTP/1.1\r\nHost: localhost\r\n\r\n");
  }
  int refused = 0;
  for (int i = 0; i < 500 && served.server.status().requests < 2; ++i) usleep(10'000);
  EXPECT_TRUE(served.serves_well());  // pages do not wait
  served.application.release();
  for (auto& client : clients) refused += read_reply(client).status == 503;
  EXPECT_GE(refused, 1);
  EXPECT_LE(refused, 3);
}

}  // namespace
}  // namespace kith::testing
