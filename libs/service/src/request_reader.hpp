#pragma once

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/parser.hpp>
#include <memory>
#include <string>
#include <string_view>

#include "kith/service/server_options.hpp"
#include "request.hpp"

namespace kith {

/// Reads requests from the bytes of a connection, in whatever pieces they arrive; one after the other if they are
/// pipelined. Knows no sockets.
class RequestReader {
 public:
  enum class State {
    kIdle,   ///< Nothing of the next request has arrived.
    kHead,   ///< The head is not complete.
    kBody,   ///< The head is complete, the body is not.
    kDone,   ///< The request is complete: take() it.
    kFailed  ///< The bytes are no request that we accept: see failure().
  };
  struct Failure {
    int status = 400;
    std::string text{};
  };

  explicit RequestReader(const ServerLimits& limits);

  /// Takes up more bytes. @return the state of the current request.
  State feed(std::string_view bytes);
  [[nodiscard]] State state() const { return state_; }
  /// What is known of the request. @pre the head is complete.
  [[nodiscard]] const HttpMessage& head() const { return parser_->get(); }
  /// Whether the head announces a body. @pre the head is complete.
  [[nodiscard]] bool has_body() const;
  /// Whether the connection can carry another request after this one. @pre the head is complete.
  [[nodiscard]] bool keeps_alive() const { return parser_->get().keep_alive(); }
  /// The request. The reader goes on with the next: look at state(). @pre state() == kDone.
  [[nodiscard]] HttpMessage take();
  [[nodiscard]] const Failure& failure() const { return failure_; }
  /// Bytes behind the current request, while it is complete and not yet taken.
  [[nodiscard]] std::size_t num_bytes_behind() const { return buffer_.size(); }

 private:
  using Parser = boost::beast::http::request_parser<boost::beast::http::string_body>;
  void begin();
  void parse();
  void skip_empty_lines();
  [[nodiscard]] Failure failure_of(const boost::beast::error_code& error) const;

  std::size_t header_bytes_;
  std::size_t body_bytes_;
  boost::beast::flat_buffer buffer_;
  std::unique_ptr<Parser> parser_;
  State state_ = State::kIdle;
  bool may_skip_ = true;  // an empty line may stand before a request (RFC 9112, 2.2)
  Failure failure_{};
};

}  // namespace kith
