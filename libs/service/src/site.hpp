#pragma once

#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

namespace kith {

/// "localhost:8642" as its parts; nothing if it is no host.
struct HostAndPort {
  std::string host{};  ///< In lower case, without a final dot; IPv6 in brackets.
  std::string port{};  ///< Digits, or empty.
};
/// @return whether `text` is a host, with or without a port.
[[nodiscard]] bool parse_host(std::string_view text, HostAndPort& result);

/// The names of this server, and whose pages may talk to it.
class Site {
 public:
  /// @param hosts  without ports, besides the loopback ones. @param origins  "https://study.example.org".
  Site(const std::vector<std::string>& hosts, const std::vector<std::string>& origins);

  /// Whether a Host field names this server; the port is not looked at, so that forwarded ports work.
  [[nodiscard]] bool is_ours(std::string_view host) const;
  /// Whether a page of this origin may talk to the server that the client called `host`.
  [[nodiscard]] bool may_talk(std::string_view origin, std::string_view host) const;

 private:
  std::unordered_set<std::string> hosts_;
  std::unordered_set<std::string> origins_;
};

}  // namespace kith
