#pragma once

#include <array>
#include <cstddef>
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
  [[nodiscard]] bool was_malformed(std::string_view input) const;
  /// One of the latest that were well-formed; empty if none was.
  [[nodiscard]] std::string well_formed(Dice& dice) const;

 private:
  std::array<std::size_t, 3> counts_{};
  std::vector<std::size_t> malformed_;  // hashes, each at its remainder; a later one replaces an earlier one
  std::vector<std::string> well_formed_;
  std::size_t num_well_formed_ = 0;
};

[[nodiscard]] Outcomes& outcomes();
/// Says how far an input came: once for every execution of a target.
inline void note(std::string_view input, Outcome outcome) { outcomes().add(input, outcome); }

}  // namespace kith::fuzzing
