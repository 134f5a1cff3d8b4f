#include "read_study_spec.hpp"

#include <algorithm>

namespace kith {

std::optional<OlderRobot> read_knowing(TomlReader& learner, const Domain* domain, TomlReport& report) {
  const auto* value = learner.value("knowing", Presence::kOptional);
  if (value == nullptr || value->string() != nullptr) return std::nullopt;
  auto known = learner.table("knowing", Presence::kRequired);
  if (!known) return std::nullopt;
  const auto robot = known->string("robot", Presence::kRequired);
  const auto* list = known->array("halfspaces", Presence::kRequired);
  known->finish();
  if (!robot || list == nullptr) return std::nullopt;
  auto region = read_prior(*list, value->place(), domain, report, true);
  return region ? std::optional{OlderRobot{*robot, *std::move(region)}} : std::nullopt;
}

void check_knowing(TomlReader& learner, const LearnerType& type, const Domain* domain, TomlReport& report) {
  if (!type.knowing || domain == nullptr) return;
  Cone prior{domain->num_features()};
  if (!prior.clip(domain->prior()) || known_to(type, prior)) return;
  report.infeasible("E0425", learner.value("knowing", Presence::kOptional)->place(),
                    "nobody can know '" + type.knowing->name + "' and the prior: no weights satisfy both",
                    "leave out of the prior what did not hold before the update");
}

void presume_knowing(TomlReader& study, StudySpec& spec, const Domain* domain, TomlReport& report) {
  if (!spec.assumes_knowing || domain == nullptr) return;
  if (const auto known = known_to_all(spec)) {
    Cone prior{domain->num_features()};
    if (prior.clip(domain->prior())) spec.teaching.known = known_within(std::move(prior), known->region);
  } else if (std::ranges::any_of(spec.learner_types, [](const auto& type) { return type.knowing.has_value(); })) {
    report.warning("W0409", study.value("learner", Presence::kOptional)->place(),
                   "the teacher assumes that nobody knows an older robot, because not all learners know the same",
                   "give everybody the same 'knowing', or say teacher.knowing = \"nothing\"");
  }
}

}  // namespace kith
