// Records of teams as the journal keeps them. The bytes after the first, with the right checksum put behind them, are
// read as a record or refused; a record that was read is written as bytes that give the same bytes again.

#include "kith/runs/team_codec.hpp"
#include "../fuzzing.hpp"
#include "../mutate/mutate_team.hpp"

using namespace kith;
using fuzzing::require;

namespace {

constexpr std::string_view kKey = "whose work it is";

// The first byte is the number of the team.
TeamAddress address_of(std::string_view head) {
  const auto team = head.empty() ? std::size_t{0} : static_cast<unsigned char>(head.front()) % std::size_t{128};
  return {.composition = "NNP", .team = team};
}

std::optional<TeamRecord> record_of(std::string_view head, std::string_view content) {
  const auto address = address_of(head);
  return decode_team(address, seal_record(address.team, std::string{content}, kKey), kKey);
}

std::string content_of(const TeamRecord& record) {
  return std::string{unseal_record(record.address.team, encode_team(record, kKey), kKey).value()};
}

}  // namespace

std::string fuzzing::mutated(std::string_view input, Dice& dice) {
  const auto [head, body] = behind_bytes(input, 1);
  auto record = record_of(head, body);
  if (!record || dice.one_in(10)) return mutate_bytes(input, dice);
  mutate_team(*record, dice);
  return std::string{head} + content_of(*record);
}

std::string fuzzing::crossed(std::string_view input, std::string_view other, Dice& dice) {
  const auto [head, body] = behind_bytes(input, 1);
  const auto [other_head, other_body] = behind_bytes(other, 1);
  auto record = record_of(head, body);
  const auto from = record_of(other_head, other_body);
  if (!record) return std::string{other};
  if (from) cross_teams(*record, *from, dice);
  if (!from) mutate_team(*record, dice);
  return std::string{head} + content_of(*record);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view input{reinterpret_cast<const char*>(data), size};
  const auto [head, content] = fuzzing::behind_bytes(input, 1);
  const auto address = address_of(head);
  static_cast<void>(decode_team(address, content, kKey));  // as it is; nobody guesses a checksum
  const auto sealed = seal_record(address.team, std::string{content}, kKey);
  const auto decoded = decode_team(address, sealed, kKey);
  fuzzing::note(input, decoded ? fuzzing::Outcome::kRead : fuzzing::Outcome::kMalformed);
  require(!decoded || is_intact(address.team, sealed, kKey), "what is read is intact");
  require(!is_intact(address.team + 1, sealed, kKey), "bytes belong to one team");
  if (!decoded) return 0;
  const auto again = encode_team(*decoded, kKey);
  const auto twice = decode_team(address, again, kKey);
  require(twice && encode_team(*twice, kKey) == again, "a record that was read can be written");
  return 0;
}
