// Texts of WebSocket frames. The count of brackets agrees with a parser about how deep JSON nests; and simulated people
// understand or ignore whatever a server sends them.

#include <algorithm>
#include <nlohmann/json.hpp>

#include "../fuzzing.hpp"
#include "bot_mind.hpp"
#include "json_depth.hpp"

using namespace kith;

namespace {

// As a parser meets it; of two members with the same name only the last is in what it makes.
std::size_t depth_of(std::string_view text) {
  std::size_t deepest = 0;
  const auto note = [&](int depth, nlohmann::json::parse_event_t event, const nlohmann::json&) {
    const bool opens =
        event == nlohmann::json::parse_event_t::object_start || event == nlohmann::json::parse_event_t::array_start;
    if (opens) deepest = std::max(deepest, static_cast<std::size_t>(depth) + 1);
    return true;
  };
  [[maybe_unused]] const auto parsed = nlohmann::json::parse(text, note, false);
  return deepest;
}

}  // namespace

std::string fuzzing::mutated(std::string_view input, Dice& dice) {
  static const Vocabulary kVocabulary{"web_frame"};
  if (dice.one_in(20)) return mutate_bytes(input, dice);
  return mutate_text(input, kVocabulary, dice);
}

std::string fuzzing::crossed(std::string_view input, std::string_view other, Dice& dice) {
  return cross_text(input, other, dice);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kDeepest = 32;
  const std::string_view text{reinterpret_cast<const char*>(data), size};
  const bool nests = json_nests_within(text, kDeepest);
  const auto json = nests ? nlohmann::json::parse(text, nullptr, false) : nlohmann::json{};
  fuzzing::note(text, nests && !json.is_discarded() ? fuzzing::Outcome::kRead : fuzzing::Outcome::kRefused);
  if (!nests || json.is_discarded()) return 0;
  const auto depth = depth_of(text);
  fuzzing::require(depth <= kDeepest && json_nests_within(text, depth), "no deeper than counted");
  fuzzing::require(depth == 0 || !json_nests_within(text, depth - 1), "as deep as counted");
  if (const auto act = act_for(json)) {
    fuzzing::require(!act->type.empty() && !act->key.empty() && act->pace >= 0.0, "an act is something to do");
  }
  return 0;
}
