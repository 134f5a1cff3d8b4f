#include "reply.hpp"

#include <fmt/chrono.h>

#include <boost/beast/http/status.hpp>
#include <ctime>

namespace kith {
namespace {

// Names and values come from us and from the application; what could begin another field must not reach the wire.
std::string clean(std::string_view text) {
  std::string cleaned;
  for (const char c : text) {
    if (c != '\r' && c != '\n' && c != '\0') cleaned += c;
  }
  return cleaned;
}

void add(std::string& head, std::string_view name, std::string_view value) {
  head.append(clean(name)).append(": ").append(clean(value)).append("\r\n");
}

}  // namespace

const std::vector<std::pair<std::string, std::string>>& security_headers() {
  static const std::vector<std::pair<std::string, std::string>> kHeaders{
      {"Content-Security-Policy",
       "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; font-src 'self'; "
       "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'; "
       "require-trusted-types-for 'script'"},
      {"X-Content-Type-Options", "nosniff"},
      {"Referrer-Policy", "no-referrer"},
      {"Cross-Origin-Opener-Policy", "same-origin"},
      {"Cross-Origin-Resource-Policy", "same-origin"}};
  return kHeaders;
}

std::string_view reason_phrase(int status) noexcept {
  if (status == 413) return "Content Too Large";
  const auto phrase = boost::beast::http::obsolete_reason(static_cast<boost::beast::http::status>(status));
  return phrase == "<unknown-status>" ? std::string_view{} : std::string_view{phrase.data(), phrase.size()};
}

ServerReply plain_reply(int status, std::string text) {
  ServerReply reply;
  reply.status = status;
  reply.headers = {{"Content-Type", "text/plain; charset=utf-8"}, {"Cache-Control", "no-store"}};
  reply.owned = std::move(text) + "\n";
  return reply;
}

std::string head_of(const ServerReply& reply) {
  std::string head =
      "HTTP/1.1 " + std::to_string(reply.status) + " " + std::string{reason_phrase(reply.status)} + "\r\n";
  add(head, "Date", fmt::format("{:%a, %d %b %Y %H:%M:%S} GMT", fmt::gmtime(std::time(nullptr))));
  for (const auto& [name, value] : security_headers()) add(head, name, value);
  for (const auto& [name, value] : reply.headers) add(head, name, value);
  if (reply.status != 304 && reply.status >= 200) add(head, "Content-Length", std::to_string(reply.body().size()));
  if (reply.closes) add(head, "Connection", "close");
  return head + "\r\n";
}

}  // namespace kith
