#include "like_bayesian.hpp"

#include <iterator>
#include <stdexcept>
#include <utility>

namespace kith {

std::vector<Parameter> with_bayesian_parameters(std::vector<Parameter> more) {
  const auto bayesian = bayesian_model().parameters;
  std::vector<Parameter> parameters(bayesian.begin(), bayesian.end());
  std::move(more.begin(), more.end(), std::back_inserter(parameters));
  return parameters;
}

LearnerModel like_bayesian(std::string_view kind, std::string_view description, std::span<const Parameter> parameters,
                           std::span<const FittedParameter> fitted, decltype(LearnerModel::make) make) {
  auto model = bayesian_model();
  model.kind = kind;
  model.description = description;
  model.parameters = parameters;
  model.fitted = fitted;
  model.make = std::move(make);
  model.describe = [](const ParameterValues& values, std::span<const double> traits) {
    auto text = bayesian_model().describe(values, traits);
    for (std::size_t i = bayesian_model().parameters.size(); i < values.declared().size(); ++i) {
      text.append(", ").append(values.declared()[i].name).append(" ").append(to_string(values.values()[i]));
    }
    return text;
  };
  return model;
}

void require_paths(const AnswerEvidence& evidence) {
  if (evidence.paths().empty()) throw std::invalid_argument{"Learner::likelihood: the answers must be given as paths"};
}

}  // namespace kith
