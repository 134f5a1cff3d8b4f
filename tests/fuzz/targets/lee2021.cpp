// Tables of the 2021 study: worlds (JSON) and responses (CSV). Worlds that are read are domains of one MDP.

#include "kith/fit/lee2021.hpp"
#include "../fuzzing.hpp"

using namespace kith;

namespace {

// The first byte chooses the table.
bool is_worlds(std::string_view head) { return head.empty() || static_cast<unsigned char>(head.front()) % 2 == 0; }

}  // namespace

std::string fuzzing::mutated(std::string_view input, Dice& dice) {
  static const Vocabulary kVocabulary{"lee2021"};
  if (dice.one_in(20)) return mutate_bytes(input, dice);
  const auto [head, body] = behind_bytes(input, 1);
  const auto mutate = is_worlds(head) ? mutate_json : mutate_csv;
  return std::string{head} + mutate(body, kVocabulary, dice);
}

std::string fuzzing::crossed(std::string_view input, std::string_view other, Dice& dice) {
  const auto [head, body] = behind_bytes(input, 1);
  const auto cross = is_worlds(head) ? cross_json : cross_csv;
  return std::string{head} + cross(body, behind_bytes(other, 1).body, dice);
}

// The first byte chooses the table.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view input{reinterpret_cast<const char*>(data), size};
  const auto [head, body] = fuzzing::behind_bytes(input, 1);
  const bool worlds = is_worlds(head);
  const fuzzing::MemoryFile file{body};
  const auto outcome = fuzzing::reads(body, file.path().string(), [&] {
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
  fuzzing::note(input, outcome);
  return 0;
}
