// Records of teams as the journal keeps them. The bytes after the first, with the right checksum put behind them, are
// read as a record or refused; a record that was read is written as bytes that give the same bytes again.

#include "kith/runs/team_codec.hpp"
#include "../fuzzing.hpp"

using namespace kith;
using fuzzing::require;

namespace {

constexpr std::string_view kKey = "whose work it is";

// The first byte is the number of the team.
TeamAddress address_of(std::string_view head) {
  const auto team = head.empty() ? std::size_t{0} : static_cast<unsigned char>(head.front()) % std::size_t{128};
  return {.composition = "NNP", .team = team};
}

}  // namespace

const fuzzing::Form fuzzing::kForm{};

fuzzing::Outcome fuzzing::run(std::string_view input) {
  const auto [head, content] = fuzzing::behind_bytes(input, 1);
  const auto address = address_of(head);
  static_cast<void>(decode_team(address, content, kKey));  // as it is; nobody guesses a checksum
  const auto sealed = seal_record(address.team, std::string{content}, kKey);
  const auto decoded = decode_team(address, sealed, kKey);
  require(!decoded || is_intact(address.team, sealed, kKey), "what is read is intact");
  require(!is_intact(address.team + 1, sealed, kKey), "bytes belong to one team");
  if (!decoded) return Outcome::kMalformed;
  const auto again = encode_team(*decoded, kKey);
  const auto twice = decode_team(address, again, kKey);
  require(twice && encode_team(*twice, kKey) == again, "a record that was read can be written");
  return Outcome::kRead;
}
