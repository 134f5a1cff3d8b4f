#include "web_socket.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <exception>
#include <utility>

#include "json_depth.hpp"
#include "reply.hpp"

namespace kith {
namespace {

namespace websocket = boost::beast::websocket;
using Code = websocket::close_code;

constexpr std::size_t kReasonBytes = 123;  // RFC 6455, 5.5
constexpr std::chrono::seconds kBetweenPings{10};
constexpr const char* kPing = "how far?";  // tells our pings from those that Beast sends to a silent client

// At most so many bytes, and no character cut in two.
std::string shortened(std::string text) {
  if (text.size() <= kReasonBytes) return text;
  auto end = kReasonBytes;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  text.resize(end);
  return text;
}

}  // namespace

// What the application holds: it may outlive the connection, and the server too.
class WebSocketConnection::Handle final : public LiveApplication::Socket {
 public:
  explicit Handle(WebSocketConnection& connection) : connection_{&connection} {}

  void send(std::shared_ptr<const std::string> frame) override {
    const std::lock_guard lock{mutex_};
    if (connection_ != nullptr) connection_->send(std::move(frame));
  }
  void close(std::uint16_t code, std::string reason) override {
    const std::lock_guard lock{mutex_};
    if (connection_ != nullptr) connection_->close(code, std::move(reason));
  }
  void authenticated() override {
    const std::lock_guard lock{mutex_};
    if (connection_ != nullptr) connection_->authenticated();
  }
  void detach() {
    const std::lock_guard lock{mutex_};
    connection_ = nullptr;
  }

 private:
  std::mutex mutex_;
  WebSocketConnection* connection_;
};

WebSocketConnection::WebSocketConnection(ServerContext& context, tcp::socket socket, Admission::Place place,
                                         std::string remote)
    : context_{context},
      strand_{socket.get_executor()},
      stream_{std::in_place, std::move(socket)},
      timer_{strand_},
      place_{std::move(place)},
      remote_{std::move(remote)},
      messages_{context.options.limits.messages_per_second, context.options.limits.message_burst,
                std::chrono::steady_clock::now()},
      queue_{context.options.limits.queued_frames, context.options.limits.queued_bytes} {
  ++context_.web_sockets;
}

WebSocketConnection::~WebSocketConnection() {
  if (handle_) handle_->detach();
  --context_.web_sockets;
}

void WebSocketConnection::start(HttpMessage request) {
  request_ = std::move(request);
  const auto& limits = context_.options.limits;
  stream_->read_message_max(limits.frame_bytes);
  stream_->auto_fragment(false);
  websocket::stream_base::timeout timeout{};
  timeout.handshake_timeout = limits.hello_time;
  timeout.idle_timeout = limits.idle_time;
  timeout.keep_alive_pings = true;
  stream_->set_option(timeout);
  stream_->set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
    for (const auto& [name, value] : security_headers()) response.set(name, value);
  }));
  stream_->control_callback(
      [this](websocket::frame_type kind, boost::beast::string_view payload) { on_control(kind, payload); });
  stream_->async_accept(request_, [self = shared_from_this()](NetError error) { self->on_open(error); });
}

void WebSocketConnection::on_open(NetError error) {
  if (is_finished_) return;
  if (error) return finish();
  request_ = {};
  is_open_ = true;
  arm(context_.options.limits.hello_time);
  handle_ = std::make_shared<Handle>(*this);
  try {
    id_ = context_.application.open(handle_, remote_);
    is_known_to_application_ = true;
  } catch (const std::exception& failure) {
    context_.notice(ServerNotice::Kind::kFailure, "opening a connection failed: " + std::string{failure.what()});
    begin_close(Code::internal_error, "the server has failed");
  }
  read();
}

void WebSocketConnection::read() {
  stream_->async_read(in_, [self = shared_from_this()](NetError error, std::size_t) { self->on_read(error); });
}

void WebSocketConnection::on_read(NetError error) {
  if (is_finished_) return;
  if (error) return finish();
  if (!closing_) deliver();
  if (!closing_) measure();
  in_.consume(in_.size());
  read();
}

void WebSocketConnection::deliver() {
  if (!messages_.take(std::chrono::steady_clock::now())) {
    return begin_close(Code::policy_error, "too many messages");
  }
  if (!stream_->got_text()) return begin_close(Code::unknown_data, "only text is understood here");
  const auto data = in_.data();
  const std::string_view frame{static_cast<const char*>(data.data()), data.size()};
  if (!json_nests_within(frame, context_.options.limits.json_depth)) {
    return begin_close(Code::policy_error, "the JSON nests too deeply or has a zero byte");
  }
  try {
    context_.application.receive(id_, frame);
  } catch (const std::exception& failure) {
    context_.notice(ServerNotice::Kind::kFailure, "a message could not be handled: " + std::string{failure.what()});
    begin_close(Code::internal_error, "the server has failed");
  }
}

