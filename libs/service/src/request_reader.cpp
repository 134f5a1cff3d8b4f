#include "request_reader.hpp"

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <utility>

namespace kith {
namespace {

namespace http = boost::beast::http;

std::string_view text_of(const boost::beast::flat_buffer& buffer) {
  const auto data = buffer.data();
  return {static_cast<const char*>(data.data()), data.size()};
}

// "GET / HTTP/2.0": well-formed, but a version that we do not speak.
bool names_other_version(std::string_view head) {
  const auto line = head.substr(0, head.find('\r'));
  const auto at = line.rfind(" HTTP/");
  if (at == std::string_view::npos) return false;
  const auto version = line.substr(at + 6);
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  return version.size() == 3 && digit(version[0]) && version[1] == '.' && digit(version[2]);
}

}  // namespace

RequestReader::RequestReader(const ServerLimits& limits)
    : header_bytes_{limits.header_bytes}, body_bytes_{limits.body_bytes} {
  begin();
}

void RequestReader::begin() {
  parser_ = std::make_unique<Parser>();
  parser_->header_limit(static_cast<std::uint32_t>(header_bytes_));
  parser_->body_limit(body_bytes_);
  state_ = State::kIdle;
  may_skip_ = true;
}

RequestReader::State RequestReader::feed(std::string_view bytes) {
  if (state_ == State::kFailed) return state_;
  boost::asio::buffer_copy(buffer_.prepare(bytes.size()), boost::asio::buffer(bytes.data(), bytes.size()));
  buffer_.commit(bytes.size());
  if (state_ != State::kDone) parse();
  return state_;
}

bool RequestReader::has_body() const {
  const auto length = parser_->content_length();
  return parser_->chunked() || (length && *length > 0);
}

HttpMessage RequestReader::take() {
  auto message = parser_->release();
  begin();
  parse();
  return message;
}

void RequestReader::skip_empty_lines() {
  while (may_skip_ && buffer_.size() > 0) {
    const auto text = text_of(buffer_);
    if (text.substr(0, 2) != "\r\n") {
      may_skip_ = text == "\r";
      return;
    }
    buffer_.consume(2);
  }
}

void RequestReader::parse() {
  skip_empty_lines();
  // What is left of a chunked body is at least "0\r\n\r\n". With less of it, the parser asserts that there is as much.
  const auto waits = [&] { return parser_->is_header_done() ? parser_->chunked() && buffer_.size() < 5 : may_skip_; };
  while (buffer_.size() > 0 && !waits()) {
    boost::beast::error_code error;
    const auto used = parser_->put(buffer_.data(), error);
    if (error && error != http::error::need_more) {
      failure_ = failure_of(error);
      state_ = State::kFailed;
      return;
    }
    buffer_.consume(used);
    if (parser_->is_done()) {
      state_ = State::kDone;
      return;
    }
    // A line of a chunked body is buffered whole before it is understood.
    if (buffer_.size() > header_bytes_ && parser_->is_header_done() && used == 0) {
      failure_ = {413, "a line of the body is too long"};
      state_ = State::kFailed;
      return;
    }
    if (error == http::error::need_more || used == 0) break;
  }
  state_ = buffer_.size() > 0 || parser_->got_some() ? State::kHead : State::kIdle;
  if (parser_->is_header_done()) state_ = State::kBody;
}

RequestReader::Failure RequestReader::failure_of(const boost::beast::error_code& error) const {
  if (error == http::error::header_limit) {
    if (parser_->get().target().empty()) return {414, "the request line is too long"};
    return {431, "the header is too long"};
  }
  if (error == http::error::body_limit) return {413, "the body is too long"};
  if (error == http::error::bad_version && names_other_version(text_of(buffer_))) {
    return {505, "this server speaks HTTP/1.1"};
  }
  return {400, "this is no HTTP request: " + error.message()};
}

}  // namespace kith
