#pragma once
#include <vector>

#include "dynamics.hpp"
#include "kith/domains/domain.hpp"
#include "kith/files/reader.hpp"

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

[[nodiscard]] Reward read_reward(TomlReader& file, const Dynamics& dynamics, RewardOf reward_of);

}  // namespace kith::detail
