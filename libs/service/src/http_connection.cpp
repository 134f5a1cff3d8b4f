#include "http_connection.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/asio/write.hpp>
#include <exception>
#include <mutex>
#include <utility>

#include "gzip.hpp"
#include "web_socket.hpp"

namespace kith {
namespace {

namespace http = boost::beast::http;

constexpr std::size_t kRequestsPerConnection = 1000;
constexpr std::size_t kDiscardedBytes = 256 * 1024;
constexpr std::chrono::milliseconds kLingerTime{1000};
constexpr std::size_t kSlowestBytesPerMillisecond = 16;

ServerReply reply_of(LiveApplication::HttpReply answer) {
  ServerReply reply;
  reply.status = answer.status;
  bool says_caching = false;
  for (auto& [name, value] : answer.headers) {
    says_caching = says_caching || boost::beast::iequals(name, "Cache-Control");
    reply.headers.emplace_back(name, std::move(value));
  }
  if (!says_caching) reply.headers.emplace_back("Cache-Control", "no-store");
  if (!answer.content_type.empty()) reply.headers.emplace_back("Content-Type", std::move(answer.content_type));
  reply.owned = std::move(answer.body);
  return reply;
}

// Tables of moves are long; what is short gains nothing.
void compress(ServerReply& reply) {
  constexpr std::size_t kShort = 1024;
  if (reply.status != 200 || reply.owned.size() <= kShort) return;
  auto compressed = gzipped(reply.owned);
  if (compressed.size() >= reply.owned.size()) return;
  reply.owned = std::move(compressed);
  reply.headers.emplace_back("Content-Encoding", "gzip");
  reply.headers.emplace_back("Vary", "Accept-Encoding");
}

std::string bearer_of(const HttpMessage& request) {
  constexpr std::string_view kScheme = "bearer ";
  const auto value = view_of(request[http::field::authorization]);
  if (value.size() <= kScheme.size()) return {};
  const auto scheme = request[http::field::authorization].substr(0, kScheme.size());
  return boost::beast::iequals(scheme, "bearer ") ? std::string{value.substr(kScheme.size())} : std::string{};
}

}  // namespace

// The answer to a request. It may come when the connection has ended, and the server too.
struct HttpConnection::Owed {
  void give(ServerReply reply) {
    const std::lock_guard lock{mutex};
    if (!connection) return;
    asio::post(connection->socket_.get_executor(), [self = connection, reply = std::move(reply)]() mutable {
      if (self->phase_ == Phase::kWaiting) self->answer(std::move(reply));
    });
  }

