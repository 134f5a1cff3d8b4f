#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
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

/// How far the inputs of this program came. Prints how many at the end, since libFuzzer ends the program itself. Takes
/// all its memory at the beginning: libFuzzer looks for leaks after every input that allocates more than it frees,
/// which takes a hundred times longer than most inputs.
class Outcomes {
 public:
  Outcomes();
  ~Outcomes();
  Outcomes(const Outcomes&) = delete;
  Outcomes& operator=(const Outcomes&) = delete;

  void add(std::string_view input, Outcome outcome);
  /// How far an input came that was run before; nothing if that was forgotten.
  [[nodiscard]] std::optional<Outcome> of(std::string_view input) const;
  /// One of the latest that came at least as far; empty if none did.
  [[nodiscard]] std::string one_that(Outcome came, Dice& dice) const;

 private:
  struct Memory {
    std::size_t hash = 0;
    Outcome outcome = Outcome::kMalformed;
  };
  struct Kept {
    std::vector<std::string> inputs;
    std::size_t seen = 0;
  };

  std::array<std::size_t, 3> counts_{};
  std::vector<Memory> memory_;  // each at the remainder of its hash; a later one replaces an earlier one
  std::array<Kept, 3> kept_;    // by outcome; nothing is kept that is malformed
};

[[nodiscard]] Outcomes& outcomes();
/// Says how far an input came: once for every execution of a target.
inline void note(std::string_view input, Outcome outcome) { outcomes().add(input, outcome); }

}  // namespace kith::fuzzing
