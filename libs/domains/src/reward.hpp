#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dynamics.hpp"
#include "kith/domains/domain.hpp"
#include "kith/toml/reader.hpp"

namespace kith::detail {

// Whose reward a domain has: its weights are read, or they are yet to be inferred.
enum class RewardOf { kFile, kNobody };

// What the file says about worth: [reward], [prior] and [words].
struct Reward {
  RewardWeights weights;
  TomlPlace weights_place;
  std::vector<HalfSpace> prior;  // empty for a single feature
  std::vector<Wording> words;    // per feature
};

// `given`: the weights, shape [d], where they follow from a model and the file has none.
[[nodiscard]] Reward read_reward(TomlReader& file, const Dynamics& dynamics, RewardOf reward_of,
                                 const std::optional<std::vector<double>>& given = std::nullopt);

}  // namespace kith::detail
