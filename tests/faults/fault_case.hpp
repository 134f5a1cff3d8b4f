#pragma once

#include <optional>
#include <string>

namespace kith::faults {

/// One trial: what is done, and what goes wrong meanwhile.
struct Case {
  std::string scenario;  ///< Name of a Scenario.
  int variant = 0;       ///< Which preparation, how many threads, how teams are saved: see Variant.
  std::string family;    ///< none, kill, timer, failpoint, io, flip, truncate or mix.
  std::string fault;     ///< What exactly; "-" in family none.
};

/// The words after --case, from which parse_case() makes the case again.
[[nodiscard]] std::string to_text(const Case& one);
[[nodiscard]] std::optional<Case> parse_case(const std::string& text);

/// What a number of a variant stands for.
struct Variant {
  int preparation = 0;
  int threads = 1;    ///< 1 or 2.
  bool each = false;  ///< Every team is saved by itself, instead of all of a fifth of a second together.
};
[[nodiscard]] Variant variant_of(int number);
[[nodiscard]] int number_of(const Variant& variant);

/// What a case came to.
struct Outcome {
  bool struck = false;   ///< The fault happened; else the run was shorter than expected.
  bool resumed = false;  ///< The same command finished.
  bool refused = false;  ///< A command refused and named another one, which finished.
  int lost = 0;          ///< Records that the fault cost, all of them named.
  std::string wrong{};   ///< What must not be, in sentences; empty if all is well.
};

}  // namespace kith::faults
