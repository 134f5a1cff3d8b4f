#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

namespace kith::testing {

/// A TCP client that sends any bytes; every wait ends after ten seconds.
class RawClient {
 public:
  explicit RawClient(std::uint16_t port, int receive_buffer = 0) : socket_{::socket(AF_INET, SOCK_STREAM, 0)} {
    if (receive_buffer > 0) setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    is_connected_ = connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  }
  ~RawClient() { close(); }
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;
  RawClient(RawClient&& other) noexcept : socket_{other.socket_}, is_connected_{other.is_connected_}, in_{other.in_} {
    other.socket_ = -1;
  }

  [[nodiscard]] bool is_connected() const { return is_connected_; }
  /// @return whether everything could be sent.
  bool send(std::string_view bytes) const {
    while (!bytes.empty()) {
      const auto sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
  }
  void end_sending() const { shutdown(socket_, SHUT_WR); }
  void close() {
    if (socket_ >= 0) ::close(socket_);
    socket_ = -1;
  }

  /// Reads until `is_enough` says so of all that has arrived. @return false if the server ended the connection first,
  /// or time is up.
  template <typename Enough>
  bool read_until(Enough&& is_enough, int milliseconds = 10'000) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds{milliseconds};
    while (!is_enough(std::string_view{in_})) {
      const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
      if (left.count() <= 0 || !receive(static_cast<int>(left.count()))) return false;
    }
    return true;
  }
  /// Everything that comes until the server ends the connection.
  std::string read_all(int milliseconds = 10'000) {
    read_until([](std::string_view) { return false; }, milliseconds);
    return take();
  }
  /// Whether the server has ended the connection, or does so in time; what arrives is kept.
  bool is_ended(int milliseconds = 10'000) {
    read_until([](std::string_view) { return false; }, milliseconds);
    return has_ended_;
  }
  [[nodiscard]] std::string& received() { return in_; }
  std::string take() {
    std::string all;
    all.swap(in_);
    return all;
  }

 private:
  bool receive(int milliseconds) {
    if (has_ended_) return false;
    pollfd wait{socket_, POLLIN, 0};
    if (poll(&wait, 1, milliseconds) <= 0) return false;
    char bytes[4096];
    const auto size = recv(socket_, bytes, sizeof bytes, 0);
    if (size <= 0) {
      has_ended_ = true;
      return false;
    }
    in_.append(bytes, static_cast<std::size_t>(size));
    return true;
  }

  int socket_;
  bool is_connected_ = false;
  bool has_ended_ = false;
  std::string in_;
};

/// A reply to a request, as far as tests look at it.
struct RawReply {
  int status = 0;  ///< 0: none came.
  std::string head;
  std::string body;

  /// The value of a field, or "".
  [[nodiscard]] std::string field(const std::string& name) const {
    const auto at = head.find("\r\n" + name + ": ");
    if (at == std::string::npos) return {};
    const auto begin = at + name.size() + 4;
    return head.substr(begin, head.find("\r\n", begin) - begin);
  }
};

/// Reads one reply with a body of the length that it says; none for HEAD.
[[nodiscard]] inline RawReply read_reply(RawClient& client, bool is_head = false, int milliseconds = 10'000) {
  RawReply reply;
  const auto has_head = [](std::string_view text) { return text.find("\r\n\r\n") != std::string_view::npos; };
  if (!client.read_until(has_head, milliseconds)) return reply;
  auto& in = client.received();
  const auto end = in.find("\r\n\r\n") + 4;
  reply.head = in.substr(0, end);
  in.erase(0, end);
  reply.status = std::stoi(reply.head.substr(9, 3));
  const auto length = reply.field("Content-Length");
  if (length.empty() || is_head) return reply;
  const auto size = static_cast<std::size_t>(std::stoul(length));
  client.read_until([size](std::string_view text) { return text.size() >= size; }, milliseconds);
  reply.body = in.substr(0, size);
  in.erase(0, size);
  return reply;
}

[[nodiscard]] inline RawReply ask(std::uint16_t port, std::string_view request) {
  RawClient client{port};
  client.send(request);
  return read_reply(client, request.substr(0, 5) == "HEAD ");
}

}  // namespace kith::testing
