#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "kith/core/text.hpp"
#include "kith/domains/domain.hpp"

namespace kith::detail {

enum class Number { kSingular, kPlural, kUnknown };

// One thing of the robot's reward, several times: "crossing rubble", "2 steps".
struct Thing {
  std::string words;
  std::string fewer;  // so many fewer: "2 fewer steps", "not crossing rubble"
  std::int64_t n = 0;
  Number number = Number::kUnknown;
};

// "a step", "the charger" and "crossing rubble" are singular, "2 steps" is plural; of other words nobody knows.
[[nodiscard]] Thing thing(const Wording& wording, std::int64_t n);

// What stands on one side of the inequality: costs and gains of the robot.
struct Side {
  std::vector<Thing> costs, gains;

  void add(Thing what, bool is_cost) { (is_cost ? costs : gains).push_back(std::move(what)); }
  [[nodiscard]] bool empty() const { return costs.empty() && gains.empty(); }
  [[nodiscard]] bool mixed() const { return !costs.empty() && !gains.empty(); }
  [[nodiscard]] Side only_costs() const { return {costs, {}}; }
  [[nodiscard]] Side only_gains() const { return {{}, gains}; }
  // Whether the numbers of all verbs are known once costs and gains are told apart.
  [[nodiscard]] bool parts_can_be_said() const { return only_costs().can_be_said() && only_gains().can_be_said(); }
  [[nodiscard]] const std::vector<Thing>& things() const { return costs.empty() ? gains : costs; }
  [[nodiscard]] std::string words() const {
    std::vector<std::string> words;
    for (const auto& thing : things()) words.push_back(thing.words);
    return listed(words);
  }
  // What a verb behind words() agrees with. Only for a side that is not mixed.
  [[nodiscard]] Number number() const { return things().size() > 1 ? Number::kPlural : things().front().number; }
  [[nodiscard]] bool can_be_said() const { return empty() || (!mixed() && number() != Number::kUnknown); }
  // "costs" or "is worth".
  [[nodiscard]] std::string verb() const {
    const bool plural = number() == Number::kPlural;
    return costs.empty() ? (plural ? "are worth" : "is worth") : (plural ? "cost" : "costs");
  }
  // "the cost of 2 steps", "the gain of stopping at the charger", or both.
  [[nodiscard]] std::string amount() const {
    std::vector<std::string> parts;
    if (!costs.empty()) parts.push_back("the cost of " + Side{costs, {}}.words());
    if (!gains.empty()) parts.push_back("the gain of " + Side{{}, gains}.words());
    return listed(parts);
  }
  // What is good about it, with costs spared: "going by road and 2 fewer steps".
  [[nodiscard]] std::string benefits() const {
    std::vector<std::string> words;
    for (const auto& gain : gains) words.push_back(gain.words);
    for (const auto& cost : costs) words.push_back(cost.fewer);
    return listed(words);
  }
  // The verb of amount().
  [[nodiscard]] std::string is() const { return mixed() ? " together are " : " is "; }
};

}  // namespace kith::detail
