#include "serve_address.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "command.hpp"

namespace kith::cli {
namespace {

// The text of an address of either family; empty for other families.
std::string text_of(const sockaddr* address) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (address == nullptr) return {};
  if (address->sa_family == AF_INET) {
    const auto* v4 = reinterpret_cast<const sockaddr_in*>(address);
    inet_ntop(AF_INET, &v4->sin_addr, text.data(), text.size());
  } else if (address->sa_family == AF_INET6) {
    const auto* v6 = reinterpret_cast<const sockaddr_in6*>(address);
    inet_ntop(AF_INET6, &v6->sin6_addr, text.data(), text.size());
  }
  return text.data();
}

// The addresses of this machine but for the loopback ones; those of version 4 first.
std::vector<std::string> addresses_of_machine() {
  ifaddrs* all = nullptr;
  if (getifaddrs(&all) != 0) return {};
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> owner{all, &freeifaddrs};
  std::vector<std::string> addresses;
  for (const auto* one = all; one != nullptr; one = one->ifa_next) {
    if ((one->ifa_flags & static_cast<unsigned>(IFF_LOOPBACK)) != 0) continue;
    auto text = text_of(one->ifa_addr);
    if (!text.empty()) addresses.push_back(std::move(text));
  }
  std::stable_partition(addresses.begin(), addresses.end(),
                        [](const auto& text) { return text.find(':') == std::string::npos; });
  return addresses;
}

bool is_loopback(const std::string& address) { return address == "::1" || address.rfind("127.", 0) == 0; }
bool is_any(const std::string& address) { return address == "0.0.0.0" || address == "::"; }

bool is_address(const std::string& text) {
  in6_addr any{};
  return inet_pton(AF_INET, text.c_str(), &any) == 1 || inet_pton(AF_INET6, text.c_str(), &any) == 1;
}

std::string in_url(const std::string& host) { return host.find(':') == std::string::npos ? host : "[" + host + "]"; }

// "https://study.example.org" as its scheme and host, or nothing.
struct PublicUrl {
  bool is_secure = false;
  std::string host;
  std::string origin;
};

std::optional<PublicUrl> public_url_of(std::string text) {
  if (!text.empty() && text.back() == '/') text.pop_back();
  PublicUrl url;
  url.is_secure = text.rfind("https://", 0) == 0;
  if (!url.is_secure && text.rfind("http://", 0) != 0) return std::nullopt;
  const auto authority = text.substr(text.find("//") + 2);
  url.host = authority.substr(0, authority.rfind(':') == std::string::npos ? authority.size() : authority.rfind(':'));
  if (authority.front() == '[') url.host = authority.substr(0, authority.find(']') + 1);
  const auto allowed = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           std::string_view{"-._:[]"}.find(c) != std::string_view::npos;
  };
  if (url.host.empty() || !std::all_of(authority.begin(), authority.end(), allowed)) return std::nullopt;
  url.origin = text;
  return url;
}

void check_combination(const ServeOptions& options) {
  if (options.lan && is_loopback(options.bind)) refuse("--lan and --bind " + options.bind + " contradict each other");
  if (options.trusted_proxy.empty()) return;
  if (!is_address(options.trusted_proxy)) {
    refuse("--trusted-proxy must be an IP address such as 192.0.2.1, not '" + options.trusted_proxy + "'");
  }
}

}  // namespace

ServeAddress serve_address(const ServeOptions& options) {
  check_combination(options);
  std::optional<PublicUrl> url;
  if (!options.public_url.empty()) {
    url = public_url_of(options.public_url);
    if (!url) {
      refuse("--public-url must be like https://study.example.org, without a path, not '" + options.public_url + "'");
    }
  }
  ServeAddress address;
  address.bind = !options.bind.empty() ? options.bind : options.lan ? "0.0.0.0" : "127.0.0.1";
  const bool is_local = is_loopback(address.bind);
  const bool has_tls = url && url->is_secure;
  if (!is_local && !has_tls && !options.insecure_lan) {
    refuse("answers and links would cross the network unencrypted",
           Advice{"put a reverse proxy with TLS in front and name its address with --public-url https://..., or "
                  "add --lan --insecure-lan on a network that you trust (docs/security.md)"});
  }
  if (!is_local && !has_tls) {
    address.warnings.emplace_back("answers and links cross the network unencrypted (--insecure-lan)");
  }
  if (geteuid() == 0) {
    address.warnings.emplace_back("running as root is not needed; use an account of its own for the server");
  }
  address.host = address.bind;
  if (is_any(address.bind)) {
    address.hosts = addresses_of_machine();
    address.host = address.hosts.empty() ? "127.0.0.1" : address.hosts.front();
    std::array<char, 256> name{};
    if (gethostname(name.data(), name.size() - 1) == 0) {
      address.hosts.emplace_back(name.data());
      address.hosts.push_back(std::string{name.data()} + ".local");
    }
  } else if (!is_local) {
    address.hosts.push_back(address.bind);
  }
  if (url) {
    address.public_url = url->origin;
    address.hosts.push_back(url->host);
    address.origins.push_back(url->origin);
    address.behind_proxy = is_local || !options.trusted_proxy.empty();
  }
  // Interfaces may have names that are no hosts ("fe80::1%eth0").
  address.hosts.erase(
      std::remove_if(address.hosts.begin(), address.hosts.end(),
                     [](const auto& host) { return host.empty() || host.find('%') != std::string::npos; }),
      address.hosts.end());
  return address;
}

std::string base_url(const ServeAddress& address, std::uint16_t port) {
  if (!address.public_url.empty()) return address.public_url;
  return "http://" + in_url(address.host) + ":" + std::to_string(port);
}

}  // namespace kith::cli
