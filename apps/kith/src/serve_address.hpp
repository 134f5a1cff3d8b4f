#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "serve_options.hpp"

namespace kith::cli {

/// Where to serve, and by which names people call the server.
struct ServeAddress {
  std::string bind;                  ///< An address.
  std::string public_url{};          ///< "https://study.example.org", or empty: links name the address itself.
  std::string host{};                ///< Of links without a public URL.
  std::vector<std::string> hosts{};  ///< See ServerOptions::hosts.
  std::vector<std::string> origins{};
  bool behind_proxy = false;
  std::vector<std::string> warnings{};
};

/// @throws kith::Error (kUsage) if the options contradict each other, or would send answers through a network in the
/// clear without saying that this is wanted.
[[nodiscard]] ServeAddress serve_address(const ServeOptions& options);

/// How links begin: "http://127.0.0.1:8642".
[[nodiscard]] std::string base_url(const ServeAddress& address, std::uint16_t port);

}  // namespace kith::cli
