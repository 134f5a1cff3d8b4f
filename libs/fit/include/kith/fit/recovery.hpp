#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "kith/fit/fit.hpp"
#include "kith/fit/person_log.hpp"

namespace kith {

/// How well one parameter of simulated people was recovered.
struct ParameterRecovery {
  std::string name;       ///< "ability", "confirm gain" or "correct gain".
  double truth = 0.0;     ///< Mean over people.
  double estimate = 0.0;  ///< Mean over people of their posterior means.
  double error = 0.0;     ///< estimate - truth.
  double error_se = 0.0;  ///< Standard error of that mean over people. What all people share, such as an error of the
                          ///< population's scale, is not in it.
  std::size_t held = 0;   ///< People whose 95 % interval holds their true value.
  std::size_t people = 0;
};

/// Compares a fit with PersonLog::truth. Empty unless that is known of everybody.
[[nodiscard]] std::vector<ParameterRecovery> recovery(const ResponseLogs& logs, const FitReport& report);

}  // namespace kith
