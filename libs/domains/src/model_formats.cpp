#include "kith/domains/model_formats.hpp"

#include <cmath>

#include "kith/files/reader.hpp"

namespace kith::detail {

bool has_room(const RawModel& model, const ModelPlace& place, ModelReport& report) {
  if (model.num_transitions < kMaxTransitions) return true;
  report.error("E0257", place, "the model has more than " + std::to_string(kMaxTransitions) + " transitions",
               "leave out what the robot cannot reach");
  return false;
}

std::optional<std::uint32_t> action_number(RawModel& model, const std::string& name, const ModelPlace& place,
                                           ModelReport& report) {
  if (const auto known = model.actions.find(name)) return known;
  if (model.actions_are_declared) {
    report.error("E0243", place, "action '" + name + "' is not in [mdp] actions", name_hint(name, model.actions.all()));
    return std::nullopt;
  }
  if (model.actions.size() == kMaxModelActions) {
    report.error("E0257", place, "there are more than " + std::to_string(kMaxModelActions) + " actions",
                 "give the same action the same name in every state");
    return std::nullopt;
  }
  return model.actions.number_of(name);
}

std::string name_hint(const std::string& name, const std::vector<std::string>& known) {
  constexpr std::size_t kCompared = 5'000;  // comparing with more takes too long
  constexpr std::size_t kListed = 8;
  if (known.size() > kCompared) return "";
  const std::string nearest = nearest_word(name, known);
  if (!nearest.empty() || known.size() <= kListed) return suggestion(name, known);
  return "";
}

bool check_finite(double number, const std::string& what, const ModelPlace& place, ModelReport& report) {
  constexpr double kLargest = 2147483648.0;  // 2^31, as for integers
  if (std::abs(number) < kLargest) return true;
  const bool finite = std::isfinite(number);
  report.error("E0249", place, what + (finite ? " is too large" : " is not a finite number"),
               finite ? "features stay below 2^31 in size: count in larger units" : "write a number such as -1 or 0.5");
  return false;
}

}  // namespace kith::detail
