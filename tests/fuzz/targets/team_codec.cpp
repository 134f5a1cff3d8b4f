// Records of teams as the journal keeps them. The bytes after the first, with the right checksum put behind them, are
// read as a record or refused; a record that was read is written as bytes that give the same bytes again.

#include "kith/study/team_codec.hpp"
#include "../fuzzing.hpp"

using namespace kith;
using fuzzing::require;

constexpr std::string_view kKey = "whose work it is";

// The first byte is the number of the team.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzzing::Bytes bytes{data, size};
  const TeamAddress address{.composition = "NNP", .team = bytes.below(128)};
  const std::string record{bytes.rest()};
  static_cast<void>(decode_team(address, record, kKey));  // as it is; nobody guesses a checksum
  const auto sealed = seal_record(address.team, record, kKey);
  const auto decoded = decode_team(address, sealed, kKey);
  require(!decoded || is_intact(address.team, sealed, kKey), "what is read is intact");
  require(!is_intact(address.team + 1, sealed, kKey), "bytes belong to one team");
  if (!decoded) return 0;
  const auto again = encode_team(*decoded, kKey);
  const auto twice = decode_team(address, again, kKey);
  require(twice && encode_team(*twice, kKey) == again, "a record that was read can be written");
  return 0;
}
