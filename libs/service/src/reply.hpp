#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kith {

/// An answer, before it is written.
struct ServerReply {
  int status = 200;
  std::vector<std::pair<std::string, std::string>> headers{};
  std::string owned{};       ///< The body, if it was made for this answer ...
  std::string_view fixed{};  ///< ... or if it lives as long as the program.
  bool closes = false;       ///< The connection ends after it.

  [[nodiscard]] std::string_view body() const { return fixed.empty() ? std::string_view{owned} : fixed; }
};

/// An answer that is a sentence for people: what was wrong with the request.
[[nodiscard]] ServerReply plain_reply(int status, std::string text);

/// "Not Found", of RFC 9110; an empty text for codes that it does not name.
[[nodiscard]] std::string_view reason_phrase(int status) noexcept;

/// Status line and header fields of an HTTP/1.1 reply, with the fields that every reply of this server has: length,
/// date, connection, and those that make browsers careful.
[[nodiscard]] std::string head_of(const ServerReply& reply);

/// The fields that make browsers careful, for replies that others write.
[[nodiscard]] const std::vector<std::pair<std::string, std::string>>& security_headers();

}  // namespace kith
