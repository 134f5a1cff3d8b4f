#include "site.hpp"

#include <algorithm>
#include <cctype>
#include <stdexcept>

namespace kith {
namespace {

std::string lower_case(std::string_view text) {
  std::string result;
  for (const char c : text) result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

bool all_of_set(std::string_view text, std::string_view extra) {
  return std::all_of(text.begin(), text.end(), [extra](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || extra.find(c) != std::string_view::npos;
  });
}

}  // namespace

bool parse_host(std::string_view text, HostAndPort& result) {
  constexpr std::size_t kLongest = 255;
  std::size_t end = 0;
  if (!text.empty() && text.front() == '[') {
    end = text.find(']');
    if (end == std::string_view::npos || end < 3 || !all_of_set(text.substr(1, end - 1), ":.")) return false;
    ++end;
  } else {
    end = std::min(text.find(':'), text.size());
    if (end == 0 || !all_of_set(text.substr(0, end), "-._")) return false;
  }
  const auto port = text.substr(end);
  if (end > kLongest || port.size() > 6) return false;
  if (!port.empty() && (port.front() != ':' || port.find_first_not_of("0123456789", 1) != std::string_view::npos)) {
    return false;
  }
  result.host = lower_case(text.substr(0, end));
  if (result.host.size() > 1 && result.host.back() == '.') result.host.pop_back();
  result.port = port.empty() ? std::string{} : std::string{port.substr(1)};
  return true;
}

Site::Site(const std::vector<std::string>& hosts, const std::vector<std::string>& origins)
    : hosts_{"localhost", "127.0.0.1", "[::1]"} {
  for (const auto& host : hosts) {
    HostAndPort parts;
    const bool bare_ipv6 = host.find(':') != std::string::npos && host.front() != '[';
    if (!parse_host(bare_ipv6 ? "[" + host + "]" : host, parts)) throw std::invalid_argument{"no host: " + host};
    hosts_.insert(parts.host);
  }
  for (const auto& origin : origins) origins_.insert(lower_case(origin));
}

bool Site::is_ours(std::string_view host) const {
  HostAndPort parts;
  return parse_host(host, parts) && hosts_.count(parts.host) > 0;
}

bool Site::may_talk(std::string_view origin, std::string_view host) const {
  const auto text = lower_case(origin);
  if (origins_.count(text) > 0) return true;
  const auto called = lower_case(host);
  return text == "http://" + called || text == "https://" + called;
}

}  // namespace kith
