// Records of teams as the journal keeps them. The bytes after the first, with the right checksum put behind them, are
// read as a record or refused; a record that was read is written as bytes that give the same bytes again.

#include "kith/study/team_codec.hpp"
#include "../fuzzing.hpp"
#include "../mutate/mutate_team.hpp"
#include "kith/study/sha256.hpp"

using namespace kith;
using fuzzing::require;

namespace {

constexpr std::size_t kChecksumSize = 8;

// The first byte is the number of the team.
TeamAddress address_of(std::string_view head) {
  const auto team = head.empty() ? std::size_t{0} : static_cast<unsigned char>(head.front()) % std::size_t{128};
  return {.composition = "NNP", .team = team};
}

std::string sealed(const TeamAddress& address, std::string_view record) {
  const auto team = static_cast<char>(address.team);
  Sha256 hash;
  hash.update(std::string_view{&team, 1});
  hash.update(record);
  return std::string{record} + std::move(hash).digest().substr(0, kChecksumSize);
}

std::string without_seal(std::string bytes) {
  bytes.resize(bytes.size() - kChecksumSize);
  return bytes;
}

}  // namespace

std::string fuzzing::mutated(std::string_view input, Dice& dice) {
  const auto [head, body] = behind_bytes(input, 1);
  auto record = decode_team(address_of(head), sealed(address_of(head), body));
  if (!record || dice.one_in(10)) return mutate_bytes(input, dice);
  mutate_team(*record, dice);
  return std::string{head} + without_seal(encode_team(*record));
}

std::string fuzzing::crossed(std::string_view input, std::string_view other, Dice& dice) {
  const auto [head, body] = behind_bytes(input, 1);
  const auto [other_head, other_body] = behind_bytes(other, 1);
  auto record = decode_team(address_of(head), sealed(address_of(head), body));
  const auto from = decode_team(address_of(other_head), sealed(address_of(other_head), other_body));
  if (!record || !from) return std::string{input.substr(0, dice.below(input.size() + 1))} + std::string{other_body};
  cross_teams(*record, *from, dice);
  return std::string{head} + without_seal(encode_team(*record));
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto [head, record] = fuzzing::behind_bytes({reinterpret_cast<const char*>(data), size}, 1);
  const auto address = address_of(head);
  static_cast<void>(decode_team(address, record));  // as it is; nobody guesses a checksum
  const auto bytes = sealed(address, record);
  const auto decoded = decode_team(address, bytes);
  fuzzing::note({reinterpret_cast<const char*>(data), size},
                decoded ? fuzzing::Outcome::kRead : fuzzing::Outcome::kMalformed);
  require(!decoded || is_intact(address.team, bytes), "what is read is intact");
  require(!is_intact(address.team + 1, bytes), "bytes belong to one team");
  if (!decoded) return 0;
  const auto again = encode_team(*decoded);
  const auto twice = decode_team(address, again);
  require(twice && encode_team(*twice) == again, "a record that was read can be written");
  return 0;
}
