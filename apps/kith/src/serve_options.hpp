#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kith::cli {

/// What `kith serve` is asked for.
struct ServeOptions {
  std::string study;
  std::vector<std::string> set;
  std::string out;                    ///< Folder of the session; empty: a temporary one.
  std::optional<std::uint16_t> port;  ///< 0: any that is free.
  std::string bind;                   ///< An address; empty: this machine alone, or with `lan` every one.
  bool lan = false;
  bool insecure_lan = false;  ///< Unencrypted through the network.
  std::string public_url;     ///< What a reverse proxy in front is called.
  std::string trusted_proxy;  ///< Its address if it is not on this machine.
  std::size_t rooms = 0;      ///< Rooms to make at the start.
  std::size_t join_limit = 120;
  std::size_t connections_per_address = 1024;
  bool demo = false;
  bool no_browser = false;
  std::size_t rehearse = 0;  ///< Groups of simulated people; 0: no rehearsal.
  double for_seconds = 0.0;  ///< 0: until everybody has finished.
  double answer_every = 5.0;
  double reconnects = 0.0;
  double restart_after = 0.0;  ///< Seconds after which a rehearsal restarts its server; 0: never.
};

}  // namespace kith::cli