  std::mutex mutex;
  std::shared_ptr<HttpConnection> connection;
};

HttpConnection::HttpConnection(ServerContext& context, tcp::socket socket, Admission::Place place, std::string remote)
    : context_{context},
      socket_{std::move(socket)},
      timer_{socket_.get_executor()},
      place_{std::move(place)},
      remote_{std::move(remote)},
      reader_{context.options.limits} {}

void HttpConnection::start() {
  asio::post(socket_.get_executor(), [self = shared_from_this()] {
    self->begin_request();
    self->advance();
  });
}

void HttpConnection::refuse(ServerReply reply) {
  asio::post(socket_.get_executor(), [self = shared_from_this(), reply = std::move(reply)]() mutable {
    self->only_refuses_ = true;
    reply.closes = true;
    self->answer(std::move(reply));
  });
}

void HttpConnection::stop() {
  asio::post(socket_.get_executor(), [self = shared_from_this()] {
    self->is_stopping_ = true;
    if (self->phase_ == Phase::kReading || self->phase_ == Phase::kLingering) self->finish();
  });
}

void HttpConnection::cut() {
  asio::post(socket_.get_executor(), [self = shared_from_this()] { self->finish(); });
}

void HttpConnection::begin_request() {
  phase_ = Phase::kReading;
  is_judged_ = false;
  is_head_only_ = false;
  const auto& limits = context_.options.limits;
  const bool waits = num_requests_ > 0 && reader_.state() == RequestReader::State::kIdle;
  arm(waits ? limits.keep_alive_time : limits.header_time);
}

void HttpConnection::read() {
  socket_.async_read_some(
      asio::buffer(in_), [self = shared_from_this()](NetError error, std::size_t size) { self->on_read(error, size); });
}

void HttpConnection::on_read(NetError error, std::size_t size) {
  if (phase_ == Phase::kFinished) return;
  if (phase_ == Phase::kLingering) {
    num_discarded_ += size;
    if (error || num_discarded_ > kDiscardedBytes) return finish();
    return read();
  }
  if (has_timed_out_) {
    const bool has_begun = reader_.state() != RequestReader::State::kIdle;
    if (!has_begun) return finish();
    auto reply = plain_reply(408, "the request did not arrive in time");
    reply.closes = true;
    return answer(std::move(reply));
  }
  if (error) return finish();
  const bool was_idle = reader_.state() == RequestReader::State::kIdle;
  reader_.feed({in_.data(), size});
  if (was_idle && num_requests_ > 0) arm(context_.options.limits.header_time);
  advance();
}

void HttpConnection::advance() {
  switch (reader_.state()) {
    case RequestReader::State::kIdle:
    case RequestReader::State::kHead:
      return read();
    case RequestReader::State::kFailed: {
      auto reply = plain_reply(reader_.failure().status, reader_.failure().text);
      reply.closes = true;
      return answer(std::move(reply));
    }
    case RequestReader::State::kBody:
    case RequestReader::State::kDone:
      break;
  }
  if (!is_judged_ && !judge()) return;
  if (reader_.state() == RequestReader::State::kBody) return read();
  dispatch();
}

// Once the head is there. @return false if the request was refused, or is continued after "100 Continue".
bool HttpConnection::judge() {
  is_judged_ = true;
  is_head_only_ = reader_.head().method() == http::verb::head;
  if (auto refused = context_.rules.judge(reader_.head(), reader_.has_body(), destination_)) {
    const bool is_complete = reader_.state() == RequestReader::State::kDone;
    const bool may_go_on = refused->status == 404 || refused->status == 405 || refused->status == 426;
    if (is_complete) {
      const bool keeps_alive = reader_.keeps_alive() && reader_.head().version() >= 11;
      refused->closes = !may_go_on || !keeps_alive || is_stopping_;
      static_cast<void>(reader_.take());
      ++num_requests_;
    } else {
      refused->closes = true;  // the rest of the body would be taken for a request
    }
    answer(*std::move(refused));
    return false;
  }
  if (reader_.state() == RequestReader::State::kBody) {
    arm(context_.options.limits.body_time);
    if (!reader_.head()[http::field::expect].empty()) {
      static constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
      asio::async_write(socket_, asio::buffer(kContinue.data(), kContinue.size()),
                        [self = shared_from_this()](NetError error, std::size_t) {
                          if (error) return self->finish();
                          if (self->phase_ == Phase::kReading) self->advance();
                        });
      return false;
    }
  }
  return true;
}

void HttpConnection::dispatch() {
  const bool is_web_socket = destination_.kind == Destination::Kind::kWebSocket;
  if (is_web_socket && reader_.num_bytes_behind() > 0) {
    auto reply = plain_reply(400, "frames must wait for the reply to the request");
    reply.closes = true;
    return answer(std::move(reply));
  }
  auto request = reader_.take();
  ++num_requests_;
  reply_ = {};
  reply_.closes = !request.keep_alive() || request.version() < 11 || is_stopping_ ||
                  num_requests_ >= kRequestsPerConnection || context_.admission.is_crowded();
  place_.renew();
  if (is_web_socket) return open_web_socket(std::move(request));
  if (destination_.kind == Destination::Kind::kApplication) return ask_application(std::move(request));
  auto reply = asset_reply(*destination_.asset, request);
  reply.closes = reply_.closes;
  answer(std::move(reply));
}

void HttpConnection::ask_application(HttpMessage request) {
  phase_ = Phase::kWaiting;
  ++timer_round_;  // the application may take its time
  timer_.cancel();
  const bool closes = reply_.closes;
  const bool compresses = accepts_gzip(view_of(request[http::field::accept_encoding]));
  if (auto refused = context_.rules.judge_body(request)) {
    refused->closes = true;
    return answer(*std::move(refused));
  }
  LiveApplication::HttpRequest question{.method = request.method() == http::verb::post ? "POST" : "GET",
                                        .target = destination_.target,
                                        .bearer = bearer_of(request),
                                        .body = std::move(request.body()),
                                        .remote = client_of(request)};
  if (context_.waiting_requests >= context_.options.limits.waiting_requests) {
    auto busy = plain_reply(503, "the server is busy; try again in a few seconds");
    busy.headers.emplace_back("Retry-After", "2");
    busy.closes = true;
    return answer(std::move(busy));
  }

  ++context_.waiting_requests;
  owed_ = std::make_shared<Owed>();
  owed_->connection = shared_from_this();
  const auto give = [owed = owed_, closes](ServerReply reply) {
    reply.closes = closes;
    owed->give(std::move(reply));
  };
  try {
    context_.application.http(std::move(question), [give, compresses](LiveApplication::HttpReply given) {
      auto reply = reply_of(std::move(given));
      if (compresses) compress(reply);
      give(std::move(reply));
    });
  } catch (const std::exception& error) {
    context_.notice(ServerNotice::Kind::kFailure, "answering a request failed: " + std::string{error.what()});
    give(plain_reply(500, "the server could not answer this"));
  }
}

// What the application owes is given, or nobody waits for it any more.
void HttpConnection::end_waiting() {
  const auto owed = std::exchange(owed_, nullptr);
  if (!owed) return;
  --context_.waiting_requests;
  const std::lock_guard lock{owed->mutex};
  owed->connection = nullptr;
}

void HttpConnection::open_web_socket(HttpMessage request) {
  phase_ = Phase::kFinished;
  ++timer_round_;
  timer_.cancel();
  ++context_.requests;
  const auto client = client_of(request);
  const auto socket = std::make_shared<WebSocketConnection>(context_, std::move(socket_), std::move(place_), client);
  socket->claim_place();
  if (context_.connections.add(socket)) socket->start(std::move(request));
  context_.connections.remove(this);
}

// A proxy appends the address of its client to the list.
std::string HttpConnection::client_of(const HttpMessage& request) const {
  NetError error;
  const auto peer = asio::ip::make_address(remote_, error);
  if (error || !context_.is_proxy(peer)) return remote_;
  std::string last;
  for (const auto& field : request) {
    if (boost::beast::iequals(field.name_string(), "X-Forwarded-For")) last = std::string{view_of(field.value())};
  }
  last = last.substr(last.rfind(',') + 1);
  last.erase(0, last.find_first_not_of(" \t"));
  last.erase(last.find_last_not_of(" \t") + 1);
  const auto client = asio::ip::make_address(last, error);
  return error ? remote_ : client.to_string();
}

void HttpConnection::answer(ServerReply reply) {
  if (phase_ == Phase::kFinished) return;
  end_waiting();
  ++context_.requests;
  phase_ = Phase::kWriting;
  reply_ = std::move(reply);
  reply_.closes = reply_.closes || is_stopping_;
  head_ = head_of(reply_);
  const auto body = is_head_only_ || reply_.status == 304 ? std::string_view{} : reply_.body();
  arm(context_.options.limits.header_time + std::chrono::milliseconds{body.size() / kSlowestBytesPerMillisecond});
  const std::array<asio::const_buffer, 2> parts{asio::buffer(head_), asio::buffer(body.data(), body.size())};
  asio::async_write(socket_, parts,
                    [self = shared_from_this()](NetError error, std::size_t) { self->on_written(error); });
}

void HttpConnection::on_written(NetError error) {
  if (phase_ == Phase::kFinished) return;
  if (error) return finish();
  if (reply_.closes || is_stopping_) return linger();
  begin_request();
  advance();
}

// A socket that is closed while bytes of the client wait unread is reset, and the client may never see the reply.
void HttpConnection::linger() {
  phase_ = Phase::kLingering;
  has_timed_out_ = false;
  NetError error;
  socket_.shutdown(tcp::socket::shutdown_send, error);
  if (error || is_stopping_) return finish();
  arm(kLingerTime);
  read();
}

void HttpConnection::finish() {
  if (phase_ == Phase::kFinished) return;
  phase_ = Phase::kFinished;
  end_waiting();
  if (only_refuses_) --context_.refusing;
  ++timer_round_;
  timer_.cancel();
  NetError ignored;
  socket_.close(ignored);
  place_ = {};
  context_.connections.remove(this);
}

void HttpConnection::arm(std::chrono::milliseconds time) {
  const auto round = ++timer_round_;
  timer_.expires_after(time);
  timer_.async_wait([self = shared_from_this(), round](NetError error) {
    if (!error && round == self->timer_round_) self->on_time_out();
  });
}

void HttpConnection::on_time_out() {
  if (phase_ == Phase::kReading) {
    has_timed_out_ = true;
    NetError ignored;
    socket_.cancel(ignored);
    return;
  }
  finish();
}

}  // namespace kith