// Asks a client that has just said something how far away it is.
void WebSocketConnection::measure() {
  const auto now = std::chrono::steady_clock::now();
  if (!is_authenticated_ || is_pinging_ || now - pinged_at_ < kBetweenPings) return;
  is_pinging_ = true;
  pinged_at_ = now;
  stream_->async_ping(kPing, [self = shared_from_this()](NetError) { self->is_pinging_ = false; });
}

// Pings are answered by Beast; they count as messages, and so do pongs.
void WebSocketConnection::on_control(websocket::frame_type kind, boost::beast::string_view payload) {
  const auto now = std::chrono::steady_clock::now();
  if (kind == websocket::frame_type::pong && payload == kPing && is_known_to_application_) {
    const auto round_trip = std::chrono::duration_cast<std::chrono::microseconds>(now - pinged_at_);
    context_.application.measured(id_, round_trip);
  }
  if (closing_ || messages_.take(now)) return;
  asio::post(strand_, [self = shared_from_this()] { self->begin_close(Code::policy_error, "too many messages"); });
}

void WebSocketConnection::send(std::shared_ptr<const std::string> frame) {
  asio::post(strand_,
             [self = shared_from_this(), frame = std::move(frame)]() mutable { self->push(std::move(frame)); });
}

void WebSocketConnection::push(std::shared_ptr<const std::string> frame) {
  if (is_finished_ || is_closing_sent_ || queue_.is_overflown()) return;
  if (!queue_.push(std::move(frame))) {
    ++context_.slow_clients;
    return begin_close(Code::try_again_later, "messages are not read fast enough");
  }
  if (out_ == nullptr) write_next();
}

void WebSocketConnection::write_next() {
  if (is_finished_) return;
  out_ = queue_.pop();
  if (out_ == nullptr) {
    if (closing_) close_now();
    return;
  }
  stream_->text(true);
  stream_->async_write(asio::buffer(*out_),
                       [self = shared_from_this()](NetError error, std::size_t) { self->on_written(error); });
}

void WebSocketConnection::on_written(NetError error) {
  if (is_finished_) return;
  if (error) return finish();
  write_next();
}

void WebSocketConnection::close(std::uint16_t code, std::string reason) {
  asio::post(strand_,
             [self = shared_from_this(), code, reason = std::move(reason)] { self->begin_close(code, reason); });
}

void WebSocketConnection::begin_close(std::uint16_t code, const std::string& reason) {
  if (is_finished_ || closing_) return;
  closing_ = websocket::close_reason{static_cast<Code>(code), shortened(reason)};
  arm(context_.options.limits.close_time);
  if (out_ == nullptr) close_now();
}

void WebSocketConnection::close_now() {
  if (is_closing_sent_ || is_finished_) return;
  is_closing_sent_ = true;
  stream_->async_close(*closing_, [self = shared_from_this()](NetError) { self->finish(); });
}

void WebSocketConnection::authenticated() {
  asio::post(strand_, [self = shared_from_this()] {
    if (self->is_authenticated_ || self->is_finished_) return;
    self->is_authenticated_ = true;
    self->place_.trust();
    if (!self->closing_) {
      ++self->timer_round_;
      self->timer_.cancel();
    }
  });
}

void WebSocketConnection::stop() {
  asio::post(strand_, [self = shared_from_this()] {
    if (!self->is_open_) return self->finish();
    static const auto kBye = std::make_shared<const std::string>(R"({"t":"bye","reason":"server-stops"})");
    self->push(kBye);
    self->begin_close(Code::going_away, "the server stops");
  });
}

void WebSocketConnection::cut() {
  asio::post(strand_, [self = shared_from_this()] { self->finish(); });
}

void WebSocketConnection::arm(std::chrono::milliseconds time) {
  const auto round = ++timer_round_;
  timer_.expires_after(time);
  timer_.async_wait([self = shared_from_this(), round](NetError error) {
    if (!error && round == self->timer_round_) self->on_time_out();
  });
}

void WebSocketConnection::on_time_out() {
  if (closing_) return finish();
  begin_close(Code::policy_error, "no valid hello arrived in time");
}

void WebSocketConnection::finish() {
  if (is_finished_) return;
  is_finished_ = true;
  if (handle_) handle_->detach();
  ++timer_round_;
  timer_.cancel();
  NetError ignored;
  stream_->next_layer().close(ignored);
  // Beast's read and close may wait for each other when a client breaks the protocol while we close (1.74), and then
  // they hold the connection for good. They end with the stream, which must not be destroyed by its own handler.
  asio::post(strand_, [self = shared_from_this()] { self->stream_.reset(); });
  place_ = {};
  if (is_known_to_application_) {
    try {
      context_.application.closed(id_);
    } catch (const std::exception& failure) {
      context_.notice(ServerNotice::Kind::kFailure, "closing a connection failed: " + std::string{failure.what()});
    }
  }
  context_.connections.remove(this);
}

}  // namespace kith
