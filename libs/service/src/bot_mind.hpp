#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "kith/explain/json.hpp"

namespace kith {

/// What a simulated person does next.
struct BotAct {
  std::string type;     ///< Of the message.
  Json body;            ///< Empty for an answer, whose path depends on the world.
  std::string key;      ///< Equal for the same thing to do: it is done once.
  double pace = 0.0;    ///< How long it takes, as a share of the time for an answer.
  std::string world{};  ///< For answers.
  int start = -1;
};

/// What a participant's view asks for; nothing where there is nothing to do but wait.
[[nodiscard]] std::optional<BotAct> act_for(const Json& view);

/// Whether a person who is shown this stage has come to an end.
[[nodiscard]] bool is_last_stage(const std::string& stage);

}  // namespace kith
