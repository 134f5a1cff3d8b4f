#include "kith/learners/learner_model.hpp"

#include <algorithm>
#include <array>

namespace kith {

LearnerModels learner_models() {
  static const std::array<const LearnerModel*, 6> kModels{
      &bayesian_model(),  &slipping_model(),     &noisy_rational_model(),
      &imitating_model(), &misconceived_model(), &decaying_model(),
  };
  return kModels;
}

const LearnerModel* find_learner_model(std::string_view kind, LearnerModels models) {
  const auto found = std::find_if(models.begin(), models.end(), [&](const auto* model) { return model->kind == kind; });
  return found == models.end() ? nullptr : *found;
}

std::string describe_person(const LearnerModel& model, const ParameterValues& values, std::span<const double> traits) {
  if (model.describe != nullptr) return model.describe(values, traits);
  std::string text;
  for (std::size_t i = 0; i < traits.size() && i < model.traits.size(); ++i) {
    text.append(text.empty() ? "" : ", ").append(model.traits[i].name).append(" ").append(to_string(traits[i]));
  }
  return text.empty() ? std::string{model.kind} : text;
}

std::size_t num_particles(const ParameterValues& values) {
  const auto declared = values.declared();
  const bool has_particles =
      std::any_of(declared.begin(), declared.end(), [](const Parameter& one) { return one.name == "particles"; });
  return has_particles ? static_cast<std::size_t>(values.count("particles")) : 0;
}

Parameter particles_parameter() {
  return {.name = "particles",
          .default_value = std::int64_t{1000},
          .description = "particles of a person's own belief",
          .min = 1,
          .max = 1'000'000};
}

Parameter process_noise_parameter() {
  return {.name = "process_noise",
          .default_value = 0.1,
          .description = "bandwidth factor of the kernel that moves particles after resampling",
          .min = 0.0,
          .max = 10.0};
}

}  // namespace kith
