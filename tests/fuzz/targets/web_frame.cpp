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

const fuzzing::Form fuzzing::kForm{.words = "web_frame"};

fuzzing::Outcome fuzzing::run(std::string_view text) {
  constexpr std::size_t kDeepest = 32;
  const bool nests = json_nests_within(text, kDeepest);
  const auto json = nests ? nlohmann::json::parse(text, nullptr, false) : nlohmann::json{};
  if (!nests || json.is_discarded()) return Outcome::kRefused;
  const auto depth = depth_of(text);
  fuzzing::require(depth <= kDeepest && json_nests_within(text, depth), "no deeper than counted");
  fuzzing::require(depth == 0 || !json_nests_within(text, depth - 1), "as deep as counted");
  if (const auto act = act_for(json)) {
    fuzzing::require(!act->type.empty() && !act->key.empty() && act->pace >= 0.0, "an act is something to do");
  }
  return Outcome::kRead;
}
