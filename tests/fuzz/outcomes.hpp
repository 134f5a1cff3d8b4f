#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "kith/core/diagnostic.hpp"
#include "mutate/dice.hpp"

namespace kith::fuzzing {

/// How far an input came.
enum class Outcome {
  kMalformed,  ///< It is no TOML, JSON, CSV with these columns, ...: its meaning was never looked at.
  kRefused,
  kRead
};
[[nodiscard]] Outcome outcome_of(const std::vector<Diagnostic>& diagnostics);

/// How far the inputs of this program came. Prints how many at the end, since libFuzzer ends the program itself.
class Outcomes {
 public:
  Outcomes() = default;
  ~Outcomes();
  Outcomes(const Outcomes&) = delete;
  Outcomes& operator=(const Outcomes&) = delete;

  void add(std::string_view input, Outcome outcome);
  [[nodiscard]] bool was_malformed(std::string_view input) const;
  /// One of the latest that were well-formed; empty if none was.
  [[nodiscard]] std::string well_formed(Dice& dice) const;

 private:
  std::array<std::size_t, 3> counts_{};
  std::unordered_set<std::size_t> malformed_;  // by hash
  std::vector<std::string> well_formed_;
};

[[nodiscard]] Outcomes& outcomes();
/// Says how far an input came: once for every execution of a target.
inline void note(std::string_view input, Outcome outcome) { outcomes().add(input, outcome); }

}  // namespace kith::fuzzing
