// Records of teams as the journal keeps them. The bytes after the first, with the right checksum put behind them, are
// read as a record or refused; a record that was read is written as bytes that give the same bytes again.

#include <array>

#include "../fuzzing.hpp"
#include "kith/files/sha256.hpp"
#include "kith/study/team_codec.hpp"

using namespace kith;
using fuzzing::require;

// The first byte is the number of the team.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzzing::Bytes bytes{data, size};
  const auto team = static_cast<char>(bytes.below(128));
  const TeamAddress address{.composition = "NNP", .team = static_cast<std::size_t>(team)};
  const std::string record{bytes.rest()};
  static_cast<void>(decode_team(address, record));  // as it is; nobody guesses a checksum
  Sha256 hash;
  hash.update(std::string_view{&team, 1});
  hash.update(record);
  const auto sealed = record + std::move(hash).digest().substr(0, 8);
  const auto decoded = decode_team(address, sealed);
  require(!decoded || is_intact(address.team, sealed), "what is read is intact");
  require(!is_intact(address.team + 1, sealed), "bytes belong to one team");
  if (!decoded) return 0;
  const auto again = encode_team(*decoded);
  const auto twice = decode_team(address, again);
  require(twice && encode_team(*twice) == again, "a record that was read can be written");
  return 0;
}
