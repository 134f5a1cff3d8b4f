// Tables of the 2021 study: worlds (JSON) and responses (CSV). Worlds that are read are domains of one MDP.

#include "kith/fit/lee2021.hpp"
#include "../fuzzing.hpp"

using namespace kith;

// The first byte chooses the table.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzzing::Bytes bytes{data, size};
  const bool worlds = bytes.below(2) == 0;
  const fuzzing::MemoryFile file{bytes.rest()};
  fuzzing::reads(bytes.rest(), file.path().string(), [&] {
    if (!worlds) {
      for (const auto& response : read_lee2021_responses(file.path())) {
        fuzzing::require(response.line >= 2, "a response stands below the header");
      }
      return;
    }
    for (const auto& world : read_lee2021_worlds(file.path())) {
      fuzzing::require(world.domain.num_mdps() == 1, "a world is one MDP");
    }
  });
  return 0;
}
