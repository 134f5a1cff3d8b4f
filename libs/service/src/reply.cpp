#include "reply.hpp"

#include <array>
#include <boost/beast/http/status.hpp>
#include <ctime>
#include <ostream>

namespace kith {
namespace {

// As RFC 9110, 5.6.7 demands, whatever the locale.
std::string date_now() {
  static constexpr std::array kDays{"Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat"};
  static constexpr std::array kMonths{"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                      "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  const auto two = [](int n) { return std::string(n < 10 ? "0" : "") + std::to_string(n); };
  return std::string{kDays.at(static_cast<std::size_t>(utc.tm_wday))} + ", " + two(utc.tm_mday) + " " +
         kMonths.at(static_cast<std::size_t>(utc.tm_mon)) + " " + std::to_string(1900 + utc.tm_year) + " " +
         two(utc.tm_hour) + ":" + two(utc.tm_min) + ":" + two(utc.tm_sec) + " GMT";
}

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
  if (status == 421) return "Misdirected Request";
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
  add(head, "Date", date_now());
  for (const auto& [name, value] : security_headers()) add(head, name, value);
  for (const auto& [name, value] : reply.headers) add(head, name, value);
  if (reply.status != 304 && reply.status >= 200) add(head, "Content-Length", std::to_string(reply.body().size()));
  if (reply.closes) add(head, "Connection", "close");
  return head + "\r\n";
}

}  // namespace kith
