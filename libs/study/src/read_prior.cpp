#include "read_study_spec.hpp"

#include <algorithm>

#include "kith/geometry/cone.hpp"

namespace kith {
namespace {

constexpr std::int64_t kMaxEntry = 1000, kMaxOfOlder = (std::int64_t{1} << 31) - 1;

std::optional<IntegerVector> read_normal(const TomlValue& element, const TomlTable& names, const Domain& domain,
                                         std::int64_t most, TomlReport& report) {
  const auto& features = domain.feature_names();
  bool good = features.size() >= 2 && features.size() <= IntegerVector::kMaxDimension;
  IntegerVector normal(good ? features.size() : 0);
  for (const auto& entry : names.entries()) {
    const auto feature = std::find(features.begin(), features.end(), entry.key);
    const auto value = read_integer(entry.value, "a weight in 'prior'", {-most, most}, report);
    if (feature == features.end()) {
      report.error("E0410", entry.place, "prior names an unknown feature '" + entry.key + "'",
                   suggestion(entry.key, features));
    }
    good = good && value && feature != features.end();
    if (good) normal[static_cast<std::size_t>(feature - features.begin())] = *value;
  }
  if (good && normal.is_zero()) {
    report.error("E0410", element.place(), "this prior is empty", "write for instance { step = -1 }");
    good = false;
  }
  return good ? std::optional{normal} : std::nullopt;
}

}  // namespace

std::optional<std::vector<HalfSpace>> read_prior(const TomlArray& list, const TomlPlace& place, const Domain* domain,
                                                 TomlReport& report, bool is_of_older) {
  std::vector<HalfSpace> half_spaces;
  bool readable = domain != nullptr;
  for (const auto& element : list) {
    const auto* names = read_table(element, "every element of 'prior'", report);
    const auto normal = names != nullptr && domain != nullptr
                            ? read_normal(element, *names, *domain, is_of_older ? kMaxOfOlder : kMaxEntry, report)
                            : std::nullopt;
    if (normal) half_spaces.emplace_back(*normal);
    readable = readable && normal.has_value();
  }
  if (!readable) return std::nullopt;
  for (std::size_t i = 0; i < half_spaces.size(); ++i) {
    if (is_of_older || half_spaces[i].contains(domain->weights().integer)) continue;
    report.infeasible(
        "E0411", list[i].place(), "this prior does not hold at the robot's weights",
        "learners who start from it could never learn the policy; people with a false belief from which they can "
        "recover are of the kind 'misconceived'");
    return std::nullopt;
  }
  if (!has_interior(half_spaces)) {
    report.infeasible("E0411", place, "no weights satisfy all of 'prior'");
    return std::nullopt;
  }
  return half_spaces;
}

}  // namespace kith
