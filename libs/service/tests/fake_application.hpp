#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "kith/core/live_application.hpp"
#include "kith/service/server.hpp"

namespace kith::testing {

/// Greets whoever says the token "good", and repeats what it hears.
class FakeApplication final : public LiveApplication {
 public:
  ConnectionId open(std::shared_ptr<Socket> socket, std::string remote) override {
    const std::lock_guard lock{mutex_};
    remotes.push_back(std::move(remote));
    sockets_[++last_] = std::move(socket);
    ++opened;
    return last_;
  }
  void receive(ConnectionId connection, std::string_view frame) override {
    ++received;
    const auto socket = socket_of(connection);
    const std::string text{frame};
    if (text.find("\"hello\"") != std::string::npos) {
      if (text.find("\"good\"") == std::string::npos) {
        say(*socket, R"({"t":"bye","reason":"bad-token"})");
        return socket->close(4001, "bad token");
      }
      socket->authenticated();
      return say(*socket, R"({"t":"welcome"})");
    }
    if (text == "throw") throw std::runtime_error{"asked to"};
    if (text == "leave") return socket->close(1000, "bye");
    if (text.rfind("flood ", 0) == 0) {
      const auto frame_of_1k = std::make_shared<const std::string>(std::string(1000, 'x'));
      for (int i = std::stoi(text.substr(6)); i > 0; --i) socket->send(frame_of_1k);
      return;
    }
    if (text.rfind("large ", 0) == 0) return say(*socket, std::string(std::stoul(text.substr(6)), 'x'));
    say(*socket, text);
  }
  void measured(ConnectionId, std::chrono::microseconds round_trip) override {
    const std::lock_guard lock{mutex_};
    round_trips.push_back(round_trip);
    changed_.notify_all();
  }
  /// Waits until a round trip was measured. @return how long it took, or nothing if there is none for 20 s.
  std::optional<std::chrono::microseconds> wait_for_round_trip() {
    std::unique_lock lock{mutex_};
    if (!changed_.wait_for(lock, std::chrono::seconds{20}, [this] { return !round_trips.empty(); })) return {};
    return round_trips.front();
  }
  void closed(ConnectionId connection) override {
    const std::lock_guard lock{mutex_};
    sockets_.erase(connection);
    ++num_closed;
    changed_.notify_all();
  }
  void http(HttpRequest request, HttpAnswer answer) override {
    if (request.target == "/api/throw") throw std::runtime_error{"asked to"};
    if (request.target == "/api/wait") {
      const std::lock_guard lock{mutex_};
      if (holds) return held_.push_back([answer, reply = reply_to(request)] { answer(reply); });
    }
    answer(reply_to(request));
  }
  void release() {
    const std::lock_guard lock{mutex_};
    holds = false;
    for (const auto& answer : std::exchange(held_, {})) answer();
  }
  /// Waits until every connection that was opened has been closed.
  bool wait_until_all_closed() {
    std::unique_lock lock{mutex_};
    return changed_.wait_for(lock, std::chrono::seconds{20}, [this] { return num_closed == opened; });
  }
  std::shared_ptr<Socket> socket_of(ConnectionId connection) {
    const std::lock_guard lock{mutex_};
    return sockets_.at(connection);
  }
  static void say(Socket& socket, const std::string& text) { socket.send(std::make_shared<const std::string>(text)); }

  std::atomic<int> opened{0};
  std::atomic<int> num_closed{0};
  std::atomic<int> received{0};
  bool holds = true;
  std::vector<std::string> remotes;
  std::vector<std::chrono::microseconds> round_trips;

 private:
  static HttpReply reply_to(const HttpRequest& request) {
    if (request.target == "/api/long") return {.body = std::string(5000, 'a')};
    if (request.target == "/api/header") return {.body = "{}", .headers = {{"X-Odd", "a\r\nSet-Cookie: b"}}};
    return {.body = request.method + " " + request.target + " [" + request.bearer + "] " + request.body + " " +
                    request.remote};
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::function<void()>> held_;
  ConnectionId last_ = 0;
  std::map<ConnectionId, std::shared_ptr<Socket>> sockets_;
};

/// A server on any free port, with two pages and a large script.
struct Served {
  explicit Served(ServerOptions options = {}) : server{filled(std::move(options)), application} {}
  static ServerOptions filled(ServerOptions options) {
    static const std::string kLarge(300'000, 'x');  // more than any real one
    static const std::vector<Asset> kAssets{
        {"/assets/live/index.html", "text/html; charset=utf-8", "aaaa", "<!doctype html><p>page", ""},
        {"/assets/live/app.js", "text/javascript; charset=utf-8", "bbbb", "let script = 1;", "COMPRESSED"},
        {"/assets/live/large.js", "text/javascript; charset=utf-8", "cccc", kLarge, ""}};
    options.assets = kAssets;
    options.pages = {{"/", "/assets/live/index.html"}, {"/j", "/assets/live/index.html"}};
    return options;
  }
  [[nodiscard]] std::uint16_t port() const { return server.port(); }
  /// Whether a client that behaves well is served, by HTTP and by WebSocket.
  [[nodiscard]] bool serves_well() const;

  FakeApplication application;
  Server server;
};

}  // namespace kith::testing
