#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dynamics.hpp"
#include "kith/core/integer_vector.hpp"
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

// The words of [words] for more than once, by rule: "a step on the path" -> "{n} steps on the path",
// "crossing a blue tile" -> "crossing {n} blue tiles", "crossing rubble" -> "crossing rubble {n} times".
[[nodiscard]] std::string several_by_rule(const std::string& once);

// Fills in what the file leaves out.
[[nodiscard]] Wording completed(Wording wording);

// The primitive integer vector in the direction of `numbers`, each taken as the
// decimal fraction that its shortest text shows (3.5 = 7/2, 0.1 = 1/10). Nothing
// if an entry of it would reach 2^31. Zeros give zero.
// @pre all finite, at most 8.
[[nodiscard]] std::optional<IntegerVector> exact_direction(const std::vector<double>& numbers);

}  // namespace kith::detail
