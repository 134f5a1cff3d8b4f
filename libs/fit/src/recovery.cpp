#include "kith/fit/recovery.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace kith {
namespace {

struct Compared {
  const char* name;
  double TrueParameters::*truth;
  ParameterPosterior PersonPosterior::*posterior;
};

constexpr std::array kCompared{
    Compared{"ability", &TrueParameters::ability, &PersonPosterior::ability},
    Compared{"confirm gain", &TrueParameters::confirm_gain, &PersonPosterior::confirm_gain},
    Compared{"correct gain", &TrueParameters::correct_gain, &PersonPosterior::correct_gain},
};

ParameterRecovery compare(const Compared& what, const ResponseLogs& logs, const FitReport& report) {
  ParameterRecovery result{.name = what.name, .people = logs.people.size()};
  const auto n = static_cast<double>(logs.people.size());
  double squares = 0.0;
  for (std::size_t i = 0; i < logs.people.size(); ++i) {
    const double truth = (*logs.people[i].truth).*what.truth;
    const auto& posterior = report.people[i].posterior.*what.posterior;
    result.truth += truth / n;
    result.estimate += posterior.mean / n;
    squares += (posterior.mean - truth) * (posterior.mean - truth);
    result.held += posterior.lower <= truth && truth <= posterior.upper ? 1u : 0u;
  }
  result.error = result.estimate - result.truth;
  if (logs.people.size() > 1)
    result.error_se = std::sqrt(std::max(0.0, squares / n - result.error * result.error) / (n - 1.0));
  return result;
}

}  // namespace

std::vector<ParameterRecovery> recovery(const ResponseLogs& logs, const FitReport& report) {
  const auto is_known = [](const PersonLog& person) { return person.truth.has_value(); };
  if (logs.people.empty() || report.people.size() != logs.people.size() ||
      !std::all_of(logs.people.begin(), logs.people.end(), is_known))
    return {};
  std::vector<ParameterRecovery> all;
  for (const auto& one : kCompared) all.push_back(compare(one, logs, report));
  return all;
}

}  // namespace kith
