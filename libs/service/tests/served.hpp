#pragma once

#include "fake_application.hpp"
#include "raw_web_socket.hpp"

namespace kith::testing {

inline bool Served::serves_well() const {
  const auto reply = ask(port(), "GET /j HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
  if (reply.status != 200 || reply.body != "<!doctype html><p>page") return false;
  RawWebSocket socket{port()};
  socket.say(kHello);
  if (socket.hear() != R"({"t":"welcome"})") return false;
  socket.say("still there?");
  return socket.hear() == "still there?";
}

/// Waits until the server has no connection.
[[nodiscard]] inline bool all_gone(const Server& server) {
  for (int i = 0; i < 2000; ++i) {
    if (server.status().connections == 0 && server.status().web_sockets == 0) return true;
    usleep(10'000);
  }
  return false;
}

}  // namespace kith::testing
